"""How far the wagon's step is from what the machine can do: operations, instructions, memory."""
import json
import re
import shutil

import measure
import workspace
from table import Table, number, times


def run():
    operations = json.loads(measure.Run([workspace.program("train_dynamics", "wagon_operations")]).stdout)
    peak = workspace.bench("peak_bench")
    measured_ns = _fastest_wagon()
    counts = operations["rolling"]["whole_step"]
    add_multiply, divide, root = (1e12 * peak[f"Run/{name}"]["s_per_operation"]
                                  for name in ("add_and_multiply", "divide", "square_root"))
    busy_ns = 1e-3 * (counts["add"] + counts["multiply"]) * add_multiply
    dividing_ns = 1e-3 * (counts["divide"] * divide + counts["square_root"] * root)
    bytes_of_state = number(operations["bytes_per_step"]["wagon"])
    stream = {vehicles: 1e9 * peak[f"Stream/{vehicles}"]["s_per_vehicle_step"] for vehicles in (242, 2000)}
    instructions, references = _instructions()
    limit_ns = max(busy_ns, dividing_ns, stream[242])
    rows = [
        ("+ - and *", number(counts["add"] + counts["multiply"]), f"{add_multiply:.1f} ps each", number(busy_ns)),
        ("/ and square root", number(counts["divide"] + counts["square_root"]), f"{divide:.0f} ps each",
         number(dividing_ns)),
        ("bytes of state, 242 wagons", bytes_of_state, "read and written", number(stream[242])),
        ("bytes of state, 2000 wagons", bytes_of_state, "read and written", number(stream[2000])),
        ("the limit: the busiest of these units", "", "", number(limit_ns)),
        ("measured", "", times(measured_ns / limit_ns) + " the limit", number(measured_ns)),
    ]
    table = Table("a wagon's step at the machine's limit", ["count", "peak", "time [ns]"], rows)
    tables = [table]
    if instructions is not None:
        tables.append(Table("counted, whole train, AVX2 (four wagons each)", ["per step"], [
            ("instructions per vehicle", number(instructions)), ("loads and stores per vehicle", number(references))]))
    return tables, {"to_limit": measured_ns / limit_ns}


def _fastest_wagon():
    results = workspace.bench("vehicle_bench")
    return 1e9 * min(v["s_per_vehicle_step"] for name, v in results.items() if name.startswith("wagon/"))


def _instructions():
    """Instructions and data references per vehicle-step, by Valgrind (whose processor has AVX2), between two runs."""
    if shutil.which("valgrind") is None:
        return None, None
    counts = []
    for steps in (20, 120):
        run = measure.Run(["valgrind", "--tool=cachegrind", "--cachegrind-out-file=/dev/null", "--log-fd=1",
                           workspace.program("ltd_master", "train_sim"), "run", workspace.EMERGENCY, "--threads", "1",
                           "--set", f"duration_s={steps / 1000:g}"])
        counts.append([int(re.search(rf"{name} +refs: +([0-9,]+)", run.stdout).group(1).replace(",", ""))
                       for name in "ID"])
    return [(many - few) / (100 * workspace.VEHICLES) for few, many in zip(*counts)]
