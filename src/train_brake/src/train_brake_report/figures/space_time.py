"""Pictures of the whole train over time: a row per vehicle, the colour is a quantity."""

import dataclasses
from typing import List, Tuple

import numpy
from matplotlib import patheffects
from matplotlib.colors import LogNorm
from matplotlib.ticker import MaxNLocator

from train_brake_report import style, wave
from train_brake_report.figure import Figure, LeftOut, Table, minus, new_canvas
from train_brake_report.group import Group, lacks
from train_brake_report.run import Run
from train_brake_report.series import common_rows, decimate
from train_brake_report.slides import LOCKED, SLIDING, SLOWEST_MPS, Slide, find_slides

COLUMNS = 1000
ON_PICTURE = [patheffects.Stroke(linewidth=3.2, foreground="white"), patheffects.Normal()]
ROWS_OF_SLIDES = 20
LEAST_SLIP = 1e-3  # [%] where the logarithmic scale begins


@dataclasses.dataclass
class Quantity:
    name: str
    title: str
    unit: str
    table: str
    field: str
    factor: float  # from SI to the unit
    signed: bool  # a diverging colour scale
    rows: str = "vehicle"
    caption: str = ""

    def of(self, run: Run) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """(times [s], values [record, vehicle] in the unit) without records that lack it: LTD has no creepage, and the
        first record of any model has no acceleration."""
        table = getattr(run.recording, self.table)
        values = numpy.float32(self.factor) * table[self.field]
        known = numpy.isfinite(values).all(axis=1)
        return table.time_s[known], values[known]


FORCE = Quantity(
    "coupler_force_picture",
    "Coupler force, whole train",
    "coupler force [kN]",
    "forces",
    "coupler_force_n",
    1e-3,
    True,
    "connection",
    "Orange is tension, blue compression: shocks run along the train as slanted lines.",
)
PRESSURE = Quantity(
    "pressure_picture",
    "Cylinder pressure, whole train",
    "cylinder pressure [kPa]",
    "pressures",
    "cylinder_pressure_pa",
    1e-3,
    False,
    caption="The brake starts as a wedge at each source.",
)
PIPE = Quantity(
    "pipe_pressure_picture",
    "Brake pipe, whole train",
    "pipe pressure [kPa]",
    "pressures",
    "pipe_pressure_pa",
    1e-3,
    False,
    caption="The fall in the pipe goes before the cylinders.",
)
SLIP = Quantity(
    "slip_picture",
    "Wheel slip, whole train",
    "creepage [%]",
    "state",
    "creepage",
    100.0,
    False,
    caption="Creepage of each vehicle's wheelset with the largest.",
)
ACCELERATION = Quantity(
    "acceleration_picture",
    "Acceleration, whole train",
    "acceleration [m/s²]",
    "state",
    "acceleration_mps2",
    1.0,
    True,
    caption="Blue slows down. Slanted lines are shocks that run along " "the train.",
)


def _round_up(value: float) -> float:
    """To two digits."""
    if value <= 0.0:
        return 1.0
    scale = 10.0 ** (numpy.floor(numpy.log10(value)) - 1)
    return float(numpy.ceil(value / scale - 1e-9) * scale)


def _limit(values: numpy.ndarray) -> tuple:
    """(where the colours end, the largest size): all of the values, or 99.9 % where few are far beyond."""
    sizes = numpy.abs(values)
    largest, most = float(sizes.max()), float(numpy.percentile(sizes, 99.9))
    return (_round_up(largest) if largest < 1.3 * most else _round_up(most)), largest


def _image(axes, rows: str, time_s: numpy.ndarray, values: numpy.ndarray, label: str, arrows: str, **colours) -> str:
    """Returns a sentence on what is missing; empty if nothing is."""
    picture, begin_s, end_s = decimate(time_s, values, COLUMNS)
    image = axes.imshow(
        picture, aspect="auto", interpolation="nearest", extent=(begin_s, end_s, values.shape[1] + 0.5, 0.5), **colours
    )
    axes.set_xlim(time_s[0], time_s[-1])
    axes.grid(False)
    axes.set_ylabel(rows)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    bar = axes.figure.colorbar(image, ax=axes, pad=0.015, aspect=18, label=label, extend=arrows)
    bar.outline.set_visible(False)
    if isinstance(image.norm, LogNorm):
        style.powers_of_ten(bar.ax.yaxis)
    return " Grey: no records." if numpy.isnan(picture).any() else ""


def _picture(axes, quantity: Quantity, time_s: numpy.ndarray, values: numpy.ndarray, signed: bool, label: str) -> str:
    """Draws values [record, vehicle]; returns a sentence on the limits of the colours."""
    limit, largest = _limit(values)
    beyond = largest > limit
    least = -limit if signed else 0.0
    arrows = ["neither", "max", "min", "both"][int(values.max() > limit) + 2 * int(values.min() < least - 0.01 * limit)]
    missing = _image(
        axes,
        quantity.rows,
        time_s,
        values,
        label,
        arrows,
        cmap=style.DIVERGING if signed else style.SEQUENTIAL,
        vmin=least,
        vmax=limit,
    )
    sign = "±" if signed else ""
    unit = quantity.unit[quantity.unit.index("[") + 1 : -1]
    return (
        f"Colours end at {sign}{limit:g} {unit}"
        + (f" (99.9 % of the values; the largest is {largest:.3g})" if beyond else "")
        + "."
        + missing
    )


def _series(quantity: Quantity, group: Group, least_rows: int = 2) -> Tuple[dict, str]:
    """({run: (times, values)} of the runs that can be drawn, a sentence on the others); LeftOut if there are none."""

    def why_not(run: Run) -> str:
        reason = lacks(run, quantity.table)
        if reason:
            return reason
        time_s, values = quantity.of(run)
        if quantity is PIPE and not values.shape[1]:
            return "its brake has no pipe: it is not of kind pneumatic"
        if len(time_s) < 2:
            return (
                "the LTD models have no wheels that could slip"
                if quantity is SLIP and run.model != "2d"
                else "there is but one record"
            )
        if values.shape[1] < least_rows:
            return f"a picture along the train needs more than one {quantity.rows}"
        return ""

    runs, not_shown = group.drawable(why_not)
    return {run: quantity.of(run) for run in runs}, not_shown


def _draw(quantity: Quantity, group: Group) -> Figure:
    series, not_shown = _series(quantity, group)
    runs = list(series)
    first, shown = runs[0], next((run for run in runs if run.model == "2d"), runs[0])
    same, differences = [], []
    others, not_compared = group.comparable(runs, quantity.table)
    for run in others:
        a, b = common_rows(series[first][0], series[run][0])
        if not len(a):  # but for records that do not know the quantity
            continue
        difference = series[run][1][b] - series[first][1][a]
        if difference.any():
            differences.append((run, series[run][0][b], difference))
        else:
            same.append(run.label)

    canvas = new_canvas(3.9 + 3.1 * len(differences))
    panels = canvas.subplots(1 + len(differences), 1, sharex=True, squeeze=False)[:, 0]
    time_s, values = series[shown]
    signed = quantity.signed or numpy.percentile(values, 0.1) < -0.1 * values.max()
    limits = _picture(panels[0], quantity, time_s, values, signed, quantity.unit)
    caption = f"{quantity.caption} {limits}"
    if len(group.runs) > 1:
        panels[0].set_title(shown.label, loc="left", fontsize=11.5)
    for axes, (run, time_s, values) in zip(panels[1:], differences):
        limits = _picture(
            axes, quantity, time_s, values, True, "difference " + quantity.unit[quantity.unit.index("[") :]
        )
        axes.set_title(group.difference(run, first), loc="left", fontsize=11.5)
        caption += f" {group.difference(run, first)}: {limits[0].lower()}{limits[1:]}"
    if same:
        caption += f" {' and '.join(same)}: the same as {first.label}."
    panels[-1].set_xlabel("time [s]")
    panels[-1].set_xlim(
        min(time_s[0] for time_s, _ in series.values()), max(time_s[-1] for time_s, _ in series.values())
    )
    return Figure(quantity.name, quantity.title, caption + not_compared + not_shown, canvas)


def draw_force(group: Group) -> Figure:
    return _draw(FORCE, group)


def draw_acceleration(group: Group) -> Figure:
    return _draw(ACCELERATION, group)


def draw_pipe(group: Group) -> Figure:
    return _draw(PIPE, group)


def draw_pressure(group: Group) -> Figure:
    series, _ = _series(PRESSURE, group)
    if not any(values.any() for _, values in series.values()):
        raise LeftOut("No brake was applied.")
    return _draw(PRESSURE, group)


SLIDE_RULE = f"creepage above {100 * SLIDING:g} % at more than {SLOWEST_MPS:g} m/s"


def draw_slip(group: Group) -> Figure:
    series, not_shown = _series(SLIP, group, least_rows=1)
    sliding = {run: find_slides(run.recording.state) for run in series}
    run = max(sliding, key=lambda r: len(sliding[r]))
    if sliding[run]:
        figure = _draw_slides(run, sliding[run])
        figure.caption += not_shown
        return figure
    figure = _draw(SLIP, group)
    figure.caption += f" No wheel slid ({SLIDE_RULE})."
    return figure


def _draw_slides(run: Run, slides: List[Slide]) -> Figure:
    time_s, creepage = SLIP.of(run)
    canvas = new_canvas(3.9)
    axes = canvas.subplots()
    if creepage.shape[1] > 1:
        missing = _image(
            axes,
            "vehicle",
            time_s,
            numpy.maximum(numpy.abs(creepage), LEAST_SLIP),
            "size of creepage [%]",
            "min",
            cmap=style.SEQUENTIAL,
            norm=LogNorm(LEAST_SLIP, 100.0),
        )
        axes.plot([s.begin_s for s in slides], [s.vehicle for s in slides], ">", color=style.VERMILLION, markersize=4)
        caption = f"{SLIP.caption} The scale is logarithmic.{missing}"
    else:
        axes.plot(time_s, creepage[:, 0], linewidth=1.2)
        axes.plot([s.begin_s for s in slides], [100 * SLIDING] * len(slides), ">", color=style.VERMILLION)
        axes.set_ylabel(SLIP.unit)
        axes.margins(x=0)
        caption = "Creepage of the wheelset with the largest."
    axes.set_xlabel("time [s]")
    locked = sum(slide.locked for slide in slides)
    caption += (
        f" Wheel slides of {run.label} ({SLIDE_RULE}) begin at the red marks: {len(slides)} on "
        f"{len({s.vehicle for s in slides})} vehicle(s), {locked} of them with a locked wheel "
        f"({100 * LOCKED:g} %)."
    )
    if len(slides) > ROWS_OF_SLIDES:
        caption += f" The table has the first {ROWS_OF_SLIDES}."
    table = Table(
        ["vehicle", "from [s]", "to [s]", "largest creepage [%]", "locked"],
        [
            [
                str(s.vehicle),
                f"{s.begin_s:.2f}",
                f"{s.end_s:.2f}",
                f"{100 * s.largest_creepage:.1f}".replace("-", "\u2212"),
                "yes" if s.locked else "no",
            ]
            for s in slides[:ROWS_OF_SLIDES]
        ],
    )
    return Figure(SLIP.name, SLIP.title, caption, canvas, table)


@dataclasses.dataclass
class _Phase:
    name: str
    wave: wave.Wave
    configured_mps: float


def _phases(run: Run) -> List[_Phase]:
    found, reason = [], None
    for name, find, is_release in (("application", wave.application, False), ("release", wave.release, True)):
        try:
            found.append(_Phase(name, find(run), wave.configured_speed_mps(run, is_release)))
        except LeftOut as left_out:
            reason = reason or left_out
    if not found:
        raise reason
    return found


def draw_wave(group: Group) -> Figure:
    phases_of = {}

    def why_not(run: Run) -> str:
        try:
            phases_of[run] = _phases(run)
        except LeftOut as left_out:
            reason = str(left_out).rstrip(".")
            return reason[0].lower() + reason[1:]
        return ""

    runs, not_shown = group.drawable(lambda run: lacks(run, "pressures") or why_not(run))
    run = runs[0]
    phases = phases_of[run]
    canvas = new_canvas(3.9 * len(phases))
    rows = canvas.subplots(len(phases), 2, squeeze=False, width_ratios=[3, 1], sharey=True)
    time_s, pressure = PRESSURE.of(run)
    caption = ""
    for (axes, beside), phase in zip(rows, phases):
        found = phase.wave
        begin, end = numpy.nanmin(found.arrival_s), numpy.nanmax(found.arrival_s)
        window = (time_s >= begin - 1.0) & (time_s <= end + 3.0)
        _picture(axes, PRESSURE, time_s[window], pressure[window], False, PRESSURE.unit)
        for branch in found.branches:
            vehicles = numpy.arange(branch.first, branch.last + 1)
            axes.plot(branch.time_s, vehicles + 1, color=style.VERMILLION, linewidth=1.8, path_effects=ON_PICTURE)
            beside.plot(
                1e3 * (found.arrival_s[vehicles] - branch.time_s),
                vehicles + 1,
                ".",
                color=style.VERMILLION,
                markersize=3,
            )
        reach = max(1.0, 1.1 * max(abs(v) for v in beside.get_xlim()))
        beside.set_xlim(-reach, reach)
        beside.set_xlabel("seen \u2212 fitted [ms]")
        axes.set_xlabel("time [s]")
        axes.set_title(
            f"{phase.name}: fitted {found.speed_mps:.2f} m/s"
            + (f", configured {phase.configured_mps:g} m/s" if phase.configured_mps else ""),
            loc="left",
            fontsize=11.5,
        )
        starts = ", ".join(f"vehicle {vehicle} at {start_s:.2f} s" for vehicle, start_s in found.sources())
        error = (
            f"\u00b1 {minus(f'{found.speed_error_mps:.1g}')}"
            if found.speed_error_mps >= 1e-3
            else "\u00b1 less than 0.001"
        )
        caption += (
            f"The {phase.name} runs at {found.speed_mps:.2f} m/s {error} m/s (scatter only) by least squares "
            f"over the times at which the recorded pressures begin to move ("
            + (
                f"configured: {phase.configured_mps:g} m/s"
                if phase.configured_mps
                else "the configuration names no speed for it"
            )
            + "); "
            + (f"it starts at {starts}. " if starts else "where it starts was not recorded. ")
        )
    caption += (
        f"Besides the scatter there is a systematic error of about {100 * wave.SYSTEMATIC:g} %: the rise is curved, "
        f"the "
        "line through its beginning is not. Lines: the fit. Right: how far each vehicle is from it."
    )
    if len(group.runs) > 1:
        caption += f" Of {run.label}."
    return Figure("brake_wave", "Brake wave", caption + not_shown, canvas)
