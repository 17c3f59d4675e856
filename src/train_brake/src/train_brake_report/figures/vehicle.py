"""Of one vehicle, without a run: adhesion over creepage (the paper's Figure 3) and the modes of vibration.

The numbers come from `train_sim adhesion` and `train_sim modes`.
"""

import csv
import json
import subprocess
from typing import List

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, LeftOut, Table, new_canvas

SETS = ["paper", "dry", "wet", "low"]
SPEEDS_KMH = [5, 20, 40, 80, 120]


def _train_sim(command: List[str], *arguments: str) -> str:
    try:
        done = subprocess.run([*command, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        raise LeftOut(f"train_sim cannot be started: {error}.") from None
    if done.returncode != 0:
        raise LeftOut(f"train_sim {' '.join(arguments)}: {done.stderr.strip()}.")
    return done.stdout


def draw_adhesion(vehicle_file: str, train_sim: List[str]) -> Figure:
    canvas = new_canvas(6.6)
    panels = canvas.subplots(2, 2, sharex=True, sharey=True).ravel()
    largest = []
    for axes, surface in zip(panels, SETS):
        table = _train_sim(train_sim, "adhesion", vehicle_file, "--csv", "--set", f"wheel_rail.adhesion={surface}")
        rows = list(csv.DictReader(table.splitlines()))
        creepage = 100 * numpy.array([float(row["creepage"]) for row in rows])
        for speed, colour in zip(SPEEDS_KMH, style.COLOURS):
            adhesion = numpy.array([float(row[f"adhesion_at_{speed}_kmh"]) for row in rows])
            axes.semilogx(creepage[1:], adhesion[1:], color=colour, label=f"{speed} km/h")
            if speed == 80:
                largest.append(f"{surface} {adhesion.max():.3f}")
        axes.annotate(
            surface,
            (0, 1),
            (8, -8),
            xycoords="axes fraction",
            textcoords="offset points",
            va="top",
            fontsize=13,
            weight="bold",
        )
        axes.margins(x=0)
    style.powers_of_ten(panels[0].xaxis)
    for axes in panels[2:]:
        axes.set_xlabel("creepage [%]")
    for axes in panels[::2]:
        axes.set_ylabel("adhesion")
    panels[0].set_ylim(bottom=0)
    panels[-1].legend(loc="upper right", ncol=2)  # room above the lowest adhesion
    return Figure(
        "adhesion",
        "Adhesion characteristics",
        f"Longitudinal over normal force of a wheelset at rest load. Largest at 80 km/h: {', '.join(largest)}. With "
        "the paper's friction, 0.4 at any slip, adhesion neither depends on speed nor falls: all speeds are one line, "
        "as on low. The others are Polach's typical sets (low: assumed).",
        canvas,
    )


def mode_table(vehicle_file: str, train_sim: List[str]) -> Figure:
    told = json.loads(_train_sim(train_sim, "modes", vehicle_file, "--json"))
    return Figure(
        "modes",
        "Modes of vibration",
        f"{told['vehicle']}: {told['mass_kg']:.1f} kg, linearised about its static equilibrium, wedges without "
        f"friction. "
        f"Largest stable explicit step: {1e3 * told['largest_stable_step_s']:.3f} ms.",
        table=Table(
            ["mode", "frequency [Hz]", "damping [%]", "largest shares of the kinetic energy"],
            [
                [
                    str(number),
                    f"{mode['frequency_hz']:.3f}",
                    f"{100 * mode['damping_ratio']:.2f}",
                    ", ".join(
                        f"{motion} {100 * share:.0f} %" for motion, share in mode["largest_energy_shares"].items()
                    ),
                ]
                for number, mode in enumerate(told["modes"], 1)
            ],
        ),
    )
