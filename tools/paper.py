#!/usr/bin/python3
"""Runs the paper's three scenarios with all three models and the dip, and compares the results with the paper's.

usage: tools/paper.py TRAIN_SIM RESULTS_FOLDER

Prints Table 1 of the paper (speeds at the last step) and the largest coupler forces of its Figure 10; writes all
figures into RESULTS_FOLDER/report.html. Exit code 0 when all runs completed and the page was written.
"""

import json
import pathlib
import subprocess
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "src" / "train_brake" / "src"), str(ROOT / "devel" / "lib" / "python3" / "dist-packages")]

from train_brake_report.command import main as report  # noqa: E402
from train_brake_report.figures.couplers import compare_largest  # noqa: E402
from train_brake_report.paper import COUPLER, COUPLER_TENSION_KN, MODELS, SCENARIOS, SPEED_KMH  # noqa: E402
from train_brake_report.run import read_couplers  # noqa: E402


def run(train_sim, scenario, model, out):
    command = [
        train_sim,
        "run",
        str(ROOT / "config" / "scenarios" / f"{scenario}.yaml"),
        "--model",
        model,
        "--out",
        str(out),
        "--csv",
    ]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with exit code {done.returncode}:\n{done.stderr}")
    summary = json.loads((out / "summary.json").read_text())
    summary["couplers"] = read_couplers(out / "couplers.csv")
    print(f"  {scenario:<14}{model:<16}{summary['wall_s']:7.2f} s wall for {summary['simulated_s']:g} s", flush=True)
    return summary


def print_table_1(results):
    print("\nTable 1: mean speed at the last step [km/h]; the paper's value, the difference")
    print(f"{'':<17}" + "".join(f"{s:^28}" for s in SCENARIOS))
    for model in MODELS:
        row = f"{model:<17}"
        for scenario in SCENARIOS:
            ours = results[scenario, model]["final_speed_kmh"]["mean"]
            paper = SPEED_KMH[model, scenario]
            row += f"{ours:10.3f}{paper:8.2f}{round(ours - paper, 3) + 0.0:+8.3f}  "
        print(row)


def print_figure_10(results):
    print("\nFigure 10: largest coupler forces [kN] and where (connection); difference 2d - ltd over all connections")
    print(
        f"{'':<17}{'ltd tension':>18}{'2d tension':>18}{'ltd compression':>18}{'2d compression':>18}"
        f"{'mean diff.':>12}{'largest':>16}"
    )
    for scenario in SCENARIOS:
        row = f"{scenario:<17}"
        for key, column in (("max_tension_n", "max_tension_n"), ("max_compression_n", "max_compression_n")):
            for model in ("ltd", "2d"):
                extreme = results[scenario, model][key]
                row += f"{extreme['value'] / 1e3:12.1f} @{extreme['connection']:>4d}"
        mean, largest, where = compare_largest(
            *(
                numpy.array(
                    [results[scenario, model]["couplers"][side] for side in ("max_tension_n", "max_compression_n")]
                )
                for model in ("ltd", "2d")
            )
        )
        row += f"{mean / 1e3:12.2f}{largest / 1e3:+10.1f} @{where:>4d}"
        print(row)
    print(f"\nCoupler {COUPLER}, emergency, largest tension [kN]:")
    for model in ("ltd", "2d"):
        largest_n, time_s = (
            results["emergency", model]["couplers"][name][COUPLER - 1]
            for name in ("max_tension_n", "max_tension_time_s")
        )
        print(
            f"  {model:<6}{largest_n / 1e3:8.1f} at {time_s:.2f} s"
            f"   (the paper: {COUPLER_TENSION_KN[model]:g} near 35 s)"
        )


def print_energy(results):
    print("\nEnergy ledger: residual over initial energy")
    for scenario in SCENARIOS:
        ledgers = {model: results[scenario, model]["energy"] for model in MODELS}
        shares = (f"{model:>16} {one['residual_j'] / one['initial_j']:+.1e}" for model, one in ledgers.items())
        print(f"  {scenario:<15}" + "".join(shares))


def write_page(train_sim, folder):
    # In this order: differences are taken to the first, LTD with inertia.
    runs = [folder / f"{s}_{m}" for s in SCENARIOS for m in ("ltd", "2d", "ltd-no-inertia")]
    return report(
        [
            *map(str, runs),
            str(folder / "dip"),
            "--by-scenario",
            "--vehicle",
            str(ROOT / "config" / "vehicles" / "ore_wagon.yaml"),
            "--out",
            str(folder / "report.html"),
        ],
        [train_sim],
    )


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    train_sim, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    print("Ten runs, recorded in", folder)
    results = {(s, m): run(train_sim, s, m, folder / f"{s}_{m}") for s in SCENARIOS for m in MODELS}
    run(train_sim, "dip", "2d", folder / "dip")
    print_table_1(results)
    print_figure_10(results)
    print_energy(results)
    wall = sum(r["wall_s"] for r in results.values())
    print(f"\n{sum(r['simulated_s'] for r in results.values()):g} s of train in {wall:.1f} s", flush=True)
    sys.exit(write_page(train_sim, folder))


if __name__ == "__main__":
    main()
