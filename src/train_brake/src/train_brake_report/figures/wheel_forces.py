"""Brake force on a shoe and on a wheel of one wagon (the paper's Figure 9)."""

from typing import Tuple

import numpy

from train_brake_report import consist, style
from train_brake_report.figure import Figure, LeftOut, new_canvas
from train_brake_report.group import Group, lacks
from train_brake_report.run import Run

KN = 1e-3


def _shoes_and_wheels(run: Run, vehicle: int) -> Tuple[int, int]:
    """Of a vehicle of a run, from 1; without its configuration: those of a wagon of the paper."""
    if run.config is None:
        return 8, 8
    shape = next(group["vehicle"] for first, last, group in consist.groups(run.config["train"]) if vehicle <= last)
    return shape["brake_rigging"].get("shoes", 8), 2 * (shape.get("axles") or 2 * shape.get("wheelsets_per_bogie", 2))


def draw(group: Group) -> Figure:
    runs, not_shown = group.drawable(
        lambda run: lacks(run, "state")
        or (
            f"there is no wagon {group.wagon}: the train has {run.vehicles} vehicle(s)"
            if run.vehicles < group.wagon
            else ""
        )
    )
    if not any(numpy.nan_to_num(run.recording.state["shoe_force_n"][:, group.wagon - 1]).any() for run in runs):
        raise LeftOut(f"The brake of wagon {group.wagon} was not applied.")
    canvas = new_canvas(4.2)
    axes = canvas.subplots()
    caption = (
        f"Tangential force on one brake shoe and longitudinal force of the rail on one wheel of wagon {group.wagon}, "
        "backwards positive."
    )
    with_wheels = []
    for run in runs:
        state = run.recording.state
        shoes, wheels = _shoes_and_wheels(run, group.wagon)
        shoe = KN / shoes * state["shoe_force_n"][:, group.wagon - 1]
        wheel = KN / wheels * state["wheel_force_n"][:, group.wagon - 1]
        known = numpy.isfinite(wheel)
        look = group.line(run)
        of_run = f", {run.label}" if len(runs) > 1 else ""
        axes.plot(state.time_s, shoe, label="shoe" + of_run, **look)
        if known.any():
            with_wheels.append(run)
            axes.plot(
                state.time_s[known],
                wheel[known],
                color=style.ORANGE if run is group.runs[0] else style.INK,
                linewidth=1.5,
                label="wheel" + of_run,
            )
    numbers = sorted({_shoes_and_wheels(run, group.wagon) for run in runs})
    caption += (
        f" It has {' or '.join(f'{shoes} shoes on {wheels} wheels' for shoes, wheels in numbers)}, taken as equal."
    )
    if with_wheels:
        caption += (
            " A steady wheel force is lower than the shoe force by the share that slows the rotation, and higher by "
            "the rolling resistance; it swings with the couplers' pull."
        )
    if len(with_wheels) < len(runs):
        caption += " An LTD vehicle has no wheels: its shoe force acts on the train as it is."
    axes.axhline(0.0, color=style.MUTED, linewidth=1.0)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("force [kN]")
    axes.margins(x=0)
    style.mark_commands(axes, group.commands())
    style.legend_above(axes, columns=4 if len(runs) < 3 else 3)
    return Figure(
        f"shoe_and_wheel_{group.wagon}", f"Shoe and wheel of wagon {group.wagon}", caption + not_shown, canvas
    )
