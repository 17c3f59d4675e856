"""Whole runs of the paper's emergency stop in one process, with and without recording."""
import tempfile

import machine
import measure
import workspace
from table import Table, number, percent, times

PAPER_WALL_S = 272.0  # on 243 cores, Table 2 of the paper


def run():
    rows, facts = [], {}
    with tempfile.TemporaryDirectory() as folder:
        for model, repetitions in (("2d", 5), ("ltd", 15)):
            for threads in sorted({1, machine.cores()}) if model == "2d" else [1]:
                arguments = ["--model", model, "--threads", threads]
                silent, bag, tables = measure.in_turn(
                    repetitions,
                    lambda: workspace.train_sim(*arguments),
                    lambda: workspace.train_sim_into(folder, *arguments),
                    lambda: workspace.train_sim_into(folder, "--csv", *arguments),
                )
                wall, cpu = _medians(silent)
                bag_wall, bag_cpu = _medians(bag)
                rows.append(
                    (
                        f"{model}, {threads} thread(s)",
                        number(wall),
                        number(bag_wall),
                        percent(_ratio(bag, silent, "wall_s") - 1),
                        percent(_ratio(bag, silent, "cpu_s") - 1),
                        percent(_ratio(tables, silent, "wall_s") - 1),
                        times(70 / bag_wall),
                        times(PAPER_WALL_S / bag_wall),
                    )
                )
                key = f"{model}_{threads}"
                facts[f"{key}_wall_s"] = bag_wall
                facts[f"{key}_recording"] = _ratio(bag, silent, "wall_s") - 1
                facts[f"{key}_recording_cpu"] = _ratio(bag, silent, "cpu_s") - 1
                facts[f"{key}_ns"] = measure.median([r.summary["ns_per_vehicle_step"] for r in silent])
                facts["digest_" + model] = bag[0].summary["state_digest"]
    columns = ["no record [s]", "bag [s]", "bag, wall", "bag, CPU", "and CSV, wall", "to real time", "to the paper"]
    remark = f"Digests: 2D `{facts['digest_2d']}`, LTD `{facts['digest_ltd']}`."
    return [Table("emergency stop, 242 vehicles, 70 s, whole process", columns, rows, remark)], facts


def _medians(runs):
    return measure.median([r.wall_s for r in runs]), measure.median([r.cpu_s for r in runs])


def _ratio(of, to, what):
    return measure.ratio([getattr(r, what) for r in of], [getattr(r, what) for r in to])
