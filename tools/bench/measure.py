"""Runs programs and measures their time and memory."""
import contextlib
import json
import os
import pathlib
import re
import signal
import statistics
import subprocess
import tempfile
import time


class Failed(Exception):
    """A measured program failed."""


class Run:
    """One process, from start to exit: wall_s, cpu_s, stdout."""

    def __init__(self, command, timeout_s=600, libraries=None):
        environment = {**os.environ, "LD_LIBRARY_PATH": str(libraries)} if libraries else None
        with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
            begin = time.monotonic()
            process = subprocess.Popen(
                [str(c) for c in command], stdout=out, stderr=err, start_new_session=True, env=environment
            )
            with _ended_after(process, timeout_s):
                _, status, usage = os.wait4(process.pid, 0)
            self.wall_s = time.monotonic() - begin
            process.returncode = os.WEXITSTATUS(status) if os.WIFEXITED(status) else -os.WTERMSIG(status)
            self.cpu_s = usage.ru_utime + usage.ru_stime
            out.seek(0)
            err.seek(0)
            self.stdout = out.read()
            if process.returncode != 0:
                raise Failed(
                    f"{' '.join(map(str, command))} ended with exit code {process.returncode}:\n" + err.read()[-2000:]
                )


@contextlib.contextmanager
def _ended_after(process, timeout_s):
    """Ends the whole group of processes when it takes too long, or when this program is interrupted."""

    def too_long(*_):
        raise Failed(f"a measurement took longer than {timeout_s} s")

    before = signal.signal(signal.SIGALRM, too_long)
    signal.alarm(timeout_s)
    try:
        yield
    except BaseException:
        signal.alarm(0)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGINT)  # a roslaunch then ends its nodes
            for _ in range(200):
                if os.waitpid(process.pid, os.WNOHANG)[0] != 0:
                    break
                time.sleep(0.1)
            os.killpg(process.pid, signal.SIGKILL)
        raise
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def median(values):
    return statistics.median(values)


def in_turn(times, *actions):
    """Does A B A B ..., so that a change of the machine's speed meets all alike; lists of results, one per action."""
    results = [[] for _ in actions]
    for _ in range(times):
        for action, result in zip(actions, results):
            result.append(action())
    return results


def ratios(of, to):
    """Pair by pair."""
    return [a / b for a, b in zip(of, to)]


def ratio(of, to):
    """Median of the ratios pair by pair."""
    return median(ratios(of, to))


def peak_bytes(helper, command):
    """The most memory that a program has. Not wait4's, which begins with that of this Python.

    @param helper  the program peak_memory
    """
    return int(Run([helper, *command]).stdout.splitlines()[-1])


def google_benchmark(program, repetitions=3, min_time_s=0.2):
    """Medians of a Google Benchmark program: {name: {counter or "cpu_time" in s: value}}."""
    run = Run(
        [
            program,
            "--benchmark_format=json",
            f"--benchmark_repetitions={repetitions}",
            f"--benchmark_min_time={min_time_s}",
            "--benchmark_report_aggregates_only=true",
        ]
    )
    units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    results = {}
    for result in json.loads(run.stdout)["benchmarks"]:
        if result.get("aggregate_name") != "median":
            continue
        values = {k: v for k, v in result.items() if k.startswith("s_per_")}
        values["cpu_time"] = result["cpu_time"] * units[result["time_unit"]]
        results[re.sub(r"/(real_time|process_time|iterations:\d+)", "", result["run_name"])] = values
    return results


def summary_of(folder):
    return json.loads((pathlib.Path(folder) / "summary.json").read_text())
