"""Whole runs of this build against those of another one, in turn: one thread, with and without a bag."""
import json
import pathlib
import tempfile

import measure
import workspace
from table import Table, number, times

REPETITIONS = {"2d": 5, "ltd": 15}


def run():
    if workspace.OTHER is None:
        raise measure.Failed("needs the folder of another build: make bench AGAINST=FOLDER")
    rows, facts = [], {}
    with tempfile.TemporaryDirectory() as folder:
        for model, repetitions in REPETITIONS.items():
            for fact, bag in (("bag", True), ("no_record", False)):
                before, now = measure.in_turn(
                    repetitions, lambda: _run(_other, model, folder, bag), lambda: _run(_own, model, folder, bag)
                )
                for what in ("cpu_s", "wall_s"):
                    of, to = ([getattr(r, what) for r in runs] for runs in (now, before))
                    ratios = measure.ratios(of, to)
                    if what == "cpu_s":
                        facts[f"{model}_{fact}"] = measure.median(ratios)
                    rows.append(
                        (
                            f"{model}, {'with its bag' if bag else 'no record'}, {what[:-2]}",
                            number(measure.median(to)),
                            number(measure.median(of)),
                            times(measure.median(ratios)),
                            f"{number(min(ratios))} ... {number(max(ratios))}",
                        )
                    )
                if bag:
                    facts[f"{model}_same_digest"] = before[0].digest == now[0].digest
    remark = "; ".join(
        f"{model}: {'the same digest' if facts[f'{model}_same_digest'] else 'another digest'}" for model in REPETITIONS
    )
    columns = ["before", "now", "ratio", "from ... to"]
    return [Table("emergency stop, one thread, against another build [s]", columns, rows, remark)], facts


def _own():
    return workspace.program("train_sim", "train_sim"), workspace.EMERGENCY


def _other():
    return workspace.other_program("train_sim"), workspace.OTHER / "config" / "scenarios" / "emergency.yaml"


def _run(build, model, folder, bag):
    program, scenario = build()
    with tempfile.TemporaryDirectory(dir=folder) as out:
        run = measure.Run(
            [program, "run", scenario, "--model", model, "--threads", 1, *(["--out", out] if bag else [])],
            libraries=program.parents[1],
        )
        if bag:
            run.digest = json.loads((pathlib.Path(out) / "summary.json").read_text())["state_digest"]
        return run
