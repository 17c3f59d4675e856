"""The whole emergency stop as a ROS graph with its bag: one rank per core, and one per vehicle."""
import tempfile

import machine
import measure
import workspace
from runs import PAPER_WALL_S
from table import Table, number, times

EVERY_VEHICLE_S = 30  # simulated


def run():
    cores = machine.cores()
    with tempfile.TemporaryDirectory() as folder:
        alone, ranks = measure.in_turn(
            2,
            lambda: workspace.train_sim_into(folder, "--threads", cores),
            lambda: workspace.Launch(cores, record=True),
        )
    if {run.summary["state_digest"] for run in alone} != {launch.summary["state_digest"] for launch in ranks}:
        raise measure.Failed("the ROS graph and the train in one process have different digests")
    every = workspace.Launch(
        workspace.VEHICLES, record=True, settings=["exchange_interval_s=0.005", f"duration_s={EVERY_VEHICLE_S}"]
    )

    alone_s, ranks_s = (measure.median([workspace.per_exchange_s(r.summary) for r in runs]) for runs in (alone, ranks))
    wall_s = measure.median([launch.wall_s for launch in ranks])
    rows = [
        (
            "one process",
            f"{cores} threads",
            "1 ms",
            number(1e3 * alone_s),
            number(measure.median([run.summary["wall_s"] for run in alone])),
            "-",
        ),
        (
            "one rank per core",
            f"{cores} nodes",
            "1 ms",
            number(1e3 * ranks_s),
            number(wall_s),
            times(PAPER_WALL_S / wall_s),
        ),
        (
            "one rank per vehicle",
            f"{workspace.VEHICLES} nodes",
            "5 ms",
            number(1e3 * every.per_exchange_s()),
            number(every.wall_s),
            "-",
        ),
    ]
    table = Table(
        f"emergency stop with its bag, 70 s (with a rank per vehicle: its first {EVERY_VEHICLE_S} s)",
        ["", "interval", "exchange [ms]", "run [s]", "to the paper"],
        rows,
    )
    overhead_s = measure.median(
        [workspace.per_exchange_s(r.summary) - workspace.per_exchange_s(a.summary) for a, r in zip(alone, ranks)]
    )
    return [table], {
        "overhead_ms": 1e3 * overhead_s,
        "ranks_wall_s": wall_s,
        "every_vehicle_to_real": every.wall_s / EVERY_VEHICLE_S,
        "every_vehicle_ms": 1e3 * every.per_exchange_s(),
    }
