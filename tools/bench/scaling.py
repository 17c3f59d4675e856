"""Trains of 10 to 5000 vehicles in one process: time per vehicle-step, memory per vehicle."""
import machine
import measure
import workspace
from table import Table, number

SIZES = [10, 20, 50, 100, 242, 500, 1000, 2000, 5000]
SPREAD_SIZES = [50, 100, 242, 500, 1000, 2000]  # of the targets
MEMORY_SIZES = [242, 2000, 10000]
VEHICLE_STEPS = {"2d": 3e6, "ltd": 2e7}  # of a measurement
LONGEST_S = 40.0  # the train is still moving then


def run():
    results = {(model, size): _measure(model, size) for model in ("2d", "ltd") for size in SIZES}
    lanes = machine.lanes()
    rows, facts = [], {"lanes": lanes, "lanes_of_the_last_pack": (50 - 1) % lanes + 1}
    for model in ("2d", "ltd"):
        ns = {size: results[model, size] for size in SIZES}
        rows.append((f"{model} [ns per vehicle-step]", *[number(ns[size]) for size in SIZES]))
        long = [ns[size] for size in SPREAD_SIZES]
        facts[f"{model}_spread"] = max(long) / min(long) - 1
        facts[f"{model}_fixed_us"] = 1e-3 * _fixed_ns(ns[50], ns[2000])
    columns = [str(size) for size in SIZES]
    time = Table("length of the train, one thread", columns, rows)
    memory = Table("memory", ["whole, 242", "per vehicle"], [_memory(model) for model in ("2d", "ltd")])
    return [time, memory], facts


def _fixed_ns(ns_50, ns_2000):
    """The cost of an exchange that does not depend on the train's length; the rest is a time per lane of the packs."""
    lanes = machine.lanes()
    lanes_of_50, lanes_of_2000 = (lanes * -(-size // lanes) for size in (50, 2000))
    per_lane = (2000 * ns_2000 - 50 * ns_50) / (lanes_of_2000 - lanes_of_50)
    return max(0.0, 2000 * ns_2000 - lanes_of_2000 * per_lane)  # noise, where packs are all of the cost


def _measure(model, size):
    duration_s = round(min(LONGEST_S, 1e-3 * VEHICLE_STEPS[model] / size), 2)
    arguments, settings = _train(model, size, duration_s)
    runs = [workspace.train_sim(*arguments, settings=settings) for _ in range(5)]
    return measure.median([run.summary["ns_per_vehicle_step"] for run in runs])


def _memory(model):
    """Of short runs: it does not grow with time."""
    peak = {}
    for size in MEMORY_SIZES:
        arguments, settings = _train(model, size, 0.1)
        peak[size] = workspace.peak_bytes_of_train_sim(*arguments, settings=settings)
    per_vehicle = (peak[10000] - peak[2000]) / (10000 - 2000)
    return model, f"{peak[workspace.VEHICLES] / 2**20:.1f} MiB", f"{per_vehicle / 1024:.2f} KiB"


def _train(model, size, duration_s):
    """Arguments and settings of train_sim."""
    sources = ", ".join(
        f"{{name: every 120, vehicle: {i}, application_delay_s: 0, releases: false}}" for i in range(1, size + 1, 120)
    )
    settings = [
        f"train.consist=[{{vehicle: ore_wagon, count: {size}}}]",
        f"brake.sources=[{sources}]",
        "detail_vehicles=[]",
        f"duration_s={duration_s}",
    ]
    return ["--model", model, "--threads", 1], settings
