"""Speed of the train over time (the paper's Figure 8)."""

import numpy

from train_brake_report import cards, paper, style
from train_brake_report.figure import Figure, minus, panels_with_differences
from train_brake_report.group import Group
from train_brake_report.run import KMH_PER_MPS
from train_brake_report.series import common_rows


def draw(group: Group) -> Figure:
    runs, not_shown = group.having("state")
    others, not_compared = group.comparable(runs, "state")
    first = runs[0]
    canvas, axes, below = panels_with_differences(4.2, [group.difference(run, first) for run in others])
    of_paper = [run for run in runs if run.is_of_paper]
    for run in runs:
        axes.plot(run.recording.state.time_s, run.mean_speed_kmh, label=run.label, **group.line(run))
    if len(runs) == 1 and first.vehicles > 1:
        speeds = KMH_PER_MPS * first.recording.state["speed_mps"]
        axes.fill_between(
            first.recording.state.time_s,
            speeds.min(axis=1),
            speeds.max(axis=1),
            color=style.BLUE,
            alpha=0.25,
            linewidth=0,
            label="slowest to fastest vehicle",
        )
    for i, run in enumerate(of_paper):
        axes.plot(
            run.end_s,
            paper.SPEED_KMH[run.model, run.scenario],
            "o",
            markersize=9,
            markerfacecolor="none",
            markeredgewidth=1.8,
            color=group.colour(run),
            clip_on=False,
            label="the paper's Table 1" if i == 0 else None,
        )
    axes.set_ylabel("mean speed [km/h]")
    style.mark_commands(axes, group.commands(), at_bottom=True)
    style.legend_above(axes)

    caption = "Mean speed of the train: its momentum over its mass."
    if first.vehicles > 1:
        apart = max(
            numpy.abs(KMH_PER_MPS * run.recording.state["speed_mps"] - run.mean_speed_kmh[:, None]).max()
            for run in runs
        )
        caption += f" Single vehicles run up to {apart:.2f} km/h faster or slower."
    for panel, run in zip(below, others):
        a, b = common_rows(first.recording.state.time_s, run.recording.state.time_s)
        difference = run.mean_speed_kmh[b] - first.mean_speed_kmh[a]
        panel.plot(first.recording.state.time_s[a], difference, color=group.colour(run), linewidth=1.8)
        panel.set_ylabel("[km/h]")
        style.mark_commands(panel, group.commands(), named=False)
        caption += (
            f" {group.difference(run, first)}: {minus(f'{difference[-1]:+.4f}')} km/h at the last common instant."
        )
    canvas.axes[-1].set_xlabel("time [s]")
    if of_paper:
        caption += f" Circles: the paper's values at the last step. {cards.calibrated({run.model for run in of_paper})}"
    return Figure("speeds", "Speed", caption + not_compared + not_shown, canvas)
