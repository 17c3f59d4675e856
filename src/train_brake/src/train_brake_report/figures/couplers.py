"""Forces between the vehicles: largest along the train, and the history of one (the paper's Figures 10 and 11)."""

import numpy
from matplotlib.ticker import MaxNLocator

from train_brake_report import paper, style
from train_brake_report.figure import Figure, minus, panels_with_differences
from train_brake_report.group import Group, lacks
from train_brake_report.run import MODEL_NAMES, Run
from train_brake_report.series import common_rows

KN = 1e-3


def _forces_kn(run: Run) -> numpy.ndarray:
    return KN * run.recording.forces["coupler_force_n"]


def _why_not(run: Run) -> str:
    return lacks(run, "forces") or ("a single vehicle has no coupler" if run.vehicles < 2 else "")


def compare_largest(ours: numpy.ndarray, others: numpy.ndarray) -> tuple:
    """(mean size, largest with its sign, its connection from 1) of the difference of two runs' largest forces
    [tension, compression][connection]."""
    difference = others - ours
    side, at = numpy.unravel_index(numpy.abs(difference).argmax(), difference.shape)
    return numpy.abs(difference).mean(), difference[side, at], int(at) + 1


def _marker(connections: numpy.ndarray) -> dict:
    """A single connection is a point: a line would not show it."""
    return {"marker": "o"} if len(connections) == 1 else {}


def draw_largest(group: Group) -> Figure:
    runs, not_shown = group.drawable(_why_not)
    others, not_compared = group.comparable(runs, "forces", same_instants=False)
    first = runs[0]
    canvas, axes, below = panels_with_differences(4.6, [group.difference(run, first) for run in others])
    largest = {}
    for run in runs:
        largest[run] = KN * run.largest_coupler_forces_n
        connections = numpy.arange(1, largest[run].shape[1] + 1)
        axes.plot(connections, largest[run][0], label=run.label, **group.line(run), **_marker(connections))
        axes.plot(connections, largest[run][1], **group.line(run), **_marker(connections))
    axes.axhline(0.0, color=style.MUTED, linewidth=1.0)
    axes.set_ylabel("largest coupler force [kN]")
    for side, offset, align in (("tension", 4, "bottom"), ("compression", -5, "top")):
        axes.annotate(
            side,
            (1, 0.0),
            (4, offset),
            xycoords=("axes fraction", "data"),
            textcoords="offset points",
            ha="left",  # beside the panel: within it they would lie on curves
            va=align,
            color=style.MUTED,
        )
    style.legend_above(axes)

    of_records = [run.label for run in runs if run.couplers_file is None]
    caption = (
        "Largest tension and compression of each connection during the run; connection c joins vehicles c and "
        "c + 1. "
        + (
            "Of all exchanges (couplers.csv)."
            if not of_records
            else "Of the records of the bag."
            if len(of_records) == len(runs)
            else "Of all exchanges (couplers.csv); of " f"{' and '.join(of_records)} of the records of the bag only."
        )
    )
    for panel, run in zip(below, others):
        difference = largest[run] - largest[first]
        connections = numpy.arange(1, difference.shape[1] + 1)
        for side, values, dash in zip(("tension", "compression"), difference, ("-", (0, (3, 1.5)))):
            panel.plot(
                connections,
                values,
                linestyle=dash,
                color=group.colour(run),
                linewidth=1.4,
                label=side,
                **_marker(connections),
            )
        panel.set_ylabel("[kN]")
        style.legend_beside_title(panel)
        mean, most, connection = compare_largest(largest[first], largest[run])
        caption += (
            f" {group.difference(run, first)}: {mean:.2f} kN on average in size, at most {minus(f'{most:+.1f}')} kN at "
            f"connection {connection}."
        )
    canvas.axes[-1].set_xlabel("connection, from the front")
    canvas.axes[-1].xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    if first.vehicles == 2:
        canvas.axes[-1].set_xlim(0.5, 1.5)
    if all(run.is_of_paper for run in runs) and {"ltd", "2d"} <= {run.model for run in runs}:
        caption += _beside_the_paper(first.scenario, axes)
    return Figure(
        "largest_coupler_forces", "Largest coupler forces along the train", caption + not_compared + not_shown, canvas
    )


def _beside_the_paper(scenario: str, axes) -> str:
    if scenario != "emergency":
        return (
            " The paper finds differences below 100 kN between 2D and LTD in this scenario, 2D mostly lower: the bound "
            "is confirmed, the direction is not (docs/validation.md)."
        )
    first, last = paper.LOWER_COUPLERS
    axes.axvspan(first, last, color=style.MUTED, alpha=0.18, linewidth=0)
    axes.annotate(
        "here the paper's 2D train has\ntensions lower by more than 200 kN",
        (last, 0.0),
        (6, 40),
        textcoords="offset points",
        fontsize=9.5,
        color=style.MUTED,
    )
    return (
        f" The paper finds the 2D train up to {paper.LARGEST_DIFFERENCE_KN:g} kN lower at coupler {paper.COUPLER} "
        f"(grey: "
        "by more than 200 kN). That was NOT found here; docs/validation.md says what would make such a difference."
    )


def choose(group: Group) -> int:
    """The connection to follow: the user's, else the paper's, else the one with the largest force."""
    if group.coupler:
        return group.coupler
    runs, _ = group.drawable(_why_not)
    if runs[0].vehicles == paper.VEHICLES:
        return paper.COUPLER
    return int(numpy.abs(_forces_kn(runs[0])).max(axis=0).argmax()) + 1


def draw_history(group: Group) -> Figure:
    coupler = choose(group)
    runs, not_shown = group.drawable(
        lambda run: _why_not(run)
        or (f"there is no coupler {coupler}: the train has {run.vehicles - 1}" if run.vehicles <= coupler else "")
    )
    others, not_compared = group.comparable(runs, "forces", same_train=False)
    first = runs[0]
    canvas, axes, below = panels_with_differences(4.2, [group.difference(run, first) for run in others])
    of_paper = coupler == paper.COUPLER and first.scenario == "emergency" and all(run.is_of_paper for run in runs)
    caption = f"Force of coupler {coupler}, tension positive" + (
        " (the paper's Figure 11 draws it negative)." if of_paper else "."
    )
    history = {run: _forces_kn(run)[:, coupler - 1] for run in runs}
    for run in runs:
        table = run.recording.forces
        axes.plot(table.time_s, history[run], label=run.label, **group.line(run))
        most = history[run].argmax()
        caption += (
            f" {run.label}: largest tension {minus(f'{history[run][most]:.1f}')} kN at {table.time_s[most]:.2f} s."
        )
    axes.axhline(0.0, color=style.MUTED, linewidth=1.0)
    if of_paper:
        for run in runs:
            if run.model in paper.COUPLER_TENSION_KN:
                axes.plot(
                    paper.COUPLER_TIME_S,
                    paper.COUPLER_TENSION_KN[run.model],
                    "o",
                    markersize=9,
                    markerfacecolor="none",
                    markeredgewidth=1.8,
                    color=group.colour(run),
                    label=f"the paper, {run.label}",
                )
        printed = [
            f"{paper.COUPLER_TENSION_KN[model]:g} kN ({MODEL_NAMES[model]})"
            for model in paper.COUPLER_TENSION_KN
            if model in {run.model for run in runs}
        ]
        if printed:
            caption += f" Circles: the paper's largest tension, {', '.join(printed)}."
        if len(printed) > 1:
            caption += " That the two models part there was not found here (docs/validation.md)."
    axes.set_ylabel(f"force of coupler {coupler} [kN]")
    style.mark_commands(axes, group.commands())
    style.legend_above(axes, columns=5 if len(runs) < 3 else 3)
    for panel, run in zip(below, others):
        a, b = common_rows(first.recording.forces.time_s, run.recording.forces.time_s)
        panel.plot(
            first.recording.forces.time_s[a],
            history[run][b] - history[first][a],
            linewidth=1.4,
            color=group.colour(run),
        )
        panel.set_ylabel("[kN]")
        style.mark_commands(panel, group.commands(), named=False)
    canvas.axes[-1].set_xlabel("time [s]")
    return Figure(f"coupler_{coupler}", f"Force of coupler {coupler}", caption + not_compared + not_shown, canvas)
