"""Launches of trains under a ROS master of their own, for tests of what happens to them: their log with the time of
each line, their processes, their results, and the train in one process to compare these with."""
import contextlib
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest

import rosbag
import rosgraph

SHORT_TRAIN = pathlib.Path(__file__).resolve().parent / "short_train.yaml"  # six wagons


LATE = 600.0  # what waits may take on a loaded machine


def wait_until(condition, timeout_s):
    end = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


class RosMaster:
    """A ROS master without anything else, on a free port."""

    def __init__(self, folder):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            self.port = probe.getsockname()[1]
        self.uri = f"http://localhost:{self.port}"
        # The log of a launch is written at once, line by line, and the launch leaves nothing in the home folder.
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_LOG_DIR=str(folder), PYTHONUNBUFFERED="1")
        self.start()

    def start(self):
        self.process = subprocess.Popen(
            ["rosmaster", "--core", "-p", str(self.port)],
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        assert wait_until(lambda: rosgraph.is_master_online(self.uri), LATE), "no ROS master"

    def services(self):
        with contextlib.suppress(OSError, rosgraph.MasterException):
            return {name for name, _ in rosgraph.Master("/test", self.uri).getSystemState()[2]}
        return set()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def processes(self):
        """All that have been started under it, but for itself: {process: name of its node or program}."""
        found = {}
        mark = f"ROS_MASTER_URI={self.uri}".encode()
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if mark not in (entry / "environ").read_bytes().split(b"\0"):
                    continue
                arguments = (entry / "cmdline").read_text()
                node = re.search(r"\0__name:=(\w+)", arguments)
                found[int(entry.name)] = node[1] if node else (entry / "comm").read_text().strip()
        found.pop(self.process.pid, None)
        return found

    def process_of(self, node, timeout_s=LATE):
        """The process of a node, which is waited for."""
        found = []

        def look():
            found[:] = [process for process, name in self.processes().items() if name == node]
            return found

        assert wait_until(look, timeout_s), f"there is no {node}"
        return found[0]


class Launch:
    """A roslaunch, and what came of it."""

    def __init__(self, master, folder, target, *arguments):
        """@param target  a launch file, or a package and a file; its arguments out and exit_status_file are given"""
        self.out = pathlib.Path(folder) / "out"
        self.status_file = pathlib.Path(folder) / "status"
        self.lines = []  # (time, text)
        # A node that does not listen to SIGINT is given 5 s here instead of 15.
        self.process = subprocess.Popen(
            [
                "roslaunch",
                "--sigint-timeout=5",
                *target,
                f"out:={self.out}",
                f"exit_status_file:={self.status_file}",
                *arguments,
            ],
            env=master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append((time.monotonic(), line))

    def log(self):
        return "".join(line for _, line in list(self.lines))

    def saw(self, pattern, timeout_s, since=0.0):
        """When the first line came that holds the pattern; it is waited for."""
        found = []

        def look():
            found[:] = [when for when, line in list(self.lines) if when >= since and re.search(pattern, line)]
            return found or self.process.poll() is not None

        wait_until(look, timeout_s)
        look()
        assert found, f"'{pattern}' was not logged within {timeout_s} s:\n{self.log()}"
        return found[0]

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        return time.monotonic()

    def ended(self, timeout_s=LATE):
        """Waits for its end. @return the exit code of the train's master; None: it has left none"""
        self.process.wait(timeout_s)
        return int(self.status_file.read_text()) if self.status_file.exists() else None

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def bag(self):
        return messages(self.out / "train.bag")


class LaunchTest(unittest.TestCase):
    """Tests with a ROS master and a folder of their own; whatever has been started ends with the test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.master = RosMaster(folder.name)
        self.addCleanup(self.end_everything)

    def end_everything(self):
        for process in self.master.processes():
            subprocess.run(["kill", "-9", str(process)], stderr=subprocess.DEVNULL, check=False)
        self.master.kill()

    def tool(self, *command, timeout_s=LATE):
        """The output of a command, to its end."""
        done = subprocess.run(
            command,
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=timeout_s,
            check=False,
        )
        return done.stdout


def messages(bag_file):
    """What is in a bag: {topic: [(time, serialised message)]}."""
    found = {}
    with rosbag.Bag(str(bag_file)) as bag:
        for topic, message, when in bag.read_messages(raw=True):
            found.setdefault(topic, []).append((when, message[1]))
    return found


def is_beginning(bag, whole):
    """Whether all that is in a bag is what another one begins with."""
    return all(whole[topic][: len(found)] == found for topic, found in bag.items())


def train_sim(*arguments, scenario=SHORT_TRAIN):
    """A train in one process. @return its summary"""
    done = subprocess.run(
        ["rosrun", "train_sim", "train_sim", "run", "--json", *([str(scenario)] if scenario else []), *arguments],
        check=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    return json.loads(done.stdout)
