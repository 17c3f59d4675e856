#!/usr/bin/env python3
"""Tells of changed bits: every scenario in config/ beside its digest in digests.csv.

usage: digests_test.py TRAIN_SIM CONFIG_FOLDER [--write | --gtest_output=xml:FILE]

It holds no law and says nothing of right or wrong: other tests do. --write writes digests.csv anew, with the models and
durations that it has and a row of one second for each scenario that it lacks. Every machine gives the same digests
(docs/architecture.md, The same bits).
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import unittest

import rosunit

TRAIN_SIM, CONFIG = sys.argv[1], pathlib.Path(sys.argv[2])
TABLE = pathlib.Path(__file__).resolve().parent / "digests.csv"
COLUMNS = ["scenario", "model", "duration_s", "state_digest"]


def rows():
    with open(TABLE, newline="") as table:
        return list(csv.DictReader(table))


def scenarios():
    return {file.stem for file in (CONFIG / "scenarios").glob("*.yaml")}


def digest(row):
    command = [
        TRAIN_SIM,
        "run",
        "--json",
        str(CONFIG / "scenarios" / f"{row['scenario']}.yaml"),
        "--set",
        "duration_s=" + row["duration_s"],
    ]
    if row["model"]:  # otherwise the scenario's
        command += ["--model", row["model"]]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with exit code {done.returncode}:\n{done.stderr}")
    return json.loads(done.stdout)["state_digest"]


def write():
    table = rows() if TABLE.exists() else []
    table = [row for row in table if row["scenario"] in scenarios()]
    for name in sorted(scenarios() - {row["scenario"] for row in table}):
        table.append({"scenario": name, "model": "", "duration_s": "1"})
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for row in sorted(table, key=lambda row: (row["scenario"], row["model"])):
            writer.writerow(dict(row, state_digest=digest(row)))


class Digests(unittest.TestCase):
    def test_every_shipped_scenario_has_one(self):
        self.assertEqual(
            scenarios(),
            {row["scenario"] for row in rows()},
            f"add the row of a new scenario with {pathlib.Path(__file__).name} ... --write",
        )

    def test_no_bit_has_changed(self):
        changed = []
        for row in rows():
            now = digest(row)
            if now != row["state_digest"]:
                changed.append(
                    f"  {row['scenario']} {row['model']} {row['duration_s']} s: {row['state_digest']} -> {now}"
                )
        self.assertFalse(
            changed,
            "Bits changed. If that is intended, say why in the commit and in CHANGELOG.md, with the old and "
            "the new digests, and write digests.csv anew (--write):\n" + "\n".join(changed),
        )


if __name__ == "__main__":
    os.environ["TRAIN_BRAKE_CONFIG"] = str(CONFIG)
    if "--write" in sys.argv:
        write()
    else:
        rosunit.unitrun("train_sim", "digests", Digests)
