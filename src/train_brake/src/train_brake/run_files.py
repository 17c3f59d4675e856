"""Checks the files beside a bag: a summary.json or config.yaml of another program is reported as an error."""

import pathlib
from typing import Any, List, NamedTuple

from train_brake.bag import BagError

NUMBER = (int, float)


class Maybe(NamedTuple):
    """May be null or missing."""

    kind: Any


EXTREME = {"value": NUMBER, "connection": int, "time_s": NUMBER}
SUMMARY = {
    "scenario": str,
    "model": str,
    "vehicles": int,
    "simulated_s": NUMBER,
    "wall_s": NUMBER,
    "real_time_factor": NUMBER,
    "complete": bool,
    "fault": Maybe(str),
    "commands": Maybe([{"time_s": NUMBER, "command": str}]),
    "final_speed_kmh": {"mean": NUMBER},
    "stopped": bool,
    "stop_time_s": Maybe(NUMBER),
    "stop_distance_m": Maybe(NUMBER),
    "stops": Maybe([{"time_s": NUMBER, "distance_m": NUMBER}]),
    "max_tension_n": Maybe(EXTREME),
    "max_compression_n": Maybe(EXTREME),
    "partings": Maybe([{"time_s": NUMBER}]),
    "twin": Maybe({"start_offset_kmh": NUMBER, "max_tension_spread_n": NUMBER, "max_compression_spread_n": NUMBER}),
    "slides": Maybe({"slides": int, "flat_risks": int, "wheelsets": [{"locked_s": NUMBER}]}),
    "energy": {"initial_j": NUMBER, "residual_j": NUMBER},
    "state_digest": str,
}
CONFIG = {
    "name": Maybe(str),
    "duration_s": NUMBER,
    "commands": Maybe([{"kind": str, "time_s": Maybe(NUMBER)}]),
    "train": {"consist": [{"count": int, "vehicle": {"length_m": NUMBER}}]},
}


def _complaints(value: Any, kind: Any, path: str) -> List[str]:
    if isinstance(kind, Maybe):
        return [] if value is None else _complaints(value, kind.kind, path)
    if isinstance(kind, dict):
        if not isinstance(value, dict):
            return [f"{path} is not a map"]
        found = []
        for key, of_value in kind.items():
            found += _complaints(value.get(key), of_value, f"{path}.{key}" if path else key)
        return found
    if isinstance(kind, list):
        if not isinstance(value, list):
            return [f"{path} is not a list"]
        return [c for i, item in enumerate(value) for c in _complaints(item, kind[0], f"{path}[{i}]")]
    if value is None:
        return [f"{path} is missing"]
    is_flag = isinstance(value, bool)
    if not isinstance(value, kind) or (is_flag and kind is not bool):
        return [f"{path} is {value!r}"[:80]]
    return []


def checked(content: dict, kind: dict, source: pathlib.Path, what: str) -> dict:
    """@raises BagError with the first mismatch"""
    complaints = _complaints(content, kind, "")
    if complaints:
        more = f" (and {len(complaints) - 1} more)" if len(complaints) > 1 else ""
        raise BagError(f"{source} is not {what}: {complaints[0]}{more}. Move it away if it is another program's")
    return content
