#!/usr/bin/python3
"""Checks every launch file as roslaunch_add_file_check does, and what they launch.

(That CMake function and roslaunch-check look for a file's package in the parents of its real path. launch/ is outside
of the package train_brake, which links to it; so launch/ has a link to its package.xml.)
"""
import pathlib
import subprocess
import unittest

import roslaunch.rlutil
import rosunit
import yaml

LAUNCH = pathlib.Path(__file__).resolve().parent.parent / "launch"


class LaunchFiles(unittest.TestCase):
    def test_check_every_file(self):
        files = [f for f in sorted(LAUNCH.glob("*.launch")) if f.stem != "wagons"]  # that one has required arguments
        self.assertGreater(len(files), 5)
        for file in files:
            with self.subTest(file.name):
                self.assertIsNone(roslaunch.rlutil.check_roslaunch(str(file), ignore_unset_args=True))

    def test_the_program_that_checks_launch_files_knows_their_package(self):
        for file in (LAUNCH / "emergency.launch", LAUNCH.parent / "src" / "train_brake" / "launch" / "view.launch"):
            done = subprocess.run(
                ["rosrun", "roslaunch", "roslaunch-check", str(file)],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            self.assertEqual(0, done.returncode, done.stdout)

    def test_every_scenario_has_a_launch_file_that_names_it(self):
        scenarios = {file.stem for file in (LAUNCH.parent / "config" / "scenarios").glob("*.yaml")}
        self.assertLessEqual(scenarios, {file.stem for file in LAUNCH.glob("*.launch")})
        for scenario in scenarios:
            text = (LAUNCH / (scenario + ".launch")).read_text()
            self.assertIn("config/scenarios/%s.yaml" % scenario, text)

    def test_nothing_optional_is_called_required(self):
        needed = {"wagon.launch": {"name"}}
        for file in sorted(LAUNCH.glob("*.launch")):
            if file.stem == "wagons":  # cannot be listed: its arguments are computed from required ones
                continue
            told = subprocess.run(
                ["roslaunch", "--ros-args", str(file)], stdout=subprocess.PIPE, text=True, check=True
            ).stdout
            required = told.partition("Required Arguments:\n")[2].partition("Optional Arguments:")[0]
            names = {line.strip().partition(":")[0] for line in required.splitlines()}
            self.assertEqual(needed.get(file.name, set()), names, file.name)

    def test_by_package_name_and_by_path(self):
        by_name = subprocess.run(
            ["roslaunch", "--nodes", "train_brake", "emergency.launch", "nodes:=4"],
            stdout=subprocess.PIPE,
            check=True,
            text=True,
        ).stdout
        by_path = subprocess.run(
            ["roslaunch", "--nodes", str(LAUNCH / "emergency.launch"), "nodes:=4"],
            stdout=subprocess.PIPE,
            check=True,
            text=True,
        ).stdout
        self.assertEqual(by_name, by_path)
        self.assertEqual(
            {"/train/master", "/train/wagon_001", "/train/wagon_061", "/train/wagon_122", "/train/wagon_182"},
            set(by_name.split()),
        )

    def test_which_trains_run_on_wagon_nodes(self):
        def wagons(*arguments):
            nodes = subprocess.run(
                ["roslaunch", "--nodes", *arguments], stdout=subprocess.PIPE, check=True, text=True
            ).stdout
            return sum("wagon" in node for node in nodes.split())

        self.assertEqual(
            4, wagons(str(LAUNCH / "heavy_haul_mixed.launch"), "nodes:=4")
        )  # groups of an LTD train are 2D
        self.assertEqual(0, wagons(str(LAUNCH / "ore_line_emergency.launch"), "nodes:=4"))
        self.assertEqual(0, wagons(str(LAUNCH / "emergency.launch"), "nodes:=4", "on_nodes:=false"))
        self.assertEqual(4, wagons(str(LAUNCH / "train.launch"), "nodes:=4"))
        self.assertEqual(0, wagons(str(LAUNCH / "train.launch"), "nodes:=4", "model:=ltd"))

    def test_the_model_is_that_of_the_scenario_unless_said(self):
        def model(*arguments):
            parameters = subprocess.run(
                ["roslaunch", "--dump-params", str(LAUNCH / "train.launch"), *arguments],
                stdout=subprocess.PIPE,
                check=True,
                text=True,
            ).stdout
            return yaml.safe_load(parameters).get("/train/master/model", "")

        self.assertEqual("", model())
        self.assertEqual("ltd", model("model:=ltd"))

    def test_words_that_are_not_understood_are_errors(self):
        """No is not taken for true, as a text that is not empty would be."""
        for argument in "on_nodes:=maybe", "end_with_master:=no", "record:=no":
            word = argument.split("=")[1]
            done = subprocess.run(
                ["roslaunch", "--nodes", str(LAUNCH / "emergency.launch"), argument],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            self.assertNotEqual(0, done.returncode, argument)
            self.assertRegex(done.stdout, rf"\b{word}\b.? is not", argument)

    def test_machines_get_contiguous_blocks_of_nodes(self):
        config = roslaunch.config.load_config_default(
            [
                (
                    str(LAUNCH / "emergency.launch"),
                    ["nodes:=7", "machines:=10.1.0.1 10.1.0.2  10.1.0.3", "env_loader:=/env.sh"],
                )
            ],
            None,
            verbose=False,
        )
        addresses = [
            config.machines[n.machine_name].address
            for n in sorted(config.nodes, key=lambda n: n.name)
            if n.type == "wagon_node"
        ]
        self.assertEqual(["10.1.0.1"] * 3 + ["10.1.0.2"] * 2 + ["10.1.0.3"] * 2, addresses)


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "launch_files", LaunchFiles)
