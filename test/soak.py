#!/usr/bin/python3
"""Many short trains in a row under one ROS master: nothing may pile up.

Each round is a launch of a train, and a run of another master on two wagon nodes that stay for all rounds. Measured
after each round: memory, descriptors and threads of the ROS master and of those wagon nodes; how many processes there
are; what the ROS master knows; what lies among temporary files.

usage: soak.py [rounds] [arguments of unittest]
       soak.py --short --gtest_output=xml:FILE   a few rounds, for continuous integration
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rosunit

from launches import SHORT_TRAIN, Launch, RosMaster, train_sim, wait_until

# What a process may need more at one time than before, and keep, and what it may lose in each round. A wagon node's
# copy of the scenario's text alone is ten times as much. What roscore loses is ROS's own: it is in Python, has a thread
# for each that calls it, and remembers every roslaunch and every node.
ALLOCATED_KIB, LOST_KIB_PER_ROUND = {"roscore": 2048}, {"roscore": 20}


def measure(process):
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    found = {
        "threads": int(re.search(r"Threads:\s*(\d+)", status)[1]),
        "descriptors": len(os.listdir(f"/proc/{process}/fd")),
    }
    # A sanitizer keeps what is freed, and books of its own; it tells of leaks itself.
    if not re.search(r"lib[at]san\.so", pathlib.Path(f"/proc/{process}/maps").read_text()):
        found["memory KiB"] = int(re.search(r"RssAnon:\s*(\d+)", status)[1])
    return found


class Soak(unittest.TestCase):
    rounds = 100

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.temporary = self.folder / "tmp"
        self.temporary.mkdir()
        self.master = RosMaster(folder.name)
        self.addCleanup(self.master.kill)
        self.master.environment["TMPDIR"] = str(self.temporary)
        for name in ("wagon_001", "wagon_004"):
            wagon = self.start("wagon_node", "wagon_node", name, "_master_timeout_s:=0")
            self.addCleanup(wagon.wait)
            self.addCleanup(wagon.kill)
        self.assertTrue(
            wait_until(lambda: {"/stay/wagon_001/step", "/stay/wagon_004/step"} <= self.master.services(), 60)
        )

    def start(self, package, program, name, *parameters):
        return subprocess.Popen(
            ["rosrun", package, program, "__ns:=/stay", f"__name:={name}", *parameters],
            env=self.master.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def round(self, expected):
        launch = Launch(
            self.master,
            self.folder,
            ("train_brake", "train.launch"),
            f"scenario:={SHORT_TRAIN}",
            "vehicles:=6",
            "nodes:=2",
        )
        self.assertEqual(0, launch.ended(), launch.log())
        self.assertEqual(expected, launch.summary()["state_digest"])
        master = self.start("ltd_master", "ltd_master", "master", f"_scenario:={SHORT_TRAIN}", "_ranks:=2")
        self.assertEqual(0, master.wait(60))
        self.assertTrue(wait_until(lambda: len(self.master.processes()) == 2, 20), self.master.processes())

    def sample(self):
        """{what is counted: how many}"""
        graph = rosgraph.Master("/soak", self.master.uri)
        publishers, subscribers, services = graph.getSystemState()
        # roslaunch leaves its own address at every ROS master that it has not started itself.
        parameters = [name for name in graph.getParamNames() if not name.startswith("/roslaunch/uris/")]
        found = {
            "parameters": len(parameters),
            "publishers": len(publishers),
            "subscribers": len(subscribers),
            "services": len(services),
            "temporary files": len(os.listdir(self.temporary)),
        }
        for process, name in [*self.master.processes().items(), (self.master.process.pid, "roscore")]:
            found.update((f"{key} of {name}", value) for key, value in measure(process).items())
        return found

    def test_nothing_piles_up(self):
        expected = train_sim()["state_digest"]
        samples = []
        for _ in range(self.rounds):
            self.round(expected)
            samples.append(self.sample())
        print(f"{'after round':28} {'1':>8} {self.rounds // 2:>8} {self.rounds:>8}")
        for key, last in samples[-1].items():
            print(f"{key:28} {samples[0][key]:8} {samples[self.rounds // 2 - 1][key]:8} {last:8}")
        for key, last in samples[-1].items():
            limit = max(4, self.rounds // 3)
            if key.startswith("memory"):
                process = key.split()[-1]
                limit = ALLOCATED_KIB.get(process, 512) + LOST_KIB_PER_ROUND.get(process, 1) * self.rounds
            self.assertLess(last - samples[0][key], limit, key)


if __name__ == "__main__":
    if "--short" in sys.argv:
        sys.argv.remove("--short")
        Soak.rounds = 6
        rosunit.unitrun("train_brake", "soak", Soak)
    else:
        if len(sys.argv) > 1 and sys.argv[1].isdigit():
            Soak.rounds = int(sys.argv.pop(1))
        unittest.main(warnings="ignore", catchbreak=True)
