#!/usr/bin/python3
"""Draws the figures of docs/air_brake.md from runs of the shipped scenarios.

usage: tools/air_brake_figures.py TRAIN_SIM [FOLDER]

Runs what it needs in a temporary folder (LTD, under a minute) and writes docs/images/air_brake_*.png, or into FOLDER.
"""

import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")

import numpy  # noqa: E402
from matplotlib import pyplot  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "src" / "train_brake" / "src"), str(ROOT / "devel" / "lib" / "python3" / "dist-packages")]

import train_brake  # noqa: E402
from train_brake_report import style  # noqa: E402

KPA = 1e-3


def run(train_sim, folder, scenario, name, *overrides):
    out = folder / name
    command = [
        train_sim,
        "run",
        str(ROOT / "config" / "scenarios" / f"{scenario}.yaml"),
        "--model",
        "ltd",
        "--out",
        str(out),
    ]
    for override in overrides:
        command += ["--set", override]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with exit code {done.returncode}:\n{done.stderr}")
    return train_brake.load(str(out))["brake_pressures"]


def picture(axes, table, field, end_s, label):
    rows = table.time_s <= end_s
    values = KPA * table[field][rows].T
    image = axes.imshow(
        values,
        aspect="auto",
        interpolation="nearest",
        cmap=style.SEQUENTIAL,
        extent=(0.0, table.time_s[rows][-1], values.shape[0] + 0.5, 0.5),
    )
    axes.grid(False)
    axes.set_xlabel("time [s]")
    axes.figure.colorbar(image, ax=axes, label=label, aspect=25, pad=0.02).outline.set_visible(False)


def save(figure, folder, name):
    figure.savefig(folder / f"air_brake_{name}.png", dpi=80, facecolor="white", pil_kwargs={"optimize": True})
    pyplot.close(figure)
    print(folder / f"air_brake_{name}.png")


def service(table, out):
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 3.8), sharey=True, layout="constrained")
    picture(left, table, "pipe_pressure_pa", 60.0, "brake pipe [kPa]")
    picture(right, table, "cylinder_pressure_pa", 60.0, "cylinder [kPa]")
    left.set_ylabel("vehicle")
    save(figure, out, "service")


def pipe_and_reservoir(axes, table, vehicle, colour):
    for quantity, label, dashes in (
        ("pipe_pressure_pa", "pipe", "-"),
        ("auxiliary_reservoir_pa", "auxiliary reservoir", (0, (4, 2))),
    ):
        values = KPA * table[quantity][:, vehicle - 1]
        axes.plot(table.time_s, values, color=colour, linestyle=dashes, label=f"{label}, vehicle {vehicle}")


def charging(table, out):
    figure, axes = pyplot.subplots(figsize=(11, 3.6), layout="constrained")
    last = table["pipe_pressure_pa"].shape[1]
    for vehicle, colour in zip((1, (last + 1) // 2, last), style.COLOURS):
        pipe_and_reservoir(axes, table, vehicle, colour)
    tail = table["pipe_pressure_pa"][:, -1]
    goal = 0.95 * table["pipe_pressure_pa"][-1, 0]
    at_s = table.time_s[numpy.argmax(tail >= goal)]
    axes.axvline(at_s, color=style.MUTED, linestyle=(0, (1, 2)))
    axes.annotate(f"tail at 95 %: {at_s:.0f} s", (at_s, 250.0), (4, 0), textcoords="offset points", color=style.MUTED)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("pressure [kPa]")
    axes.margins(x=0)
    axes.legend(ncol=3, loc="lower right", fontsize=9)
    save(figure, out, "charging")


def second_application(table, out):
    figure, (above, below) = pyplot.subplots(2, 1, figsize=(11, 7.0), sharex=True, layout="constrained")
    picture(above, table, "cylinder_pressure_pa", table.time_s[-1], "cylinder [kPa]")
    above.set_xlabel("")
    above.set_ylabel("vehicle")
    last = table["pipe_pressure_pa"].shape[1]
    for vehicle, colour in ((1, style.BLUE), (last, style.VERMILLION)):
        pipe_and_reservoir(below, table, vehicle, colour)
    for time_s, text in ((5, "70 kPa"), (65, "release"), (80, "50 kPa"), (180, "100 kPa")):
        for axes in (above, below):
            axes.axvline(time_s, color=style.MUTED, linestyle=(0, (1, 2)))
        below.annotate(
            text,
            (time_s, 1.0),
            (3, -10),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            fontsize=9,
            color=style.MUTED,
        )
    below.set_xlabel("time [s]")
    below.set_ylabel("pressure [kPa]")
    below.legend(loc="upper right", fontsize=9)
    save(figure, out, "second_application")


def build_up(tables, out):
    figure, axes = pyplot.subplots(figsize=(11, 3.6), layout="constrained")
    for (label, table), colour in zip(tables.items(), style.COLOURS):
        mean = table["cylinder_pressure_pa"].mean(axis=1)
        axes.plot(table.time_s - 2.0, 100.0 * mean / mean[-1], color=colour, label=label)
    axes.axvline(10.0, color=style.MUTED, linestyle=(0, (1, 2)))
    axes.set_xlim(0.0, 30.0)
    axes.set_ylim(0.0, 105.0)
    axes.set_xlabel("time after the emergency's command [s]")
    axes.set_ylabel("mean cylinder [% of its end]")
    axes.legend(loc="lower right")
    save(figure, out, "build_up")


def against_empirical(pairs, out):
    figure, panels = pyplot.subplots(
        2, 2, figsize=(11, 7.2), sharey="col", layout="constrained", gridspec_kw={"width_ratios": [3, 2]}
    )
    for (title, end_s, tables), (left, right) in zip(pairs, panels):
        for vehicle, colour in zip((1, 61, 122, 182, 242), style.COLOURS):
            for (kind, table), line in zip(tables.items(), ("-", (0, (4, 2)))):
                left.plot(
                    table.time_s,
                    KPA * table["cylinder_pressure_pa"][:, vehicle - 1],
                    color=colour,
                    linestyle=line,
                    linewidth=1.5,
                    label=f"vehicle {vehicle}" if line == "-" else None,
                )
        left.set_xlim(0.0, end_s)
        left.set_title(f"{title}: {' (lines), '.join(tables)} (dashed)", loc="left", fontsize=11)
        left.set_ylabel("cylinder [kPa]")
        for (kind, table), colour in zip(tables.items(), (style.INK, style.VERMILLION)):
            pressure = table["cylinder_pressure_pa"]
            begun = pressure > 2e3
            arrival = numpy.where(begun.any(axis=0), table.time_s[begun.argmax(axis=0)], numpy.nan)
            right.plot(arrival, numpy.arange(1, pressure.shape[1] + 1), color=colour, label=kind)
        right.set_ylim(pressure.shape[1] + 0.5, 0.5)
        right.set_xlim(left=0.0)
        right.set_ylabel("vehicle")
        right.set_title("first air in the cylinder (2 kPa)", loc="left", fontsize=11)
        right.legend(loc="upper right", fontsize=9)
    panels[0][0].legend(ncol=2, loc="lower right", fontsize=9)
    for axes in panels[1]:
        axes.set_xlabel("time [s]")
    save(figure, out, "against_empirical")


def main(train_sim, out):
    with tempfile.TemporaryDirectory() as temporary, style.applied():
        folder = pathlib.Path(temporary)

        def of(scenario, *overrides):
            return run(train_sim, folder, scenario, f"run_{len(list(folder.iterdir()))}", *overrides)

        service(of("full_service_ab", "duration_s=62"), out)
        charging(of("charging"), out)
        second_application(of("cycle_braking_long_grade"), out)
        build_up(
            {
                "ECP": of("ecp_against_head_end"),
                "AB, vented at the head": of("ecp_against_head_end", "brake=ab_head_end"),
                "AB with a two-way End-of-Train device": of(
                    "ecp_against_head_end",
                    "brake=ab_head_end",
                    "brake.sources=[{name: driver, vehicle: 1, kind: driver}, {name: device, vehicle: -1, kind: "
                    "end_of_train, "
                    "radio_delay_s: 1}]",
                ),
            },
            out,
        )
        pairs = []
        for title, end_s, command in (
            ("emergency", 15.0, "emergency"),
            ("full service", 60.0, "apply, reduction_kpa: 170"),
        ):
            pairs.append(
                (
                    title,
                    end_s,
                    {
                        brake: of(
                            "emergency_ab",
                            f"brake={brake}",
                            f"commands=[{{time_s: 0, kind: {command}}}]",
                            f"duration_s={end_s}",
                        )
                        for brake in ("calibrated", "ab_distributed")
                    },
                )
            )
        against_empirical(pairs, out)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(sys.argv[1], pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else ROOT / "docs" / "images")
