"""Studies: many runs of one scenario with changed keys, by the program train_sim. What sweep and calibrate share."""

import csv
import itertools
import pathlib
import re
import shutil
import subprocess
from typing import Any, Dict, List, NamedTuple, Sequence, Tuple

import numpy

# The program itself where it is on PATH: rosrun takes longer to find it than a short run does.
TRAIN_SIM = ("train_sim",) if shutil.which("train_sim") else ("rosrun", "train_sim", "train_sim")
# Values of a summary that describe the machine, not the train.
NO_RESULT = ("wall_s", "real_time_factor", "ns_per_vehicle_step", "dt_s", "exchange_interval_s", "resumed_at_s")


class StudyError(Exception):
    """An error in the user's input. The text says where, what, and the remedy."""


class Change(NamedTuple):
    """A key and the value that it gets, as after --set."""

    path: str
    value: str

    def __str__(self) -> str:
        return f"{self.path}={self.value}"


def change_of(text: str) -> Change:
    path, assigned, value = text.partition("=")
    if not assigned or not path.strip():
        raise StudyError(f"'{text}': a change is given as path=value")
    return Change(path.strip(), value.strip())


def number(value: float) -> str:
    """The shortest text that gives the same number again."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def grid_of(text: str) -> Tuple[str, List[str]]:
    """PATH=V1,V2,... or PATH=FIRST:LAST:COUNT"""
    path, values = change_of(text)
    points = re.fullmatch(r"([^:,\s]+):([^:,\s]+):(\d+)", values)
    if points:
        try:
            first, last, count = float(points[1]), float(points[2]), int(points[3])
        except ValueError:
            raise StudyError(f"'{text}': FIRST:LAST:COUNT must be numbers") from None
        if count < 2:
            raise StudyError(f"'{text}': COUNT must be >= 2")
        return path, [number(value) for value in numpy.linspace(first, last, count)]
    # Commas within brackets belong to a value: {name: a, grades: []}
    parts, depth = [""], 0
    for character in values:
        depth += (character in "[{") - (character in "]}")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    parts = [part.strip() for part in parts]
    if not all(parts):
        raise StudyError(f"'{text}': a value is empty")
    return path, parts


def draws_of(text: str, count: int, generator: numpy.random.Generator) -> Tuple[str, List[str]]:
    """PATH=uniform(LOW,HIGH), normal(MEAN,SD), lognormal(MEDIAN,SD_OF_LOG) or choice(V1,V2,...)"""
    path, law = change_of(text)
    match = re.fullmatch(r"(\w+)\((.*)\)", law)
    kinds = {"uniform": 2, "normal": 2, "lognormal": 2, "choice": None}
    if not match or match[1] not in kinds:
        raise StudyError(
            f"'{text}': must be uniform(LOW,HIGH), normal(MEAN,SD), lognormal(MEDIAN,SD) or choice(V1,V2,...)"
        )
    words = [word.strip() for word in match[2].split(",")]
    if match[1] == "choice":
        return path, [words[i] for i in generator.integers(len(words), size=count)]
    try:
        a, b = map(float, words)
    except ValueError:
        raise StudyError(f"'{text}': {match[1]} takes two numbers") from None
    if (b < a) if match[1] == "uniform" else (b < 0.0 or (match[1] == "lognormal" and a <= 0.0)):
        raise StudyError(
            f"'{text}': {'HIGH is below LOW' if match[1] == 'uniform' else 'a spread must be >= 0, a median > 0'}"
        )
    if match[1] == "uniform":
        values = generator.uniform(a, b, count)
    elif match[1] == "normal":
        values = generator.normal(a, b, count)
    else:
        values = a * numpy.exp(b * generator.standard_normal(count))
    return path, [number(value) for value in values]


def list_of(file: pathlib.Path) -> List[List[Change]]:
    """Of a table with a path in each column's head: the changes of each row. Empty cells change nothing."""
    try:
        with open(file, newline="", encoding="utf-8-sig") as text:
            rows = [row for row in csv.reader(text) if row and not row[0].startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{file} cannot be read: {error}") from None
    if len(rows) < 2:
        raise StudyError(f"{file}: it must have a line with paths, and one or more lines with values")
    head = [cell.strip() for cell in rows[0]]
    for i, row in enumerate(rows[1:], 2):
        if len(row) != len(head):
            raise StudyError(f"{file}: row {i} has {len(row)} cells, the first one {len(head)}")
    return [[Change(path, cell.strip()) for path, cell in zip(head, row) if cell.strip()] for row in rows[1:]]


def combined(lists: Sequence[List[Change]], grids: Sequence[Tuple[str, List[str]]]) -> List[List[Change]]:
    """Every row of the list with every point of the grid; the last grid's values change first."""
    points = itertools.product(*([Change(path, value) for value in values] for path, values in grids))
    return [[*row, *point] for row, point in itertools.product(lists or [[]], list(points))]


def resolve(scenario: pathlib.Path, changes: Sequence[Change], train_sim: Sequence[str] = TRAIN_SIM) -> str:
    """The scenario with everything in place, checked. @raises StudyError  with what train_sim says"""
    words = [word for change in changes for word in ("--set", str(change))]
    done = subprocess.run(
        [*train_sim, "resolve", str(scenario), *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    if done.returncode:
        raise StudyError(done.stderr.strip() or f"train_sim resolve {scenario} ended with exit code {done.returncode}")
    return done.stdout


def flat(summary: Any, path: str = "") -> Dict[str, Any]:
    """The single numbers and words of a summary by their paths: final_speed_kmh.mean, max_tension_n.value."""
    if isinstance(summary, dict):
        found: Dict[str, Any] = {}
        for key, value in summary.items():
            if path or key not in NO_RESULT:
                found.update(flat(value, f"{path}.{key}" if path else key))
        return found
    return {} if isinstance(summary, list) or not path else {path: summary}
