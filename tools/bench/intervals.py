"""The exchange interval: speed against error."""
import csv
import pathlib
import tempfile

import measure
import workspace
from table import Table, times

INTERVALS_MS = [1, 2, 5, 10]


def run():
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for model, repetitions in (("2d", 1), ("ltd", 3)):
            exact = None
            for interval_ms in INTERVALS_MS:
                out = pathlib.Path(folder) / f"{model}_{interval_ms}"
                wall_s = measure.median([_run(model, interval_ms, out).summary["wall_s"] for _ in range(repetitions)])
                summary, couplers = measure.summary_of(out), _couplers(out)
                if exact is None:
                    exact, first_wall_s = (summary, couplers), wall_s
                rows.append((f"{model}, {interval_ms} ms", times(first_wall_s / wall_s),
                             *_errors(summary, couplers, *exact)))
    columns = ["speed", "end [km/h]", "largest force", "any maximum", "residual"]
    return [Table("exchange interval; against 1 ms", columns, rows)], {}


def _run(model, interval_ms, out):
    return workspace.train_sim("--model", model, "--threads", 1, "--csv", "--out", out,
                               settings=[f"exchange_interval_s={interval_ms / 1000:g}"])


def _couplers(out):
    with open(out / "couplers.csv", newline="") as table:
        return [(float(row["max_tension_n"]), float(row["max_compression_n"])) for row in csv.DictReader(table)]


def _errors(summary, couplers, exact_summary, exact_couplers):
    """End speed, largest tension or compression, largest change of the maximum of any coupler, energy residual."""
    end = summary["final_speed_kmh"]["mean"] - exact_summary["final_speed_kmh"]["mean"]
    largest = max((summary[side]["value"] - exact_summary[side]["value"]
                   for side in ("max_tension_n", "max_compression_n")), key=abs)
    any_maximum = max(abs(a - b) for now, then in zip(couplers, exact_couplers) for a, b in zip(now, then))
    residual = summary["energy"]["residual_j"] / summary["energy"]["initial_j"]
    return f"{end:+.5f}", f"{largest / 1e3:+.2f} kN", f"{any_maximum / 1e3:.1f} kN", f"{residual:.0e}"
