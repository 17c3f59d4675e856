#!/usr/bin/python3
"""Runs the ensemble of the study `couplers/paper_lugre` and draws it beside Figures 10 and 11 of the paper.

    tools/paper_lugre.py OUT_FOLDER [--starts 36] [--jobs 2]

The emergency of the paper's train from 79.9 to 80.1 km/h, in LTD and in 2D; a few minutes on two cores. Runs that
OUT_FOLDER holds already are not repeated.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402
import numpy  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIRST_KMH, LAST_KMH = 79.9, 80.1
COUPLER = 105
NAMED = range(99, 117)  # the connections that the paper's text names
PAPER_KN = {"ltd": 750.0, "2d": 484.0}  # of coupler 105, and 266 kN between them
SECOND_INCREASE_KN = 700.0


def run(train_sim: str, model: str, start_kmh: float, folder: pathlib.Path) -> numpy.ndarray:
    """Largest tension of each connection [kN]."""
    if not (folder / "couplers.csv").exists() or not json.loads((folder / "summary.json").read_text())["complete"]:
        command = [
            train_sim,
            "run",
            str(ROOT / "config/scenarios/emergency.yaml"),
            "--model",
            model,
            "--threads",
            "1",
            "--set",
            "train.connection=paper_lugre",
            "--set",
            f"initial_speed_kmh={start_kmh:.6f}",
            "--checkpoint-interval",
            "0",
            "--set",
            "record_interval_s=1",
            "--set",
            "detail_vehicles=[]",
            "--out",
            str(folder),
        ]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    with open(folder / "couplers.csv", newline="") as table:
        return 1e-3 * numpy.array([float(row["max_tension_n"]) for row in csv.DictReader(table)])


def draw(starts: numpy.ndarray, tension: dict, file: pathlib.Path) -> None:
    figure, (above, below) = pyplot.subplots(2, 1, figsize=(10, 8))
    colours = {"ltd": "#0072b2", "2d": "#d55e00"}
    for model, values in tension.items():
        above.plot(starts, values[:, COUPLER - 1], "o", color=colours[model], label=f"coupler {COUPLER}, {model}")
        above.axhline(
            PAPER_KN[model], color=colours[model], linestyle=(0, (4, 3)), linewidth=1.0, label=f"paper, {model}"
        )
    above.set_xlabel("start speed [km/h]")
    above.set_ylabel("largest tension [kN]")
    above.legend(ncol=4, loc="lower left", bbox_to_anchor=(0, 1), frameon=False)
    difference = tension["2d"] - tension["ltd"]
    connections = numpy.arange(1, difference.shape[1] + 1)
    mean, error = difference.mean(axis=0), difference.std(axis=0, ddof=1) / numpy.sqrt(len(starts))
    below.fill_between(connections, mean - error, mean + error, color="#56b4e9", alpha=0.5, label="standard error")
    below.plot(connections, mean, color="#0072b2", label="mean of 2D - LTD")
    below.axvspan(NAMED[0], NAMED[-1], color="#d8dde3", zorder=0, label="connections of the paper's text")
    below.set_xlabel("connection")
    below.set_ylabel("difference [kN]")
    below.legend(ncol=3, loc="lower left", bbox_to_anchor=(0, 1), frameon=False)
    figure.tight_layout()
    figure.savefig(file, dpi=120)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--starts", type=int, default=36)
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time")
    parser.add_argument("--train-sim", default=str(ROOT / "devel/lib/train_sim/train_sim"))
    options = parser.parse_args()
    if options.starts < 2:
        parser.error("--starts must be at least 2")
    starts = numpy.linspace(FIRST_KMH, LAST_KMH, options.starts)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = {
            model: [
                pool.submit(run, options.train_sim, model, start, options.out / f"{model}_{start:.6f}")
                for start in starts
            ]
            for model in PAPER_KN
        }
        try:
            tension = {model: numpy.array([job.result() for job in of]) for model, of in jobs.items()}
        except subprocess.CalledProcessError as error:
            for of in jobs.values():
                for job in of:
                    job.cancel()
            print(f"paper_lugre: {' '.join(error.cmd)} failed:\n{error.stderr.decode()}", file=sys.stderr)
            return 1
    difference = tension["2d"] - tension["ltd"]
    named = difference[:, [c - 1 for c in NAMED]].mean(axis=1)
    for model, values in tension.items():
        one = values[:, COUPLER - 1]
        print(
            f"{model:>4}: coupler {COUPLER} {one.mean():.0f} +- {one.std(ddof=1):.0f} kN (paper "
            f"{PAPER_KN[model]:.0f}); over "
            f"{SECOND_INCREASE_KN:.0f} kN in {(one > SECOND_INCREASE_KN).sum()} of {len(one)} runs"
        )
    for name, values in ((f"{NAMED[0]}-{NAMED[-1]}", named), ("all", difference.mean(axis=1))):
        print(
            f"2D - LTD, connections {name}: {values.mean():+.1f} +- {values.std(ddof=1) / numpy.sqrt(len(values)):.1f} "
            f"kN"
        )
    draw(starts, tension, options.out / "paper_lugre.png")
    print(options.out / "paper_lugre.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
