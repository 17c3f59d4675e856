"""`rosrun train_brake sweep`: a scenario run with many values of its keys; one table, one page.

A study is a folder:

    study.json            what was asked for
    plan.csv              one row per run: its number and the keys that change
    runs/0001/config.yaml the scenario of a run with everything in place: checked before the first run begins
    runs/0001/summary.json  is there when the run is done; runs/0001/log what it said
    jobs.txt              the numbers of all runs, for GNU parallel
    results.csv, percentiles.csv, study.html
"""

import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
from typing import Any, Dict, List, Optional

import numpy

from train_brake.presentable import tell
from train_brake.study import (
    TRAIN_SIM,
    Change,
    StudyError,
    change_of,
    combined,
    draws_of,
    flat,
    grid_of,
    list_of,
    resolve,
)

DESCRIPTION = """Runs a scenario with many values of its keys, side by side on all cores, and makes one table and one
page of the results.

Without a SCENARIO, the study in the folder OUT is continued, or the results of other machines are collected."""
EPILOG = """What changes: every row of --list, with every point of all --grid, with every draw of --random. Draws are
the same at every point, so that points differ by their values and not by chance.

  rosrun train_brake sweep my.yaml study --grid initial_speed_kmh=40:80:5 --grid 'commands[0].reduction_kpa=50,100,170'
  rosrun train_brake sweep my.yaml study --random 'initial_speed_kmh=uniform(79.9,80.1)' --draws 36 --seed 1
  rosrun train_brake sweep my.yaml study --list cases.csv       # a line of paths, then a line of values per run
  rosrun train_brake sweep study                                # goes on

Exit codes: 0 done; 1 something could not be written; 2 wrong arguments or configuration, nothing was run; 3 some runs
broke down, the table says which; 130 interrupted: what is done is kept."""
PERCENTILES = (5, 50, 95)
DONE = (0, 3)  # exit codes that are results


def _positive(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"must be >= 1, got {text}")
    return int(text)


def _arguments(argv: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        "sweep", description=DESCRIPTION, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "scenario", nargs="?", metavar="SCENARIO", type=pathlib.Path, help="scenario file; none: the study goes on"
    )
    parser.add_argument("out", metavar="OUT", type=pathlib.Path, help="folder of the study")
    parser.add_argument(
        "--grid", action="append", default=[], metavar="PATH=VALUES", help="V1,V2,... or FIRST:LAST:COUNT"
    )
    parser.add_argument("--list", type=pathlib.Path, metavar="FILE.csv", help="a row per run, paths in the first row")
    parser.add_argument(
        "--random",
        action="append",
        default=[],
        metavar="PATH=LAW",
        help="uniform(LOW,HIGH), normal(MEAN,SD), lognormal(MEDIAN,SD) or choice(V1,V2,...)",
    )
    parser.add_argument("--draws", type=_positive, metavar="N", help="how many of --random")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of the draws (default 1)")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", dest="changes", help="of all runs")
    parser.add_argument("--model", choices=("2d", "ltd", "ltd-no-inertia"), help="of all runs")
    parser.add_argument(
        "--results",
        action="append",
        default=[],
        metavar="PATH",
        help="shown on the page, as named in results.csv (default: stopping distance or end speed, largest forces)",
    )
    parser.add_argument(
        "--figures", action="store_true", help="write each figure of the page into OUT/figures, too, as SVG and PNG"
    )
    parser.add_argument(
        "--jobs",
        type=_positive,
        metavar="N",
        default=len(os.sched_getaffinity(0)),
        help="runs at a time (default: cores)",
    )
    parser.add_argument("--keep-records", action="store_true", help="keep each run's train.bag, too")
    parser.add_argument("--plan-only", action="store_true", help="write the plan, run nothing")
    parser.add_argument(
        "--collect", action="store_true", help="make the table and the page of what is done, run nothing"
    )
    options = parser.parse_args(argv)
    planned = options.grid or options.list or options.random
    if options.scenario and not planned:
        parser.error("nothing changes: give --grid, --list or --random")
    if not options.scenario and (planned or options.changes or options.model):
        parser.error("SCENARIO is missing")
    if bool(options.random) != bool(options.draws):
        parser.error("--random and --draws N belong together")
    return options


def _variants(options: argparse.Namespace) -> List[List[Change]]:
    grids = [grid_of(text) for text in options.grid]
    points = combined(list_of(options.list) if options.list else [], grids)
    if options.random:
        generator = numpy.random.Generator(numpy.random.PCG64(options.seed))
        draws = [draws_of(text, options.draws, generator) for text in options.random]
        points = [
            [*point, *(Change(path, values[i]) for path, values in draws)]
            for point in points
            for i in range(options.draws)
        ]
    for point in points[:1]:
        paths = [change.path for change in point]
        twice = sorted({path for path in paths if paths.count(path) > 1})
        if twice:
            raise StudyError(f"{', '.join(twice)}: changed more than once in each run")
    return points


class Study:
    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        try:
            self.asked: Dict[str, Any] = json.loads((folder / "study.json").read_text())
            with open(folder / "plan.csv", newline="") as text:
                self.plan = list(csv.DictReader(text))
        except (OSError, ValueError) as error:
            raise StudyError(f"{folder} is no study: {error}; give a SCENARIO and what changes") from None

    @staticmethod
    def create(options: argparse.Namespace, train_sim=TRAIN_SIM) -> "Study":
        """Checks all runs, then writes the plan. The same study in the folder is continued; another one is refused."""
        fixed = [change_of(text) for text in options.changes]
        if options.model:
            fixed.append(Change("model", options.model))
        variants = _variants(options)
        both = sorted({change.path for change in fixed} & {change.path for variant in variants for change in variant})
        if both:
            raise StudyError(f"{', '.join(both)}: set for all runs, and changed from run to run")
        asked = {
            "scenario": str(options.scenario),
            "set": [str(change) for change in fixed],
            "list": str(options.list or ""),
            "grid": options.grid,
            "random": options.random,
            "draws": options.draws,
            "seed": options.seed,
            "keep_records": options.keep_records,
        }
        folder = options.out
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            found = [pool.submit(resolve, options.scenario, [*fixed, *variant], train_sim) for variant in variants]
            configurations, errors = [], []
            for variant, future in zip(variants, found):
                try:
                    configurations.append(future.result())
                except StudyError as error:
                    errors.append(f"with {', '.join(map(str, variant))}:\n{error}")
        if errors:
            more = f"\nand {len(errors) - 3} more" if len(errors) > 3 else ""
            raise StudyError("\n".join(errors[:3]) + more)
        if (folder / "study.json").exists():
            old = Study(folder)
            same = len(old.plan) == len(configurations) and all(
                (old.run(row) / "config.yaml").read_text() == text for row, text in zip(old.plan, configurations)
            )
            if not same:
                raise StudyError(f"{folder} holds another study; give another folder, or remove this one")
            return old
        digits = max(4, len(str(len(variants))))
        paths = list(dict.fromkeys(change.path for variant in variants for change in variant))
        for i, text in enumerate(configurations, 1):
            run = folder / "runs" / f"{i:0{digits}d}"
            run.mkdir(parents=True, exist_ok=True)
            (run / "config.yaml").write_text(text)
        with open(folder / "plan.csv", "w", newline="") as text:
            writer = csv.writer(text, lineterminator="\n")
            writer.writerow(["run", *paths])
            for i, variant in enumerate(variants, 1):
                values = {change.path: change.value for change in variant}
                writer.writerow([f"{i:0{digits}d}", *(values.get(path, "") for path in paths)])
        (folder / "jobs.txt").write_text("".join(f"{i:0{digits}d}\n" for i in range(1, len(variants) + 1)))
        unfinished = folder / "study.json.unfinished"
        unfinished.write_text(json.dumps(asked, indent=2) + "\n")
        unfinished.replace(folder / "study.json")  # last: with it, the study is whole
        return Study(folder)

    @property
    def paths(self) -> List[str]:
        """The keys that change."""
        return [path for path in self.plan[0] if path != "run"]

    def run(self, row: Dict[str, str]) -> pathlib.Path:
        return self.folder / "runs" / row["run"]

    def summary(self, row: Dict[str, str]) -> Optional[dict]:
        """None: the run is not done, or was cut off, here or on another machine."""
        try:
            summary = json.loads((self.run(row) / "summary.json").read_text())
        except (OSError, ValueError):
            return None
        return summary if summary.get("complete") or summary.get("fault") else None

    def go(self, jobs: int, train_sim=TRAIN_SIM) -> None:
        """Runs what is not done. @raises KeyboardInterrupt, OSError"""
        left = [row for row in self.plan if self.summary(row) is None]
        if not left:
            return
        running: Dict[int, subprocess.Popen] = {}
        lock, ends = threading.Lock(), threading.Event()
        keep = ["--out", "results"] if self.asked.get("keep_records") else []

        def one(row: Dict[str, str]) -> Optional[str]:
            run = self.run(row)
            with open(run / "summary.unfinished", "w") as out, open(run / "log", "w") as log:
                with lock:
                    if ends.is_set():
                        return None
                    # In a process group of its own: on Ctrl-C, this program ends it.
                    process = subprocess.Popen(
                        [*train_sim, "run", "config.yaml", "--json", "--threads", "1", *keep],
                        cwd=run,
                        stdout=out,
                        stderr=log,
                        start_new_session=True,
                    )
                    running[process.pid] = process
                code = process.wait()
                with lock:
                    del running[process.pid]
            if code in DONE:
                (run / "summary.unfinished").replace(run / "summary.json")
                return None
            return None if ends.is_set() else f"run {row['run']} ended with exit code {code}: {run / 'log'}"

        failures = []
        print(f"sweep: {len(left)} of {len(self.plan)} runs, {min(jobs, len(left))} at a time", file=sys.stderr)
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(one, row) for row in left]
            try:
                for count, future in enumerate(concurrent.futures.as_completed(futures), 1):
                    failures += filter(None, [future.result()])
                    if count == len(left) or count % max(1, len(left) // 10) == 0:
                        print(f"sweep: {count} of {len(left)} done", file=sys.stderr)
            except BaseException:
                with lock:
                    ends.set()
                    for pid in running:
                        os.killpg(pid, signal.SIGINT)
                raise
        if failures:
            raise OSError("\n".join(failures))

    def results(self) -> List[Dict[str, Any]]:
        """For each run that is done: its row of the plan, and the numbers of its summary."""
        found = ((row, self.summary(row)) for row in self.plan)
        return [{**row, **flat(summary)} for row, summary in found if summary is not None]


def _text(value: Any) -> str:
    return "" if value is None else json.dumps(value) if isinstance(value, bool) else str(value)


def write_results(study: Study, rows: List[Dict[str, Any]]) -> pathlib.Path:
    columns = list(dict.fromkeys(name for row in rows for name in row))
    file = study.folder / "results.csv"
    with open(file, "w", newline="") as text:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([_text(row.get(name)) for name in columns] for row in rows)
    return file


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def percentiles(study: Study, rows: List[Dict[str, Any]]) -> List[Dict[str, Any]]:
    """For each point of the grid, over its draws: number of runs, mean, standard deviation, extremes, percentiles of
    each result."""
    drawn = {change_of(text).path for text in study.asked["random"]}
    kept = [path for path in study.paths if path not in drawn]
    points: Dict[tuple, List[Dict[str, Any]]] = {}
    for row in rows:
        points.setdefault(tuple(row[path] for path in kept), []).append(row)
    names = [
        name
        for name in dict.fromkeys(name for row in rows for name in row)
        if name not in study.plan[0] and any(is_number(row.get(name)) for row in rows)
    ]
    found = []
    for point, members in points.items():
        for name in names:
            values = numpy.array([row[name] for row in members if is_number(row.get(name))], float)
            if not len(values):
                continue
            line = dict(
                zip(kept, point),
                result=name,
                runs=len(members),
                values=len(values),
                mean=values.mean(),
                standard_deviation=values.std(ddof=1) if len(values) > 1 else float("nan"),
                min=values.min(),
            )
            line.update({f"p{p}": numpy.percentile(values, p) for p in PERCENTILES})
            found.append({**line, "max": values.max()})
    return found


def write_percentiles(study: Study, rows: List[Dict[str, Any]]) -> List[Dict[str, Any]]:
    lines = percentiles(study, rows)
    with open(study.folder / "percentiles.csv", "w", newline="") as text:
        writer = csv.DictWriter(text, list(lines[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)
    return lines


def _run(options: argparse.Namespace, train_sim) -> int:
    study = Study.create(options, train_sim) if options.scenario else Study(options.out)
    if options.plan_only:
        tell(f"sweep: planned {len(study.plan)} runs: {study.folder / 'plan.csv'}")
        return 0
    code = 0
    if not options.collect:
        if shutil.which(train_sim[0]) is None:
            raise StudyError(f"there is no program {train_sim[0]} here: source the setup file of the workspace")
        try:
            study.go(options.jobs, train_sim)
        except KeyboardInterrupt:
            code = 130
    rows = study.results()
    if not rows:
        print("sweep: no run is done yet", file=sys.stderr)
        return code
    tell(f"sweep: wrote {write_results(study, rows)}")
    if study.asked["random"]:
        write_percentiles(study, rows)
        tell(f"sweep: wrote {study.folder / 'percentiles.csv'}")
    from train_brake_report.study_page import write_page  # pylint: disable=import-outside-toplevel

    tell(f"sweep: wrote {write_page(study, rows, options.results, options.figures)}")
    if len(rows) < len(study.plan):
        print(
            f"sweep: {len(rows)} of {len(study.plan)} runs are done; `rosrun train_brake sweep {study.folder}` goes on",
            file=sys.stderr,
        )
    broken = [row["run"] for row in rows if row.get("fault")]
    if broken:
        print(f"sweep: broke down: run {', '.join(broken)}", file=sys.stderr)
    return code or (3 if broken else 0)


def main(argv: List[str], train_sim=TRAIN_SIM) -> int:
    options = _arguments(argv)
    try:
        return _run(options, list(train_sim))
    except StudyError as error:
        print("\n".join(f"sweep: {line}" for line in str(error).splitlines()), file=sys.stderr)
        return 2
    except OSError as error:
        print("\n".join(f"sweep: {line}" for line in str(error).splitlines()), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
