#!/usr/bin/python3
"""Runs the paper's three scenarios with all three models and prints what came out beside the paper.

usage: tools/paper.py TRAIN_SIM RESULTS_FOLDER

Table 1 of the paper (speeds at the last step) and the largest coupler forces of its Figure 10.
Exit code 0 when all nine runs completed.
"""

import csv
import json
import pathlib
import subprocess
import sys

SCENARIOS = ["emergency", "full_service", "minimum"]
MODELS = ["ltd-no-inertia", "ltd", "2d"]
# Wu, Cole & Spiryagin 2020, Table 1 [km/h]
PAPER_SPEED = {
    ("ltd-no-inertia", "emergency"): 3.97, ("ltd-no-inertia", "full_service"): 1.05, ("ltd-no-inertia", "minimum"): 77.29,
    ("ltd", "emergency"): 9.86, ("ltd", "full_service"): 7.20, ("ltd", "minimum"): 77.45,
    ("2d", "emergency"): 9.94, ("2d", "full_service"): 7.18, ("2d", "minimum"): 77.42,
}
# The paper's text names two maxima of its Figure 11, coupler 105 in the emergency run [kN].
PAPER_COUPLER_105 = {"ltd": 750.0, "2d": 484.0}


def run(train_sim, scenario, model, out):
    command = [train_sim, "run", f"config/scenarios/{scenario}.yaml", "--model", model, "--out", str(out), "--csv"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with exit code {done.returncode}:\n{done.stderr}")
    summary = json.loads((out / "summary.json").read_text())
    with open(out / "couplers.csv", newline="") as table:
        summary["couplers"] = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(table)]
    print(f"  {scenario:<14}{model:<16}{summary['wall_s']:7.2f} s wall for {summary['simulated_s']:g} s", flush=True)
    return summary


def print_table_1(results):
    print("\nTable 1: mean speed at the last step [km/h]; the paper's value, the difference")
    print(f"{'':<17}" + "".join(f"{s:^28}" for s in SCENARIOS))
    for model in MODELS:
        row = f"{model:<17}"
        for scenario in SCENARIOS:
            ours = results[scenario, model]["final_speed_kmh"]["mean"]
            paper = PAPER_SPEED[model, scenario]
            row += f"{ours:10.3f}{paper:8.2f}{ours - paper:+8.3f}  "
        print(row)


def print_figure_10(results):
    print("\nFigure 10: largest coupler forces [kN] and where (connection); difference 2d - ltd over all connections")
    print(f"{'':<17}{'ltd tension':>18}{'2d tension':>18}{'ltd compression':>18}{'2d compression':>18}"
          f"{'mean diff.':>12}{'largest':>16}")
    for scenario in SCENARIOS:
        row = f"{scenario:<17}"
        for key, column in (("max_tension_n", "max_tension_n"), ("max_compression_n", "max_compression_n")):
            for model in ("ltd", "2d"):
                extreme = results[scenario, model][key]
                row += f"{extreme['value'] / 1e3:12.1f} @{extreme['connection']:>4d}"
        difference = [(b[side] - a[side], int(a["connection"]))
                      for side in ("max_tension_n", "max_compression_n")
                      for a, b in zip(results[scenario, "ltd"]["couplers"], results[scenario, "2d"]["couplers"])]
        mean = sum(abs(d) for d, _ in difference) / len(difference)
        largest, where = max(difference, key=lambda d: abs(d[0]))
        row += f"{mean / 1e3:12.2f}{largest / 1e3:+10.1f} @{where:>4d}"
        print(row)
    print("\nCoupler 105, emergency, largest tension [kN]:")
    for model in ("ltd", "2d"):
        extreme = results["emergency", model]["couplers"][104]
        print(f"  {model:<6}{extreme['max_tension_n'] / 1e3:8.1f} at {extreme['max_tension_time_s']:.2f} s"
              f"   (the paper: {PAPER_COUPLER_105[model]:g} near 35 s)")


def print_energy(results):
    print("\nEnergy ledger: residual over initial energy")
    for scenario in SCENARIOS:
        print(f"  {scenario:<15}" + "".join(
            f"{model:>16} {results[scenario, model]['energy']['residual_j'] / results[scenario, model]['energy']['initial_j']:+.1e}"
            for model in MODELS))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    train_sim, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    print("Nine runs, recorded in", folder)
    results = {(s, m): run(train_sim, s, m, folder / f"{s}_{m}") for s in SCENARIOS for m in MODELS}
    print_table_1(results)
    print_figure_10(results)
    print_energy(results)
    wall = sum(r["wall_s"] for r in results.values())
    print(f"\n{sum(r['simulated_s'] for r in results.values()):g} s of train in {wall:.1f} s")


if __name__ == "__main__":
    main()
