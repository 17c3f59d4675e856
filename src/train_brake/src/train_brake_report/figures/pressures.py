"""Cylinder pressures over time (the paper's Figure 7)."""

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, LeftOut, new_canvas
from train_brake_report.group import Group
from train_brake_report.series import common_rows

KPA = 1e-3


def spread_over_train(vehicles: int) -> list:
    """At most five vehicles, evenly from the first to the last: of 242 those with the numbers 1, 61, 122, 182, 242."""
    return sorted({int(numpy.floor(1 + (vehicles - 1) * quarter / 4 + 0.5)) for quarter in range(5)})


def draw(group: Group) -> Figure:
    runs, not_shown = group.having("pressures")
    others, not_compared = group.comparable(runs, "pressures")
    first = runs[0]
    shown = spread_over_train(first.vehicles)
    pressures = {run: KPA * run.recording.pressures["cylinder_pressure_pa"] for run in runs}
    if not any(p.any() for p in pressures.values()):
        raise LeftOut("No brake was applied.")
    canvas = new_canvas(4.2)
    axes = canvas.subplots()
    caption = "Pressure in the brake cylinders above the atmosphere."
    for vehicle, colour in zip(shown, style.COLOURS):
        axes.plot(
            first.recording.pressures.time_s, pressures[first][:, vehicle - 1], color=colour, label=f"vehicle {vehicle}"
        )
    for run in others:
        a, b = common_rows(first.recording.pressures.time_s, run.recording.pressures.time_s)
        difference = float(numpy.abs(pressures[run][b] - pressures[first][a]).max())
        if difference == 0.0:
            caption += f" {run.label} has the same."
            continue
        for vehicle, colour in zip(shown, style.COLOURS):
            axes.plot(
                run.recording.pressures.time_s,
                pressures[run][:, vehicle - 1],
                color=colour,
                linewidth=1.2,
                linestyle=(0, (4, 2)),
            )
        caption += f" Dashed: {run.label}, which differs from {first.label} by up to {difference:.1f} kPa."
    axes.set_xlabel("time [s]")
    axes.set_ylabel("cylinder pressure [kPa]")
    axes.margins(x=0)
    axes.set_ylim(0.0, 1.12 * max(p.max() for p in pressures.values()))
    style.mark_commands(axes, group.commands())
    style.legend_above(axes, columns=5)
    return Figure("pressures", "Cylinder pressures", caption + not_compared + not_shown, canvas)
