#!/usr/bin/env python3
"""Routes and trains from files, as their users make them, and the examples in config/: each is run for a while.

usage: examples_test.py TRAIN_SIM CONFIG_FOLDER [--gtest_output=xml:FILE]
"""

import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosunit
import yaml

TRAIN_SIM, CONFIG = sys.argv[1], pathlib.Path(sys.argv[2])

SCENARIO = """
name: mine
model: ltd
train: {train}
track: line.csv
brake: single_vehicle
commands: [{{time_s: 1, kind: apply, reduction_kpa: 100}}]
initial_speed_kmh: 36
start_position_m: {start}
duration_s: 20
dt_s: 0.005
exchange_interval_s: 0.005
record_interval_s: 0.1
"""
COUPLER = str(CONFIG / "couplers" / "mt2.yaml")
SIMPLE = """
length_m: 12
mass_kg: 20000
axles: 2
load: {mass_kg: 30000}
brake_rigging: {shoe_load_per_pressure_n_per_pa: 0.1, shoe_friction: {standstill_friction_coefficient: 0.322,
                reference_speed_kmh: 150}}
propulsion_resistance: {constant_n_per_kn: 0, linear_n_per_kn_kmh: 0, quadratic_n_per_kn_kmh2: 0}
"""


def train_sim(*arguments):
    return subprocess.run(
        [TRAIN_SIM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=500
    )


class OwnFiles(unittest.TestCase):
    """In the user's own folder, with own vehicle, consist and route."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.here = pathlib.Path(folder.name)
        self.write("simple.yaml", SIMPLE)

    def write(self, name, text):
        path = self.here / name
        path.write_text(text)
        return path

    def run_ok(self, scenario, *arguments):
        done = train_sim("run", "--json", scenario, *arguments)
        self.assertEqual(0, done.returncode, done.stderr)
        return json.loads(done.stdout), done.stderr

    def test_a_survey_of_400_points_just_works(self):
        heights, rows = [], ["position_km;height_m;radius_m;speed_limit_kmh;station;note"]
        for i in range(400):
            heights.append(round(250 + 40 * math.sin(i / 30) + 0.05 * i, 1))
            radius = 0 if i % 7 else (600 if i % 2 else -450)
            rows.append(
                f"{0.25 * i:g};{heights[-1]};{radius};{80 if i < 300 else 60};{'Zell' if i == 200 else ''};\"m, ok\""
            )
        line = self.write("line.csv", "\n".join(rows) + "\n")
        plot, table = self.here / "line.svg", self.here / "again.csv"
        done = train_sim("route", line, "--plot", plot, "--csv", table)
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        self.assertIn("0.000 km to 99.750 km", done.stdout)
        self.assertIn("Zell at 50.000 km", done.stdout)
        rises = [b - a for a, b in zip(heights, heights[1:])]
        self.assertIn(
            f"up {sum(r for r in rises if r > 0):.1f} m, down {-sum(r for r in rises if r < 0):.1f} m", done.stdout
        )
        self.assertIn("450 m radius to the left", done.stdout)
        self.assertIn("<polyline", plot.read_text())
        self.assertIn("Zell", plot.read_text())
        again = train_sim("route", table)
        self.assertEqual(0, again.returncode, again.stderr)
        for fact in ("grades", "curves", "limits", "stations"):
            one, other = (re.search(rf"^ +{fact} +(.*)$", text, re.M).group(1) for text in (done.stdout, again.stdout))
            self.assertEqual(*[re.sub(r"^\d+( stretches)?", "", fact) for fact in (one, other)])

    def test_a_train_falls_down_the_route_of_a_table(self):
        # Without resistance and brake: from 10 m/s down 1 % on the level of energy, at the end on level track.
        self.write("line.csv", "grade_permille,position_m\n0,-1000\n-10,0\n0,500\n0,2000\n")
        scenario = self.write(
            "mine.yaml",
            SCENARIO.format(
                train="{name: t, connection: %s, consist: [{vehicle: ./simple.yaml, load_fraction: 0.5}]}" % COUPLER,
                start=-50,
            ),
        )
        summary, _ = self.run_ok(scenario, "--set", "commands=[]", "--set", "duration_s=60")
        self.assertAlmostEqual(
            3.6 * math.sqrt(10**2 + 2 * 9.81 * 5.0), summary["final_speed_kmh"]["mean"], delta=0.01
        )

    def test_a_consist_by_rows_is_that_by_lists(self):
        self.write("line.csv", "position_m,grade_permille\n-1000,0\n5000,0\n")
        self.write(
            "groups.csv", 'count,vehicle,load_fraction,note\n2,./simple.yaml,1,"full, front"\n3,./simple.yaml,0,\n'
        )
        rows = self.write(
            "rows.yaml", SCENARIO.format(train="{name: t, connection: %s, consist: groups.csv}" % COUPLER, start=0)
        )
        lists = self.write(
            "lists.yaml",
            SCENARIO.format(
                train="{name: t, connection: %s, consist: [{vehicle: ./simple.yaml, count: 2}, "
                "{vehicle: ./simple.yaml, count: 3, load_fraction: 0}]}" % COUPLER,
                start=0,
            ),
        )
        one, two = self.run_ok(rows)[0], self.run_ok(lists)[0]
        self.assertEqual(5, one["vehicles"])
        self.assertEqual(one["state_digest"], two["state_digest"])
        # Initial kinetic energy: 2 of 50 t, 3 of 20 t at 10 m/s.
        self.assertAlmostEqual(0.5 * 160e3 * 100.0, one["energy"]["initial_j"], delta=1.0)

    def test_errors_name_file_line_and_column(self):
        self.write("line.csv", "position_m,grade_permile,radius_m\n0,1,0\n250,2,30\n200,,0\n")
        self.write(
            "groups.csv", "vehicle,count,load_fraction\n./simple.yaml,two,1\n./complex.yaml,1,1\n./simple.yaml,1,1.2\n"
        )
        done = train_sim(
            "run",
            self.write(
                "mine.yaml", SCENARIO.format(train="{name: t, connection: %s, consist: groups.csv}" % COUPLER, start=0)
            ),
        )
        self.assertEqual(2, done.returncode)
        for words in (
            r"line.csv:1: \S*track.points\[0\].grade_permile is not a known key; did you mean grade_permille\?",
            r"line.csv:3: \S*track.points\[1\].radius_m must be at least 50 m",
            r"groups.csv:2: \S*train.consist\[0\].count must be a (whole )?number, got 'two'",
            r"groups.csv:3: \S*train.consist\[1\].vehicle names the file './complex.yaml'",
            r"groups.csv:4: \S*load_fraction must be in \[0, 1\], got 1.2",
        ):
            self.assertRegex(done.stderr, words)

    def test_one_mass_has_no_2d_model(self):
        self.write("line.csv", "position_m,grade_permille\n-1000,0\n5000,0\n")
        scenario = self.write(
            "mine.yaml",
            SCENARIO.format(train="{name: t, connection: %s, consist: [{vehicle: ./simple.yaml}]}" % COUPLER, start=0),
        )
        done = train_sim("run", scenario, "--model", "2d")
        self.assertEqual(2, done.returncode)
        self.assertIn("vehicle.mass_kg is all that the vehicle has, but the 2d model needs its bodies", done.stderr)
        modes = train_sim("modes", self.here / "simple.yaml")
        self.assertEqual(2, modes.returncode)
        self.assertIn("without bodies it has no 2D model", modes.stderr)

    def test_a_train_that_leaves_its_route_is_told(self):
        self.write("line.csv", "position_m,grade_permille\n-100,0\n40,0\n")
        scenario = self.write(
            "mine.yaml",
            SCENARIO.format(train="{name: t, connection: %s, consist: [{vehicle: ./simple.yaml}]}" % COUPLER, start=0),
        )
        summary, told = self.run_ok(scenario, "--set", "commands=[]")
        self.assertAlmostEqual(3.4, summary["left_route_s"], delta=0.11)  # 40 m less half of 12 m at 10 m/s
        self.assertIn("beyond an end of its route", told)
        _, told = self.run_ok(scenario, "--set", "start_position_m=-99")
        self.assertIn("start_position_m", told + "start_position_m" * ("the train begins between" in told))
        self.assertIn("the train begins between -105 m and -93 m", told)


class Examples(unittest.TestCase):
    """Every scenario and route in config/."""

    def test_routes(self):
        for route in sorted((CONFIG / "tracks").iterdir()):
            done = train_sim("route", route)
            self.assertEqual(0, done.returncode, f"{route}: {done.stderr}")
            self.assertIn("extent", done.stdout)

    def test_scenarios_run(self):
        for scenario in sorted((CONFIG / "scenarios").glob("*.yaml")):
            with self.subTest(scenario.name):
                checked = yaml.safe_load(scenario.read_text())
                done = train_sim(
                    "run",
                    "--json",
                    scenario,
                    "--model",
                    "ltd",
                    "--set",
                    "duration_s=4",
                    "--set",
                    "record_interval_s=0.1",
                    "--set",
                    "ledger_interval_s=1",
                    "--set",
                    "detail_vehicles=[]",
                )
                self.assertEqual(0, done.returncode, done.stderr)
                summary = json.loads(done.stdout)
                self.assertEqual(checked["name"], summary["scenario"])
                energy = summary["energy"]
                scale = max(energy["initial_j"], 1e6)
                self.assertLess(abs(energy["residual_j"]), 1e-4 * scale)
                self.assertIsNone(summary["left_route_s"])

    def test_what_is_resolved_can_be_read_again(self):
        """A run's config.yaml is such a text: resume, verify and wagon nodes read it. Every scenario, and every part in
        one."""
        scenarios = [(file, []) for file in sorted((CONFIG / "scenarios").glob("*.yaml"))]
        for folder, scenario, key in (
            ("brakes", "emergency_ab", "brake"),
            ("couplers", "emergency_ab", "train.connection"),
            ("vehicles", "single_wagon_stop", "train.consist[0].vehicle"),
            ("trains", "single_wagon_stop", "train"),
            ("tracks", "single_wagon_stop", "track"),
        ):
            for part in sorted((CONFIG / folder).glob("*.yaml")):
                settings = ["--set", f"{key}={part.stem}", "--set", "model=ltd", "--set", "detail_vehicles=[]"]
                scenarios.append((CONFIG / "scenarios" / f"{scenario}.yaml", settings))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "resolved.yaml"
            for scenario, settings in scenarios:
                with self.subTest(f"{scenario.stem} {settings[:2]}"):
                    resolved = train_sim("resolve", scenario, *settings)
                    self.assertEqual(0, resolved.returncode, resolved.stderr)
                    file.write_text(resolved.stdout)
                    again = train_sim("resolve", file)
                    self.assertEqual(0, again.returncode, again.stderr)
                    self.assertEqual(resolved.stdout, again.stdout)


if __name__ == "__main__":
    os.environ.pop("TRAIN_BRAKE_CONFIG", None)
    os.environ["TRAIN_BRAKE_CONFIG"] = str(CONFIG)
    rosunit.unitrun("train_sim", "own_files", OwnFiles)
    rosunit.unitrun("train_sim", "examples", Examples)
