#!/usr/bin/python3
"""Commands that are given to a running train: they take effect, are recorded, and the run is repeated to the same
bits."""
import json
import os
import pathlib
import pty
import random
import re
import subprocess
import time

import rosunit

from launches import Launch, LaunchTest, train_sim, wait_until

HERE = pathlib.Path(__file__).resolve().parent
SETTINGS = ["duration_s=8", "ledger_interval_s=1", "record_interval_s=0.02", "commands=[]", "initial_speed_kmh=30"]
FREIGHT = HERE.parent / "config" / "scenarios" / "drive_and_stop.yaml"
# What a joystick tells: at rest, half up, no stick and a button, a stick that is broken and the button again, at rest.
STICK = """
import rospy, time
from sensor_msgs.msg import Joy
rospy.init_node("joy")
joy = rospy.Publisher("/train/joy", Joy, queue_size=10)
while joy.get_num_connections() == 0: time.sleep(0.1)
for axes, buttons in (([0, 0], [0, 0, 0]), ([0, 0.5], [0, 0, 0]), ([], [1]), ([0, 0.5], [0]),
                      ([0, float("nan")], [1, 0, 0]), ([0, 0], [0, 0, 0]), ([0, 0], [0, 1, 0])):
    joy.publish(Joy(axes=axes, buttons=buttons))
    time.sleep(0.3)
"""
# A driver who does this and that at random times, and much that no train obeys.
AT_RANDOM = """
import random, rospy, sys, time
from train_brake_msgs.msg import DriverCommand
seed, nan = random.Random(int(sys.argv[1])), float("nan")
rospy.init_node("driver", anonymous=True, disable_rostime=True)
publisher = rospy.Publisher("/train/driver/command", DriverCommand, queue_size=100)
while publisher.get_num_connections() == 0: time.sleep(0.05)
SOUND = (lambda: dict(kind="throttle", notch=seed.randint(0, 8)),
         lambda: dict(kind="apply", reduction_kpa=seed.uniform(50, 120)),
         lambda: dict(kind="release"),
         lambda: dict(kind="friction", from_m=seed.uniform(0, 20), to_m=seed.uniform(20, 90),
                      friction_coefficient=seed.uniform(0.02, 0.1)))
WRONG = (dict(kind="apply", reduction_kpa=nan), dict(kind="throttle", notch=nan), dict(kind="throttle", notch=-1),
         dict(kind="throttle", notch=1, vehicles=[99]), dict(kind="fly"), dict(kind="friction", to_m=1e400),
         dict(kind="friction", to_m=1, friction_coefficient=2))
for wrong in WRONG + WRONG:
    time.sleep(seed.uniform(0, 0.4))
    publisher.publish(DriverCommand(**seed.choice(SOUND)()))
    publisher.publish(DriverCommand(**wrong))
time.sleep(0.5)
"""


class LiveCommands(LaunchTest):
    def assert_verified(self, out, digest):
        """Repeated in process, the run has that digest."""
        verified = subprocess.run(
            ["rosrun", "train_sim", "train_sim", "verify", str(out)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.assertEqual(0, verified.returncode, verified.stdout)
        self.assertIn(digest, verified.stdout)

    def drivable(self, scenario, *arguments, settings):
        """A launch whose train takes commands."""
        words = (f"scenario:={scenario}", *arguments, f"set:={settings}")
        launch = Launch(self.master, self.folder, ("train_brake", "train.launch"), *words)
        self.assertTrue(wait_until(lambda: "/train/driver/give" in self.master.services(), 120), launch.log())
        return launch

    def give(self, **command):
        return self.tool(
            "rosservice", "call", "/train/driver/give", json.dumps({"command": command}).replace("NaN", ".nan")
        )

    def test_random_commands_are_repeated_to_the_same_bits(self):
        launch = self.drivable(
            HERE / "short_train.yaml", "vehicles:=6", "nodes:=2", "start_paused:=true", settings=" ".join(SETTINGS)
        )
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
        step = lambda: self.tool("rosservice", "call", "/train/master/step", "1000")
        self.assertIn("success: True", step())
        self.tool(
            "rostopic",
            "pub",
            "-1",
            "/train/driver/command",
            "train_brake_msgs/DriverCommand",
            json.dumps({"kind": "apply", "reduction_kpa": round(seed.uniform(80, 100), 3)}),
        )
        step()
        self.give(kind="emergency")
        self.give(kind="release")  # weaker: the emergency holds
        self.tool("rosservice", "call", "/train/master/resume")
        self.assertEqual(0, launch.ended(120), launch.log())
        summary = launch.summary()
        self.assertEqual(
            ["apply", "apply", "emergency", "release"], [c["command"].split()[0] for c in summary["commands"]]
        )
        self.assertTrue(all(c["live"] for c in summary["commands"]))
        self.assertEqual([0, 1000, 2000, 2000], [c["exchange"] for c in summary["commands"]])

        self.assert_verified(launch.out, summary["state_digest"])
        again = train_sim(scenario=launch.out / "replay.yaml")
        self.assertEqual(summary["state_digest"], again["state_digest"])
        # A branch takes over what came live before it.
        branch = self.folder / "branch"
        train_sim("--resume", str(launch.out), "--set", "duration_s=9", "--out", str(branch), scenario=None)
        longer = train_sim("--set", "duration_s=9", scenario=launch.out / "replay.yaml")
        self.assertEqual(longer["state_digest"], json.loads((branch / "summary.json").read_text())["state_digest"])
        self.assert_verified(branch, longer["state_digest"])
        without = train_sim(*[word for s in SETTINGS for word in ("--set", s)])
        self.assertNotEqual(summary["state_digest"], without["state_digest"])
        self.assertLess(summary["final_speed_kmh"]["mean"], without["final_speed_kmh"]["mean"])

    def test_two_drivers_at_random_times_are_repeated_to_the_same_bits(self):
        settings = ["commands=[]", "until=null", "duration_s=90", "exchange_interval_s=0.005", "initial_speed_kmh=20"]
        launch = self.drivable(
            FREIGHT, "vehicles:=11", "model:=ltd", "real_time_factor:=1", settings=" ".join(settings)
        )
        drivers = [
            subprocess.Popen(["/usr/bin/python3", "-c", AT_RANDOM, seed], env=self.master.environment) for seed in "12"
        ]
        self.assertEqual([0, 0], [driver.wait(90) for driver in drivers])
        self.assertIn("live_command_latency_max_exchanges", self.tool("rostopic", "echo", "-n1", "/diagnostics"))
        self.tool("rosservice", "call", "/train/master/set_real_time_factor", "0")  # the rest as fast as possible
        self.assertEqual(0, launch.ended(200), launch.log())
        refusals = re.findall("a command on driver/command is refused: (.*)", launch.log())
        self.assertEqual(28, len(refusals), launch.log())
        for words in (
            "reduction_kpa must be",
            "notch must be >= 0, got nan",
            "got -1",
            "kind must be one of",
            "to_m must",
        ):
            self.assertTrue(any(words in refusal for refusal in refusals), f"{words}: {refusals}")
        summary = launch.summary()
        self.assertEqual(28, len(summary["commands"]))
        self.assertGreater(len({c["exchange"] for c in summary["commands"]}), 10)
        self.assertEqual(4, len({c["command"].split()[0] for c in summary["commands"]}))
        self.assert_verified(launch.out, summary["state_digest"])
        self.assertEqual(summary["state_digest"], train_sim(scenario=launch.out / "replay.yaml")["state_digest"])

    def test_a_patch_of_rail_that_comes_live_is_as_one_of_the_track(self):
        patch = {"from_m": 10.0, "to_m": 60.0, "friction_coefficient": 0.03}
        settings = ["duration_s=4", "record_interval_s=0.02", "ledger_interval_s=1", "detail_vehicles=[]"]
        launch = self.drivable(
            HERE / "short_train.yaml",
            "vehicles:=6",
            "nodes:=2",
            "real_time_factor:=1",
            "start_paused:=true",
            settings=" ".join(settings),
        )
        for wrong, words in (
            ({"to_m": 10.0}, "to_m must be greater than from_m"),
            ({"from_m": float("nan")}, "from_m must be finite, got "),
            ({"friction_coefficient": -0.1}, "friction_coefficient must be > 0"),
            ({"friction_coefficient": float("nan")}, "friction_coefficient must be > 0"),
        ):
            self.assertIn(words, self.give(kind="friction", **{**patch, **wrong}))
        self.assertIn("success: True", self.give(kind="friction", **patch))
        self.tool("rosservice", "call", "/train/master/resume")
        launch.saw(r" 1\.\d+ of 4 s", 30)
        subprocess.run(["kill", "-9", str(self.master.process_of("wagon_004"))], check=True)
        self.assertEqual(0, launch.ended(120), launch.log())  # who takes its place has the patch, too
        summary = launch.summary()
        given = [c for c in summary["commands"] if c["live"]]
        self.assertEqual(["friction 0.03 from 10 to 60 m"], [c["command"] for c in given])
        self.assertEqual(0, given[0]["exchange"])
        words = [word for s in settings for word in ("--set", s)]
        of_track = train_sim(*words, "--set", "track={name: slippery, friction_patches: [" + json.dumps(patch) + "]}")
        self.assertEqual(of_track["state_digest"], summary["state_digest"])
        self.assertNotEqual(train_sim(*words)["state_digest"], summary["state_digest"])
        self.assertEqual(summary["state_digest"], train_sim(scenario=launch.out / "replay.yaml")["state_digest"])
        self.assert_verified(launch.out, summary["state_digest"])
        branch = self.folder / "branch"
        train_sim("--resume", str(launch.out), "--set", "duration_s=5", "--out", str(branch), scenario=None)
        longer = train_sim("--set", "duration_s=5", scenario=launch.out / "replay.yaml")
        self.assertEqual(longer["state_digest"], json.loads((branch / "summary.json").read_text())["state_digest"])

    def test_keys_and_joystick_of_a_cab(self):
        launch = self.drivable(
            FREIGHT,
            "vehicles:=11",
            "model:=ltd",
            "real_time_factor:=1",
            settings="commands=[] until=null duration_s=600 exchange_interval_s=0.005",
        )
        terminal, end = pty.openpty()
        cab = subprocess.Popen(
            ["rosrun", "train_brake_examples", "cab_controls", "__ns:=/train"],
            env=self.master.environment,
            stdin=end,
            stdout=subprocess.DEVNULL,
        )
        self.addCleanup(cab.kill)
        press = lambda keys: os.write(terminal, keys.encode())
        self.assertTrue(wait_until(lambda: "/train/cab_controls/get_loggers" in self.master.services(), 120))
        time.sleep(3)  # until they are connected
        press("wwws")
        time.sleep(1.5)
        self.assertIn("success: True", self.give(kind="throttle", notch=5.0))
        time.sleep(1.5)
        press("w")  # the lever has gone with the train
        self.tool("/usr/bin/python3", "-c", STICK)
        press(" ")
        time.sleep(2)
        press("q")
        self.assertEqual(0, cab.wait(30))
        time.sleep(1)
        launch.interrupt()
        self.assertEqual(130, launch.ended(60), launch.log())
        expected = ["throttle 1", "throttle 2", "throttle 3", "throttle 2", "throttle 5", "throttle 6"]
        expected += ["throttle 4", "apply 50 kPa", "apply 60 kPa", "throttle 0", "release", "emergency"]
        self.assertEqual(expected, [c["command"] for c in launch.summary()["commands"]])


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "live_commands", LiveCommands)
