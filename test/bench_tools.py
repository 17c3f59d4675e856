#!/usr/bin/python3
"""The benchmarks still run and say what tools/bench looks for. How fast anything is, is no matter here.

usage: bench_tools.py FOLDER_OF_PROGRAMS [--gtest_output=xml:FILE]
"""
import functools
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import rosunit

BENCH = pathlib.Path(__file__).resolve().parents[1] / "tools" / "bench"
sys.path.insert(0, str(BENCH))

import limit  # noqa: E402
import measure  # noqa: E402
import page  # noqa: E402
import targets  # noqa: E402
import vehicles  # noqa: E402
import workspace  # noqa: E402
from table import Table, as_text  # noqa: E402

workspace.PROGRAMS = pathlib.Path(sys.argv[1])
BUILT = (workspace.PROGRAMS / "train_dynamics" / "vehicle_bench").exists()
HURRIED = functools.partial(measure.google_benchmark, repetitions=2, min_time_s=0.001)


class BenchTools(unittest.TestCase):
    @unittest.skipUnless(BUILT, "the benchmarks are not built")
    @mock.patch.object(measure, "google_benchmark", HURRIED)
    def test_vehicles_names_what_the_programs_measure(self):
        tables, facts = vehicles.run()
        self.assertGreater(facts["locked_ns"], 0)
        instruction_sets = [row[0] for row in tables[0].rows]
        self.assertIn("scalar", instruction_sets)
        for table in tables:
            for row in table.rows:
                self.assertEqual(len(table.columns) + 1, len(row), table.title)

    @unittest.skipUnless(BUILT, "the benchmarks are not built")
    @mock.patch.object(measure, "google_benchmark", HURRIED)
    @mock.patch.object(shutil, "which", lambda _: None)
    def test_limit_names_what_the_programs_measure(self):
        tables, facts = limit.run()
        self.assertGreater(facts["to_limit"], 0)
        self.assertEqual("measured", tables[0].rows[-1][0])

    @unittest.skipUnless(BUILT, "the benchmarks are not built")
    def test_mpi_gives_the_same_bits(self):
        settings = ["duration_s=0.05"]
        mpi = workspace.mpi_train(2, settings)
        if mpi is None:
            self.skipTest("MPI is not installed")
        self.assertEqual(workspace.train_sim(settings=settings).summary["state_digest"], mpi["state_digest"])

    def test_unknown_section(self):
        done = subprocess.run([sys.executable, str(BENCH), "--only", "runs,speed"], stderr=subprocess.PIPE, text=True)
        self.assertEqual(2, done.returncode)
        self.assertIn("speed is not a section; the sections are vehicles, runs, ", done.stderr)

    def test_a_program_that_fails_is_an_error_with_its_words(self):
        with self.assertRaisesRegex(measure.Failed, "(?s)exit code 3.*no such wagon"):
            measure.Run(["sh", "-c", "echo no such wagon >&2; exit 3"])
        with self.assertRaisesRegex(measure.Failed, "longer than 1 s"):
            measure.Run(["sleep", "60"], timeout_s=1)

    def test_targets(self):
        rows = dict((row[0], row[1:]) for row in targets.table({"runs": {"2d_1_ns": 110, "ltd_1_wall_s": 0.3}}).rows)
        self.assertEqual(("110", "220 ns per vehicle-step", "met, 50 % below"),
                         rows["2D train, one thread, everything included"])
        self.assertEqual("MISSED by 100 %", rows["emergency stop with its bag, LTD, one thread"][2])
        self.assertEqual("not measured", rows["ROS, 242 ranks: an exchange against MPI"][0])

    def test_tables_are_aligned(self):
        text = as_text([Table("short", ["a"], [("one", "1"), ("a much longer label", "100")]),
                        Table("other", ["b", "c"], [("x", "2", "3")])])
        for block in text.strip("\n").split("\n\n"):
            self.assertEqual(1, len({len(line) for line in block.splitlines()}), block)

    def test_the_page_says_what_is_missing(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(page, "PAGE", pathlib.Path(folder) / "page.md"):
            page.write([("processor", "one")], Table("targets", ["measured"], []),
                       {"runs": [Table("run", ["s"], [("2d", "1.5")])]})
            text = page.PAGE.read_text()
        self.assertIn("- processor: one", text)
        self.assertIn("| 2d  | 1.5 |", text)
        self.assertIn("*Not measured: `make bench ONLY=exchange`.*", text)
        self.assertNotIn("{", text.replace("`{", ""))


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "bench_tools", BenchTools)
