"""`rosrun train_brake calibrate`: fits a few values of a configuration so that runs meet targets.

    minimise  sum_i ((r_i(p) - v_i) / t_i)^2   over   lowest_k <= p_k <= highest_k

r_i: result of run i as in its summary, v_i: its target, t_i: its tolerance, by which the differences of all targets are
weighted. By scipy.optimize.least_squares (trust region reflective; derivatives by differences)."""

import argparse
import concurrent.futures
import difflib
import json
import math
import os
import pathlib
import subprocess
import sys
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy
import yaml

from train_brake.study import TRAIN_SIM, Change, StudyError, flat, number

DESCRIPTION = """Fits a few values of a configuration so that runs meet targets, by least squares
(scipy.optimize.least_squares).

FILE.yaml:
  parameters:                                       # of all runs
    - {path: initial_speed_kmh, start: 40, lowest: 0, highest: 100}
  targets:                                          # a run each; equal runs are done once
    - {scenario: my.yaml, set: [duration_s=10], result: final_speed_kmh.mean, value: 57, tolerance: 0.01}
  fixed: [model=ltd]                                # changes of all runs; optional

Scenarios are looked for beside FILE.yaml, then as names in the folders of TRAIN_BRAKE_CONFIG (scenarios/NAME.yaml)."""
EPILOG = """A result is named as in results.csv of a sweep: final_speed_kmh.mean, stop_distance_m,
max_tension_n.value. A path may be several, joined by +, which get the same value.

Exit codes: 0 all targets are met within their tolerances; 1 they are not, or something could not be written; 2 wrong
arguments or configuration; 3 a run broke down; 130 interrupted."""
STEP = 1e-4  # of a derivative, in shares of the range: large beside the noise of ten digits, small beside the curvature


class Parameter(NamedTuple):
    path: str
    start: float
    lowest: float
    highest: float


class Target(NamedTuple):
    scenario: pathlib.Path
    changes: Tuple[str, ...]
    result: str
    value: float
    tolerance: float


def _checked(
    item: Any, where: str, keys: Dict[str, type], optional: Sequence[str], errors: List[str]
) -> Optional[dict]:
    if not isinstance(item, dict):
        errors.append(f"{where} must have the keys {', '.join(keys)}")
        return None
    before = len(errors)
    for key in item:
        if key not in keys:
            close = difflib.get_close_matches(str(key), keys, 1)
            errors.append(
                f"{where}.{key} is not a known key"
                + (f"; did you mean {close[0]}?" if close else f"; the keys are {', '.join(keys)}")
            )
    for key, kind in keys.items():
        if key not in item:
            if key not in optional:
                errors.append(f"{where}.{key} is missing")
        elif kind is float and (
            isinstance(item[key], bool) or not isinstance(item[key], (int, float)) or not math.isfinite(item[key])
        ):
            errors.append(f"{where}.{key} must be a number, got {item[key]!r}")
        elif kind is str and not isinstance(item[key], str):
            errors.append(f"{where}.{key} must be a text, got {item[key]!r}")
        elif kind is list and not (
            isinstance(item[key], list) and all(isinstance(text, str) and "=" in text for text in item[key])
        ):
            errors.append(f"{where}.{key} must be a list of path=value, got {item[key]!r}")
    numbers = {key: item[key] for key in ("tolerance",) if isinstance(item.get(key), (int, float))}
    errors += [f"{where}.{key} must be > 0, got {value}" for key, value in numbers.items() if value <= 0]
    return item if len(errors) == before else None


def _scenario(name: str, beside: pathlib.Path) -> Optional[pathlib.Path]:
    for folder in (
        beside,
        *(pathlib.Path(entry) for entry in os.environ.get("TRAIN_BRAKE_CONFIG", "").split(":") if entry),
    ):
        for file in (folder / name, folder / "scenarios" / f"{name}.yaml"):
            if file.is_file():
                return file
    return None


def read(file: pathlib.Path) -> Tuple[List[Parameter], List[Target], List[str]]:
    """@raises StudyError naming all errors"""
    try:
        given = yaml.safe_load(file.read_text())
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise StudyError(f"{file} cannot be read: {' '.join(str(error).split())}") from None
    errors: List[str] = []
    parameters, targets = [], []
    given = given if isinstance(given, dict) else {}
    for key in given:
        if key not in ("parameters", "targets", "fixed"):
            errors.append(f"{key} is not a known key; the keys are parameters, targets, fixed")
    for key in ("parameters", "targets"):
        if not isinstance(given.get(key), list) or not given[key]:
            errors.append(f"{key} must be a list of one or more")
            given[key] = []
    for i, item in enumerate(given["parameters"]):
        found = _checked(
            item, f"parameters[{i}]", {"path": str, "start": float, "lowest": float, "highest": float}, (), errors
        )
        if found:
            parameters.append(Parameter(**found))
            if not found["lowest"] < found["highest"] or not found["lowest"] <= found["start"] <= found["highest"]:
                errors.append(f"parameters[{i}]: lowest < highest must hold, and start must be between them")
    for i, item in enumerate(given["targets"]):
        keys = {"scenario": str, "set": list, "result": str, "value": float, "tolerance": float}
        found = _checked(item, f"targets[{i}]", keys, ("set",), errors)
        if found:
            scenario = _scenario(found["scenario"], file.parent)
            if scenario is None:
                errors.append(
                    f"targets[{i}].scenario: there is no {found['scenario']} beside {file} nor in TRAIN_BRAKE_CONFIG"
                )
            targets.append(
                Target(scenario, tuple(found.get("set", ())), found["result"], found["value"], found["tolerance"])
            )
    fixed = given.get("fixed", [])
    if not isinstance(fixed, list) or not all(isinstance(text, str) and "=" in text for text in fixed):
        errors.append(f"fixed must be a list of path=value, got {fixed!r}")
    if errors:
        raise StudyError("\n".join(f"{file}: {error}" for error in errors))
    if len(targets) < len(parameters):
        print(
            f"calibrate: warning: {len(parameters)} parameters for {len(targets)} target(s): many values fit",
            file=sys.stderr,
        )
    return parameters, targets, fixed


class RunFailed(Exception):
    pass


class Runs:
    """The results of all targets at given values of the parameters."""

    def __init__(self, parameters, targets, fixed, jobs, train_sim):
        self.parameters, self.targets, self.fixed, self.train_sim = parameters, targets, fixed, train_sim
        self.pool = concurrent.futures.ThreadPoolExecutor(jobs)
        self.done = 0

    def changes(self, values: Sequence[float]) -> List[Change]:
        return [
            Change(path.strip(), number(value))
            for parameter, value in zip(self.parameters, values)
            for path in parameter.path.split("+")
        ]

    def _run(self, scenario: pathlib.Path, changes: Sequence[str], values: Sequence[float]) -> Dict[str, Any]:
        words = [word for text in [*self.fixed, *changes, *map(str, self.changes(values))] for word in ("--set", text)]
        done = subprocess.run(
            [*self.train_sim, "run", str(scenario), "--json", "--threads", "1", *words],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
        self.done += 1
        if done.returncode == 2:
            raise StudyError(done.stderr.strip())
        if done.returncode:
            raise RunFailed(
                f"{scenario} with {' '.join(map(str, self.changes(values)))} ended with exit code {done.returncode}:\n"
                + done.stderr.strip()[-500:]
            )
        return flat(json.loads(done.stdout))

    def results(self, points: Sequence[Sequence[float]]) -> numpy.ndarray:
        """[point, target]"""
        kinds = list(dict.fromkeys((target.scenario, target.changes) for target in self.targets))
        futures = {
            (i, kind): self.pool.submit(self._run, *kind, point) for i, point in enumerate(points) for kind in kinds
        }
        found = numpy.empty((len(points), len(self.targets)))
        for i in range(len(points)):
            for k, target in enumerate(self.targets):
                summary = futures[i, (target.scenario, target.changes)].result()
                value = summary.get(target.result)
                if isinstance(value, bool) or not isinstance(value, (int, float)):
                    numbers = [
                        name for name, x in summary.items() if isinstance(x, (int, float)) and not isinstance(x, bool)
                    ]
                    raise StudyError(
                        f"targets[{k}].result: the run has no number {target.result}; it has {', '.join(numbers)}"
                    )
                found[i, k] = value
        return found


def fit(runs: Runs, report=lambda values, results: None) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """(values, results at them)"""
    from scipy.optimize import least_squares  # pylint: disable=import-outside-toplevel

    low = numpy.array([p.lowest for p in runs.parameters])
    span = numpy.array([p.highest for p in runs.parameters]) - low
    aims = numpy.array([t.value for t in runs.targets])
    tolerances = numpy.array([t.tolerance for t in runs.targets])
    at: Dict[bytes, numpy.ndarray] = {}

    def results(shares: Sequence[numpy.ndarray]) -> List[numpy.ndarray]:
        new = [share for share in shares if share.tobytes() not in at]
        if new:
            for share, row in zip(new, runs.results([low + span * share for share in new])):
                at[share.tobytes()] = row
        return [at[share.tobytes()] for share in shares]

    def residuals(share: numpy.ndarray) -> numpy.ndarray:
        (row,) = results([share])
        report(low + span * share, row)
        return (row - aims) / tolerances

    def jacobian(share: numpy.ndarray) -> numpy.ndarray:
        """All columns side by side, inwards at a bound."""
        steps = [STEP if share[k] + STEP <= 1.0 else -STEP for k in range(len(share))]
        points = [share + step * numpy.eye(len(share))[k] for k, step in enumerate(steps)]
        rows = results([share, *points])
        return numpy.array([(row - rows[0]) / tolerances / step for row, step in zip(rows[1:], steps)]).T

    start = (numpy.array([p.start for p in runs.parameters]) - low) / span
    best = least_squares(residuals, start, jacobian, bounds=(0.0, 1.0), xtol=1e-9, ftol=1e-10, gtol=1e-10, max_nfev=50)
    for target, row in zip(runs.targets, best.jac):
        if not row.any():
            print(
                f"calibrate: {target.scenario.stem}: {target.result} does not depend on the parameters here; start "
                f"elsewhere",
                file=sys.stderr,
            )
    return low + span * best.x, results([best.x])[0]


def _arguments(argv: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        "calibrate", description=DESCRIPTION, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", metavar="FILE.yaml", type=pathlib.Path, help="parameters and targets")
    parser.add_argument("--out", type=pathlib.Path, metavar="FILE.json", help="write the result there, too")
    parser.add_argument(
        "--jobs", type=int, metavar="N", default=len(os.sched_getaffinity(0)), help="runs at a time (default: cores)"
    )
    return parser.parse_args(argv)


def _calibrate(options: argparse.Namespace, train_sim) -> int:
    parameters, targets, fixed = read(options.file)
    runs = Runs(parameters, targets, fixed, max(1, options.jobs), train_sim)

    def report(values, results):
        off = max(abs((r - t.value) / t.tolerance) for r, t in zip(results, targets))
        print(
            f"calibrate: {runs.done} runs, {', '.join(f'{v:.6g}' for v in values)}: largest difference {off:.3g} "
            f"tolerances",
            file=sys.stderr,
        )

    values, results = fit(runs, report)
    print("--set " + " --set ".join(map(str, runs.changes(values))))
    met = True
    for target, result in zip(targets, results):
        within = abs(result - target.value) <= target.tolerance
        met = met and within
        print(
            f"{target.scenario.stem} {' '.join(target.changes)} {target.result}: {result:.7g}, target {target.value:g} "
            f"+- {target.tolerance:g}" + ("" if within else "  MISSED")
        )
    for parameter, value in zip(parameters, values):
        span = parameter.highest - parameter.lowest
        for bound, name in ((parameter.lowest, "lowest"), (parameter.highest, "highest")):
            if abs(value - bound) < 1e-3 * span:
                print(f"calibrate: {parameter.path} is at its {name}, {bound:g}", file=sys.stderr)
    if options.out:
        found = {
            "parameters": [{"path": p.path, "value": float(v)} for p, v in zip(parameters, values)],
            "targets": [
                {
                    "scenario": str(t.scenario),
                    "set": list(t.changes),
                    "result": t.result,
                    "target": t.value,
                    "tolerance": t.tolerance,
                    "obtained": float(r),
                    "difference": float(r - t.value),
                }
                for t, r in zip(targets, results)
            ],
            "runs": runs.done,
        }
        options.out.write_text(json.dumps(found, indent=2) + "\n")
    return 0 if met else 1


def main(argv: List[str], train_sim=TRAIN_SIM) -> int:
    options = _arguments(argv)
    try:
        return _calibrate(options, list(train_sim))
    except (StudyError, RunFailed, OSError, ImportError) as error:
        text = str(error) if not isinstance(error, ImportError) else f"{error}: apt-get install python3-scipy"
        print("\n".join(f"calibrate: {line}" for line in text.splitlines()), file=sys.stderr)
        return 2 if isinstance(error, StudyError) else 3 if isinstance(error, RunFailed) else 1
    except KeyboardInterrupt:
        return 130
