"""Brake force on a shoe and on a wheel of one wagon (the paper's Figure 9)."""

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, LeftOut, new_canvas
from train_brake_report.group import Group, lacks

WHEELS = 8  # of a wagon, one shoe each
KN = 1e-3


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
        "backwards positive: an eighth of the wagon's."
    )
    with_wheels = []
    for run in runs:
        state = run.recording.state
        shoe, wheel = (KN / WHEELS * state[field][:, group.wagon - 1] for field in ("shoe_force_n", "wheel_force_n"))
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
