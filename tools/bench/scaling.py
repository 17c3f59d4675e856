"""Trains of 10 to 2000 vehicles in one process: time per vehicle-step, memory per vehicle."""
import measure
import workspace
from table import Table, number

SIZES = [10, 20, 50, 100, 242, 500, 1000, 2000]
VEHICLE_STEPS = {"2d": 3e6, "ltd": 2e7}  # of a measurement
LONGEST_S = 40.0     # the train is still moving then


def run():
    results = {(model, size): _measure(model, size) for model in ("2d", "ltd") for size in SIZES}
    rows, facts = [], {}
    for model in ("2d", "ltd"):
        ns = {size: results[model, size][0] for size in SIZES}
        rows.append((f"{model} [ns per vehicle-step]", *[number(ns[size]) for size in SIZES]))
        long = [ns[size] for size in SIZES if size >= 50]
        facts[f"{model}_spread"] = max(long) / min(long) - 1
        per_vehicle = (results[model, 2000][1] - results[model, 242][1]) / (2000 - 242)
        facts[f"{model}_bytes_per_vehicle"] = per_vehicle
    columns = [str(size) for size in SIZES]
    time = Table("length of the train, one thread", columns, rows)
    memory = Table("memory", ["whole, 242", "per vehicle"], [
        (model, f"{results[model, 242][1] / 2**20:.1f} MiB", f"{facts[f'{model}_bytes_per_vehicle'] / 1024:.1f} KiB")
        for model in ("2d", "ltd")])
    return [time, memory], facts


def _measure(model, size):
    duration_s = round(min(LONGEST_S, 1e-3 * VEHICLE_STEPS[model] / size), 2)
    sources = ", ".join(f"{{name: every 120, vehicle: {i}, application_delay_s: 0, releases: false}}"
                        for i in range(1, size + 1, 120))
    settings = [f"train.consist=[{{vehicle: ore_wagon, count: {size}}}]", f"brake.sources=[{sources}]",
                "detail_vehicles=[]", f"duration_s={duration_s}"]
    runs = [workspace.train_sim("--model", model, "--threads", 1, settings=settings) for _ in range(5)]
    return (measure.median([run.summary["ns_per_vehicle_step"] for run in runs]),
            measure.median([run.peak_bytes for run in runs]))
