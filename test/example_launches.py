#!/usr/bin/python3
"""The launch file of every shipped scenario, in a running graph: the digest that digests.csv has of it, in process.

With --short a few of them; that and all of them are the same test. Durations are those of digests.csv, at most MOST_S.
"""
import csv
import pathlib
import sys

import rosunit

from launches import Launch, LaunchTest, train_sim

HERE = pathlib.Path(__file__).resolve().parent
SHORT = "--short" in sys.argv
MOST_S = 10  # of simulated time
FEW = ("branch_freight_stop", "drive_and_stop", "heavy_haul_mixed", "ore_line_trip")


def rows():
    table = HERE.parent / "src" / "train_sim" / "test" / "digests.csv"
    with open(table, encoding="utf-8") as file:
        found = list(csv.DictReader(file))
    assert {row["scenario"] for row in found} >= set(FEW)
    return [row for row in found if not SHORT or row["scenario"] in FEW]


class ExampleLaunches(LaunchTest):
    def test_the_graph_gives_the_digest_of_the_run_in_process(self):
        for row in rows():
            with self.subTest(**row):
                duration_s = 1 if SHORT else min(MOST_S, float(row["duration_s"]))
                settings = [f"duration_s={duration_s:g}"]
                model = ["--model", row["model"]] if row["model"] else []
                scenario = HERE.parent / "config" / "scenarios" / (row["scenario"] + ".yaml")
                launch = Launch(
                    self.master,
                    self.folder,
                    ("train_brake", row["scenario"] + ".launch"),
                    "nodes:=2",
                    "set:=" + " ".join(settings),
                    *(["model:=" + row["model"]] if row["model"] else []),
                )
                self.assertEqual(0, launch.ended(600), launch.log())
                expected = train_sim(*model, *[word for s in settings for word in ("--set", s)], scenario=scenario)
                self.assertEqual(expected["state_digest"], launch.summary()["state_digest"])
                if duration_s == float(row["duration_s"]):
                    self.assertEqual(row["state_digest"], launch.summary()["state_digest"])


if __name__ == "__main__":
    sys.argv = [argument for argument in sys.argv if argument != "--short"]
    rosunit.unitrun("train_brake", "example_launches", ExampleLaunches)
