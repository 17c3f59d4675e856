#!/usr/bin/python3
"""The benchmarks still run and say what tools/bench looks for. How fast anything is, is no matter here.

usage: bench_tools.py FOLDER_OF_PROGRAMS [--gtest_output=xml:FILE]
"""
import contextlib
import functools
import importlib.util
import io
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import rosunit

BENCH = pathlib.Path(__file__).resolve().parents[1] / "tools" / "bench"
sys.path.insert(0, str(BENCH))

import against  # noqa: E402
import exchange  # noqa: E402
import limit  # noqa: E402
import machine  # noqa: E402
import measure  # noqa: E402
import page  # noqa: E402
import profile_ranks  # noqa: E402
import targets  # noqa: E402
import vehicles  # noqa: E402
import workspace  # noqa: E402
from table import Table, as_text  # noqa: E402

workspace.PROGRAMS = pathlib.Path(sys.argv[1])
BUILT = (workspace.PROGRAMS / "train_dynamics" / "vehicle_bench").exists()
# CMake leaves them out of builds with sanitizers, whose times mean nothing, and where Google Benchmark is missing.
NOT_BUILT = "this build has no benchmarks: a sanitizer, or no libbenchmark-dev"
HURRIED = functools.partial(measure.google_benchmark, repetitions=2, min_time_s=0.001)


def bench_main():
    """tools/bench/__main__.py, loaded by path because this file is called __main__, too."""
    spec = importlib.util.spec_from_file_location("bench_main", BENCH / "__main__.py")
    main = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(main)
    return main


class BenchTools(unittest.TestCase):
    @unittest.skipUnless(BUILT, NOT_BUILT)
    @mock.patch.object(measure, "google_benchmark", HURRIED)
    def test_vehicles_names_what_the_programs_measure(self):
        tables, facts = vehicles.run()
        self.assertGreater(facts["locked_ns"], 0)
        self.assertEqual(["ltd, 1 thread(s)"], [row[0] for row in tables[1].rows if row[0].startswith("ltd")])
        self.assertAlmostEqual(1.0, sum(facts[fact] for fact in facts if fact.startswith("ltd_share")))
        instruction_sets = [row[0] for row in tables[0].rows]
        self.assertIn("scalar", instruction_sets)
        for table in tables:
            for row in table.rows:
                self.assertEqual(len(table.columns) + 1, len(row), table.title)

    @unittest.skipUnless(BUILT, NOT_BUILT)
    @mock.patch.object(measure, "google_benchmark", HURRIED)
    @mock.patch.object(shutil, "which", lambda _: None)
    def test_limit_names_what_the_programs_measure(self):
        tables, facts = limit.run()
        self.assertGreater(facts["to_limit"], 0)
        self.assertEqual("measured", tables[0].rows[-1][0])

    @unittest.skipUnless(BUILT, NOT_BUILT)
    @mock.patch.object(measure, "google_benchmark", HURRIED)
    @mock.patch.object(limit, "_instructions", lambda: (1500, 700))
    @mock.patch.object(shutil, "which", lambda name: name)
    def test_limit_of_the_instructions(self):
        tables, facts = limit.run()
        if "issue_share" not in facts:
            self.skipTest("no AVX2 here")
        self.assertTrue(0 < facts["issue_share"] < 2, facts)
        self.assertEqual(
            ["instructions", "loads and stores", "measured, wagons alone"], [row[0] for row in tables[1].rows]
        )

    @unittest.skipUnless(BUILT, NOT_BUILT)
    def test_memory_is_that_of_the_program_alone(self):
        of_this_python = bytearray(os.urandom(1 << 20) * 100)
        peak = measure.peak_bytes(workspace.program("train_dynamics", "peak_memory"), ["true"])
        self.assertTrue(0.1 * 2**20 < peak < 5 * 2**20, peak)
        self.assertLess(peak, len(of_this_python))
        with self.assertRaisesRegex(measure.Failed, "exit code 3"):
            measure.peak_bytes(workspace.program("train_dynamics", "peak_memory"), ["sh", "-c", "exit 3"])

    @unittest.skipUnless(BUILT, NOT_BUILT)
    def test_mpi_gives_the_same_bits(self):
        settings = ["duration_s=0.05"]
        mpi = workspace.mpi_train(2, settings)
        if mpi is None:
            self.skipTest("MPI is not installed")
        self.assertEqual(workspace.train_sim(settings=settings).summary["state_digest"], mpi["state_digest"])

    @mock.patch.object(workspace, "_mpi_works", True)
    def test_an_mpi_that_fails_is_no_mpi(self):
        with tempfile.TemporaryDirectory() as folder:
            mpirun = pathlib.Path(folder) / "mpirun"
            mpirun.write_text("#!/bin/sh\necho no such option: --oversubscribe >&2; exit 255\n")
            mpirun.chmod(0o755)
            programs = pathlib.Path(folder) / "train_dynamics"
            programs.mkdir()
            (programs / "mpi_train").touch()
            said = io.StringIO()
            with mock.patch.dict(os.environ, PATH=f"{folder}:{os.environ['PATH']}"), mock.patch.object(
                workspace, "PROGRAMS", pathlib.Path(folder)
            ), contextlib.redirect_stderr(said):
                self.assertIsNone(workspace.mpi_train(2, []))
                self.assertIsNone(workspace.mpi_train(8, []))
        self.assertEqual(1, said.getvalue().count("no such option: --oversubscribe"))

    def test_exchange_is_measured_in_pairs(self):
        class Launch:
            """Takes as long per exchange as it has ranks, in ms."""

            start_s, stop_s = 1.0, 2.0

            def __init__(self, ranks, *_, settings):
                self.ranks, self.summary = ranks, {"state_digest": f"{ranks}"}

            def per_exchange_s(self):
                return 1e-3 * self.ranks

        walls = iter(range(1, 100))

        def mpi(ranks, _):
            return {"wall_s": 1e-3 * ranks * next(walls), "exchanges": 1, "state_digest": f"{ranks}"}

        with mock.patch.multiple(workspace, Launch=Launch, mpi_train=mpi), mock.patch.object(
            exchange, "EXCHANGES", {2: 10, 242: 10}
        ), mock.patch.object(exchange, "PROFILES", [("shared memory", 2, 1), ("MPI", 2, 1)]), mock.patch.object(
            exchange, "BUSY", {2: 10}
        ):
            tables, facts = exchange.run()
        rows = {row[0]: row[1:] for row in tables[0].rows}
        self.assertEqual(("0.75 x", "0.292 x"), rows["shared memory to MPI"])
        self.assertEqual(("0.5 ... 1", "0.25 ... 0.333"), rows["from ... to"])
        self.assertEqual(("0.75 x", "0.286 x"), rows["TCP to MPI"])
        self.assertAlmostEqual((1 / 3 + 1 / 4) / 2, facts["to_mpi_242"])
        self.assertEqual([("2 ranks", "2", "10", "0.2 x")], tables[2].rows)  # MPI's fifth run
        self.assertEqual(["shared memory, 2 ranks", "MPI, 2 ranks"], [row[0] for row in tables[3].rows])
        with mock.patch.multiple(workspace, Launch=Launch, mpi_train=lambda *_: None), mock.patch.object(
            exchange, "PROFILES", [("MPI", 2, 1)]
        ), mock.patch.object(exchange, "BUSY", {2: 10}):
            tables, facts = exchange.run()
        self.assertIsNone(facts["to_mpi_242"])
        self.assertEqual({"-"}, set(tables[0].rows[-1][1:]))

    def test_the_profile_counts_what_the_ranks_do(self):
        script = "import sys, time\nprint('up', flush=True)\nwhile True: time.sleep(0.001)"
        with tempfile.TemporaryDirectory() as folder:
            rank = pathlib.Path(folder) / "a_rank"
            rank.symlink_to(sys.executable)
            ranks = [subprocess.Popen([str(rank), "-c", script], stdout=subprocess.PIPE) for _ in range(2)]
            try:
                for process in ranks:
                    process.stdout.readline()
                with profile_ranks.Watch("a_rank", 2) as watch:
                    time.sleep(3)
                with profile_ranks.Watch("a_rank", 3) as of_too_many:
                    time.sleep(0.5)
            finally:
                for process in ranks:
                    process.kill()
                    process.wait()
                    process.stdout.close()
        self.assertIsNone(of_too_many.per_exchange(1))
        of_a_second = watch.per_exchange(1)
        self.assertTrue(0 < of_a_second["switches"] < 1100, of_a_second)  # it sleeps 1000 times, or is held up
        self.assertTrue(0 < of_a_second["cpu_us"] < 1e6, of_a_second)
        self.assertAlmostEqual(0.5 * of_a_second["cpu_us"], watch.per_exchange(0.5)["cpu_us"])

    def test_missing_are_those_without_results_of_this_commit(self):
        main = bench_main()
        results = {name: {"commit": workspace.commit()} for name in main.SECTIONS if name not in ("runs", "graph")}
        results["graph"] = {"commit": "another"}
        with mock.patch.object(main, "_load", lambda: results):
            self.assertEqual(["runs", "graph"], main._chosen(["missing"]))
        self.assertEqual(main.SECTIONS, main._chosen([]))
        self.assertEqual(["runs"], main._chosen(["runs"]))
        with mock.patch.object(workspace, "OTHER", pathlib.Path("/")):
            self.assertEqual(["runs", "against"], main._chosen(["runs"]))

    def test_against_compares_two_builds(self):
        with tempfile.TemporaryDirectory() as folder:
            other = pathlib.Path(folder)
            programs = other / "devel" / "lib" / "train_sim"
            programs.mkdir(parents=True)
            (programs / "train_sim").write_text("a script is not the program")
            with mock.patch.object(workspace, "OTHER", other), self.assertRaisesRegex(measure.Failed, "build it first"):
                workspace.other_program("train_sim")

            def build(seconds):
                program = programs / f"takes_{seconds}"
                program.write_text(
                    f"#!/bin/sh\nsleep {seconds}; : $((n = 0)); while [ $n -lt 3000 ]; do n=$((n + 1)); done\n"
                    'while [ $# -gt 1 ]; do [ "$1" = --out ] && echo \'{"state_digest": "1"}\' > "$2/summary.json"; '
                    "shift; done\n"
                    "exit 0\n"
                )
                program.chmod(0o755)
                return lambda: (program, "scenario")

            with mock.patch.multiple(
                against, _own=build(0.1), _other=build(0.3), REPETITIONS={"2d": 1, "ltd": 1}
            ), mock.patch.object(workspace, "OTHER", other):
                tables, facts = against.run()
        self.assertTrue(facts["2d_same_digest"] and facts["ltd_same_digest"])
        self.assertTrue(all(facts[f"{model}_{what}"] > 0 for model in ("2d", "ltd") for what in ("bag", "no_record")))
        self.assertEqual(8, len(tables[0].rows))
        with self.assertRaisesRegex(measure.Failed, "AGAINST="):
            against.run()

    def test_a_section_that_fails_leaves_the_others(self):
        main = bench_main()
        sections = {"runs": lambda: 1 / 0, "graph": lambda: ([Table("graph", ["s"], [("one", "1")])], {"x": 1})}
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(
            main, "RESULTS", pathlib.Path(folder) / "bench"
        ), mock.patch.object(main.page, "PAGE", pathlib.Path(folder) / "page.md"), mock.patch.object(
            main.importlib, "import_module", lambda name: mock.Mock(run=sections[name])
        ), mock.patch.object(
            sys, "argv", ["bench", "--only", "runs,graph"]
        ), contextlib.redirect_stdout(
            io.StringIO()
        ), contextlib.redirect_stderr(
            io.StringIO()
        ):
            with self.assertRaisesRegex(SystemExit, "(?s)make bench: runs: .*ZeroDivisionError"):
                main.main()
            text = main.page.PAGE.read_text()
            self.assertIn("| one   |   1 |", text)
            self.assertIn("*Not measured: `make bench ONLY=runs`.*", text)
            kept = pathlib.Path(folder) / "bench" / "graph.json"
            self.assertEqual(workspace.commit(), json.loads(kept.read_text())["commit"])

            main.page.PAGE = pathlib.Path(folder) / "no such folder" / "page.md"
            with self.assertRaisesRegex(SystemExit, "make bench: the page is not written: .*no such folder"):
                main.main()

    def test_sections_of_different_commits_are_told_apart(self):
        main = bench_main()
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(
                "a (runs, limit); b (graph)",
                main._commits({"runs": {"commit": "a"}, "graph": {"commit": "b"}, "limit": {"commit": "a"}}),
            )
        self.assertEqual("a", main._commits({"runs": {"commit": "a"}}))

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
        self.assertEqual(
            ("110", "220 ns per vehicle-step", "met, 50 % below"), rows["2D train, one thread, everything included"]
        )
        self.assertEqual("MISSED by 150 %", rows["emergency stop with its bag, LTD, one thread"][2])
        self.assertEqual("not measured", rows["ROS, 242 ranks: an exchange against MPI"][0])

    def test_the_verdict_names_what_is_missed(self):
        lines = targets.verdict({"runs": {"2d_1_ns": 110, "ltd_1_wall_s": 0.3}}).splitlines()
        self.assertEqual(f"1 of {len(targets.TARGETS)} targets are met.", lines[0])
        self.assertEqual("MISSED: emergency stop with its bag, LTD, one thread", lines[1])
        self.assertEqual(len(targets.TARGETS), len(lines))
        self.assertTrue(all(line.startswith("not measured: ") for line in lines[2:]))

    def test_tables_are_aligned(self):
        text = as_text(
            [
                Table("short", ["a"], [("one", "1"), ("a much longer label", "100")]),
                Table("other", ["b", "c"], [("x", "2", "3")]),
            ]
        )
        for block in text.strip("\n").split("\n\n"):
            self.assertEqual(1, len({len(line) for line in block.splitlines()}), block)

    def page(self, tables, facts):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(page, "PAGE", pathlib.Path(folder) / "page.md"):
            page.write([("processor", "one")], tables, facts)
            return page.PAGE.read_text()

    def test_the_page_says_what_is_missing(self):
        text = self.page({"runs": [Table("run", ["s"], [("2d", "1.5")])]}, {"runs": {"ltd_1_wall_s": 0.1}})
        self.assertIn("- processor: one", text)
        self.assertIn("| 2d  | 1.5 |", text)
        self.assertIn("*Not measured: `make bench ONLY=exchange`.*", text)
        self.assertNotIn("What is missed", text)
        self.assertNotIn("{", text.replace("`{", ""))

    def test_the_page_says_why_a_target_is_missed(self):
        cores = machine.cores()
        text = self.page(
            {},
            {
                "runs": {
                    "ltd_1_wall_s": 0.2,
                    "ltd_1_recording": 0.104,
                    f"2d_{cores}_recording": 0.07,
                    f"2d_{cores}_recording_cpu": 0.051,
                },
                "vehicles": {"bag_us": 5.88, "ltd_share_of_couplers": 0.45, "ltd_share_of_vehicles": 0.25},
                "scaling": {"ltd_spread": 0.3, "ltd_fixed_us": 0.15, "lanes": 8, "lanes_of_the_last_pack": 2},
                "graph": {"overhead_ms": 1.0, "every_vehicle_ms": 3.0},
                "exchange": {"242_ms": 2.0},
            },
        )
        text = " ".join(text.split())
        for words in (
            "## What is missed, and why",
            "couplers take 45 % of an exchange",
            "works 5.88 us for a record",
            "adds 5 % to the CPU time",
            "costs about 0.15 us",
            "fill 2 of the 8 lanes",
            "overhead of an exchange**: not explained",
            "five of 2 ms: 30 % of the time",
        ):
            self.assertIn(words, text)
        self.assertNotIn("2000 vehicles, 2D**", text)
        self.assertNotIn("{", text.replace("`{", ""))


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "bench_tools", BenchTools)
