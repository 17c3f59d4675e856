"""Slides of wheelsets over time, their locks, and where wheels wear the track."""

import csv
import pathlib
from typing import Dict, Sequence

import numpy
from train_brake.bag import BagError
from train_brake.run import text_of

from train_brake_report import style
from train_brake_report.figure import Figure, Table, new_canvas
from train_brake_report.group import Group
from train_brake_report.run import Run

KJ, KN = 1e-3, 1e-3
FLAT_RISK_J = 30e3
MOST_ROWS = 40
OF_SLIDES = (
    "vehicle",
    "wheelset",
    "start_s",
    "end_s",
    "slid_m",
    "locked_s",
    "locked_m",
    "longest_lock_from_s",
    "longest_lock_s",
    "largest_lock_j",
    "energy_j",
    "largest_adhesion",
)
OF_WEAR = ("from_m", "creep_j", "brake_j")


def _columns(file: pathlib.Path, needed: Sequence[str]) -> Dict[str, numpy.ndarray]:
    """@raises BagError"""
    reader = csv.DictReader(text_of(file).splitlines())
    rows = list(reader)
    missing = [name for name in needed if name not in (reader.fieldnames or [])]
    if missing:
        raise BagError(f"{file} is damaged: it has no column {', '.join(missing)}")
    try:
        return {name: numpy.array([float(row[name]) for row in rows]) for name in reader.fieldnames or []}
    except (TypeError, ValueError) as error:
        raise BagError(f"{file} is damaged: {error}") from None


def _why_no_slides(run: Run) -> str:
    if run.slides_file is None:
        return "no wheelset slid (there is no slides.csv beside the bag)"
    return "" if len(_columns(run.slides_file, OF_SLIDES)["vehicle"]) else "no wheelset slid"


def draw_slides(group: Group) -> Figure:
    """Of the first run in which a wheelset slid."""
    runs, not_shown = group.drawable(_why_no_slides)
    run = runs[0]
    slides = _columns(run.slides_file, OF_SLIDES)
    wheelsets = sorted(set(zip(slides["vehicle"].astype(int), slides["wheelset"].astype(int))))
    energy = {
        w: slides["energy_j"][(slides["vehicle"] == w[0]) & (slides["wheelset"] == w[1])].sum() for w in wheelsets
    }
    shown = sorted(sorted(wheelsets, key=lambda w: -energy[w])[:MOST_ROWS])
    canvas = new_canvas(1.8 + 0.28 * max(6, len(shown)))
    axes = canvas.subplots()
    for row, (vehicle, wheelset) in enumerate(shown):
        mine = (slides["vehicle"] == vehicle) & (slides["wheelset"] == wheelset)
        axes.broken_barh(
            list(zip(slides["start_s"][mine], (slides["end_s"] - slides["start_s"])[mine])),
            (row - 0.3, 0.6),
            color=style.SKY,
            label="slides" if row == 0 else None,
        )
        locked = mine & (slides["longest_lock_s"] > 0)
        axes.broken_barh(
            list(zip(slides["longest_lock_from_s"][locked], slides["longest_lock_s"][locked])),
            (row - 0.3, 0.6),
            color=style.VERMILLION,
            label=None,
        )
    axes.plot([], [], color=style.VERMILLION, linewidth=8, label="locked")
    axes.set_yticks(range(len(shown)), [f"{v}.{w}" for v, w in shown])
    axes.set_ylim(len(shown) - 0.4, -0.6)
    axes.set_xlim(0.0, run.end_s)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("vehicle.wheelset")
    style.legend_above(axes)
    risks = int((slides["largest_lock_j"] > FLAT_RISK_J).sum())
    rows = []
    for v, w in sorted(wheelsets, key=lambda each: -energy[each])[:12]:
        mine = (slides["vehicle"] == v) & (slides["wheelset"] == w)
        rows.append(
            [
                f"{v}.{w}",
                f"{mine.sum()}",
                f"{slides['slid_m'][mine].sum():.1f}",
                f"{slides['locked_s'][mine].sum():.1f}",
                f"{slides['locked_m'][mine].sum():.1f}",
                f"{KJ * energy[(v, w)]:.1f}",
                f"{KJ * slides['largest_lock_j'][mine].max():.1f}",
                f"{slides['largest_adhesion'][mine].max():.3f}",
            ]
        )
    table = Table(
        [
            "vehicle.wheelset",
            "slides",
            "slid [m]",
            "locked [s]",
            "locked [m]",
            "energy [kJ]",
            "largest lock [kJ]",
            "largest adhesion",
        ],
        rows,
    )
    caption = (
        f"{run.label}: {len(slides['vehicle'])} slide(s) of {len(wheelsets)} wheelset(s): creepage above 0.3 for at "
        f"least "
        "0.2 s, above 3 km/h"
        + (f"; the {MOST_ROWS} with the most energy are drawn" if len(wheelsets) > MOST_ROWS else "")
        + ". Of each slide its longest lock is marked. "
        + (f"{risks} lock(s) took more than 30 kJ: risk of a flat." if risks else "No lock took more than 30 kJ.")
        + not_shown
    )
    return Figure("wheel_slides", "Wheels that slide", caption, canvas, table)


def draw_wear(group: Group) -> Figure:
    def why_not(run: Run) -> str:
        if run.track_wear_file is None:
            return "there is no track_wear.csv beside the bag"
        return "" if len(_columns(run.track_wear_file, OF_WEAR)["from_m"]) > 1 else "no wheelset of the 2D model ran"

    runs, not_shown = group.drawable(why_not)
    canvas = new_canvas(6.0)
    above, below = canvas.subplots(2, 1, sharex=True)
    for run in runs:
        wear = _columns(run.track_wear_file, OF_WEAR)
        for axes, column in ((above, "creep_j"), (below, "brake_j")):
            axes.step(wear["from_m"], KN * wear[column], where="post", label=run.label, **group.line(run))
    above.set_ylabel("sum of T\u03b3 [kN]")
    below.set_ylabel("sum of brake forces [kN]")
    below.set_xlabel("position along the track [m]")
    for axes in (above, below):
        axes.margins(x=0)
    if len(runs) > 1:
        style.legend_above(above)
    wear = _columns(runs[0].track_wear_file, OF_WEAR)
    worst = int(wear["creep_j"].argmax())
    caption = (
        f"Of all wheelsets that ran over each metre, both wheels: energy lost in creep (wear of wheel and rail), and "
        f"work "
        f"of the braking force on the rail. {runs[0].label}: {KJ * wear['creep_j'].sum():.0f} kJ in creep in all; "
        f"most, "
        f"{KJ * wear['creep_j'][worst]:.2f} kJ, on the metre at {wear['from_m'][worst]:.0f} m.{not_shown}"
    )
    return Figure("track_wear", "Wear and brake force along the track", caption, canvas)
