"""What differs between the configurations of runs."""

from typing import Any, Dict

from train_brake_report.figure import Figure, LeftOut, Table
from train_brake_report.group import Group

MOST_ROWS = 60
NAMES = ("name", "description")  # of the scenario: they change nothing


def flat(value: Any, path: str = "") -> Dict[str, str]:
    """Every single value of a configuration by the path that --set takes."""
    if isinstance(value, dict) and value:
        return {
            p: t for key, item in value.items() for p, t in flat(item, f"{path}.{key}" if path else str(key)).items()
        }
    if isinstance(value, list) and any(isinstance(item, (dict, list)) for item in value):
        return {p: t for i, item in enumerate(value) for p, t in flat(item, f"{path}[{i}]").items()}
    if isinstance(value, bool):
        return {path: "true" if value else "false"}
    return {
        path: "none"
        if value is None
        else f"{value:g}"
        if isinstance(value, float) and float(f"{value:g}") == value
        else str(value)
    }


def table(group: Group) -> Figure:
    if len(group.runs) < 2:
        raise LeftOut("")
    runs, not_shown = group.drawable(lambda run: "" if run.config is not None else "its configuration is not known")
    configurations = [flat({key: value for key, value in run.config.items() if key not in NAMES}) for run in runs]
    paths = list(dict.fromkeys(path for configuration in configurations for path in configuration))
    rows = []
    for path in paths:
        values = [configuration.get(path, "\u2013") for configuration in configurations]
        if len(set(values) - {"none", "\u2013"}) + bool({"none", "\u2013"} & set(values)) > 1:
            rows.append([path, *values])
    more = f" The first {MOST_ROWS} of {len(rows)} keys." if len(rows) > MOST_ROWS else ""
    caption = (
        "Keys that are not the same in all runs, with everything resolved, as --set takes them; \u2013: the run has no "
        "such key."
        if rows
        else "Nothing: the configurations are the same but for their names."
    )
    return Figure(
        "changed_keys",
        "What differs between the runs",
        caption + more + not_shown,
        table=Table(["key", *(run.label for run in runs)], rows[:MOST_ROWS]) if rows else None,
    )
