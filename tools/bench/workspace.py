"""Where the programs are and how they are called."""
import contextlib
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time

import measure

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / "devel" / "lib"
OTHER = None  # a workspace with another build, to compare with
EMERGENCY = ROOT / "config" / "scenarios" / "emergency.yaml"
VEHICLES = 242

_mpi_works = True  # until it fails


def program(package, name):
    path = PROGRAMS / package / name
    if not path.exists():
        raise measure.Failed(f"{path.relative_to(ROOT)} is missing: `make bench` builds it")
    return path


def bench(name):
    return measure.google_benchmark(program("train_dynamics", name))


def commit():
    """What has been measured: the commit, -dirty if a file of it but the page has changed since."""

    def git(*arguments):
        return subprocess.run(
            ["git", "-C", ROOT, *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=True
        ).stdout.strip()

    try:
        changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/performance.md")
        return git("rev-parse", "--short=12", "HEAD") + ("-dirty" if changed else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"  # sources without their history


def other_program(name):
    """Of the other workspace, wherever its build left it."""
    for path in sorted((OTHER / "devel" / "lib").glob(f"*/{name}")):
        if path.read_bytes()[:4] == b"\x7fELF":
            return path
    raise measure.Failed(f"{OTHER} has no devel/lib/*/{name}: build it first (make build)")


def _train_sim(arguments, settings):
    return [
        program("train_sim", "train_sim"),
        "run",
        "--json",
        EMERGENCY,
        *arguments,
        *(word for setting in settings for word in ("--set", setting)),
    ]


def train_sim(*arguments, settings=()):
    """Runs the emergency stop; the Run, with its summary."""
    run = measure.Run(_train_sim(arguments, settings))
    run.summary = json.loads(run.stdout)
    return run


def peak_bytes_of_train_sim(*arguments, settings=()):
    return measure.peak_bytes(program("train_dynamics", "peak_memory"), _train_sim(arguments, settings))


def train_sim_into(folder, *arguments, **options):
    """The same with results in a folder that is new, and gone afterwards."""
    with tempfile.TemporaryDirectory(dir=folder) as out:
        return train_sim(*arguments, "--out", out, **options)


class Launch:
    """A roslaunch of the emergency stop on a ROS master of its own: its summary, wall_s of the run, start_s, stop_s."""

    def __init__(self, nodes, *arguments, record=False, settings=(), timeout_s=600):
        with tempfile.TemporaryDirectory() as folder:
            out, status = pathlib.Path(folder) / "out", pathlib.Path(folder) / "status"
            port = _free_port()
            os.environ.update(ROS_MASTER_URI=f"http://localhost:{port}", ROS_LOG_DIR=f"{folder}/log")
            begin = time.time()
            measure.Run(
                [
                    "roslaunch",
                    "-p",
                    port,
                    "train_brake",
                    "train.launch",
                    f"nodes:={nodes}",
                    *arguments,
                    f"out:={out}",
                    f"record:={str(record).lower()}",
                    f"set:={' '.join(settings)}",
                    f"exit_status_file:={status}",
                    "startup_timeout:=120",
                ],
                timeout_s,
            )
            end = time.time()
            if not status.exists() or status.read_text().strip() != "0":
                raise measure.Failed(f"the launch with {' '.join([f'nodes:={nodes}', *arguments])} failed")
            self.summary = measure.summary_of(out)
            finished = (out / "summary.json").stat().st_mtime
            self.wall_s = self.summary["wall_s"]
            self.start_s = finished - self.wall_s - begin
            self.stop_s = end - finished

    def per_exchange_s(self):
        return per_exchange_s(self.summary)


def per_exchange_s(summary):
    return summary["wall_s"] * summary["exchange_interval_s"] / summary["simulated_s"]


def mpi_train(ranks, settings):
    """The same exchange over MPI; what it printed, or None without an MPI that works."""
    global _mpi_works
    if not _mpi_works or shutil.which("mpirun") is None or not (PROGRAMS / "train_dynamics" / "mpi_train").exists():
        return None
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    try:
        run = measure.Run(
            [
                "mpirun",
                "--oversubscribe",
                "--mca",
                "mpi_yield_when_idle",
                "1",
                "-n",
                ranks + 1,
                program("train_dynamics", "mpi_train"),
                EMERGENCY,
                *settings,
            ],
            timeout_s=120,
        )
    except measure.Failed as failure:  # another MPI than Open MPI has other options
        print(f"No MPI from here on: {failure}", file=sys.stderr)
        _mpi_works = False
        return None
    return json.loads(run.stdout)


def _free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def busy_core(core):
    """A program that does nothing but work, on that core."""
    program = subprocess.Popen(
        [sys.executable, "-c", "while True: pass"],
        preexec_fn=lambda: os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[core]}),
    )
    try:
        yield
    finally:
        program.kill()
        program.wait()
