#!/usr/bin/python3
"""Commands that are given to a running train: they take effect, are recorded, and the run is repeated to the same bits."""
import json
import pathlib
import random
import subprocess

import rosunit

from launches import Launch, LaunchTest, train_sim, wait_until

HERE = pathlib.Path(__file__).resolve().parent
SETTINGS = ["duration_s=8", "ledger_interval_s=1", "record_interval_s=0.02", "commands=[]", "initial_speed_kmh=30"]


class LiveCommands(LaunchTest):
    def give(self, **command):
        return self.tool("rosservice", "call", "/train/driver/give", json.dumps({"command": command}))

    def test_random_commands_are_repeated_to_the_same_bits(self):
        launch = Launch(
            self.master,
            self.folder,
            ("train_brake", "train.launch"),
            f"scenario:={HERE / 'short_train.yaml'}",
            "vehicles:=6",
            "nodes:=2",
            "real_time_factor:=1",
            "start_paused:=true",
            "set:=" + " ".join(SETTINGS),
        )
        self.assertTrue(wait_until(lambda: "/train/driver/give" in self.master.services(), 30), launch.log())
        seed = random.Random(20)
        refused = [
            self.give(kind="apply", reduction_kpa=5000.0),
            self.give(kind="brake"),
            self.give(kind="throttle", notch=3.0),
            self.give(kind="apply"),
        ]
        for reply, words in zip(
            refused,
            (
                "reduction_kpa must be",
                "kind must be one of apply",
                "a train without a locomotive",
                "reduction_kpa must be > 0",
            ),
        ):
            self.assertIn("success: False", reply)
            self.assertIn(words, reply)
        self.assertIn("success: True", self.give(kind="apply", reduction_kpa=round(seed.uniform(45, 60), 3)))
        self.tool("rosservice", "call", "/train/master/resume")
        self.tool(
            "rostopic",
            "pub",
            "-1",
            "/train/driver/command",
            "train_brake_msgs/DriverCommand",
            json.dumps({"kind": "apply", "reduction_kpa": round(seed.uniform(80, 100), 3)}),
        )
        self.give(kind="emergency")
        self.give(kind="release")  # weaker: the emergency holds
        self.assertEqual(0, launch.ended(120), launch.log())
        summary = launch.summary()
        self.assertEqual(
            ["apply", "apply", "emergency", "release"], [c["command"].split()[0] for c in summary["commands"]]
        )
        self.assertTrue(all(c["live"] for c in summary["commands"]))
        self.assertEqual(0, summary["commands"][0]["exchange"])

        verified = subprocess.run(
            ["rosrun", "train_sim", "train_sim", "verify", str(launch.out)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.assertEqual(0, verified.returncode, verified.stdout)
        self.assertIn(summary["state_digest"], verified.stdout)
        again = train_sim(scenario=launch.out / "replay.yaml")
        self.assertEqual(summary["state_digest"], again["state_digest"])
        # A branch takes over what came live before it.
        branch = self.folder / "branch"
        train_sim("--resume", str(launch.out), "--set", "duration_s=9", "--out", str(branch), scenario=None)
        longer = train_sim("--set", "duration_s=9", scenario=launch.out / "replay.yaml")
        self.assertEqual(longer["state_digest"], json.loads((branch / "summary.json").read_text())["state_digest"])
        verified = subprocess.run(
            ["rosrun", "train_sim", "train_sim", "verify", str(branch)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.assertEqual(0, verified.returncode, verified.stdout)
        self.assertIn(longer["state_digest"], verified.stdout)
        without = train_sim(*[word for s in SETTINGS for word in ("--set", s)])
        self.assertNotEqual(summary["state_digest"], without["state_digest"])
        self.assertLess(summary["final_speed_kmh"]["mean"], without["final_speed_kmh"]["mean"])


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "live_commands", LiveCommands)
