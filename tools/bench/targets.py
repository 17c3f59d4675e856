"""What we want, and whether we have it."""
import machine
from table import Table, number

# what, section, fact, limit, unit
TARGETS = [
    ("2D train, one thread, everything included", "runs", "2d_1_ns", 220, "ns per vehicle-step"),
    ("the same with all wheels locked", "vehicles", "locked_ns", 450, "ns per vehicle-step"),
    ("emergency stop with its bag, 2D, one thread", "runs", "2d_1_wall_s", 4.0, "s"),
    ("emergency stop with its bag, 2D, all cores", "runs", "2d_{cores}_wall_s", 2.3, "s"),
    ("emergency stop with its bag, LTD, one thread", "runs", "ltd_1_wall_s", 0.15, "s"),
    ("share of recording, 2D, one thread", "runs", "2d_1_recording", 5, "%"),
    ("share of recording, 2D, all cores", "runs", "2d_{cores}_recording", 5, "%"),
    ("ROS, one rank per core: overhead of an exchange", "graph", "overhead_ms", 0.2, "ms"),
    ("ROS, one rank per core: emergency stop with its bag", "graph", "ranks_wall_s", 20, "s"),
    ("ROS, 242 ranks: an exchange against MPI", "exchange", "to_mpi_242", 1.5, "x"),
    ("ROS, 242 ranks, interval 5 ms: emergency stop", "graph", "every_vehicle_wall_s", 272, "s"),
    ("cost per vehicle from 50 to 2000 vehicles, 2D", "scaling", "2d_spread", 20, "%"),
    ("cost per vehicle from 50 to 2000 vehicles, LTD", "scaling", "ltd_spread", 20, "%"),
]


def table(facts):
    """@param facts  {section: {fact: value}} of what has been measured"""
    rows = []
    for what, section, fact, limit, unit in TARGETS:
        value = facts.get(section, {}).get(fact.format(cores=machine.cores()))
        if value is None:
            rows.append((what, "not measured", f"{limit} {unit}", "-"))
            continue
        value = 100 * value if unit == "%" else value
        margin = f"{100 * abs(value / limit - 1):.0f} %"
        verdict = f"MISSED by {margin}" if value > limit else f"met, {margin} below" if value > 0 else "met"
        rows.append((what, number(value), f"{limit} {unit}", verdict))
    return Table("targets", ["measured", "at most", "verdict"], rows)
