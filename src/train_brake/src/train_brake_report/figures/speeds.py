"""Speed of the train over time (the paper's Figure 8)."""

from train_brake_report import paper, style
from train_brake_report.figure import Figure, new_canvas
from train_brake_report.group import Group
from train_brake_report.run import KMH_PER_MPS
from train_brake_report.series import common_rows


def draw(group: Group) -> Figure:
    runs = group.having("state")
    others = group.comparable(runs)
    canvas = new_canvas(5.8 if others else 4.2)
    axes, below = canvas.subplots(2, 1, sharex=True, height_ratios=[2, 1]) if others else (canvas.subplots(), None)
    of_paper = [run for run in runs if paper.is_of_paper(run)]
    for run in runs:
        look = style.run_line(group.number(run))
        axes.plot(run.recording.state.time_s, run.mean_speed_kmh, label=run.label, **look)
    if len(runs) == 1:
        speeds = KMH_PER_MPS * runs[0].recording.state["speed_mps"]
        axes.fill_between(runs[0].recording.state.time_s, speeds.min(axis=1), speeds.max(axis=1), color=style.BLUE,
                          alpha=0.25, linewidth=0, label="slowest to fastest vehicle")
    for i, run in enumerate(of_paper):
        axes.plot(run.end_s, paper.SPEED_KMH[run.model, run.scenario], "o", markersize=9, markerfacecolor="none",
                  markeredgewidth=1.8, color=style.run_line(group.number(run))["color"], clip_on=False,
                  label="the paper's Table 1, same colour" if i == 0 else None)
    axes.set_ylabel("mean speed [km/h]")
    axes.margins(x=0)
    style.mark_commands(axes, group.commands())
    style.legend_above(axes)

    caption = "Speed of the train: the mean of its momentum; single vehicles of a slack train differ from it by 1 km/h."
    for run in others:
        first = runs[0]
        a, b = common_rows(first.recording.state.time_s, run.recording.state.time_s)
        difference = run.mean_speed_kmh[b] - first.mean_speed_kmh[a]
        below.plot(first.recording.state.time_s[a], difference, color=style.run_line(group.number(run))["color"],
                   linewidth=1.8, label=f"{run.label} - {first.label}")
        caption += f" {run.label} - {first.label}: {difference[-1]:+.4f} km/h at the end."
    if others:
        below.set_ylabel("difference [km/h]")
        style.mark_commands(below, group.commands(), named=False)
    (below or axes).set_xlabel("time [s]")
    if of_paper:
        caption += (" Circles: the paper's values at the last step. LTD without rotational inertia was calibrated on them; "
                    "the others are predictions (docs/validation.md).")
    return Figure("speeds", "Speed", caption + group.without(runs, "state"), canvas)
