#!/usr/bin/env python3
"""The air brake as its users meet it: air-test, brake-weight, and what is said of a brake that cannot be.

usage: brake_commands_test.py TRAIN_SIM CONFIG_FOLDER [--gtest_output=xml:FILE]
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosunit

TRAIN_SIM, CONFIG = sys.argv[1], pathlib.Path(sys.argv[2])
SERVICE, GRADUATED = (str(CONFIG / "scenarios" / f"{name}.yaml") for name in ("full_service_ab", "mixed_g_p"))
FEW = ["--set", "train.consist[1].count=19"]


def train_sim(*arguments):
    return subprocess.run(
        [TRAIN_SIM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300
    )


class BrakeCommands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, text, base=SERVICE):
        path = self.folder / "own.yaml"
        path.write_text(f"base: {base}\n{text}\n")
        return path

    def assert_refused(self, text, *sentences, base=SERVICE):
        done = train_sim("check", self.write(text, base))
        self.assertEqual(2, done.returncode, text)
        for sentence in sentences:
            self.assertIn(sentence, done.stderr)

    def test_each_test_is_a_line_with_its_rule(self):
        done = train_sim("air-test", SERVICE, *FEW, "--trials", 2, "--seed", 3)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        lines = [line for line in done.stdout.splitlines() if line.endswith("passed") and ":" in line]
        for subject in (
            "single car",
            "charging",
            "leakage",
            "full service",
            "release",
            "service and release",
            "emergency",
            "random service commands, 1 cell(s)",
            "random service commands, 8 cell(s)",
        ):
            self.assertTrue(any(line.startswith(subject + ":") for line in lines), subject)
        for line in lines:
            self.assertRegex(line, r"(at most|at least|none|all)\b")
        self.assertIn(f"{len(lines)} of {len(lines)} passed", done.stdout)

    def test_a_brake_that_fails_is_told_with_1(self):
        done = train_sim("air-test", SERVICE, *FEW, "--set", "brake.pipe.leakage_g_per_s_km=300")
        self.assertEqual(1, done.returncode)
        self.assertRegex(done.stdout, r"leakage: tail's fall in a minute of lap.*FAILED")
        done = train_sim(
            "air-test",
            SERVICE,
            "--trials",
            1,
            "--set",
            "brake.valves[0].direct.quick_service_opening_mm=6",
            "--set",
            "brake.valves[0].direct.quick_service_volume_l=3",
            "--set",
            "brake.valves[0].direct.quick_service_kpa=200",
        )
        self.assertEqual(1, done.returncode)
        self.assertRegex(done.stdout, r"trial 1: vehicle \d+ at [\d.]+ s, pipe at first 600.0 kPa, after .*kPa")

    def test_an_empirical_brake_has_no_air(self):
        done = train_sim("air-test", CONFIG / "scenarios" / "emergency.yaml")
        self.assertEqual(2, done.returncode)
        self.assertIn("brake.kind must be pneumatic", done.stderr)

    def test_braked_weight(self):
        done = train_sim("brake-weight", GRADUATED, "--set", "brake=uic_p")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        stop_m, weight = map(
            float, re.search(r"from 100 km/h: ([\d.]+) m, braked weight ([\d.]+) %", done.stdout).groups()
        )
        self.assertAlmostEqual(61300.0 / stop_m - 8.9, weight, delta=0.1)  # UIC 544-1
        self.assertRegex(done.stdout, r"train: 50 vehicles, 525 m, position P\n.*within 10 %")

    def test_what_cannot_be_is_told_with_its_line(self):
        self.assert_refused(
            "brake:\n  base: ab_head_end\n  charged_pressure_kpa: 1100",
            "own.yaml:4: brake.charged_pressure_kpa must be in [300, 1000], got 1100",
        )
        self.assert_refused(
            "brake:\n  base: ab_head_end\n  charged_pressure_kpa: 250",
            "own.yaml:4: brake.charged_pressure_kpa must be in [300, 1000], got 250",
        )
        self.assert_refused(
            "brake:\n  base: ab_head_end\n  pipe: {inner_diameter_mm: 15}\n  closed_angle_cocks: [150]\n"
            "  equipment:\n    - {from: 1, to: 5, valve: ab}\n    - {from: 5, to: 6, valve: ab}",
            "own.yaml:4: brake.pipe.inner_diameter_mm must be in [20, 50], got 15",
        )
        self.assert_refused(
            "brake:\n  base: ab_head_end\n  closed_angle_cocks: [150]\n"
            "  equipment:\n    - {from: 1, to: 5, valve: ab}\n    - {from: 5, to: 6, valve: ab}",
            "own.yaml:4: brake.closed_angle_cocks[0] must be in [1, 149]: a hose and its angle cocks are between",
            "own.yaml:7: brake.equipment[1].from must leave each vehicle to one entry: vehicle 5 is in "
            "brake.equipment[0], too",
        )
        self.assert_refused(
            "brake:\n  base: ecp\n  valves:\n    - {name: e, kind: ecp, direct: {apply_kpa: 5}}",
            "own.yaml:5: brake.valves[0].direct is not",
        )
        self.assert_refused(
            "commands:\n  - {time_s: 1, kind: apply, reduction_kpa: 100}\n"
            "  - {time_s: 20, kind: apply, reduction_kpa: 50}",
            "own.yaml:4: commands[1].reduction_kpa must not be below that of the application before, 100: valves "
            "of direct release cannot let the brake down by steps",
        )

    def test_valves_that_release_differently_are_warned_of(self):
        done = train_sim(
            "check",
            self.write(
                "brake:\n  base: ab_head_end\n  valves:\n    - {name: ab, kind: direct_release}\n"
                "    - {name: p, kind: graduated_release}\n"
                "  equipment:\n    - {from: 3, to: 5, valve: p}"
            ),
        )
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertRegex(
            done.stderr,
            r"own.yaml:\d+: .*147 valves of direct and 3 of graduated release: at the first rise of the "
            "pipe the direct ones release fully",
        )


if __name__ == "__main__":
    rosunit.unitrun("train_sim", "brake_commands_test", BrakeCommands)
