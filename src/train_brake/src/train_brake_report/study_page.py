"""The page of a study: parameter against result."""

import datetime
import pathlib
from typing import Any, Dict, List, Sequence, Tuple

import numpy
from train_brake.bag import unit_of
from train_brake.study import StudyError, change_of
from train_brake.sweep import Study, is_number, percentiles

from train_brake_report import page, style
from train_brake_report.figure import Figure, Table, minus, new_canvas

MOST_LINES = len(style.COLOURS)
Rows = List[Dict[str, Any]]


def _number(text: str):
    try:
        return float(text)
    except ValueError:
        return None


def _title(path: str) -> Tuple[str, float]:
    """(name with unit, factor): forces in kN."""
    field = next((part for part in reversed(path.split(".")) if unit_of(part)), path)
    unit = unit_of(field)
    words = path
    for suffix in (".value", ".mean"):
        words = words[: -len(suffix)] if words.endswith(suffix) else words
    if unit == "N":  # the unit in the name would contradict that of the axis
        return f"{words[:-2] if words.endswith('_n') else words} [kN]", 1e-3
    return f"{words} [{unit}]" if unit else words, 1.0


def default_results(rows: Rows) -> List[str]:
    """Stopping distance if all stop, else the speed at the end; then the largest forces."""
    first = "stop_distance_m" if all(row.get("stopped") for row in rows) else "final_speed_kmh.mean"
    found = [first, "max_tension_n.value", "max_compression_n.value"]
    return [name for name in found if any(is_number(row.get(name)) for row in rows)]


def _label(paths: Sequence[str], values: Sequence[str]) -> str:
    return ", ".join(f"{path.rsplit('.', 1)[-1]} {value or 'as in the scenario'}" for path, value in zip(paths, values))


def _places(texts: Sequence[str]) -> Tuple[List[float], List[str]]:
    """On the axis: (places, names of them; empty for numbers)"""
    numbers = [_number(text) for text in texts]
    if all(value is not None for value in numbers):
        return numbers, []
    names = list(dict.fromkeys(texts))
    return [float(names.index(text)) for text in texts], [name or "as in the scenario" for name in names]


def _width(line: int, lines: int) -> dict:
    """The first lines are broad: where results agree, the others are seen upon them."""
    more = max(0, min(lines, 4) - 1 - line)
    return {"linewidth": 1.8 + 2.0 * more, "markersize": 5 + 3.0 * more}


def _against(study: Study, rows: Rows, x: str, others: Sequence[str], result: str, drawn: Sequence[str]) -> Figure:
    """A result over a key of the grid or the list; a line for each set of values of the others, a band over draws."""
    groups: Dict[tuple, Rows] = {}
    for row in rows:
        groups.setdefault(tuple(row[path] for path in others), []).append(row)
    title, factor = _title(result)
    canvas = new_canvas(4.2)
    axes = canvas.subplots()
    places, names = _places([row[x] for row in rows])
    place_of = dict(zip((row[x] for row in rows), places))
    shown = list(groups.items())[:MOST_LINES]
    for i, (values, members) in enumerate(shown):
        colour = style.COLOURS[i]
        at: Dict[float, List[float]] = {}
        for row in members:
            if is_number(row.get(result)):
                at.setdefault(place_of[row[x]], []).append(factor * row[result])
        where = sorted(at)
        label = _label(others, values) or None
        if drawn:
            low, middle, high = (numpy.array([numpy.percentile(at[place], p) for place in where]) for p in (5, 50, 95))
            if names:  # between names there is nothing; lines of several sets stand side by side
                where = [place + 0.12 * (i - (len(shown) - 1) / 2) for place in where]
                axes.errorbar(
                    where, middle, (middle - low, high - middle), fmt="o", color=colour, capsize=6, label=label
                )
            else:
                axes.fill_between(where, low, high, color=colour, alpha=0.25, linewidth=0)
                axes.plot(where, middle, "o-", color=colour, markersize=5, label=label)
        else:
            line = "o" if names else "o-"
            axes.plot(
                [place for place in where for _ in at[place]],
                [y for place in where for y in at[place]],
                line,
                color=colour,
                **_width(i, len(shown)),
                label=label,
            )
    if names:
        axes.set_xticks(range(len(names)), names)
        axes.set_xlim(-0.5, len(names) - 0.5)
    axes.set_xlabel(_title(x)[0])
    axes.set_ylabel(title)
    if others and len(shown) > 1:
        style.legend_above(axes, 2)
    more = (
        f" The first {MOST_LINES} of {len(groups)} sets of values are shown; results.csv has all."
        if len(groups) > MOST_LINES
        else ""
    )
    band = (
        f" Points: median of {study.asked['draws']} draws; band or bars: from the 5th to the 95th percentile."
        if drawn
        else ""
    )
    missing = sum(not is_number(row.get(result)) for row in rows)
    without = f" {missing} run(s) have no such result." if missing else ""
    name = "".join(c if c.isalnum() else "_" for c in f"{result}_over_{x}")
    return Figure(
        name,
        f"{title.split(' [')[0]} over {x}",
        f"A point per run.{more}{without}" if not drawn else band.strip() + more + without,
        canvas,
    )


def _ensemble(rows: Rows, result: str, drawn: Sequence[str]) -> Figure:
    """The distribution of a result over the draws: share of runs below, and over each key that was drawn."""
    title, factor = _title(result)
    numeric = [path for path in drawn if all(_number(row[path]) is not None for row in rows)]
    canvas = new_canvas(3.8)
    panels = canvas.subplots(1, 1 + len(numeric[:2]), sharey=True, squeeze=False)[0]
    having = [row for row in rows if is_number(row.get(result))]
    values = factor * numpy.array([row[result] for row in having], float)
    share = (numpy.arange(len(values)) + 0.5) / len(values)
    panels[0].plot(share, numpy.sort(values), "o", color=style.BLUE, markersize=4)
    panels[0].set_xlabel("share of runs below")
    panels[0].set_xlim(0, 1)
    panels[0].set_ylabel(title)
    for path, axes in zip(numeric, panels[1:]):
        axes.plot([_number(row[path]) for row in having], values, "o", color=style.BLUE, markersize=4)
        axes.set_xlabel(_title(path)[0])
        axes.tick_params(axis="x", labelrotation=20)
    low, middle, high = numpy.percentile(values, (5, 50, 95))
    name = "".join(c if c.isalnum() else "_" for c in f"{result}_of_draws")
    return Figure(
        name,
        f"{title.split(' [')[0]} of {len(values)} draws",
        minus(f"5 % of the runs are below {low:.6g}, half below {middle:.6g}, 95 % below {high:.6g}."),
        canvas,
    )


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return minus(f"{value:.0f}" if abs(value) >= 1e5 else f"{value:.6g}")
    return "" if value is None else str(value)


def _percentile_table(study: Study, rows: Rows, results: Sequence[str]) -> Figure:
    lines = [line for line in percentiles(study, rows) if line["result"] in results]
    head = [name for name in lines[0] if name not in ("runs", "standard_deviation")]
    return Figure(
        "percentiles",
        "Percentiles over the draws",
        "Forces in N. percentiles.csv has every result.",
        table=Table(head, [[_cell(line[name]) for name in head] for line in lines]),
    )


def _run_table(study: Study, rows: Rows, results: Sequence[str]) -> Figure:
    most = 200
    head = ["run", *study.paths, *results]
    more = f" The first {most} of {len(rows)} runs." if len(rows) > most else ""
    return Figure(
        "runs",
        "Runs",
        f"Forces in N. results.csv has every number of every run; runs/NUMBER/config.yaml runs again.{more}",
        table=Table(head, [[_cell(row.get(name)) for name in head] for row in rows[:most]]),
    )


def figures_of(study: Study, rows: Rows, results: Sequence[str]) -> List[Figure]:
    drawn = [change_of(text).path for text in study.asked["random"]]
    given = [path for path in study.paths if path not in drawn and len({row[path] for row in rows}) > 1]
    figures = []
    for result in results:
        for x in given:
            figures.append(_against(study, rows, x, [path for path in given if path != x], result, drawn))
        if drawn and not given:
            figures.append(_ensemble(rows, result, drawn))
    if drawn:
        figures.append(_percentile_table(study, rows, results))
    figures.append(_run_table(study, rows, results))
    return figures


def write_page(study: Study, rows: Rows, results: Sequence[str], with_files: bool = False) -> pathlib.Path:
    """@raises StudyError  if there is no such result"""
    known = {name for row in rows for name in row if is_number(row[name])}
    unknown = [name for name in results if name not in known]
    if unknown:
        raise StudyError(f"--results {', '.join(unknown)}: the results are {', '.join(sorted(known))}")
    with style.applied():
        figures = figures_of(study, rows, results or default_results(rows))
        count = f"{len(rows)} of {len(study.plan)} runs" if len(rows) < len(study.plan) else f"{len(rows)} runs"
        scenario = pathlib.Path(study.asked["scenario"]).stem
        fixed = f" All runs: {', '.join(study.asked['set'])}." if study.asked["set"] else ""
        made = f"Made on {datetime.datetime.now():%Y-%m-%d %H:%M} by sweep of train_brake.{fixed}"
        html = page.render(f"Study of {scenario}: {count}", [], [page.Section("Results", "results", figures)], made)
        if with_files:
            (study.folder / "figures").mkdir(exist_ok=True)
            for figure in figures:
                figure.save(study.folder / "figures")
    file = study.folder / "study.html"
    unfinished = file.with_name(file.name + ".unfinished")
    unfinished.write_text(html)
    unfinished.replace(file)
    return file
