#!/usr/bin/python3
"""`rosrun train_brake sweep` and `calibrate`, as their users meet them."""
import csv
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import numpy
import rosunit
import yaml

from train_brake import study

HERE = pathlib.Path(__file__).resolve().parent
# A wagon that rolls freely: its way is known by hand, and a run takes no time.
SCENARIO = """
name: rolling
description: a mass without resistance, on a grade
model: ltd
train:
  name: one
  connection: mt2
  consist:
    - vehicle:
        name: mass
        length_m: 10
        mass_kg: 50000
        axles: 4
        brake_rigging:
          shoe_load_per_pressure_n_per_pa: 0.1
          shoe_friction: {standstill_friction_coefficient: 0.3, reference_speed_kmh: 150}
        propulsion_resistance: {constant_n_per_kn: 0, linear_n_per_kn_kmh: 0, quadratic_n_per_kn_kmh2: 0}
track: {name: hill, grades: [{from_m: -100000, grade_percent: -1}]}
brake: single_vehicle
commands: []
initial_speed_kmh: 36
duration_s: 10
dt_s: 0.01
exchange_interval_s: 0.01
record_interval_s: 1
"""
GRAVITY = 9.81


def table(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


class Values(unittest.TestCase):
    def test_grids(self):
        self.assertEqual(("a.b", ["1", "2.5", "x"]), study.grid_of("a.b=1, 2.5,x"))
        self.assertEqual(("a", ["40", "60", "80"]), study.grid_of("a=40:80:3"))
        self.assertEqual(("a", ["0.1", "0.2", "0.3"]), study.grid_of("a=0.1:0.3:3"))
        self.assertEqual(
            ("track", ["level", "{name: t, grades: [1, 2]}"]), study.grid_of("track=level,{name: t, grades: [1, 2]}")
        )

    def test_what_is_no_grid_is_refused_with_the_rule(self):
        for text, rule in (
            ("a", "path=value"),
            ("a=1:2:1", "COUNT must be >= 2"),
            ("a=x:2:3", "must be numbers"),
            ("a=1,,2", "is empty"),
        ):
            with self.assertRaisesRegex(study.StudyError, rule):
                study.grid_of(text)

    def test_draws_depend_on_the_seed_and_follow_their_law(self):
        def draws(law, seed):
            return [
                float(x) for x in study.draws_of(f"a={law}", 4000, numpy.random.Generator(numpy.random.PCG64(seed)))[1]
            ]

        self.assertEqual(draws("uniform(2,4)", 1), draws("uniform(2,4)", 1))
        self.assertNotEqual(draws("uniform(2,4)", 1), draws("uniform(2,4)", 2))
        # Means within five standard errors.
        for law, mean, deviation in (("uniform(2,4)", 3.0, 2 / 12**0.5), ("normal(5,2)", 5.0, 2.0)):
            self.assertAlmostEqual(mean, numpy.mean(draws(law, 3)), delta=5 * deviation / 4000**0.5)
            self.assertAlmostEqual(deviation, numpy.std(draws(law, 3)), delta=0.1 * deviation)
        self.assertAlmostEqual(0.0, numpy.mean(numpy.log(draws("lognormal(1,0.5)", 3))), delta=5 * 0.5 / 4000**0.5)

    def test_laws_that_are_none_are_refused(self):
        for law, rule in (
            ("gauss(1,2)", "must be uniform"),
            ("uniform(3,2)", "HIGH is below LOW"),
            ("normal(1)", "two numbers"),
            ("lognormal(0,1)", "median > 0"),
        ):
            with self.assertRaisesRegex(study.StudyError, rule):
                study.draws_of(f"a={law}", 2, numpy.random.default_rng(1))

    def test_rows_times_points(self):
        rows = [[study.Change("a", "1")], [study.Change("a", "2")]]
        found = [[str(change) for change in run] for run in study.combined(rows, [("b", ["3", "4"])])]
        self.assertEqual([["a=1", "b=3"], ["a=1", "b=4"], ["a=2", "b=3"], ["a=2", "b=4"]], found)


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.here = pathlib.Path(folder.name)
        self.scenario = self.here / "rolling.yaml"
        self.scenario.write_text(SCENARIO)
        self.out = self.here / "study"

    def sweep(self, *words):
        return subprocess.run(
            ["rosrun", "train_brake", "sweep", *map(str, words)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )


class Sweep(InAFolder):
    def test_nine_runs_obey_their_law(self):
        done = self.sweep(
            self.scenario,
            self.out,
            "--grid",
            "initial_speed_kmh=18:54:3",
            "--grid",
            "track.grades[0].grade_percent=-2,-1,0",
        )
        self.assertEqual(0, done.returncode, done.stderr)
        rows = table(self.out / "results.csv")
        self.assertEqual(9, len(rows))
        for row in rows:
            grade = float(row["track.grades[0].grade_percent"]) / 100
            expected = float(row["initial_speed_kmh"]) - 3.6 * GRAVITY * grade / (1 + grade**2) ** 0.5 * 10
            # g sin against g tan: whatever the program takes, they differ by less than 2e-4 of the gain.
            self.assertAlmostEqual(expected, float(row["final_speed_kmh.mean"]), delta=3e-3)
        page = (self.out / "study.html").read_text()
        self.assertIn("final_speed_kmh over initial_speed_kmh", page)
        self.assertNotIn("http://", page.replace("http://www.w3.org", ""))  # needs no network

    def test_it_goes_on_where_it_was_ended_and_repeats_nothing(self):
        self.assertEqual(0, self.sweep(self.scenario, self.out, "--grid", "initial_speed_kmh=18,36,54").returncode)
        whole = (self.out / "results.csv").read_text()
        kept = (self.out / "runs/0001/summary.json").stat().st_mtime_ns
        (self.out / "runs/0002/summary.json").unlink()
        (self.out / "runs/0003/summary.json").write_text('{"compl')  # cut off on its way from another machine
        done = self.sweep(self.out)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("2 of 3 runs", done.stderr)
        self.assertEqual(whole, (self.out / "results.csv").read_text())
        self.assertEqual(kept, (self.out / "runs/0001/summary.json").stat().st_mtime_ns)

    def test_another_study_in_the_folder_is_refused(self):
        self.assertEqual(
            0, self.sweep(self.scenario, self.out, "--grid", "initial_speed_kmh=18,36", "--plan-only").returncode
        )
        again = self.sweep(self.scenario, self.out, "--grid", "initial_speed_kmh=18,37")
        self.assertEqual(2, again.returncode)
        self.assertIn("holds another study", again.stderr)

    def test_all_runs_are_checked_before_the_first_begins(self):
        done = self.sweep(self.scenario, self.out, "--grid", "dt_s=0.01,-1")
        self.assertEqual(2, done.returncode)
        self.assertIn("with dt_s=-1", done.stderr)
        self.assertFalse(self.out.exists())

    def test_draws_are_the_same_at_every_point_and_percentiles_are_of_them(self):
        done = self.sweep(
            self.scenario,
            self.out,
            "--random",
            "initial_speed_kmh=uniform(30,40)",
            "--draws",
            5,
            "--seed",
            7,
            "--grid",
            "duration_s=1,2",
            "--set",
            "track=level",
        )
        self.assertEqual(0, done.returncode, done.stderr)
        rows = table(self.out / "results.csv")
        speeds = {t: [float(row["initial_speed_kmh"]) for row in rows if row["duration_s"] == t] for t in "12"}
        self.assertEqual(speeds["1"], speeds["2"])
        self.assertEqual(5, len(set(speeds["1"])))
        lines = [line for line in table(self.out / "percentiles.csv") if line["result"] == "final_speed_kmh.mean"]
        self.assertEqual(["1", "2"], [line["duration_s"] for line in lines])
        for line in lines:  # level and without resistance: the start speed stays
            self.assertAlmostEqual(sorted(speeds["1"])[2], float(line["p50"]), delta=1e-6)
            self.assertAlmostEqual(min(speeds["1"]), float(line["min"]), delta=1e-6)

    def test_ctrl_c_ends_the_runs_and_what_is_done_is_kept(self):
        (self.here / "cases.csv").write_text("duration_s\n1\n900000\n900000\n")
        process = subprocess.Popen(
            [
                "rosrun",
                "train_brake",
                "sweep",
                str(self.scenario),
                str(self.out),
                "--list",
                str(self.here / "cases.csv"),
                "--jobs",
                "2",
                "--set",
                "track=level",
            ],
            start_new_session=True,
            stderr=subprocess.PIPE,
            text=True,
        )
        deadline = time.monotonic() + 60
        while not list(self.out.glob("runs/0003/log")) and time.monotonic() < deadline:
            time.sleep(0.05)
        time.sleep(0.5)
        os.killpg(process.pid, signal.SIGINT)
        _, messages = process.communicate(timeout=60)
        self.assertEqual(130, process.returncode, messages)
        self.assertIn("1 of 3 runs are done", messages)
        self.assertEqual(["0001"], [row["run"] for row in table(self.out / "results.csv")])
        for run in ("0002", "0003"):
            self.assertIn("interrupted", (self.out / "runs" / run / "log").read_text())

    def test_a_key_for_all_runs_that_also_changes_is_refused(self):
        done = self.sweep(self.scenario, self.out, "--grid", "dt_s=0.01,0.02", "--set", "dt_s=0.005")
        self.assertEqual(2, done.returncode)
        self.assertIn("dt_s: set for all runs, and changed from run to run", done.stderr)

    def test_a_list_changes_what_its_cells_say(self):
        (self.here / "cases.csv").write_text("initial_speed_kmh,track\n18,\n,level\n")
        done = self.sweep(self.scenario, self.out, "--list", self.here / "cases.csv", "--plan-only")
        self.assertEqual(0, done.returncode, done.stderr)
        first, second = (yaml.safe_load((self.out / f"runs/{i}/config.yaml").read_text()) for i in ("0001", "0002"))
        self.assertEqual((18, "hill"), (first["initial_speed_kmh"], first["track"]["name"]))
        self.assertEqual((36, "level"), (second["initial_speed_kmh"], second["track"]["name"]))

    def test_gnu_parallel_runs_the_jobs_and_collect_finds_them(self):
        self.assertEqual(
            0, self.sweep(self.scenario, self.out, "--grid", "initial_speed_kmh=18,36,54", "--plan-only").returncode
        )
        subprocess.run(
            [
                "parallel",
                "--will-cite",
                "-j2",
                "train_sim run study/runs/{}/config.yaml --json --threads 1 > study/runs/{}/summary.json",
                "::::",
                "study/jobs.txt",
            ],
            cwd=self.here,
            check=True,
            stderr=subprocess.DEVNULL,
        )
        done = self.sweep(self.out, "--collect")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual(3, len(table(self.out / "results.csv")))

    def test_a_result_that_is_none_is_refused_with_those_that_are(self):
        done = self.sweep(self.scenario, self.out, "--grid", "initial_speed_kmh=18,36", "--results", "final_speed")
        self.assertEqual(2, done.returncode)
        self.assertIn("final_speed_kmh.mean", done.stderr)


class Calibrate(InAFolder):
    def calibrate(self, text, *words):
        file = self.here / "fit.yaml"
        file.write_text(text)
        return subprocess.run(
            ["rosrun", "train_brake", "calibrate", str(file), *map(str, words)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )

    def test_finds_the_start_speed_and_the_grade_that_two_speeds_tell(self):
        gained_kmh_per_s = 3.6 * GRAVITY * 0.02
        done = self.calibrate(
            f"""
parameters:
  - {{path: initial_speed_kmh, start: 40, lowest: 1, highest: 100}}
  - {{path: "track.grades[0].grade_percent", start: -1, lowest: -5, highest: 5}}
targets:
  - scenario: rolling.yaml
    set: [duration_s=10]
    result: final_speed_kmh.mean
    value: {50 + 10 * gained_kmh_per_s}
    tolerance: 0.001
  - scenario: rolling.yaml
    set: [duration_s=20]
    result: final_speed_kmh.mean
    value: {50 + 20 * gained_kmh_per_s}
    tolerance: 0.001
""",
            "--out",
            self.here / "fit.json",
        )
        self.assertEqual(0, done.returncode, done.stderr)
        found = json.loads((self.here / "fit.json").read_text())
        values = {parameter["path"]: parameter["value"] for parameter in found["parameters"]}
        self.assertAlmostEqual(50, values["initial_speed_kmh"], delta=0.01)
        self.assertAlmostEqual(-2, values["track.grades[0].grade_percent"], delta=0.002)
        self.assertTrue(all(abs(target["difference"]) < 0.001 for target in found["targets"]))
        self.assertIn("--set initial_speed_kmh=", done.stdout)

    def test_targets_that_cannot_be_met_end_with_1_and_say_so(self):
        done = self.calibrate(
            """
parameters: [{path: initial_speed_kmh, start: 40, lowest: 30, highest: 50}]
targets: [{scenario: rolling.yaml, set: [track=level], result: final_speed_kmh.mean, value: 60, tolerance: 0.01}]
"""
        )
        self.assertEqual(1, done.returncode)
        self.assertIn("initial_speed_kmh is at its highest", done.stderr)

    def test_what_is_wrong_with_the_file_is_told_at_once(self):
        done = self.calibrate(
            """
parameters: [{path: initial_speed_kmh, start: 4, lowest: 30, highst: 50}]
targets: [{scenario: rolling.yaml, result: final_speed_kmh.mean, value: fast, tolerance: 0}]
"""
        )
        self.assertEqual(2, done.returncode)
        for text in (
            "parameters[0].highst is not a known key; did you mean highest?",
            "parameters[0].highest is missing",
            "targets[0].value must be a number, got 'fast'",
            "targets[0].tolerance must be > 0, got 0",
        ):
            self.assertIn(text, done.stderr)


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "study_test", "__main__")
