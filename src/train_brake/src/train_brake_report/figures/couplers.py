"""Forces between the vehicles: largest along the train, and the history of one (the paper's Figures 10 and 11)."""

import numpy
from matplotlib.ticker import MaxNLocator

from train_brake_report import paper, style
from train_brake_report.figure import Figure, LeftOut, panels_with_differences
from train_brake_report.group import Group
from train_brake_report.run import Run
from train_brake_report.series import common_rows

KN = 1e-3


def _forces_kn(run: Run) -> numpy.ndarray:
    return KN * run.recording.forces["coupler_force_n"]


def _runs_with_couplers(group: Group) -> list:
    runs = group.having("forces")
    if runs[0].vehicles < 2:
        raise LeftOut("A single vehicle has no coupler.")
    return runs


def draw_largest(group: Group) -> Figure:
    runs = _runs_with_couplers(group)
    first, others = runs[0], group.comparable(runs)
    canvas, axes, below = panels_with_differences(4.6, [group.difference(run, first) for run in others])
    largest = {}
    for run in runs:
        forces = _forces_kn(run)
        largest[run] = numpy.array([numpy.maximum(forces.max(axis=0), 0.0), numpy.minimum(forces.min(axis=0), 0.0)])
        connections = numpy.arange(1, forces.shape[1] + 1)
        axes.plot(connections, largest[run][0], label=run.label, **group.line(run))
        axes.plot(connections, largest[run][1], **group.line(run))
    axes.axhline(0.0, color=style.MUTED, linewidth=1.0)
    axes.set_ylabel("largest coupler force [kN]")
    for side, offset, align in (("tension", 4, "bottom"), ("compression", -5, "top")):
        axes.annotate(side, (1, 0.0), (-4, offset), xycoords=("axes fraction", "data"), textcoords="offset points",
                      ha="right", va=align, color=style.MUTED)
    style.legend_above(axes)

    caption = ("Largest tension and compression of each connection during the run; connection c joins vehicles c and "
               "c + 1. From the records of the bag" + ("; the cards have the largest of all exchanges." if first.summary else "."))
    for panel, run in zip(below, others):
        difference = largest[run] - largest[first]
        connections = numpy.arange(1, difference.shape[1] + 1)
        for side, values, dash in zip(("tension", "compression"), difference, ("-", (0, (3, 1.5)))):
            panel.plot(connections, values, linestyle=dash, color=group.colour(run), linewidth=1.4, label=side)
        panel.set_ylabel("[kN]")
        style.legend_inside(panel)
        side, at = numpy.unravel_index(numpy.abs(difference).argmax(), difference.shape)
        caption += (f" {group.difference(run, first)}: {numpy.abs(difference).mean():.2f} kN on average in size, at most "
                    f"{difference[side, at]:+.1f} kN at connection {at + 1}.")
    canvas.axes[-1].set_xlabel("connection, from the front")
    canvas.axes[-1].xaxis.set_major_locator(MaxNLocator(integer=True))
    if all(paper.is_of_paper(run) for run in runs) and {"ltd", "2d"} <= {run.model for run in runs}:
        caption += _beside_the_paper(first.scenario, axes)
    return Figure("largest_coupler_forces", "Largest coupler forces along the train", caption + group.without(runs, "forces"),
                  canvas)


def _beside_the_paper(scenario: str, axes) -> str:
    if scenario != "emergency":
        return (" The paper finds differences below 100 kN between 2D and LTD in this scenario, 2D mostly lower: the bound "
                "is confirmed, the direction is not (docs/validation.md).")
    first, last = paper.LOWER_COUPLERS
    axes.axvspan(first, last, color=style.MUTED, alpha=0.18, linewidth=0)
    axes.annotate("here the paper's 2D train has\ntensions lower by more than 200 kN", (last, 0.0), (6, 40),
                  textcoords="offset points", fontsize=9.5, color=style.MUTED)
    return (f" The paper finds the 2D train up to {paper.LARGEST_DIFFERENCE_KN:g} kN lower at coupler {paper.COUPLER} (grey: "
            "by more than 200 kN). That was NOT found here; docs/validation.md says what would make such a difference.")


def choose(group: Group) -> int:
    """The connection to follow: the user's, else the paper's, else the one with the largest force."""
    runs = _runs_with_couplers(group)
    connections = runs[0].vehicles - 1
    if group.coupler:
        if group.coupler > connections:
            raise LeftOut(f"There is no coupler {group.coupler}: the train has {connections}.")
        return group.coupler
    if runs[0].vehicles == paper.VEHICLES:
        return paper.COUPLER
    return int(numpy.abs(_forces_kn(runs[0])).max(axis=0).argmax()) + 1


def draw_history(group: Group) -> Figure:
    coupler = choose(group)
    runs = [run for run in _runs_with_couplers(group) if run.vehicles > coupler]
    first, others = runs[0], runs[1:]
    canvas, axes, below = panels_with_differences(4.2, [group.difference(run, first) for run in others])
    caption = f"Force of coupler {coupler}, tension positive (the paper's Figure 11 draws it negative)."
    history = {run: _forces_kn(run)[:, coupler - 1] for run in runs}
    for run in runs:
        table = run.recording.forces
        axes.plot(table.time_s, history[run], label=run.label, **group.line(run))
        most = history[run].argmax()
        caption += f" {run.label}: largest tension {history[run][most]:.1f} kN at {table.time_s[most]:.2f} s."
    axes.axhline(0.0, color=style.MUTED, linewidth=1.0)
    if coupler == paper.COUPLER and first.scenario == "emergency" and all(paper.is_of_paper(run) for run in runs):
        for run in runs:
            if run.model in paper.COUPLER_TENSION_KN:
                axes.plot(paper.COUPLER_TIME_S, paper.COUPLER_TENSION_KN[run.model], "o", markersize=9,
                          markerfacecolor="none", markeredgewidth=1.8, color=group.colour(run),
                          label=f"the paper, {run.label}")
        caption += (" Circles: the paper's largest tensions, 750 kN in LTD and 484 kN in 2D. That the two models part there "
                    "was not found here (docs/validation.md).")
    axes.set_ylabel(f"force of coupler {coupler} [kN]")
    style.mark_commands(axes, group.commands())
    style.legend_above(axes, columns=5 if len(runs) < 3 else 3)
    for panel, run in zip(below, others):
        a, b = common_rows(first.recording.forces.time_s, run.recording.forces.time_s)
        panel.plot(first.recording.forces.time_s[a], history[run][b] - history[first][a], linewidth=1.4,
                   color=group.colour(run))
        panel.set_ylabel("[kN]")
        style.mark_commands(panel, group.commands(), named=False)
    canvas.axes[-1].set_xlabel("time [s]")
    return Figure(f"coupler_{coupler}", f"Force of coupler {coupler}", caption + group.without(runs, "forces"), canvas)
