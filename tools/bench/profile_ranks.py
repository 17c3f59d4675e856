"""Cost of an exchange for each rank: time on a core and in the kernel, waits for a core, changes between processes."""
import os
import pathlib
import re
import threading
import time

PROC = pathlib.Path("/proc")
TICKS_PER_S = os.sysconf("SC_CLK_TCK")
WINDOW_S = 0.7
LOOK_S = 0.2
FEWEST_SWITCHES = 20  # of a rank between two looks, once the run has begun


class Watch:
    """Watches the processes of that name below this one, in a thread, for a short time in the middle of their run.

    @param count  of the processes; those of rank 0 of MPI, which is the master, do not count
    """

    def __init__(self, name, count):
        self._name, self._count = name, count
        self._over = threading.Event()
        self._totals = None  # (seconds, {quantity: sum over the processes})
        self._thread = threading.Thread(target=self._run)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._thread.join()

    def per_exchange(self, seconds):
        """Of a rank in an exchange that takes so long: cpu_us, wait_us, switches, system (a share); None: not seen."""
        if self._totals is None:
            return None
        window_s, totals = self._totals
        per = 1.0 / (self._count * window_s / seconds)
        ticks = totals["user"] + totals["system"]
        return {
            "cpu_us": 1e-3 * totals["run"] * per,
            "wait_us": 1e-3 * totals["wait"] * per,
            "switches": totals["switches"] * per,
            "system": totals["system"] / ticks if ticks else None,
        }

    def _run(self):
        processes, before = [], None
        while not self._over.wait(LOOK_S):
            if len(processes) != self._count:
                processes = [pid for pid in _below(os.getpid()) if _is_rank(pid, self._name)]
                continue
            now = _read(processes[:1])
            has_begun = before and now and now["switches"] - before["switches"] > FEWEST_SWITCHES
            before = now
            if not has_begun:
                continue
            first, begin = _read(processes), time.monotonic()
            if self._over.wait(WINDOW_S):
                return
            last, end = _read(processes), time.monotonic()
            if first and last:
                self._totals = end - begin, {name: last[name] - first[name] for name in first}
            return


def _below(pid):
    found = []
    try:
        for task in (PROC / str(pid) / "task").iterdir():
            for child in (task / "children").read_text().split():
                found += [int(child), *_below(child)]
    except OSError:
        pass  # has ended
    return found


def _is_rank(pid, name):
    try:
        folder = PROC / str(pid)
        return (folder / "comm").read_text().strip() == name and b"OMPI_COMM_WORLD_RANK=0\0" not in (
            folder / "environ"
        ).read_bytes()
    except OSError:
        return False


def _read(processes):
    """Sums over all threads of the processes; None if one has ended."""
    sums = dict.fromkeys(("run", "wait", "switches", "user", "system"), 0)
    try:
        for pid in processes:
            for task in (PROC / str(pid) / "task").iterdir():
                run, wait, _ = map(int, (task / "schedstat").read_text().split())
                fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
                switches = re.findall(r"ctxt_switches:\s*(\d+)", (task / "status").read_text())
                for name, value in zip(sums, (run, wait, sum(map(int, switches)), int(fields[11]), int(fields[12]))):
                    sums[name] += value
    except (OSError, ValueError):
        return None
    return sums
