"""The vehicles by themselves, by instruction set, and what the rest of a train costs beside them."""
import json

import machine
import measure
import workspace
from table import Table, number, times


def run():
    vehicles, train, parts = map(workspace.bench, ("vehicle_bench", "train_bench", "wagon_elements_bench"))
    operations = json.loads(measure.Run([workspace.program("train_dynamics", "wagon_operations")]).stdout)
    per_record = measure.google_benchmark(workspace.program("train_results", "recording_bench"))
    pneumatic_ns = max(_ns(train, f"pneumatic_brake/{what}") for what in ("emergency", "service"))
    ltd, ltd_shares = _ltd_exchange(vehicles, train)
    step, creep_shares = _parts(parts, operations)
    tables = [_by_instruction_set(vehicles), _exchanges(train), _beside(train), ltd, _recording(per_record), step]
    return tables, {
        "alone_ns": min(_ns(vehicles, name) for name in vehicles if name.startswith("wagon/")),
        "locked_ns": _ns(train, "exchange_locked/2d/1"),
        "bag_us": 1e6 * per_record["bag"]["cpu_time"],
        "pneumatic_share": pneumatic_ns / _ns(train, "exchange/2d/1"),
        "pneumatic_of_real_time": pneumatic_ns * 242 / 1e6,  # vehicles; [ns] that are simulated
        **ltd_shares,
        **creep_shares,
    }


def _ns(results, name):
    return 1e9 * results[name]["s_per_vehicle_step"]


def _by_instruction_set(results):
    rows = []
    for name in results:
        kind, instruction_set = name.split("/")
        if kind != "wagon":
            continue
        cells = []
        for vehicle in ("wagon", "wagon_locked", "ltd"):
            value = _ns(results, f"{vehicle}/{instruction_set}")
            cells += [number(value), times(_ns(results, f"{vehicle}/scalar") / value)]
        rows.append((instruction_set, *cells))
    return Table(
        "vehicles alone, one thread [ns per step]",
        ["2D wagon", "to scalar", "wheels locked", "to scalar", "LTD", "to scalar"],
        rows,
    )


def _exchanges(results):
    rows = []
    for model in ("2d", "ltd"):
        alone = _ns(results, f"exchange/{model}/1")
        for threads in range(1, machine.cores() + 1) if model == "2d" else [1]:
            value = _ns(results, f"exchange/{model}/{threads}")
            rows.append((f"{model}, {threads} thread(s)", number(value), times(alone / value)))
    rows.append(("2d, all wheels locked, 1 thread(s)", number(_ns(results, "exchange_locked/2d/1")), "-"))
    return Table("whole exchange [ns per vehicle-step]", ["time", "to 1 thread"], rows)


def _beside(results):
    rows = [
        ("couplers", number(_ns(results, "couplers")), "every exchange"),
        ("air brake", number(_ns(results, "air_brake")), "every exchange"),
        ("pneumatic brake, emergency", number(_ns(results, "pneumatic_brake/emergency")), "every exchange"),
        ("pneumatic brake, service and release", number(_ns(results, "pneumatic_brake/service")), "every exchange"),
    ]
    for model in ("2d", "ltd"):
        record = _ns(results, f"record/{model}")
        rows.append((f"record with digest, {model}", number(record), "every 10 steps"))
        rows.append(
            (
                f"energies for the ledger, {model}",
                number(_ns(results, f"record_with_ledger/{model}") - record),
                "every 1000",
            )
        )
    return Table("beside the vehicles [ns per vehicle]", ["time", "due"], rows)


def _ltd_exchange(vehicles, train):
    """Where the time of the LTD train goes: the table, and the shares as facts."""
    whole = _ns(train, "exchange/ltd/1")
    record, ledger = (_ns(train, f"{what}/ltd") for what in ("record", "record_with_ledger"))
    parts = {
        "couplers": _ns(train, "couplers"),
        "vehicles": min(_ns(vehicles, name) for name in vehicles if name.startswith("ltd/")),
        "air brake": _ns(train, "air_brake"),
        "record": record / 10 + (ledger - record) / 1000,
    }
    parts["the rest"] = whole - sum(parts.values())
    rows = [(name, number(ns), f"{100 * ns / whole:.0f} %") for name, ns in [*parts.items(), ("whole exchange", whole)]]
    shares = {f"ltd_share_of_{name.replace(' ', '_')}": ns / whole for name, ns in parts.items()}
    return Table("the LTD train's exchange [ns per vehicle-step]", ["time", "share"], rows), shares


def _recording(results):
    return Table(
        "recording [us per record of 242 vehicles]",
        ["CPU time"],
        [
            ("copy, by the run", number(1e6 * results["copy"]["cpu_time"])),
            ("bag, by the recorder's thread", number(1e6 * results["bag"]["cpu_time"])),
            ("CSV tables, by the recorder's thread", number(1e6 * results["tables"]["cpu_time"])),
        ],
    )


def _parts(results, operations):
    names = [name.split("/")[1] for name in results if name.startswith("rolling/") and not name.endswith("whole_step")]
    whole = {motion: _ns(results, f"{motion}/whole_step") for motion in ("rolling", "sliding")}
    rows, left = [], dict(whole)
    for name in names:
        cells = []
        for motion in whole:
            value = _ns(results, f"{motion}/{name}")
            left[motion] -= value
            cells += [
                number(value),
                f"{100 * value / whole[motion]:.0f} %",
                number(_arithmetic(operations[motion][name])),
            ]
        rows.append((name.replace("_", " "), *cells))
    rest = []
    for motion in whole:
        counted = sum(_arithmetic(operations[motion][name]) for name in names)
        rest += [
            number(left[motion]),
            f"{100 * left[motion] / whole[motion]:.0f} %",
            number(_arithmetic(operations[motion]["whole_step"]) - counted),
        ]
    rows.append(("the rest", *rest))
    rows.append(
        (
            "whole step",
            *[x for m in whole for x in (number(whole[m]), "100 %", number(_arithmetic(operations[m]["whole_step"])))],
        )
    )
    table = Table(
        "parts of the wagon's step, widest lanes [ns]",
        ["rolling", "share", "operations", "wheels locked", "share", "operations"],
        rows,
    )
    rolling = operations["rolling"]
    return table, {
        "creep_share": _ns(results, "rolling/creep_and_slip") / whole["rolling"],
        "creep_share_of_operations": _arithmetic(rolling["creep_and_slip"]) / _arithmetic(rolling["whole_step"]),
    }


def _arithmetic(counts):
    return sum(counts[name] for name in ("add", "multiply", "divide", "square_root"))
