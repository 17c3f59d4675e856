#!/usr/bin/python3
"""Vehicles that an external node moves: in a train, beside the built-in ones, judged, faulty, lost and brought back."""
import json
import pathlib
import re
import signal
import subprocess

import rosbag
import rosunit

from launches import SHORT_TRAIN, LaunchTest, wait_until

HERE = pathlib.Path(__file__).resolve().parent
CONFIG = HERE.parent / "config"
# Two wagons of this program, two of an external node: two masses that are joined as all others are.
SCENARIO = f"""
base: {SHORT_TRAIN}
model: ltd
duration_s: 2
record_interval_s: 0.1
ledger_interval_s: 0.1
exchange_interval_s: 0.002
detail_vehicles: []
train:
  name: four
  connection: {CONFIG}/couplers/calibrated.yaml
  consist:
    - {{vehicle: {CONFIG}/vehicles/ore_wagon.yaml, count: 2, locomotive: true}}
    - {{vehicle: {CONFIG}/vehicles/ore_wagon.yaml, count: 2, external: mine}}
"""


class ExternalVehicles(LaunchTest):
    def setUp(self):
        super().setUp()
        self.scenario = self.folder / "four.yaml"
        self.scenario.write_text(SCENARIO)

    def node(self, *command):
        node = subprocess.Popen(
            [*command, "__ns:=/train", "__name:=mine"],
            env=self.master.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.addCleanup(node.kill)
        self.assertTrue(wait_until(lambda: {"/train/mine/configure", "/train/mine/step"} <= self.master.services(), 90))
        return node

    def example(self, name="own_vehicle"):
        return self.node("rosrun", "train_brake_examples", name)

    def end(self, node):
        node.send_signal(signal.SIGINT)  # Ctrl-C: roscpp takes its services back then, and not at SIGTERM
        node.wait(10)
        self.assertTrue(wait_until(lambda: "/train/mine/step" not in self.master.services(), 10))

    def command(self, *words, timeout_s=120):
        done = subprocess.run(
            words,
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            cwd=self.folder,
            timeout=timeout_s,
            check=False,
        )
        return done.returncode, done.stdout

    def run_train(self, out, *arguments, code=0):
        ended, log = self.command("rosrun", "train_brake", "run", str(self.scenario), out, "report:=false", *arguments)
        self.assertEqual(code, ended, log)
        return log

    def summary(self, out):
        return json.loads((self.folder / out / "summary.json").read_text())

    def test_they_run_in_a_train_in_python_and_in_cpp_the_same(self):
        python = self.example()
        log = self.run_train("alone")
        self.assertIn("/train/mine (vehicles 3-4) gives no snapshots: it cannot be brought back", log)
        self.assertFalse((self.folder / "alone" / "checkpoint.bin").exists())
        self.run_train("again")
        self.run_train("on_nodes", "on_nodes:=true", "nodes:=2")
        self.end(python)
        self.example("own_vehicle_cpp")
        log = self.run_train("cpp")
        self.assertNotIn("gives no snapshots", log)
        digests = {out: self.summary(out)["state_digest"] for out in ("alone", "again", "on_nodes", "cpp")}
        self.assertEqual(1, len(set(digests.values())), digests)
        summary = self.summary("alone")
        self.assertEqual([{"node": "mine", "first_vehicle": 3, "vehicles": 2}], summary["external"])
        self.assertIn("coupler heads", summary["external_covered"]["state_digest"])

        states, ledgers = [], []
        with rosbag.Bag(str(self.folder / "alone" / "train.bag")) as bag:
            for topic, message, _ in bag.read_messages():
                {"/train/state": states, "/train/energy_ledger": ledgers}.get(topic, []).append(message)
        self.assertTrue(
            all(f != f for state in states for f in state.shoe_force_n[2:]), "what a node leaves out is NaN"
        )
        # What goes into the external vehicles through couplers closes the ledger of the rest.
        self.assertGreater(len(ledgers), 10)
        last = ledgers[-1]
        into_them_j = last.dissipated_j[last.element.index("external_vehicles")]
        self.assertGreater(abs(into_them_j), 1e3)
        self.assertLess(abs(last.residual_j), 1e-4 * abs(into_them_j))
        # Their way is the integral of their speed.
        for i in (2, 3):
            way = states[-1].position_m[i] - states[0].position_m[i]
            trapezoid = sum((b.speed_mps[i] + a.speed_mps[i]) / 2 * 0.1 for a, b in zip(states, states[1:]))
            self.assertLess(abs(way - trapezoid), 1e-3 * way)

        # What a program without their node can do, it says.
        code, log = self.command("rosrun", "train_sim", "train_sim", "verify", "alone")
        self.assertEqual(6, code, log)
        self.assertIn("vehicles 3-4 are external, and only the node mine can move them again", log)
        code, log = self.command("rosrun", "train_sim", "train_sim", "run", str(self.scenario))
        self.assertEqual(2, code, log)
        self.assertIn("vehicles 3-4 are external, moved by the node mine", log)
        code, log = self.command("rosrun", "train_sim", "train_sim", "check", str(self.scenario))
        self.assertEqual(0, code, log)
        self.assertRegex(log, "external +vehicles 3-4, moved by the node mine")

    def test_a_scenario_says_who_moves_them(self):
        for word, told in (
            ("train.consist[1].model=ltd", "model must not be given for external vehicles"),
            ("train.consist[0].external=mine", "must differ from that of consist[0]"),
        ):
            code, log = self.command("rosrun", "train_sim", "train_sim", "check", str(self.scenario), "--set", word)
            self.assertEqual(2, code, log)
            self.assertIn(told, log)

    def test_what_is_lost_is_brought_back_if_it_gives_snapshots(self):
        node = self.example("own_vehicle_cpp")
        self.run_train("whole", "set:=duration_s=6")
        train = subprocess.Popen(
            [
                "rosrun",
                "train_brake",
                "run",
                str(self.scenario),
                "broken",
                "report:=false",
                "set:=duration_s=6",
                "real_time_factor:=0.5",
            ],
            env=self.master.environment,
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.assertTrue(wait_until(lambda: (self.folder / "broken").exists(), 120))
        self.tool("rostopic", "echo", "-n20", "/train/live/status")
        subprocess.run(["kill", "-9", str(self.master.process_of("mine"))], check=True)
        node.wait(10)
        self.example("own_vehicle_cpp")
        log = train.communicate(timeout=60)[0]
        self.assertEqual(0, train.returncode, log)
        self.assertRegex(log, r"/train/mine \(vehicles 3-4\) is back")
        self.assertEqual(self.summary("whole")["state_digest"], self.summary("broken")["state_digest"])

    def test_a_run_with_snapshots_goes_on_from_its_checkpoint(self):
        self.example("own_vehicle_cpp")
        self.run_train("whole", "set:=duration_s=3")
        self.run_train("part", "checkpoint_interval:=1")
        code, log = self.command(
            "rosrun", "train_brake", "run", "rest", "resume:=part", "set:=duration_s=3", "report:=false"
        )
        self.assertEqual(0, code, log)
        self.assertEqual(self.summary("whole")["state_digest"], self.summary("rest")["state_digest"])

    def test_who_is_lost_without_snapshots_ends_the_run_by_name(self):
        self.example()
        train = subprocess.Popen(
            ["rosrun", "train_brake", "run", str(self.scenario), "lost", "report:=false", "real_time_factor:=0.2"],
            env=self.master.environment,
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.tool("rostopic", "echo", "-n3", "/train/live/status")
        subprocess.run(["kill", "-9", str(self.master.process_of("mine"))], check=True)
        log = train.communicate(timeout=60)[0]
        self.assertEqual(4, train.returncode, log)
        self.assertRegex(log, r"/train/mine \(vehicles 3-4\), exchange \d+: (closed the connection|connection broke)")

    def test_faults_in_a_run_are_named(self):
        faulty = self.node(str(HERE / "faulty_vehicle.py"), "nan")
        log = self.run_train("nan", code=4)
        self.assertIn("/train/mine (vehicles 3-4), exchange 20: replied head_velocity_mps = nan for vehicle 4", log)
        self.end(faulty)
        self.node(str(HERE / "faulty_vehicle.py"), "slow")
        log = self.run_train("slow")
        self.assertIn("exchange 20: waiting for 1 s already for 1 of 1 wagon nodes: /train/mine (vehicles 3-4)", log)

    def judge(self):
        code, log = self.command("rosrun", "train_brake", "vehicle_test", str(self.scenario), "seconds:=2")
        return code, log, set(re.findall(r"FAILED +(\w+)", log))

    def test_the_examples_are_judged_sound(self):
        for name in ("own_vehicle", "own_vehicle_cpp"):
            node = self.example(name)
            code, log, failed = self.judge()
            self.assertEqual((0, set()), (code, failed), log)
            self.assertEqual(9, log.count("passed"))
            self.assertRegex(log, r"beside it .* m and .* m/s from the built-in ltd model")
            self.end(node)

    def test_faults_are_caught_by_name(self):
        for fault, names in (
            ("active", {"passivity"}),
            ("velocity", {"velocity"}),
            ("nan", {"finite"}),
            ("slow", {"slow"}),
            ("light", {"mass"}),
            ("random", {"repeatability"}),
            ("deaf", {"refusal"}),
        ):
            node = self.node(str(HERE / "faulty_vehicle.py"), fault)
            code, log, failed = self.judge()
            self.assertEqual(1, code, f"{fault}: {log}")
            self.assertTrue(names <= failed, f"{fault}: {log}")
            if fault in ("slow", "deaf", "random"):
                self.assertEqual(names, failed, f"{fault}: {log}")
            self.end(node)

    def test_who_is_not_there_is_named(self):
        code, log = self.command("rosrun", "train_brake", "vehicle_test", str(self.scenario))
        self.assertEqual(2, code, log)
        self.assertIn("/train/mine is not there", log)


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "external_vehicles", ExternalVehicles)
