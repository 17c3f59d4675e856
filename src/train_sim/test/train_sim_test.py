#!/usr/bin/env python3
"""train_sim as its users meet it: exit codes, the text of errors, files, Ctrl-C, repeated runs.

usage: train_sim_test.py TRAIN_SIM CONFIG_FOLDER [--gtest_output=xml:FILE]
"""

import csv
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rosunit
from std_msgs.msg import String

TRAIN_SIM, CONFIG = sys.argv[1], pathlib.Path(sys.argv[2])
EMERGENCY = str(CONFIG / "scenarios" / "emergency.yaml")
DIP = str(CONFIG / "scenarios" / "dip.yaml")
SLIDING = str(CONFIG.parent / "test" / "sliding_train.yaml")
SHORT = ["--set", "duration_s=0.5"]


def train_sim(*arguments):
    return subprocess.run(
        [TRAIN_SIM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300
    )


class TrainSimTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "out"
        self.addCleanup(self.folder.cleanup)

    def run_ok(self, *arguments):
        done = train_sim("run", "--json", *arguments)
        self.assertEqual(0, done.returncode, done.stderr)
        return json.loads(done.stdout)

    def write(self, name, text):
        path = pathlib.Path(self.folder.name) / name
        path.write_text(text)
        return path

    def test_summary_names_everything(self):
        summary = self.run_ok(EMERGENCY, "--model", "ltd", "--out", self.out, "--set", "duration_s=5")
        self.assertEqual(summary, json.loads((self.out / "summary.json").read_text()))
        self.assertEqual(("emergency", "ltd", 242), (summary["scenario"], summary["model"], summary["vehicles"]))
        self.assertEqual((0.001, 0.001, 5), (summary["dt_s"], summary["exchange_interval_s"], summary["simulated_s"]))
        self.assertTrue(summary["complete"])
        self.assertFalse(summary["stopped"])
        self.assertIsNone(summary["stop_time_s"])
        self.assertEqual({"mean", "lead", "tail"}, set(summary["final_speed_kmh"]))
        for extreme in (summary["max_tension_n"], summary["max_compression_n"]):
            self.assertEqual({"value", "connection", "time_s"}, set(extreme))
        energy = summary["energy"]
        for element in ("brake_shoes", "draft_gears", "draw_bars", "wheel_rail_creep", "air_drag"):
            self.assertIn(element, energy["dissipated_j"])
        self.assertLess(abs(energy["residual_j"]), 1e-6 * energy["initial_j"])
        balance = (
            energy["initial_j"] + energy["gravity_work_j"] - energy["final_j"] - sum(energy["dissipated_j"].values())
        )
        self.assertLess(abs(balance), 1e-6 * energy["initial_j"])
        self.assertRegex(summary["state_digest"], "^[0-9a-f]{16}$")

    def test_people_are_told_in_a_few_lines_what_a_run_came_to(self):
        for options, where in (
            (["--out", self.out], f"  results: {self.out}   figures: rosrun train_brake report {self.out}\n"),
            ([], "  nothing was written: --out FOLDER keeps the results\n"),
        ):
            done = train_sim("run", EMERGENCY, "--model", "ltd", "--set", "duration_s=5", *options)
            self.assertEqual(0, done.returncode, done.stderr)
            lines = done.stdout.splitlines(keepends=True)
            self.assertLess(len(lines), 7, done.stdout)
            self.assertEqual(where, lines[-1])
            summary = json.loads((self.out / "summary.json").read_text())
            self.assertIn(
                "emergency: 242 vehicles, ltd model, ends after 5.0 s and "
                f"{summary['distance_m']:.1f} m at {summary['final_speed_kmh']['mean']:.1f} km/h",
                lines[0],
            )
        self.assertEqual("".join(lines[:-1]), train_sim("summary", self.out).stdout)
        # 80 km/h for 5 s at most; the brake takes off less than 1 m/s2 for that time.
        self.assertTrue(5 * 80 / 3.6 - 0.5 * 5**2 < summary["distance_m"] < 5 * 80 / 3.6, summary["distance_m"])

    def test_what_is_no_summary_is_told(self):
        self.out.mkdir()
        for text, told in (
            (None, "does not exist"),
            ("[]", "is not the summary of a run"),
            ("{", "is not the summary"),
        ):
            if text:
                (self.out / "summary.json").write_text(text)
            done = train_sim("summary", self.out)
            self.assertEqual((2, ""), (done.returncode, done.stdout))
            self.assertIn("summary.json", done.stderr)
            self.assertIn(told, done.stderr)

    def test_a_twin_tells_how_far_the_maxima_are_determined(self):
        short = ("--model", "ltd", "--set", "duration_s=5")
        self.assertIsNone(self.run_ok(EMERGENCY, *short)["twin"])
        done = train_sim("run", "--json", EMERGENCY, *short, "--twin")
        self.assertEqual(0, done.returncode, done.stderr)
        twin = json.loads(done.stdout)["twin"]
        self.assertEqual(1e-9, twin["start_offset_kmh"])
        self.assertGreater(twin["distance_spread_m"], 1e-10)  # 1e-9 km/h over 5 s: 1.4e-9 m
        self.assertLess(twin["distance_spread_m"], 1e-8)
        self.assertLess(twin["max_tension_spread_n"], 1.0)  # smooth gears are not chaotic
        self.assertEqual(2, train_sim("run", "--resume", self.out, "--twin").returncode)

    def test_check_tells_programs_what_a_scenario_is(self):
        odd = self.write(
            "odd.yaml", f"base: {EMERGENCY}\nname: odd\ndescription: 'a train of 7 vehicle(s), \"quoted\"'\n"
        )
        done = train_sim("check", "--json", odd, "--model", "ltd")
        self.assertEqual(0, done.returncode, done.stderr)
        told = json.loads(done.stdout)
        self.assertEqual(
            (242, "ltd", 'a train of 7 vehicle(s), "quoted"', 70),
            (told["vehicles"], told["model"], told["description"], told["duration_s"]),
        )
        self.assertAlmostEqual(242 * 13.0, told["length_m"], delta=1000)
        self.assertGreater(told["bag_bytes"], 1e6)
        self.assertEqual(2, train_sim("check", "--json", "/nowhere.yaml").returncode)

    def test_a_resolved_scenario_runs_again_to_the_same_bits(self):
        short = ("--set", "duration_s=2", "--set", "model=ltd")
        resolved = train_sim("resolve", EMERGENCY, *short)
        self.assertEqual(0, resolved.returncode, resolved.stderr)
        again = self.run_ok(self.write("resolved.yaml", resolved.stdout))
        self.assertEqual(self.run_ok(EMERGENCY, *short)["state_digest"], again["state_digest"])

    def test_a_train_is_driven_by_speed_and_place_and_ends_at_standstill(self):
        summary = self.run_ok(CONFIG / "scenarios" / "drive_and_stop.yaml", "--out", self.out)
        self.assertEqual(("until", True), (summary["ended_by"], summary["complete"]))
        coast, brake = summary["commands"]
        self.assertEqual(("throttle 0", "apply 80 kPa"), (coast["command"], brake["command"]))
        self.assertLess(coast["time_s"], brake["time_s"])
        self.assertTrue(summary["stopped"])
        self.assertGreater(summary["stop_distance_m"], 3000.0)
        self.assertLess(summary["simulated_s"], 900.0)
        self.assertEqual(0, train_sim("verify", self.out).returncode)

    def test_bag_holds_every_record(self):
        self.run_ok(EMERGENCY, "--out", self.out, "--set", "duration_s=0.2")
        self.assertFalse((self.out / "train.bag.active").exists())
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            topics = bag.get_type_and_topic_info().topics
            count = {topic: info.message_count for topic, info in topics.items()}
            self.assertEqual(21, count["/train/state"])  # time 0 and every 10 ms
            self.assertEqual(21, count["/train/in_train_forces"])
            self.assertEqual(21, count["/train/brake_pressures"])
            self.assertEqual(2, count["/train/energy_ledger"])  # the start and the end
            self.assertEqual(1, count["/train/scenario"])
            for wagon in ("wagon_001", "wagon_100", "wagon_122", "wagon_242"):
                self.assertEqual(21, count["/train/%s/state" % wagon])
            times = []
            for _, state, _ in bag.read_messages("/train/state"):
                times.append(state.header.stamp.to_sec())
                self.assertEqual(242, len(state.position_m))
                self.assertEqual(len(times) * 10 - 10, state.exchange)
            for i, t in enumerate(times):
                self.assertAlmostEqual(0.01 * i, t, places=9)
            for _, forces, _ in bag.read_messages("/train/in_train_forces"):
                self.assertEqual(241, len(forces.coupler_force_n))
            last = list(bag.read_messages("/train/wagon_100/state"))[-1][1]
            self.assertEqual(100, last.vehicle)
            # At 80 km/h without brakes the rails carry the weight: 160.1138 t.
            self.assertAlmostEqual(160113.8 * 9.81, sum(last.normal_force_n), delta=2000)

    def test_same_bits_for_any_threads_and_from_the_resolved_config(self):
        first = self.run_ok(EMERGENCY, "--threads", 1, "--out", self.out, "--set", "duration_s=0.3")
        for threads in (2, 3):
            again = self.run_ok(EMERGENCY, "--threads", threads, "--set", "duration_s=0.3")
            self.assertEqual(first["state_digest"], again["state_digest"])
        resolved = self.run_ok(self.out / "config.yaml", "--out", str(self.out) + "2")
        self.assertEqual(first["state_digest"], resolved["state_digest"])
        self.assertEqual(
            (self.out / "config.yaml").read_text(), (pathlib.Path(str(self.out) + "2") / "config.yaml").read_text()
        )
        other = self.run_ok(EMERGENCY, "--set", "duration_s=0.3", "--set", "initial_speed_kmh=80.0000001")
        self.assertNotEqual(first["state_digest"], other["state_digest"])

    def test_slides_are_the_same_for_any_threads_and_from_their_middle(self):
        first = self.run_ok(SLIDING, "--threads", 1, "--out", self.out)
        self.assertGreater(first["slides"]["slides"], 20)
        self.assertGreater(first["slides"]["flat_risks"], 3)
        locked_s = {(w["vehicle"], w["wheelset"]): w["locked_s"] for w in first["slides"]["wheelsets"]}
        for wheelset in 1, 2, 3, 4:
            self.assertGreater(locked_s[10, wheelset], 5)  # without protection, to the end
            self.assertLess(locked_s.get((6, wheelset), 0), 0.5)
        same = ("state_digest", "slides", "energy", "final_speed_kmh", "max_tension_n", "max_compression_n")
        for threads in (2, 3):
            again = self.run_ok(SLIDING, "--threads", threads)
            for key in same:
                self.assertEqual(first[key], again[key], key)
        # Vehicle 10 is locked from the fifth second to the end.
        begun, resumed = str(self.out) + "_begun", str(self.out) + "_resumed"
        self.run_ok(SLIDING, "--threads", 3, "--out", begun, "--set", "duration_s=7")
        whole = self.run_ok("--resume", begun, "--threads", 2, "--set", "duration_s=10", "--out", resumed)
        self.assertEqual(7, whole["resumed_at_s"])
        for key in same:
            self.assertEqual(first[key], whole[key], key)
        slides = [pathlib.Path(folder, "slides.csv").read_text() for folder in (self.out, resumed)]
        self.assertEqual(*slides)
        self.assertIn("same: 501 of 501 records of 10 vehicles", self.verify(self.out, code=0))
        self.assertIn("same: 150 of 150 records of 10 vehicles from 7 s", self.verify(resumed, code=0))

    def test_csv_tables(self):
        self.run_ok(EMERGENCY, "--csv", "--out", self.out, "--set", "duration_s=0.1")
        with open(self.out / "couplers.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(241, len(rows))
        self.assertEqual(
            {"connection", "max_tension_n", "max_tension_time_s", "max_compression_n", "max_compression_time_s"},
            set(rows[0]),
        )
        with open(self.out / "vehicles.csv", newline="") as table:
            self.assertEqual(242, len(list(csv.DictReader(table))))
        with open(self.out / "train_history.csv", newline="") as table:
            self.assertEqual(11, len(list(csv.DictReader(table))))
        with open(self.out / "wagon_100.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(11, len(rows))
        for column in (
            "normal_force_wheelset_1_n",
            "creepage_wheelset_4",
            "creep_force_wheelset_1_n",
            "shoe_force_wheelset_1_n",
            "carbody_pitch_rad",
            "nest_compression_front_front_m",
            "wedge_friction_rear_rear_n",
        ):
            self.assertIn(column, rows[0])
        self.assertAlmostEqual(0.0585, float(rows[-1]["nest_compression_front_front_m"]), places=4)

    def test_a_saved_pressure_table_repeats_the_run(self):
        """The paper's procedure: pressures from an LTD run, saved every 0.01 s, interpolated by the wagons."""
        settings = ["--set", "duration_s=6"]
        ltd = self.run_ok(EMERGENCY, "--model", "ltd", "--csv", "--out", self.out, *settings)
        table = self.out / "pressures.csv"
        again = self.run_ok(
            EMERGENCY, "--model", "ltd", *settings, "--set", f"pressure_table={table}", "--out", str(self.out) + "2"
        )
        # Linear between samples 10 ms apart: the pressure is off by up to beta^2 p dt^2 / 8 = 0.3 Pa of 430 kPa while
        # it rises (2/3 of that in the mean: 0.8 Pa s of an impulse of 9e5 Pa s in these 6 s), and its impulse by up to
        # beta p dt^2 / 8 = 1.3 Pa s at the kink where the wave arrives: 2.5e-6 of the 0.76 km/h that braking takes.
        self.assertAlmostEqual(ltd["final_speed_kmh"]["mean"], again["final_speed_kmh"]["mean"], delta=2e-6)
        resolved = self.run_ok(pathlib.Path(str(self.out) + "2") / "config.yaml")
        self.assertEqual(again["state_digest"], resolved["state_digest"])

    def test_values_in_another_unit_are_refused(self):
        """Whatever key has a unit: a thousand times too much or too little is no train's."""
        vehicle, gear = "train.consist[0].vehicle", "train.connection.draft_gear"
        wrong = [
            ("brake.emergency.cylinder_pressure_kpa", 430e3),
            ("brake.emergency.wave_speed_mps", 0.25),
            ("brake.service.reduction_kpa[0]", 0.05),
            (f"{gear}.slack_m", 10),
            (f"{gear}.travel_m", 83),
            (f"{gear}.preload_n", 18.8),
            (f"{gear}.spring_stiffness_n_per_m", 40e3),
            (f"{vehicle}.wheelset.mass_kg", 1.73),
            (f"{vehicle}.carbody.mass_kg", 147.6),
            (f"{vehicle}.length_m", 10.5e3),
            (f"{vehicle}.propulsion_resistance.constant_n_per_kn", 920),
            (f"{vehicle}.coupler_height_m", 850),
            (f"{vehicle}.wheel_rail.hertz.youngs_modulus_pa", 208),
            (f"{vehicle}.spring_nest.outer_stiffness_n_per_m", 1590),
            (f"{vehicle}.wheelset.pitch_inertia_kgm2", 679e3),
            (f"{vehicle}.wheel_rail.shear_modulus_pa", 84e3),
        ]
        done = train_sim("check", EMERGENCY, *(word for path, value in wrong for word in ("--set", f"{path}={value}")))
        self.assertEqual(2, done.returncode)
        for path, value in wrong:
            self.assertRegex(
                done.stderr,
                rf"\n?.*: {re.escape(path)} must be at (most|least) [\d.e+]+ .* in size: no train has ",
                path,
            )
        self.assertIn(
            "carbody.mass_kg must be at least 500 kg in size: no train has less; is it in kg?, got 147.6", done.stderr
        )
        for radius in ("1e-154", "460", "0.0485"):
            done = train_sim(
                "check", EMERGENCY, "--model", "ltd", "--set", f"{vehicle}.wheelset.wheel_radius_m={radius}"
            )
            self.assertEqual(2, done.returncode)
            self.assertIn("wheel_radius_m must be at ", done.stderr)

    def test_pressure_tables_that_do_not_cover_the_run_are_told(self):
        table = self.write("table.csv", "time_s,vehicle_1_pa,vehicle_2_pa,note_x\n0.1,0,0,1\n0.3,50000,0,1\n")
        done = train_sim("check", DIP, "--set", f"pressure_table={table}")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("table.csv: begins at 0.1 s: until then the pressures of its first row hold", done.stderr)
        self.assertRegex(
            done.stderr, r"table.csv: ends at 0.3 s of [\d.]+ s: from then on the pressures of its last row hold"
        )
        self.assertIn("table.csv: 2 of its columns are not used: the train has 1 vehicle\n", done.stderr)
        table.write_text("time_s,vehicle_1_pa\n0,0\n100,50000\n")
        self.assertNotIn("table.csv", train_sim("check", DIP, "--set", f"pressure_table={table}").stderr)

    def test_errors_of_pressure_tables_are_few_and_name_their_rows(self):
        table = self.write("table.csv", "time_s,vehicle_1_pa\n0,0\n")
        done = train_sim("check", EMERGENCY, "--set", f"pressure_table={table}")
        self.assertEqual(2, done.returncode)
        self.assertIn(
            "table.csv:1: has no columns vehicle_2_pa, vehicle_3_pa, vehicle_4_pa, ...: of 242 vehicles 241 have no "
            "pressures",
            done.stderr,
        )
        self.assertEqual(1, len([line for line in done.stderr.splitlines() if "vehicle_" in line]), done.stderr)
        table.write_text("time_s,vehicle_1_kpa,note\n0,0,1\n")
        self.assertIn(
            "table.csv:1: has no column vehicle_1_pa: of 1 vehicles 1 have no pressures; not used: vehicle_1_kpa, note",
            train_sim("check", DIP, "--set", f"pressure_table={table}").stderr,
        )
        table.write_text("time_s,vehicle_1_pa\n0,0\n2,5\n1,-7\n1,4e8\n")
        errors = train_sim("check", DIP, "--set", f"pressure_table={table}").stderr
        for text in (
            "table.csv:4: time_s must be later than that of the row before, 2 s, got 1",
            "table.csv:4: vehicle_1_pa must be in [0, 3000000] Pa, got -7",
            "table.csv:5: time_s must be later",
            "table.csv:5: vehicle_1_pa must be in [0, 3000000] Pa, got 400000000",
        ):
            self.assertIn(text, errors)
        table.write_text("time_s,vehicle_1_pa\n0,0\n0,5,100,25\n")
        self.assertIn(
            "table.csv:3: has 4 values, but the header names 2 columns; decimals take a point",
            train_sim("check", DIP, "--set", f"pressure_table={table}").stderr,
        )

    def test_commands_behind_the_end_are_told(self):
        done = train_sim("check", EMERGENCY, "--set", "duration_s=1")
        self.assertIn("commands[0].time_s is 2, but the run ends at 1 s: the command is never given", done.stderr)
        self.assertNotIn("never given", train_sim("check", EMERGENCY, "--set", "duration_s=3").stderr)

    def test_misspelt_commands_and_options_get_the_likely_one(self):
        for arguments, text in (
            (["runn", EMERGENCY], "there is no command runn; did you mean run?"),
            (["verfy"], "there is no command verfy; did you mean verify?"),
            (["fly"], "there is no command fly. Commands: run, check"),
            (["run", EMERGENCY, "--tread", "2"], "--tread: did you mean --threads?"),
        ):
            done = train_sim(*arguments)
            self.assertEqual(2, done.returncode)
            self.assertIn(text, done.stderr)

    def test_intervals_are_plain_numbers(self):
        for interval in ("nan", "inf", "-1", "1e999", "0x10", "ten"):
            done = train_sim("run", DIP, "--out", self.out, "--checkpoint-interval", interval, *SHORT)
            self.assertEqual(2, done.returncode, interval)
            self.assertIn(f"must be a plain number of seconds >= 0, got '{interval}'", done.stderr)
            self.assertFalse(self.out.exists())

    def test_folders_that_cannot_be_made_are_told(self):
        here = pathlib.Path(self.folder.name)
        (here / "file").write_text("")
        (here / "loop").symlink_to("loop")
        (here / "dangling").symlink_to("/nowhere/at/all")
        for name in ("file/below", "loop", "dangling", "x" * 300, "file"):
            done = train_sim("run", DIP, "--out", here / name, *SHORT)
            self.assertEqual(1, done.returncode, name)
            self.assertRegex(done.stderr, f"{name}( cannot be made for the results: [A-Z/]| is not a folder)")
            self.assertNotIn("filesystem error", done.stderr)
        for name in ("dangling", "dangling/below"):
            done = train_sim("run", DIP, "--out", here / name, *SHORT)
            self.assertIn(f"{here}/dangling is a symbolic link to /nowhere/at/all, which does not exist", done.stderr)

    def test_a_replaced_result_is_told(self):
        self.assertNotIn("replaced", train_sim("run", DIP, "--out", self.out, *SHORT).stderr)
        self.assertIn(
            "out held the results of a run, which are replaced", train_sim("run", DIP, "--out", self.out, *SHORT).stderr
        )

    def test_what_arguments_hold_commands_no_terminal(self):
        for arguments in (
            ["run", "a\x1b[31mb.yaml"],
            ["\x1b[2J"],
            ["run", EMERGENCY, "--\x1b[2Jx"],
            ["verify", "\x1b]0;t\x07"],
            ["run", EMERGENCY, "--set", 'name="\\e[31m"'],
            ["check", EMERGENCY, "--set", "\x9b=1"],
            ["run", "--resume", "\u202etxt"],
        ):
            done = train_sim(*arguments)
            self.assertIn(done.returncode, (1, 2, 6), arguments)
            self.assertEqual(
                [],
                [
                    c
                    for c in done.stdout + done.stderr
                    if (ord(c) < 32 and c not in "\n\t") or ord(c) in (0x7F, 0x9B, 0x202E)
                ],
            )

    def test_pressure_table_errors(self):
        table = self.write("table.csv", "time_s,vehicle_1_pa\n0,0\n1,x\n")
        done = train_sim("run", DIP, "--set", f"pressure_table={table}")
        self.assertEqual(2, done.returncode)
        self.assertIn("table.csv:3:", done.stderr)
        table.write_text("time_s,vehicle_2_pa\n0,0\n")
        done = train_sim("run", DIP, "--set", f"pressure_table={table}")
        self.assertEqual(2, done.returncode)
        self.assertIn("vehicle_1_pa", done.stderr)

    def test_bad_configuration_ends_with_2_and_writes_nothing(self):
        scenario = self.write(
            "bad.yaml", "base: %s\ndt: 0.001\nduration_s: -1\ninitial_speed_kmh: 80 km/h\n" % EMERGENCY
        )
        done = train_sim("run", scenario, "--out", self.out)
        self.assertEqual(2, done.returncode)
        self.assertEqual("", done.stdout)
        self.assertIn("bad.yaml:2: dt is not a known key; the key is dt_s, in s", done.stderr)
        self.assertIn("bad.yaml:3: duration_s must be", done.stderr)
        self.assertIn("bad.yaml:4: initial_speed_kmh must be a plain number in km/h", done.stderr)
        self.assertFalse(self.out.exists())

    def test_rules_between_keys(self):
        in_train = "in [1, 242], or in [-242, -1] from the rear, because the train has 242 vehicles"
        lateral_radius = "train.consist[0].vehicle.wheel_rail.hertz.wheel_lateral_radius_m"
        for change, complaint in (
            ("exchange_interval_s=0.0015", "exchange_interval_s must be a multiple of dt_s (0.001), got 0.0015"),
            ("record_interval_s=0.0105", "record_interval_s must be a multiple"),
            ("detail_vehicles=[243]", f"detail_vehicles[0] must be {in_train}, got 243"),
            (
                "brake.sources[1].vehicle=300",
                f"brake.sources[1].vehicle must be {in_train} (mid-train locomotive), got 300",
            ),
            (
                "commands=[{time_s: 1, kind: apply, reduction_kpa: 20}]",
                "commands[0].reduction_kpa must be in [50, 170] (brake.service.reduction_kpa), got 20",
            ),
            ("integrator=newmark", "integrator must be leapfrog for the 2d model"),
            (f"{lateral_radius}=-0.0801", "train.consist[0].vehicle.wheel_rail.hertz gives no"),
        ):
            done = train_sim("check", EMERGENCY, "--set", change)
            self.assertEqual(2, done.returncode, change)
            self.assertIn(complaint, done.stderr)

    def check(self, *arguments):
        """The lines of train_sim check as a dictionary, and its warnings."""
        done = train_sim("check", *arguments)
        self.assertEqual(0, done.returncode, done.stderr)
        lines = {line[2:12].strip(): line[13:] for line in done.stdout.splitlines()[1:]}
        self.assertEqual(done.stdout.splitlines()[1:], ["  %-10s %s" % line for line in lines.items()])  # aligned
        return lines, done.stderr

    def test_check_tells_where_a_route_is_known(self):
        line = self.write("my_line.csv", "position_km,grade_permille\n-2.5,0\n0,3\n40,0\n")
        self.assertIn("  track      without a name, -2.500 km to 40.000 km\n", self.told(EMERGENCY, line))
        self.assertIn("  track      level\n", self.told(EMERGENCY, "level"))

    def told(self, scenario, track):
        return train_sim("check", scenario, "--model", "ltd", "--set", f"track={track}").stdout

    def test_check_predicts_the_bag(self):
        """The size of the real bag within 1 %, short runs with their descriptions of topics within 2 %."""
        for model, duration, within in (("2d", 3, 0.01), ("ltd", 3, 0.01), ("2d", 0.2, 0.02)):
            lines, _ = self.check(EMERGENCY, "--model", model, "--set", f"duration_s={duration}")
            self.run_ok(EMERGENCY, "--model", model, "--set", f"duration_s={duration}", "--out", self.out)
            size_mb = 1e-6 * (self.out / "train.bag").stat().st_size
            # Printed to 0.1 MB.
            self.assertAlmostEqual(size_mb, float(lines["bag"].split()[0]), delta=within * size_mb + 0.05)

    def test_check_is_quiet_when_all_is_well(self):
        lines, warnings = self.check(EMERGENCY)
        self.assertEqual("", warnings)
        self.assertEqual("1 ms; ore_wagon stable to 1.745 ms", lines["step"])
        self.assertEqual(
            "1 ms; calibrated stable to 6.61 ms at 900 kN, draw_bar stable to 23.2 ms; it changes the "
            "paper's coupler forces by up to 1.3 kN",
            lines["exchange"],
        )
        self.assertRegex(lines["wall time"], r"^about [\d.]+ s with \d+ thread\(s\), [\d.]+ x real time$")
        self.assertRegex(lines["memory"], r"^about \d+ MB$")
        lines, warnings = self.check(DIP)
        self.assertNotIn("exchange", lines)  # a single wagon

    def test_check_warns_with_place_and_remedy(self):
        scenario = self.write("mine.yaml", f"base: {EMERGENCY}\nexchange_interval_s: 0.01\n")
        _, warnings = self.check(scenario)
        self.assertIn(
            "mine.yaml:2: exchange_interval_s 0.01 is above 0.0066083, the longest stable one of train.connection",
            warnings,
        )
        self.assertIn("take a shorter one", warnings)
        lines, warnings = self.check(EMERGENCY, "--nodes", 300, "--machines", 2)
        self.assertIn("warning: --nodes 300: the train has 242 vehicles; take at most as many nodes", warnings)
        self.assertRegex(
            warnings, r"--nodes 300: 150 nodes share \d+ cores, so that an exchange takes about [\d.]+ ms; "
        )
        self.assertRegex(lines["messages"], "^121000 requests and as many replies per simulated second and machine, ")
        lines, warnings = self.check(EMERGENCY, "--nodes", 1)
        self.assertEqual("", warnings)
        self.assertIn("1000 requests", lines["messages"])
        _, warnings = self.check(EMERGENCY, "--model", "ltd", "--nodes", 2)
        self.assertIn("--nodes 2: the ltd model runs in the master; leave it out", warnings)
        self.assertEqual(2, train_sim("check", EMERGENCY, "--nodes", 0).returncode)

    def test_check_warns_of_what_does_not_fit(self):
        def limited(kind, limit, *arguments):
            done = subprocess.run(
                [TRAIN_SIM, "check", EMERGENCY, *arguments],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                preexec_fn=lambda: resource.setrlimit(kind, (limit, limit)),
            )
            self.assertEqual(0, done.returncode, done.stderr)
            return done.stderr

        self.assertIn(
            "the master needs 740 open files, more than `ulimit -Hn`; raise that or take fewer nodes",
            limited(resource.RLIMIT_NOFILE, 700, "--nodes", "242"),
        )
        self.assertNotIn("open files", limited(resource.RLIMIT_NOFILE, 740, "--nodes", "242"))

    @unittest.skipIf(os.geteuid() != 0, "mounts a small file system, which only root may")
    def test_check_warns_of_a_small_disk(self):
        self.out.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=50m", "none", str(self.out)]).returncode != 0:
            self.skipTest("this machine does not allow mounts")
        try:
            _, warnings = self.check(EMERGENCY, "--out", self.out / "below" / "run")
            self.assertRegex(
                warnings, r"--out .*: the bag needs 108 MB, \d+ MB are free; take a longer record_interval_s"
            )
            self.assertEqual("", self.check(EMERGENCY, "--out", self.out, "--set", "duration_s=10")[1])
        finally:
            subprocess.run(["umount", str(self.out)], check=True)

    def test_bad_arguments(self):
        for arguments in (
            [],
            ["run"],
            ["fly", EMERGENCY],
            ["run", EMERGENCY, "--model", "3d"],
            ["run", EMERGENCY, "--threads", "0"],
            ["run", EMERGENCY, "--csv"],
            ["run", EMERGENCY, "--tread"],
        ):
            done = train_sim(*arguments)
            self.assertEqual(2, done.returncode, arguments)
            self.assertNotEqual("", done.stderr, arguments)
        for option, value in (("--threads", "1e3"), ("--threads", "2.5"), ("--threads", "-1"), ("--threads", "0x10")):
            done = train_sim("run", EMERGENCY, option, value)
            self.assertEqual(2, done.returncode)
            self.assertIn(f"{option}: must be a whole number from 1 to 1024 in digits, got '{value}'", done.stderr)
        done = train_sim("air-test", EMERGENCY, "--seed", "-5")
        self.assertIn("--seed: must be a whole number from 0 to 2147483647 in digits, got '-5'", done.stderr)
        self.assertEqual(0, train_sim("--help").returncode)
        self.assertRegex(train_sim("--version").stdout, r"^train_sim \d+\.\d+\.\d+")

    def test_an_empty_path_is_not_the_default(self):
        """As of a variable of the shell that is not set: a run whose results are not written would be lost."""
        for arguments in (
            ["run", DIP, *SHORT, "--out", ""],
            ["run", DIP, *SHORT, "--out="],
            ["run", "--resume", ""],
            ["check", DIP, "--out", ""],
            ["verify", ""],
            ["verify", self.out, "--config", ""],
            ["route", DIP, "--plot", ""],
            ["new", ""],
            ["run", "", "--out", self.out],
            *(
                [command, ""]
                for command in ("check", "resolve", "route", "modes", "adhesion", "air-test", "brake-weight")
            ),
            ["verify", self.out, "--train", ""],
        ):
            done = train_sim(*arguments)
            self.assertEqual(2, done.returncode, arguments)
            self.assertEqual("", done.stdout, arguments)
            self.assertRegex(done.stderr, "empty|missing", arguments)

    def test_the_scenario_is_never_overwritten(self):
        self.run_ok(DIP, "--out", self.out, *SHORT)
        before = (self.out / "config.yaml").read_text()
        done = train_sim("run", self.out / "config.yaml", "--out", self.out)
        self.assertEqual(1, done.returncode)
        self.assertIn("is the folder of", done.stderr)
        self.assertEqual(before, (self.out / "config.yaml").read_text())

    def test_what_a_scenario_starts_from_is_never_overwritten(self):
        self.run_ok(DIP, "--out", self.out, *SHORT)
        before = (self.out / "config.yaml").read_text()
        scenario = self.write("mine.yaml", "base: out/config.yaml\nduration_s: 0.2\n")
        done = train_sim("run", scenario, "--out", self.out)
        self.assertEqual(1, done.returncode)
        self.assertIn("config.yaml, of which the scenario is made: choose another for the results", done.stderr)
        self.assertEqual(before, (self.out / "config.yaml").read_text())
        self.run_ok(scenario, "--out", str(self.out) + "2")

    def test_a_second_run_replaces_the_first(self):
        self.run_ok(EMERGENCY, "--out", self.out, "--csv", "--set", "duration_s=0.02")
        self.run_ok(DIP, "--out", self.out, *SHORT)
        self.assertEqual(
            {"checkpoint", "config.yaml", "couplers.csv", "summary.json", "track_wear.csv", "train.bag"},
            {p.name for p in self.out.iterdir()},
        )

    def test_files_of_the_user_are_left_alone(self):
        self.out.mkdir()
        mine = self.out / "vehicles.csv"
        mine.write_text("mine")
        done = train_sim("run", DIP, "--out", self.out, *SHORT)
        self.assertEqual(1, done.returncode)
        self.assertIn("holds vehicles.csv, but no run of train_brake", done.stderr)
        self.assertEqual("mine", mine.read_text())
        mine.rename(self.out / "wagon_measured.csv")
        self.run_ok(DIP, "--out", self.out, *SHORT)
        self.run_ok(DIP, "--out", self.out, *SHORT)
        self.assertEqual("mine", (self.out / "wagon_measured.csv").read_text())

    def test_lost_output_is_an_error(self):
        """Of every command that prints a result; what a run has written is kept."""
        wagon = str(CONFIG / "vehicles" / "ore_wagon.yaml")
        self.run_ok(DIP, "--out", str(self.out) + "2", *SHORT)
        for arguments in (
            ["run", DIP, "--out", str(self.out), *SHORT],
            ["check", DIP, *SHORT],
            ["verify", str(self.out) + "2"],
            ["modes", wagon],
            ["adhesion", wagon],
            ["--help"],
            ["--version"],
        ):
            with open("/dev/full", "w") as full:
                done = subprocess.run([TRAIN_SIM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(1, done.returncode, (arguments, done.stderr))
            self.assertIn("the output could not be written: ", done.stderr)
        self.assertTrue(json.loads((self.out / "summary.json").read_text())["complete"])

    def test_messages_that_cannot_be_written_do_not_end_a_run(self):
        """The standard error full, closed, a pipe without a reader; all three streams closed."""
        digest = self.run_ok(DIP, *SHORT)["state_digest"]
        tables = None
        for i, (redirection, code) in enumerate(
            (("2>/dev/full", 0), ("2>&-", 0), ("2> >(true)", 0), ("<&- >&- 2>&-", 0), ("2>&1 | head -n 1", 1))
        ):  # there the summary is lost, too
            out = pathlib.Path(f"{self.out}{i}")
            command = [TRAIN_SIM, "run", DIP, *SHORT, "--csv", "--out", str(out)]
            script = '"$@" ' + redirection + '; exit "${PIPESTATUS[0]}"'
            if code == 1:  # the reader has gone before the first line comes
                script = '(sleep 1; "$@") 2>&1 | true; exit "${PIPESTATUS[0]}"'
            done = subprocess.run(["bash", "-c", script, "bash", *command], stdout=subprocess.PIPE, timeout=120)
            self.assertEqual(code, done.returncode, redirection)
            summary = json.loads((out / "summary.json").read_text())
            self.assertEqual((True, digest), (summary["complete"], summary["state_digest"]), redirection)
            self.assertTrue((out / "checkpoint").exists(), redirection)
            found = {file.name: file.read_text() for file in out.glob("*.csv")}  # no message in one of them
            tables = tables or found
            self.assertEqual(tables, found, redirection)

    def test_errors_that_cannot_be_written_do_not_change_the_exit_code(self):
        for redirection in ("2>/dev/full", "2>&-", "<&- >&- 2>&-"):
            command = f'"$@" {redirection}'
            for arguments, code in ((["run", "missing.yaml"], 2), (["fly"], 2), (["verify", "missing"], 6)):
                done = subprocess.run(["bash", "-c", command, "bash", TRAIN_SIM, *arguments], stdout=subprocess.DEVNULL)
                self.assertEqual(code, done.returncode, (redirection, arguments))

    def test_a_terminal_that_goes_away(self):
        """Without SIGHUP, as behind setsid or after the death of a terminal's multiplexer: the run goes on."""
        terminal, of_run = os.openpty()
        process = subprocess.Popen(
            [TRAIN_SIM, "run", EMERGENCY, "--model", "ltd", "--out", str(self.out), "--set", "duration_s=60"],
            stdin=of_run,
            stdout=subprocess.DEVNULL,
            stderr=of_run,
            start_new_session=True,
        )
        os.close(of_run)
        os.read(terminal, 10)  # its progress
        os.close(terminal)
        self.assertEqual(0, process.wait(120))
        self.assertTrue(json.loads((self.out / "summary.json").read_text())["complete"])

    def test_a_limit_of_file_sizes(self):
        """`ulimit -f`: the run ends and says so; what fits is kept."""
        done = subprocess.run(
            [
                "bash",
                "-c",
                'ulimit -f 2000; "$@"',
                "bash",
                TRAIN_SIM,
                "run",
                "--json",
                EMERGENCY,
                "--model",
                "ltd",
                "--out",
                str(self.out),
                "--set",
                "duration_s=20",
                "--checkpoint-interval",
                "1",
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.assertEqual(1, done.returncode, done.stderr)
        self.assertIn("train.bag (ulimit -f limits the size of files): File too large", done.stderr)
        summary = json.loads(done.stdout)
        self.assertFalse(summary["complete"])
        self.assertEqual(summary, json.loads((self.out / "summary.json").read_text()))
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            self.assertGreater(bag.get_message_count("/train/state"), 0)

    def test_a_folder_that_is_removed_is_not_a_full_disk(self):
        process = self.start_endless()
        time.sleep(0.5)
        shutil.rmtree(self.out)
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=60)
        self.assertEqual(1, process.returncode, stderr)
        self.assertIn("No such file or directory", stderr)
        self.assertNotIn("disk", stderr)
        self.assertNotIn("filesystem error", stderr)

    def test_a_bag_that_is_removed_is_named(self):
        process = self.start_endless()
        bag = self.out / "train.bag.active"
        while not bag.exists():
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        bag.unlink()
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=60)
        self.assertEqual(1, process.returncode, stderr)
        self.assertIn(f"cannot write {self.out}/train.bag: No such file or directory", stderr)

    @unittest.skipIf(os.geteuid() != 0, "mounts a small file system, which only root may")
    def test_a_full_disk_ends_the_run_with_what_fits(self):
        self.out.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "none", str(self.out)]).returncode != 0:
            self.skipTest("this machine does not allow mounts")
        try:
            done = train_sim("run", "--json", EMERGENCY, "--model", "ltd", "--out", self.out, "--set", "duration_s=20")
            self.assertEqual(1, done.returncode, done.stderr)
            self.assertIn("could not be written", done.stderr)
            self.assertIn("train.bag: No space left on device", done.stderr)
            summary = json.loads(done.stdout)
            self.assertFalse(summary["complete"])
            self.assertLess(summary["simulated_s"], 10)  # ended when the disk was full, with about 2 s recorded
            self.assertEqual(summary, json.loads((self.out / "summary.json").read_text()))
            with rosbag.Bag(str(self.out / "train.bag")) as bag:
                self.assertGreater(bag.get_message_count("/train/state"), 0)
        finally:
            subprocess.run(["umount", str(self.out)], check=True)

    def test_a_full_disk_for_tables_ends_the_run(self):
        """Only the tables fail here: files of 40 kB are enough for the configuration, not for pressures.csv."""

        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (40000, 40000))

        done = subprocess.run(
            [TRAIN_SIM, "run", "--json", DIP, "--csv", "--out", str(self.out), "--set", "record_interval_s=0.001"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=small_files,
        )
        self.assertEqual(1, done.returncode, done.stderr)
        self.assertRegex(done.stderr, r"could not write all of .*/wagon_001.csv: File too large \(ulimit -f")
        self.assertFalse(json.loads(done.stdout)["complete"])

    def test_a_standing_ltd_wagon_has_no_brake_force(self):
        self.run_ok(str(CONFIG / "scenarios" / "single_wagon_stop.yaml"), "--model", "ltd", "--out", self.out)
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            states = [m for _, m, _ in bag.read_messages("/train/state")]
        self.assertGreater(max(s.shoe_force_n[0] for s in states[1:]), 5e4)
        self.assertEqual(0.0, states[-1].shoe_force_n[0])

    def test_stop_is_that_of_the_train_not_of_its_rocking(self):
        stops = [
            self.run_ok(str(CONFIG / "scenarios" / "single_wagon_stop.yaml"), "--model", model)
            for model in ("2d", "ltd")
        ]
        self.assertAlmostEqual(stops[0]["stop_time_s"], stops[1]["stop_time_s"], delta=0.1)
        self.assertAlmostEqual(stops[0]["stop_distance_m"], stops[1]["stop_distance_m"], delta=0.1)

    def test_an_unwritable_folder(self):
        file = self.write("file", "")
        done = train_sim("run", DIP, "--out", file / "below")
        self.assertEqual(1, done.returncode)
        self.assertIn("file", done.stderr)

    def start_endless(self, **options):
        process = subprocess.Popen(
            [TRAIN_SIM, "run", EMERGENCY, "--out", str(self.out), "--set", "duration_s=1000"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            **options,
        )
        deadline = time.monotonic() + 60
        while not (self.out / "train.bag.active").exists() and time.monotonic() < deadline:
            pass  # no later than that
        return process

    def test_two_runs_do_not_share_a_folder(self):
        first = self.start_endless()
        second = train_sim("run", DIP, "--out", self.out)
        self.assertEqual(1, second.returncode)
        self.assertIn("another run is writing into", second.stderr)
        self.assertTrue((self.out / "train.bag.active").exists())
        first.kill()
        first.communicate()
        self.run_ok(DIP, "--out", self.out)  # nothing is left of a killed run's lock

    def test_the_end_of_a_terminal_is_as_ctrl_c(self):
        for ignored in (False, True):
            how = (lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)) if ignored else None  # as nohup does
            process = self.start_endless(preexec_fn=how)
            process.send_signal(signal.SIGHUP)
            if ignored:
                time.sleep(0.5)
                self.assertIsNone(process.poll())
                process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(130, process.returncode)

    def test_ctrl_c_keeps_what_was_simulated(self):
        process = self.start_endless()
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=60)
        self.assertEqual(130, process.returncode, stderr)
        self.assertIn("interrupted", stderr)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertFalse(summary["complete"])
        self.assertIsNone(summary["fault"])
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            last = max(m.exchange for _, m, _ in bag.read_messages("/train/state"))
        exchanges = round(summary["simulated_s"] / 0.001)
        self.assertLessEqual(last, exchanges)
        self.assertGreater(last, exchanges - 10)

    def test_a_broken_simulation_names_the_culprit(self):
        """A dip 1 m deep and 2 m long, at 400 km/h, throws the wheelsets out of every law's domain."""
        done = train_sim(
            "run",
            DIP,
            "--out",
            self.out,
            "--set",
            "initial_speed_kmh=400",
            "--set",
            "track.dips[0].depth_m=1",
            "--set",
            "track.dips[0].length_m=2",
        )
        self.assertEqual(3, done.returncode, done.stderr)
        self.assertRegex(done.stderr, r"vehicle 1: (front|rear|wheelset|carbody).* is .* at t = \d+\.\d+ s")
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertFalse(summary["complete"])
        self.assertIn("vehicle 1", summary["fault"])
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            self.assertGreater(bag.get_message_count("/train/state"), 0)

    def verify(self, recording, *arguments, code):
        done = train_sim("verify", recording, *arguments)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def rewrite(self, bag, change):
        """A copy of a bag, each message as change(topic, message) gives it, or without it where that is None."""
        copy = pathlib.Path(self.folder.name) / "copy.bag"
        with rosbag.Bag(str(bag)) as original, rosbag.Bag(str(copy), "w") as changed:
            for topic, message, t in original.read_messages():
                kept = change(topic, message)
                if kept is not None:
                    changed.write(*kept, t)
        return copy

    def test_verify_tells_the_same(self):
        digest = self.run_ok(EMERGENCY, "--out", self.out, *SHORT)["state_digest"]
        expected = f"same: 51 of 51 records of 242 vehicles to 0.5 s, digest {digest}\n"
        for threads in (1, 2):
            self.assertIn(expected, self.verify(self.out, "--threads", threads, code=0))
        alone = self.out.rename(pathlib.Path(self.folder.name) / "elsewhere") / "train.bag"
        (alone.parent / "config.yaml").unlink()
        self.assertIn(expected, self.verify(alone, code=0))  # by the scenario that the bag holds

    def test_verify_takes_bags_of_others(self):
        """Another namespace, no scenario, topics left out, the beginning missed: the digest covers all before it."""
        self.run_ok(EMERGENCY, "--out", self.out, *SHORT)

        def late(topic, message):
            keeps = topic in ("/train/state", "/train/wagon_100/state") and message.exchange >= 200
            return (topic.replace("/train", "/line/7"), message) if keeps else None

        bag = self.rewrite(self.out / "train.bag", late)
        self.assertIn("give it with --config", self.verify(bag, code=6))
        verdict = self.verify(bag, "--config", self.out / "config.yaml", code=0)
        self.assertIn("same: 31 of 51 records", verdict)
        self.assertIn("the digest covers those that are not in the bag", verdict)

        def twins(topic, message):
            return (topic.replace("/train", "/b"), message) if topic.endswith("forces") else (topic, message)

        with rosbag.Bag(str(self.rewrite(self.out / "train.bag", twins)), "a") as both:
            for _, message, t in rosbag.Bag(str(self.out / "train.bag")).read_messages("/train/state"):
                both.write("/b/state", message, t)
        self.assertIn("/b, /train; choose one with --train", self.verify(both.filename, code=6))
        self.assertIn("holds no train /c but", self.verify(both.filename, "--train", "/c", code=6))
        self.verify(both.filename, "--train", "/b", "--config", self.out / "config.yaml", code=0)

    def test_verify_looks_at_what_is_missing_and_beside(self):
        self.run_ok(EMERGENCY, "--out", self.out, *SHORT)

        def with_holes(topic, message):
            lost = topic == "/train/in_train_forces" and message.exchange in (100, 300)
            return None if lost else (topic, message)

        verdict = self.verify(self.rewrite(self.out / "train.bag", with_holes), code=0)
        self.assertIn("not in the bag: 2 message(s) of /train/in_train_forces", verdict)
        summary = self.out / "summary.json"
        text = summary.read_text()
        digest = json.loads(text)["state_digest"]
        summary.write_text(text.replace(digest, "0123456789abcdef"))
        for recording in (self.out, self.out / "train.bag"):
            verdict = self.verify(recording, code=5)
            self.assertIn("summary.json has the digest 0123456789abcdef, now it is " + digest, verdict)

    def test_verify_reads_any_json_in_summary_json(self):
        """Saved again by another program, with more in it; or no summary at all."""
        self.run_ok(DIP, "--out", self.out, "--set", "duration_s=0.5", "--model", "ltd")
        file = self.out / "summary.json"
        summary = json.loads(file.read_text())
        file.write_text(json.dumps({"complete": True, "remark": "x" * 200000, **summary}, separators=(",", ":")))
        self.assertIn("same", self.verify(self.out, code=0))
        false = {key: summary[key] for key in reversed(summary)}
        false["state_digest"] = "fedcba9876543210"
        file.write_text(json.dumps(false, separators=(",", ":")))
        self.assertIn("summary.json has the digest fedcba9876543210", self.verify(self.out, code=5))
        for text, complaint in (
            ("[]", "must hold a JSON object"),
            ("{}", "must say complete"),
            ('{"complete": true, "state_digest": 7}', "must have a state_digest"),
            ('{"complete": tr', "is not JSON"),
            ("[" * 100000, "is not JSON"),
        ):
            with self.subTest(text[:30]):
                file.write_text(text)
                self.assertIn(complaint, self.verify(self.out, code=6))

    def test_verify_finds_the_pressure_table_beside_the_bag(self):
        first = pathlib.Path(self.folder.name) / "first"
        self.run_ok(EMERGENCY, "--csv", "--out", first, *SHORT)
        self.run_ok(EMERGENCY, "--set", f"pressure_table={first / 'pressures.csv'}", "--out", self.out, *SHORT)
        shutil.rmtree(first)
        for recording in (self.out, self.out / "train.bag"):
            self.assertIn("same: 51 of 51 records", self.verify(recording, code=0))

    def test_check_tells_of_a_breakdown(self):
        done = train_sim(
            "check",
            DIP,
            "--set",
            "initial_speed_kmh=400",
            "--set",
            "track.dips[0].depth_m=1",
            "--set",
            "track.dips[0].length_m=2",
            "--set",
            "track.dips[0].from_m=6",
        )
        self.assertEqual(3, done.returncode, done.stdout + done.stderr)
        self.assertIn("broke down in the trial: vehicle 1", done.stderr)

    def test_a_run_that_was_broken_off_is_not_replaced_in_silence(self):
        self.run_ok(EMERGENCY, "--out", self.out, *SHORT, "--checkpoint-interval", "0.2")
        (self.out / "summary.json").unlink()  # as after a kill
        done = train_sim("run", EMERGENCY, "--out", self.out, *SHORT)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("held a run that was broken off", done.stderr)

    def test_verify_names_the_first_difference(self):
        self.run_ok(EMERGENCY, "--out", self.out, *SHORT)
        bag, config = self.out / "train.bag", self.out / "config.yaml"

        def spoilt(at, field, index, value):
            def change(topic, message):
                if topic == at and message.exchange >= 300:
                    array = list(getattr(message, field))
                    array[index] = value
                    setattr(message, field, array)
                return topic, message

            return self.rewrite(bag, change)

        for at, field, index, where in (
            ("/train/wagon_100/state", "body_z_mps", 1, "vehicle 100, front bolster: body_z_mps"),
            ("/train/wagon_242/state", "creep_force_n", 3, "vehicle 242, wheelset 4: creep_force_n"),
            ("/train/wagon_242/state", "wedge_friction_n", 2, "vehicle 242, rear bogie, front half: wedge_friction_n"),
            ("/train/state", "position_m", 7, "vehicle 8: position_m"),
            ("/train/in_train_forces", "coupler_force_n", 99, "connection 100: coupler_force_n"),
            ("/train/brake_pressures", "cylinder_pressure_pa", 0, "vehicle 1: cylinder_pressure_pa"),
        ):
            verdict = self.verify(spoilt(at, field, index, 12345.5), code=5)
            self.assertIn(f"{where} is 12345.5 in the bag, ", verdict)
            self.assertIn("0.3 s (exchange 300)", verdict)
            self.assertIn("0 of 242 vehicles differ in it; the 30 records before it are the same", verdict)
        verdict = self.verify(spoilt("/train/state", "vehicle_digest", 41, 7), code=5)
        self.assertIn("vehicle 42: its state, but no recorded value", verdict)
        self.assertIn("1 of 242 vehicles differ", verdict)

        def change_setting(before, after):
            text = config.read_text()
            self.assertIn(before, text)
            return self.write("other.yaml", text.replace(before, after))

        for before, after, complaint in (
            ("initial_speed_kmh: 80", "initial_speed_kmh: 80.0000001", "vehicle 1, carbody: body_x_mps is"),
            (
                "record_interval_s: 0.01",
                "record_interval_s: 0.02",
                "message of exchange 10, of which there is none now",
            ),
            ("duration_s: 0.5", "duration_s: 0.4", "different: the bag goes on after the end at 0.4 s"),
            ("    count: 1\n", "    count: 2\n", "position_m is of size 242 in the bag, 244 now"),
        ):
            verdict = self.verify(bag, "--config", change_setting(before, after), code=5)
            self.assertIn(complaint, verdict)
        self.verify(bag, "--config", change_setting("detail_vehicles: [1, 100,", "detail_vehicles: ["), code=0)

    def test_verify_an_incomplete_run(self):
        self.run_ok(EMERGENCY, "--out", self.out, *SHORT)
        cut = self.rewrite(
            self.out / "train.bag",
            lambda topic, message: ((topic, message) if getattr(message, "exchange", 0) <= 200 else None),
        )
        self.assertIn(
            "incomplete: the bag ends at 0.2 s of 0.5 s; the same so far, 21 records", self.verify(cut, code=7)
        )
        bag = self.out / "train.bag"  # of a recorder that was killed: no index, the last message cut
        bag.write_bytes(bag.read_bytes()[: bag.stat().st_size // 2])
        bag.rename(self.out / "train.bag.active")
        self.assertRegex(
            self.verify(self.out, code=7), r"incomplete: the bag ends at 0\.2\d? s of 0\.5 s; the same so far, 2\d"
        )
        broken = pathlib.Path(self.folder.name) / "broken"
        train_sim(
            "run",
            DIP,
            "--out",
            broken,
            "--set",
            "initial_speed_kmh=400",
            "--set",
            "track.dips[0].depth_m=1",
            "--set",
            "track.dips[0].length_m=2",
        )
        self.assertIn("the same so far", self.verify(broken, code=7))

    def test_verify_what_cannot_be_read(self):
        self.run_ok(DIP, "--out", self.out, "--set", "duration_s=0.1")
        bag = self.out / "train.bag"
        whole = bag.read_bytes()
        self.assertIn("there is no such file or folder", self.verify(self.out / "none", code=6))
        self.assertIn("is no bag of format 2.0", self.verify(DIP, code=6))
        self.assertIn("holds no train", self.verify(self.rewrite(bag, lambda *_: ("/x", String("y"))), code=6))
        bag.write_bytes(whole[:100])
        self.assertIn("holds no train", self.verify(self.out, code=6))
        bag.unlink()
        self.assertIn("holds no train.bag", self.verify(self.out, code=6))
        with rosbag.Bag(str(bag), "w", compression="bz2") as compressed:
            compressed.write("/x", String("y"))
        self.assertIn("`rosbag decompress`", self.verify(self.out, code=6))
        bag.write_bytes(whole)
        (self.out / "config.yaml").write_text("dt_s: fast\n")
        self.assertIn(
            "config.yaml is not the scenario that the bag holds, which is repeated", self.verify(self.out, code=0)
        )
        self.rewrite(bag, lambda topic, message: None if topic == "/train/scenario" else (topic, message)).replace(bag)
        self.assertIn("config.yaml:1: dt_s must be a number", self.verify(self.out, code=6))

    def test_verify_ends_at_zeros_behind_the_bag(self):
        """As a file system leaves them after a loss of power: as many as there may be."""
        self.run_ok(DIP, "--out", self.out, "--set", "duration_s=0.1")
        with open(self.out / "train.bag", "ab") as bag:
            bag.truncate(bag.tell() + 10**12)
        self.assertIn("same: 101 of 101 records", self.verify(self.out, code=0))

    def test_verify_two_runs_in_a_bag(self):
        self.run_ok(DIP, "--out", self.out, "--set", "duration_s=0.1")
        bag = self.out / "train.bag"
        with rosbag.Bag(str(bag)) as original:
            messages = list(original.read_messages("/train/state"))
        with rosbag.Bag(str(bag), "a") as twice:
            for topic, message, t in messages:
                twice.write(topic, message, t + rospy.Duration(1.0))
        self.assertIn("falls from exchange 100 to 0: the bag holds more than one run", self.verify(self.out, code=6))

    def test_verify_names_the_version_that_wrote_a_recording(self):
        """Of a bag whose messages another version has defined otherwise, and of one with other bits; the bag tells, or
        else summary.json. Nothing is said of this version's own."""
        self.run_ok(DIP, "--out", self.out, "--set", "duration_s=0.1")
        own = train_sim("--version").stdout.split()[1]
        bag, summary = self.out / "train.bag", self.out / "summary.json"
        whole = bag.read_bytes()
        with rosbag.Bag(str(bag)) as opened:
            md5sum = opened.get_type_and_topic_info().msg_types["train_brake_msgs/TrainState"].encode()
        self.assertIn(b"# train_brake " + own.encode() + b"\n", whole)
        self.assertEqual(f"# train_brake {own}", (self.out / "config.yaml").read_text().splitlines()[1])
        other = "9" + own[1:]
        told = f"was written by train_brake {other}, this is train_brake {own}"
        defined = whole.replace(md5sum, md5sum[::-1])
        self.assertNotEqual(whole, defined)
        bag.write_bytes(defined)
        said = self.verify(self.out, code=6)
        self.assertIn(f"another definition of train_brake_msgs/TrainState than this version, train_brake {own}", said)
        self.assertNotIn("was written by", said)
        bag.write_bytes(defined.replace(b"# train_brake " + own.encode(), b"# train_brake " + other.encode()))
        self.assertIn(told, self.verify(self.out, code=6))
        alone = self.out / "alone.bag"
        bag.rename(alone)
        self.assertIn(told, self.verify(alone, code=6))
        bag.write_bytes(defined.replace(b"# train_brake " + own.encode(), b"# a bag of some version"[: 14 + len(own)]))
        summary.write_text(json.dumps({**json.loads(summary.read_text()), "version": other}))
        self.assertIn(told, self.verify(self.out, code=6))
        bag.write_bytes(whole)
        changed = {**json.loads(summary.read_text()), "version": own, "state_digest": "0" * 16}
        summary.write_text(json.dumps(changed))
        self.assertNotIn("was written by", self.verify(self.out, code=5))

    def test_verify_survives_damaged_bags(self):
        """Any verdict will do, a crash will not: bytes changed, numbers blown up, pieces cut out, the end cut off."""
        self.run_ok(DIP, "--model", "ltd", "--out", self.out, "--set", "duration_s=0.05")
        whole = (self.out / "train.bag").read_bytes()
        for seed in range(60):
            chance, bag = random.Random(seed), bytearray(whole)
            for _ in range(chance.choice([1, 1, 2, 5])):
                at = chance.randrange(len(bag))
                damage = chance.randrange(4)
                if damage == 0:
                    bag[at] = chance.randrange(256)
                elif damage == 1:
                    bag[at : at + 4] = chance.choice([0, 1000, 2**31 - 1, 2**32 - 1]).to_bytes(4, "little")
                elif damage == 2:
                    del bag[at : at + chance.randrange(100)]
                else:
                    del bag[max(at, 1) :]
            (self.out / "train.bag").write_bytes(bag)
            done = train_sim("verify", self.out)
            self.assertIn(done.returncode, (0, 5, 6, 7), f"seed {seed}: {done.stdout + done.stderr}")
            self.assertNotEqual("", done.stdout + done.stderr)

    def test_vehicle_commands(self):
        wagon = str(CONFIG / "vehicles" / "ore_wagon.yaml")
        modes = train_sim("modes", wagon)
        self.assertEqual(0, modes.returncode)
        self.assertRegex(modes.stdout, r"1 +2\.0\d+ .*carbody z 99 %")  # bounce, 2.04 Hz
        self.assertRegex(modes.stdout, r"largest stable explicit step: 1\.\d+ ms")
        told = json.loads(train_sim("modes", wagon, "--json").stdout)
        self.assertEqual(
            "carbody z", max(told["modes"][0]["largest_energy_shares"].items(), key=lambda item: item[1])[0]
        )
        self.assertIn(f"{1e3 * told['largest_stable_step_s']:.3f} ms", modes.stdout)
        for mode in told["modes"]:
            self.assertIn(f"{mode['frequency_hz']:.3f}", modes.stdout)
            shares = list(mode["largest_energy_shares"].values())
            self.assertEqual(sorted(shares, reverse=True), shares)
            self.assertLessEqual(sum(shares), 1.0 + 1e-9)
        table = list(csv.DictReader(train_sim("modes", wagon, "--csv").stdout.splitlines()))
        self.assertEqual(len(table), len(told["modes"]))
        for row, mode in zip(table, told["modes"]):
            self.assertAlmostEqual(float(row["damping_ratio"]), mode["damping_ratio"], delta=1e-5)
        self.assertNotEqual(0, train_sim("modes", wagon, "--csv", "--json").returncode)
        adhesion = train_sim("adhesion", wagon, "--csv", "--set", "wheel_rail.adhesion=wet")
        rows = list(csv.DictReader(adhesion.stdout.splitlines()))
        self.assertEqual(0.0, float(rows[0]["adhesion_at_40_kmh"]))
        self.assertTrue(all(float(row["adhesion_at_40_kmh"]) <= 0.3 for row in rows))
        self.assertEqual(2, train_sim("modes", wagon, "--set", "carbody.mass_kg=-1").returncode)


if __name__ == "__main__":
    os.environ.pop("TRAIN_BRAKE_CONFIG", None)
    rosunit.unitrun("train_sim", "train_sim_test", TrainSimTest)
