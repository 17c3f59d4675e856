"""Pipe, reservoirs and cylinders of a pneumatic brake over time, and how its force builds up beside others."""

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, new_canvas
from train_brake_report.group import Group, lacks
from train_brake_report.run import Run

KPA = 1e-3
FULL = 0.95  # of the largest mean cylinder pressure


def _why_not(run: Run) -> str:
    reason = lacks(run, "pressures")
    if reason:
        return reason
    return (
        ""
        if run.recording.pressures["pipe_pressure_pa"].shape[1]
        else "its brake has no pipe: it is not of kind pneumatic"
    )


def _built_up(time_s: numpy.ndarray, mean: numpy.ndarray) -> str:
    largest = float(mean.max())
    if largest <= 0.0:
        return "no brake is applied"
    begin, end = int((mean > 0.0).argmax()), int((mean >= FULL * largest).argmax())
    return f"from the first cylinder's to {100 * FULL:g} % of the largest mean {time_s[end] - time_s[begin]:.1f} s"


def _charged(time_s: numpy.ndarray, head_pa: numpy.ndarray, tail_pa: numpy.ndarray) -> str:
    """The charging time of an empty train; empty for a train that is charged from the start."""
    goal = FULL * float(head_pa.max())
    if tail_pa[0] >= goal or tail_pa[0] > tail_pa[1:].min(initial=numpy.inf):
        return ""
    if not (tail_pa >= goal).any():
        return f" The last vehicle's pipe is not charged to {100 * FULL:g} % of the first's within the run."
    return (
        f" Charging: the last vehicle's pipe has {100 * FULL:g} % of the first's largest pressure after "
        f"{time_s[(tail_pa >= goal).argmax()] - time_s[0]:.1f} s."
    )


def draw(group: Group) -> Figure:
    runs, not_shown = group.drawable(_why_not)
    run = runs[0]
    table = run.recording.pressures
    canvas = new_canvas(7.2)
    above, below = canvas.subplots(2, 1, sharex=True)
    for vehicle, colour in zip(sorted({1, (run.vehicles + 1) // 2, run.vehicles}), style.COLOURS):
        above.plot(
            table.time_s,
            KPA * table["pipe_pressure_pa"][:, vehicle - 1],
            color=colour,
            label=f"pipe, vehicle {vehicle}",
        )
        above.plot(
            table.time_s,
            KPA * table["auxiliary_reservoir_pa"][:, vehicle - 1],
            color=colour,
            linewidth=1.2,
            linestyle=(0, (4, 2)),
            label=f"auxiliary reservoir, vehicle {vehicle}",
        )
    above.set_ylabel("pressure [kPa]")
    for panel in (above, below):
        panel.margins(x=0)
    style.legend_above(above, columns=3)
    with_cylinders = [r for r in group.runs if not lacks(r, "pressures")]
    told = []
    for other in with_cylinders:
        cylinders = other.recording.pressures
        mean = KPA * cylinders["cylinder_pressure_pa"].mean(axis=1)
        below.plot(cylinders.time_s, mean, label=other.label, **({} if len(with_cylinders) == 1 else group.line(other)))
        told.append(f"{other.label}: {_built_up(cylinders.time_s, mean)}")
    below.set_ylabel("mean cylinder pressure [kPa]")
    below.set_xlabel("time [s]")
    below.set_ylim(bottom=0.0)
    style.mark_commands(below, group.commands())
    if len(with_cylinders) > 1:
        below.legend()
    caption = (
        f"Above: pressures in pipe and reservoirs of {run.label}, above the atmosphere. Below: the mean of all "
        f"cylinders, to which the brake force is proportional. Build-up: {'; '.join(told)}."
    ) + _charged(table.time_s, table["pipe_pressure_pa"][:, 0], table["pipe_pressure_pa"][:, -1])
    return Figure("air_brake", "Air in the brake", caption + not_shown, canvas)
