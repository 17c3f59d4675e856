#!/usr/bin/python3
"""Many short trains in a row under one ROS master: nothing may pile up.

Each round is a launch of a train and a run of another master on two wagon nodes that stay for all rounds. Measured
after each round: memory, descriptors and threads of the ROS master and of those wagon nodes; how many processes there
are; what the ROS master knows; what lies in /dev/shm and among temporary files.

usage: soak.py [rounds] [arguments of unittest]
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

import rosgraph
import rosunit

from launches import SHORT_TRAIN, Launch, RosMaster, train_sim, wait_until


def measure(process):
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return {"memory_kib": int(re.search(r"RssAnon:\s*(\d+)", status)[1]),
            "threads": int(re.search(r"Threads:\s*(\d+)", status)[1]),
            "descriptors": len(os.listdir(f"/proc/{process}/fd"))}


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
            wagon = self.node("wagon_node", "wagon_node", name, "_master_timeout_s:=0")
            self.addCleanup(wagon.wait)
            self.addCleanup(wagon.kill)
        self.assertTrue(wait_until(lambda: {"/stay/wagon_001/step", "/stay/wagon_004/step"} <= self.master.services(), 60))

    def node(self, package, program, name, *parameters):
        return subprocess.Popen(["rosrun", package, program, "__ns:=/stay", f"__name:={name}", *parameters],
                                env=self.master.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def round(self, expected):
        launch = Launch(self.master, self.folder, ("train_brake", "train.launch"), f"scenario:={SHORT_TRAIN}", "vehicles:=6",
                        "nodes:=2")
        self.assertEqual(0, launch.ended(), launch.log())
        self.assertEqual(expected, launch.summary()["state_digest"])
        master = self.node("ltd_master", "ltd_master", "master", f"_scenario:={SHORT_TRAIN}", "_ranks:=2")
        self.assertEqual(0, master.wait(60))

    def sample(self):
        graph = rosgraph.Master("/soak", self.master.uri)
        publishers, subscribers, services = graph.getSystemState()
        # roslaunch leaves its own address at every ROS master that it did not start itself.
        parameters = [name for name in graph.getParamNames() if not name.startswith("/roslaunch/uris/")]
        stay = {process: name for process, name in self.master.processes().items() if name.startswith("wagon")}
        found = {("all", "processes"): len(self.master.processes()), ("/dev/shm", "files"): len(os.listdir("/dev/shm")),
                 ("TMPDIR", "files"): len(os.listdir(self.temporary)), ("ROS master", "parameters"): len(parameters),
                 ("ROS master", "publishers"): len(publishers), ("ROS master", "subscribers"): len(subscribers),
                 ("ROS master", "services"): len(services)}
        for process, name in [(self.master.process.pid, "ROS master"), *stay.items()]:
            found.update(((name, key), value) for key, value in measure(process).items())
        return found

    def test_soak(self):
        expected = train_sim()["state_digest"]
        samples = []
        for _ in range(self.rounds):
            self.round(expected)
            time.sleep(0.2)
            samples.append(self.sample())
            print({f"{a} {b}": v for (a, b), v in samples[-1].items()}, flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1].isdigit():
        Soak.rounds = int(sys.argv.pop(1))
    unittest.main(warnings="ignore", catchbreak=True)
