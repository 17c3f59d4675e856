"""The exchange interval: speed against error."""
import csv
import pathlib
import tempfile

import measure
import workspace
from table import Table, times

INTERVALS_MS = [1, 2, 5, 10]


def run():
    rows, facts = [], {}
    with tempfile.TemporaryDirectory() as folder:
        for model, timed_s in (("2d", 20), ("ltd", 70)):
            wall_s = measure.in_turn(3, *[lambda ms=ms: _wall_s(model, ms, timed_s) for ms in INTERVALS_MS])
            results = [_recorded(model, ms, pathlib.Path(folder) / f"{model}_{ms}") for ms in INTERVALS_MS]
            for ms, wall_s_of_it, result in zip(INTERVALS_MS, wall_s, results):
                speed = facts[f"{model}_{ms}_ms"] = measure.ratio(wall_s[0], wall_s_of_it)
                rows.append((f"{model}, {ms} ms", times(speed), *_errors(*result, *results[0])))
    columns = ["speed", "end [km/h]", "largest force", "any maximum", "residual"]
    return [Table("exchange interval; against 1 ms", columns, rows)], facts


def _wall_s(model, interval_ms, duration_s):
    """Nothing is recorded: that takes as long at any interval."""
    return workspace.train_sim(
        "--model",
        model,
        "--threads",
        1,
        settings=[f"exchange_interval_s={interval_ms / 1000:g}", f"duration_s={duration_s}"],
    ).summary["wall_s"]


def _recorded(model, interval_ms, out):
    """Summary and largest tension and compression of every coupler."""
    workspace.train_sim(
        "--model", model, "--csv", "--out", out, settings=[f"exchange_interval_s={interval_ms / 1000:g}"]
    )
    with open(out / "couplers.csv", newline="") as table:
        couplers = [(float(row["max_tension_n"]), float(row["max_compression_n"])) for row in csv.DictReader(table)]
    return measure.summary_of(out), couplers


def _errors(summary, couplers, exact_summary, exact_couplers):
    """End speed, largest tension or compression, largest change of the maximum of any coupler, energy residual."""
    end = summary["final_speed_kmh"]["mean"] - exact_summary["final_speed_kmh"]["mean"]
    largest = max(
        (summary[side]["value"] - exact_summary[side]["value"] for side in ("max_tension_n", "max_compression_n")),
        key=abs,
    )
    any_maximum = max(abs(a - b) for now, then in zip(couplers, exact_couplers) for a, b in zip(now, then))
    residual = summary["energy"]["residual_j"] / summary["energy"]["initial_j"]
    return f"{end:+.5f}", f"{largest / 1e3:+.2f} kN", f"{any_maximum / 1e3:.1f} kN", f"{residual:.0e}"
