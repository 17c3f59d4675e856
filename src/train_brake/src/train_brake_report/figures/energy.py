"""The train's energy: the ledger over time, and its residual."""

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, minus, new_canvas
from train_brake_report.group import Group
from train_brake_report.run import Run

MJ = 1e-6
LEAST_J = 1e-3  # what is worth a line
LARGE = 0.01  # of the energy turned over: what is seen in the stack


def _series(run: Run) -> tuple:
    """(times, energies [J] by name, initial [J], residual [J])."""
    ledger = run.recording.ledger
    time_s = numpy.array([m.header.stamp.to_sec() for m in ledger])
    energies = {
        "kinetic": numpy.array([m.kinetic_j for m in ledger]),
        "potential": numpy.array([m.potential_j for m in ledger]),
    }
    for i, element in enumerate(ledger[-1].element):
        energies[element.replace("_", " ")] = numpy.array([m.dissipated_j[i] for m in ledger])
    return time_s, energies, ledger[0].initial_j, numpy.array([m.residual_j for m in ledger])


def _why_not(run: Run) -> str:
    if len(run.recording.ledger) < 2:
        return "the recording has no two messages of the type train_brake_msgs/EnergyLedger"
    if turned_over_j(run) < LEAST_J:
        return "the train stood all the time: no energy was turned over"
    return ""


def turned_over_j(run: Run) -> float:
    """The reference of the residual, as for residual_share in summary.json: the largest of energy dissipated, change of
    stored energy, and work of gravity and traction, at the last ledger."""
    last = run.recording.ledger[-1]
    stored = last.kinetic_j + last.potential_j - last.initial_j
    return max(abs(sum(last.dissipated_j)), abs(stored), abs(last.gravity_work_j) + abs(last.traction_work_j))


def _residual_share(run: Run) -> numpy.ndarray:
    return _series(run)[3] / turned_over_j(run)


def draw(group: Group) -> Figure:
    runs, not_shown = group.drawable(_why_not)
    shown = next((run for run in runs if run.model == "2d"), runs[0])
    time_s, energies, _, _ = _series(shown)
    whole_j = turned_over_j(shown)
    canvas = new_canvas(9.6)
    stack, single, below = canvas.subplots(3, 1, sharex=True, height_ratios=[3, 4, 2])

    dissipated = {name: e for name, e in energies.items() if name not in ("kinetic", "potential")}
    ordered = sorted(dissipated, key=lambda name: -dissipated[name][-1])
    number = {name: i + 1 for i, name in enumerate(ordered)}  # its colour, the same in both pictures; 0: kinetic
    large = {"kinetic": energies["kinetic"]}
    large.update({name: dissipated[name] for name in ordered if dissipated[name][-1] > LARGE * whole_j})
    rest = sum(dissipated.values()) - sum(e for n, e in large.items() if n != "kinetic")
    bands, labels = list(large.values()) + [rest], list(large) + ["everything else"]
    colours = [style.COLOURS[number.get(name, 0) % len(style.COLOURS)] for name in large] + [style.MUTED]
    stored = numpy.maximum(0.0, energies["potential"] - energies["potential"][0])
    if stored.max() > LARGE * whole_j:
        bands.append(stored)
        labels.append("stored")
        colours.append(style.GRID)
    stack.stackplot(time_s, [MJ * e for e in bands], colors=colours, labels=labels, alpha=0.85, linewidth=0)
    stack.set_ylabel("energy [MJ]")
    style.legend_above(stack, columns=5 if len(labels) < 6 else 4)

    _draw_single(single, time_s, dissipated, number)
    shares = {run: _residual_share(run) for run in runs}
    largest = max(numpy.abs(share).max() for share in shares.values())
    scale = 10.0 ** numpy.floor(numpy.log10(largest)) if largest > 0.0 else 1.0
    for run in runs:
        below.plot(_series(run)[0], shares[run] / scale, label=run.label, marker=".", **group.line(run))
    below.set_ylabel(f"residual over energy\nturned over [{minus(f'{scale:.0e}')}]")
    below.set_xlabel("time [s]")
    if len(runs) > 1:
        style.legend_above(below)
    for axes in (stack, single, below):
        axes.margins(x=0)
        style.mark_commands(axes, group.commands(), named=axes is stack)
    caption = (
        "Top: kinetic energy, what has turned into heat and, where it shows, what springs and heights store. Middle: "
        "what "
        "each element has taken up since the start, on a "
        "logarithmic scale. Bottom: what the ledger does not account for, the error of the time integration. One value "
        "per "
        f"{numpy.median(numpy.diff(time_s)):g} s."
    )
    if len(group.runs) > 1:
        caption += f" Top and middle: {shown.label}."
    last = shown.recording.ledger[-1]
    for name, work_j in (("The grade", last.gravity_work_j), ("Traction", last.traction_work_j)):
        if abs(work_j) > LARGE * whole_j:
            caption += f" {name} {'added' if work_j > 0.0 else 'took'} {MJ * abs(work_j):.0f} MJ."
    for run in runs:
        caption += f" {run.label}: residual {minus(f'{shares[run][-1]:+.1e}')} of the energy turned over at the end."
    return Figure("energy", "Energy ledger", caption + not_shown, canvas)


def _draw_single(axes, time_s: numpy.ndarray, dissipated: dict, number: dict) -> None:
    """Every element that dissipates, over six decades and more."""
    taken = {name: e for name, e in dissipated.items() if e[-1] > LEAST_J}
    smallest = min((e[-1] for e in taken.values()), default=1.0) / 30
    ends = []
    for name, e in sorted(taken.items(), key=lambda item: -item[1][-1]):
        colour = style.COLOURS[number[name] % len(style.COLOURS)]
        axes.semilogy(
            time_s,
            numpy.where(e > smallest, e, numpy.nan),
            color=colour,
            marker=".",
            markersize=3,
            linestyle="-" if number[name] < len(style.COLOURS) else (0, (4, 2)),
        )
        ends.append((e[-1], name, colour))
    axes.set_ylabel("dissipated [J]")
    style.powers_of_ten(axes.yaxis)
    if ends:
        axes.set_ylim(bottom=smallest)
        style.label_ends(axes, ends)
