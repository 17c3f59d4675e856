"""The wagon's step against the machine's limits: operations, instructions, memory."""
import json
import re
import shutil

import measure
import workspace
from table import Table, number, times

# Of a core of these years: Zen 3 and 4 dispatch six and reach memory three times in a cycle.
INSTRUCTIONS_PER_CYCLE, REFERENCES_PER_CYCLE = 6, 3


def run():
    operations = json.loads(measure.Run([workspace.program("train_dynamics", "wagon_operations")]).stdout)
    peak = workspace.bench("peak_bench")
    vehicles = workspace.bench("vehicle_bench")
    measured_ns = min(_wagon_ns(vehicles, name) for name in vehicles if name.startswith("wagon/"))
    counts = operations["rolling"]["whole_step"]
    add_multiply, divide, root = (
        1e12 * peak[f"Run/{name}"]["s_per_operation"] for name in ("add_and_multiply", "divide", "square_root")
    )
    busy_ns = 1e-3 * (counts["add"] + counts["multiply"]) * add_multiply
    dividing_ns = 1e-3 * (counts["divide"] * divide + counts["square_root"] * root)
    bytes_of_state = number(operations["bytes_per_step"]["wagon"])
    stream = {wagons: 1e9 * peak[f"Stream/{wagons}"]["s_per_vehicle_step"] for wagons in (242, 2000)}
    limit_ns = max(busy_ns, dividing_ns, stream[242])
    rows = [
        ("+ - and *", number(counts["add"] + counts["multiply"]), f"{add_multiply:.1f} ps each", number(busy_ns)),
        (
            "/ and square root",
            number(counts["divide"] + counts["square_root"]),
            f"{divide:.0f} ps each",
            number(dividing_ns),
        ),
        ("bytes of state, 242 wagons", bytes_of_state, "read and written", number(stream[242])),
        ("bytes of state, 2000 wagons", bytes_of_state, "read and written", number(stream[2000])),
        ("the limit: the busiest of these units", "", "", number(limit_ns)),
        ("measured", "", times(measured_ns / limit_ns) + " the limit", number(measured_ns)),
    ]
    table = Table("a wagon's step at the machine's limit", ["count", "peak", "time [ns]"], rows)
    tables = [table]
    facts = {"to_limit": measured_ns / limit_ns}
    if shutil.which("valgrind") is not None and "wagon/avx2" in vehicles:
        issue, share = _issue(1e9 * peak["Cycle"]["s_per_cycle"], _wagon_ns(vehicles, "wagon/avx2"))
        tables.append(issue)
        facts["issue_share"] = share
    return tables, facts


def _wagon_ns(vehicles, name):
    return 1e9 * vehicles[name]["s_per_vehicle_step"]


def _issue(cycle_ns, measured_ns):
    """What the core takes to issue the instructions, and its share of the time measured: the table and the share."""
    instructions, references = _instructions()
    issue_ns, reference_ns = (
        cycle_ns * count / width
        for count, width in ((instructions, INSTRUCTIONS_PER_CYCLE), (references, REFERENCES_PER_CYCLE))
    )
    limit_ns = max(issue_ns, reference_ns)
    table = Table(
        "a vehicle's step in AVX2 instructions (four wagons each)",
        ["count", "at most", "time [ns]"],
        [
            (
                "instructions",
                number(instructions),
                f"{INSTRUCTIONS_PER_CYCLE} in a cycle of {cycle_ns:.3f} ns",
                number(issue_ns),
            ),
            ("loads and stores", number(references), f"{REFERENCES_PER_CYCLE} in a cycle", number(reference_ns)),
            ("measured, wagons alone", "", times(measured_ns / limit_ns) + " the longer", number(measured_ns)),
        ],
    )
    return table, limit_ns / measured_ns


def _instructions():
    """Instructions and data references per vehicle-step, by Valgrind (whose processor has AVX2), between two runs."""
    counts = []
    for steps in (20, 120):
        run = measure.Run(
            [
                "valgrind",
                "--tool=cachegrind",
                "--cachegrind-out-file=/dev/null",
                "--log-fd=1",
                workspace.program("train_sim", "train_sim"),
                "run",
                workspace.EMERGENCY,
                "--threads",
                "1",
                "--set",
                f"duration_s={steps / 1000:g}",
            ]
        )
        counts.append(
            [int(re.search(rf"{name} +refs: +([0-9,]+)", run.stdout).group(1).replace(",", "")) for name in "ID"]
        )
    return [(many - few) / (100 * workspace.VEHICLES) for few, many in zip(*counts)]
