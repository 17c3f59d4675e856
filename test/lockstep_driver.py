#!/usr/bin/python3
"""A driver in another node, in lockstep with the train: the same bits at any pace and on any nodes; what happens when
he is late, dies, or speaks otherwise."""
import json
import pathlib
import re
import signal
import subprocess

import rosunit
from train_brake_msgs.srv import DriveRequest

from launches import Launch, LaunchTest, train_sim, wait_until

HERE = pathlib.Path(__file__).resolve().parent
FREIGHT = HERE.parent / "config" / "scenarios" / "drive_and_stop.yaml"
SETTINGS = ["commands=[]", "until=null", "exchange_interval_s=0.002"]
EXCHANGES_PER_PERIOD = 50  # of 0.1 s


class LockstepDriver(LaunchTest):
    def driver(self, *command, namespace="/train"):
        """Starts a driver's node, /train/driver."""
        node = subprocess.Popen(
            [*command, f"__ns:={namespace}", "__name:=driver"],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.addCleanup(node.kill)
        return node

    def example(self, name, *arguments):
        return self.driver("rosrun", "train_brake_examples", name, *arguments)

    def faulty(self, fault, exchange=0):
        return self.driver(str(HERE / "faulty_driver.py"), fault, str(exchange))

    def end(self, node):
        node.terminate()
        node.wait(10)
        self.assertTrue(wait_until(lambda: "/train/driver/drive" not in self.master.services(), 10))

    def launch(self, name, duration_s, *arguments, settings=()):
        folder = self.folder / name
        folder.mkdir()
        return Launch(
            self.master,
            folder,
            ("train_brake", "train.launch"),
            f"scenario:={FREIGHT}",
            "vehicles:=11",
            "model:=ltd",
            "driver:=driver",
            "set:=" + " ".join([*SETTINGS, *settings, f"duration_s={duration_s}"]),
            *arguments,
        )

    def run_train(self, name, duration_s, *arguments, code=0, **options):
        launch = self.launch(name, duration_s, *arguments, **options)
        self.assertEqual(code, launch.ended(300), launch.log())
        return launch

    def given(self, launch):
        return [(c["exchange"], c["command"]) for c in launch.summary()["commands"]]

    def test_a_python_driver_is_the_same_at_any_pace_and_on_any_nodes(self):
        driver = self.example("hold_speed", "_speed_kmh:=9")
        runs = [
            self.run_train("alone", 90),
            self.run_train("one", 90, "on_nodes:=true", "nodes:=1"),
            self.run_train("three", 90, "on_nodes:=true", "nodes:=3", "real_time_factor:=20"),
            self.run_train("again", 90),
        ]
        self.end(driver)
        first = runs[0].summary()
        self.assertEqual(1, len({run.summary()["state_digest"] for run in runs}))
        self.assertEqual(1, len({json.dumps(self.given(run)) for run in runs}))
        self.assertGreater(len(first["commands"]), 2)
        self.assertTrue(all(c["exchange"] % EXCHANGES_PER_PERIOD == 0 for c in first["commands"]))
        # It holds the speed: the integral leaves no error but that of whole notches.
        self.assertAlmostEqual(9, first["final_speed_kmh"]["mean"], delta=0.5)

        # In process: by the bag, as a scenario; and by a driver who does again what was recorded.
        verified = subprocess.run(
            ["rosrun", "train_sim", "train_sim", "verify", str(runs[2].out)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.assertEqual(0, verified.returncode, verified.stdout)
        self.assertIn(first["state_digest"], verified.stdout)
        self.assertEqual(first["state_digest"], train_sim(scenario=runs[1].out / "replay.yaml")["state_digest"])
        self.example("replay_commands", str(runs[1].out / "train.bag"))
        self.assertEqual(first["state_digest"], self.run_train("replayed", 90).summary()["state_digest"])

    def test_a_train_is_stopped_at_a_place(self):
        self.example("stop_at_place", "_place_m:=700")
        launch = self.run_train(
            "run", 200, settings=["initial_speed_kmh=40", "until={standing: true}", "exchange_interval_s=0.005"]
        )
        summary = launch.summary()
        self.assertEqual("until", summary["ended_by"])
        applied = [command for _, command in self.given(launch)]
        self.assertGreater(len(applied), 1)
        self.assertTrue(all(command.startswith("apply") for command in applied))
        self.assertLess(abs(summary["stop_distance_m"] - 700), 30, summary)

    def test_a_killed_driver_triggers_the_policy(self):
        for policy, code, consequence in (
            ("emergency", 0, "The emergency brake is applied"),
            ("hold", 0, "continues with the driver's last commands"),
            ("stop", 4, "the driver is lost"),
        ):
            driver = self.example("hold_speed", "_speed_kmh:=30")
            launch = self.launch(policy, 8, "real_time_factor:=1", f"on_lost_driver:={policy}")
            launch.saw(r" [1-5]\.\d+ of 8 s", 90)
            subprocess.run(["kill", "-9", str(self.master.process_of("driver"))], check=True)
            self.assertEqual(code, launch.ended(60), launch.log())
            self.assertIn(consequence, launch.log())
            self.assertRegex(launch.log(), r"/train/driver, exchange \d+: (closed the connection|connection broke)")
            driver.wait(10)
            given = self.given(launch)
            if policy == "emergency":
                self.assertEqual(["throttle 0", "emergency"], [command for _, command in given[-2:]])
                self.assertEqual(0, given[-1][0] % EXCHANGES_PER_PERIOD)
                verified = subprocess.run(
                    ["rosrun", "train_sim", "train_sim", "verify", str(launch.out)], stdout=subprocess.PIPE, text=True
                )
                self.assertEqual(0, verified.returncode, verified.stdout)
            else:
                self.assertNotIn("emergency", [command for _, command in given])
            self.assertEqual(policy != "stop", launch.summary()["complete"])

    def test_a_stopped_driver_is_named_in_stages(self):
        self.example("hold_speed", "_speed_kmh:=30")
        launch = self.launch("run", 4, "real_time_factor:=0.5", "driver_timeout:=5")
        launch.saw(r" [12]\.\d+ of 4 s", 90)
        process = self.master.process_of("driver")
        subprocess.run(["kill", "-STOP", str(process)], check=True)
        first = launch.saw(r"waiting for 1 s already for the driver /train/driver", 20)
        second = launch.saw(r"waiting for 3 s already for the driver /train/driver", 20)
        lost = launch.saw(r"the driver is lost: .*no answer within 5 s", 20)
        self.assertLess(first, second)
        self.assertLess(second, lost)
        self.assertEqual(0, launch.ended(60), launch.log())
        self.assertEqual("emergency", self.given(launch)[-1][1])
        subprocess.run(["kill", "-KILL", str(process)], check=True)

    def test_who_wakes_up_in_time_changes_no_bit(self):
        self.example("hold_speed", "_speed_kmh:=30")
        whole = self.run_train("whole", 4)
        launch = self.launch("late", 4, "real_time_factor:=0.5")
        launch.saw(r" [12]\.\d+ of 4 s", 90)
        process = self.master.process_of("driver")
        subprocess.run(["kill", "-STOP", str(process)], check=True)
        launch.saw(r"waiting for 1 s already for the driver", 20)
        subprocess.run(["kill", "-CONT", str(process)], check=True)
        self.assertEqual(0, launch.ended(60), launch.log())
        self.assertEqual(whole.summary()["state_digest"], launch.summary()["state_digest"])

    def test_an_interrupted_run_goes_on_with_its_driver(self):
        self.example("hold_speed", "_speed_kmh:=9", "_notches_per_m:=0")  # depends on nothing but its view
        whole = self.run_train("whole", 20)
        launch = self.launch("part", 20, "real_time_factor:=2")
        launch.saw(r" ([2-9]|1\d)\.\d+ of 20 s", 90)
        launch.interrupt()
        self.assertEqual(130, launch.ended(60), launch.log())
        rest = Launch(
            self.master,
            launch.out.parent,
            ("train_brake", "train.launch"),
            f"resume:={launch.out}",
            "vehicles:=11",
            "model:=ltd",
            "driver:=driver",
        )
        self.assertEqual(0, rest.ended(60), rest.log())
        self.assertEqual(whole.summary()["state_digest"], rest.summary()["state_digest"])

    def test_who_speaks_otherwise_is_refused(self):
        for fault, words in (
            ("version", f"the driver /train/driver version {DriveRequest.PROTOCOL_VERSION + 1}"),
            ("md5sum", "cannot be asked"),
        ):
            driver = self.faulty(fault)
            launch = self.run_train(fault, 2, code=4)
            self.assertIn(words, launch.log())
            self.end(driver)
        launch = self.run_train("none", 2, "startup_timeout:=1", code=4)
        self.assertRegex(launch.log(), "the driver /train/driver is missing after .*drive is not advertised")
        stray = self.driver("rosrun", "train_brake_examples", "hold_speed", "_speed_kmh:=30", namespace="/other")
        self.assertTrue(wait_until(lambda: "/other/driver/drive" in self.master.services(), 120))
        launch = self.run_train("elsewhere", 2, "startup_timeout:=1", code=4)
        self.assertIn("but /other/driver/drive is: for that driver say driver:=/other/driver", launch.log())
        self.run_train("there", 2, "driver:=/other/driver")
        stray.kill()
        launch = self.run_train("period", 2, "control_period:=0.003", code=2)
        self.assertIn("control_period_s must be a multiple of the exchange interval, 0.002 s, got 0.003", launch.log())

    def test_answers_that_cannot_be_used(self):
        for fault, words in (("stale", "answered exchange 99"), ("gives_up", "gives up: lunch")):
            driver = self.faulty(fault, 100)
            launch = self.run_train(fault, 2)
            self.assertIn(f"/train/driver, exchange 100: {words}", launch.log())
            self.assertEqual([(100, "throttle 0"), (100, "emergency")], self.given(launch))
            self.end(driver)
        driver = self.faulty("refused", 100)
        launch = self.run_train("refused", 2)
        self.assertEqual([], self.given(launch))
        self.assertEqual(
            2, len(re.findall("exchange 100: a command of the driver /train/driver is refused", launch.log()))
        )
        driver.send_signal(signal.SIGTERM)
        told = driver.communicate(timeout=10)[0]
        self.assertIn("refused: reduction_kpa must be > 0", told)
        self.assertIn("kind must be one of apply", told)


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "lockstep_driver", LockstepDriver)
