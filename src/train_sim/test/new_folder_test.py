#!/usr/bin/env python3
"""A folder of one's own, started by `train_sim new`, and the program's help.

usage: new_folder_test.py TRAIN_SIM CONFIG_FOLDER [--gtest_output=xml:FILE]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import rosunit

TRAIN_SIM, CONFIG = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
TOOLS = CONFIG.parent / "tools"


def train_sim(*arguments, cwd=None):
    return subprocess.run(
        [TRAIN_SIM, *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        timeout=300,
        cwd=cwd,
    )


class NewFolder(unittest.TestCase):
    def setUp(self):
        os.environ["TRAIN_BRAKE_CONFIG"] = str(CONFIG)
        self.root = tempfile.TemporaryDirectory()
        self.addCleanup(self.root.cleanup)
        self.elsewhere = tempfile.TemporaryDirectory()
        self.addCleanup(self.elsewhere.cleanup)
        self.folder = pathlib.Path(self.root.name) / "my trains"

    def start(self):
        done = train_sim("new", self.folder)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done

    def test_checks_and_runs_from_another_folder(self):
        scenario = self.folder / "scenarios" / "stop.yaml"
        self.assertIn(str(scenario), self.start().stdout)
        check = train_sim("check", scenario, cwd=self.elsewhere.name)
        self.assertEqual((check.returncode, check.stderr), (0, ""))
        self.assertIn("19 vehicle(s)", check.stdout)
        run = train_sim("run", scenario, "--out", "results", cwd=self.elsewhere.name)
        self.assertEqual((run.returncode, run.stderr.count("warning")), (0, 0), run.stderr)
        summary = json.loads((pathlib.Path(self.elsewhere.name) / "results" / "summary.json").read_text())
        self.assertLess(abs(summary["final_speed_kmh"]["mean"]), 0.1)  # it stops, as it says
        route = train_sim("route", self.folder / "tracks" / "mine.csv", cwd=self.elsewhere.name)
        self.assertEqual(route.returncode, 0, route.stderr)

    def test_the_commands_that_are_told_run_as_they_are_also_with_a_blank_in_the_name(self):
        told = re.search("^next: (.*)", self.start().stdout, re.M).group(1)
        environment = dict(os.environ, PATH=f"{pathlib.Path(TRAIN_SIM).parent}:{os.environ['PATH']}")
        done = subprocess.run(
            told, shell=True, cwd=self.elsewhere.name, env=environment, stdout=subprocess.PIPE, text=True, check=False
        )
        self.assertEqual(done.returncode, 0)
        results = str(self.folder / "results" / "stop")
        self.assertRegex(done.stdout, r"^stop: 19 vehicles, ltd model, stands after [\d.]+ s and [\d.]+ m\n")
        self.assertIn(f"report '{results}'\n", done.stdout)
        self.assertTrue(done.stdout.startswith(train_sim("summary", results).stdout))

    def test_readme_has_five_lines_whose_commands_are_there(self):
        self.start()
        readme = (self.folder / "README.md").read_text()
        self.assertEqual(len(readme.splitlines()), 5)
        for path in re.findall(r"(?:scenarios|trains|tracks|launch)/[\w.]+", readme):
            self.assertTrue((self.folder / path).exists(), path)
        commands = set(re.findall(r"train_sim (\w+)", readme))
        self.assertGreaterEqual(commands, {"check", "run", "route", "keys"})
        for command in commands:
            self.assertEqual(train_sim(command, "--help").returncode, 0, command)

    def test_editors_find_the_schemas(self):
        self.start()
        for path in ("scenarios/stop.yaml", "trains/mine.yaml"):
            first = (self.folder / path).read_text().splitlines()[0]
            schema = re.fullmatch(r"# yaml-language-server: \$schema=(.*)", first).group(1)
            self.assertTrue(pathlib.Path(schema).exists(), schema)

    def test_changes_nothing_that_is_there(self):
        self.folder.mkdir()
        mine = self.folder / "README.md"
        mine.write_text("mine")
        done = train_sim("new", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is not empty", done.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["README.md"])
        self.assertEqual(mine.read_text(), "mine")
        done = train_sim("new", mine)
        self.assertEqual((done.returncode, mine.read_text()), (2, "mine"))

    def test_takes_an_empty_folder_and_tells_where_shipped_parts_are_missing(self):
        self.folder.mkdir()
        del os.environ["TRAIN_BRAKE_CONFIG"]
        done = train_sim("new", self.folder)
        self.assertEqual(done.returncode, 0)
        self.assertIn("TRAIN_BRAKE_CONFIG", done.stderr)


class Help(unittest.TestCase):
    def test_lists_every_command_with_a_line_and_the_man_page_has_them_all(self):
        text = train_sim("--help").stdout
        commands = re.findall(r"^  ([a-z][\w-]+) {2,}\S", text.split("Subcommands:")[1], re.M)
        self.assertGreaterEqual(set(commands), {"run", "check", "resolve", "keys", "new", "route", "verify", "modes"})
        page = subprocess.run(
            [str(TOOLS / "man_page.py"), TRAIN_SIM], stdout=subprocess.PIPE, text=True, check=True
        ).stdout
        for command in commands:
            self.assertIn(f"\n.B {command}\n".replace("-", "\\-"), page)
            self.assertIn(f".SH {command.upper()}\n".replace("-", "\\-"), page)
        self.assertIn(".B \\-\-resume", page.replace("\\-\\-", "\\-\-"))

    def test_a_command_that_is_not_there_is_refused_with_the_likely_one(self):
        done = train_sim("runn", "x.yaml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no command runn; did you mean run?", done.stderr)
        self.assertIn("Commands: run, ", done.stderr)


class NewFolderTest(NewFolder, Help):
    pass


if __name__ == "__main__":
    rosunit.unitrun("train_sim", "new_folder_test", NewFolderTest)
