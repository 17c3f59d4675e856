"""What we want, whether we have it, and why not."""
import machine
from table import Table, number

# what, section, fact, limit, unit
TARGETS = [
    ("2D train, one thread, everything included", "runs", "2d_1_ns", 220, "ns per vehicle-step"),
    ("the same with all wheels locked", "vehicles", "locked_ns", 450, "ns per vehicle-step"),
    ("pneumatic brake, share of a 2D train's step", "vehicles", "pneumatic_share", 15, "%"),
    ("pneumatic brake alone, share of real time", "vehicles", "pneumatic_of_real_time", 5, "%"),
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

# By fact, why its target was missed where it was; places as in performance.md.in.
RECORDING = """the recorder's thread works {vehicles.bag_us} us for a record, and recording adds
{runs.2d_{cores}_recording_cpu %} to the CPU time of the run: the 13 kB of a record are copied three times (into the
queue, into messages, into the open chunk) and by the kernel once more (into its page cache), and checkpoints need a
digest of the bag. With a thread of the run on every core, the recorder's takes its time from one of them, and the
others wait for that one at the barrier of the step."""
SPREAD = """an exchange costs about {scaling.{model}_fixed_us} us however short the train is, and 50 vehicles fill
{scaling.lanes_of_the_last_pack} of the {scaling.lanes} lanes of their last pack, which takes as long as a full one."""
REASONS = {
    "ltd_1_wall_s": """couplers take {vehicles.ltd_share_of_couplers %} of an exchange, the vehicles themselves
{vehicles.ltd_share_of_vehicles %} ([table](#one-vehicle)): the law of a draft gear has two exponentials and two
divisions, more than all that an LTD vehicle does. Recording adds {runs.ltd_1_recording %} to the run.""",
    "2d_{cores}_recording": RECORDING,
    "2d_spread": SPREAD.replace("{model}", "2d"),
    "ltd_spread": SPREAD.replace("{model}", "ltd"),
}
NO_REASON = "it was met on the machine that these words were written on; what differs here is not known."


def table(facts):
    """@param facts  {section: {fact: value}} of what has been measured"""
    rows = []
    for what, _, value, limit, unit in _measured(facts):
        if value is None:
            rows.append((what, "not measured", f"{limit} {unit}", "-"))
            continue
        margin = f"{100 * abs(value / limit - 1):.0f} %"
        verdict = f"MISSED by {margin}" if value > limit else f"met, {margin} below" if value > 0 else "met"
        rows.append((what, number(value), f"{limit} {unit}", verdict))
    return Table("targets", ["measured", "at most", "verdict"], rows)


def missed(facts):
    """Items for the page, one for every target that is missed."""
    return [f"- **{what}**: {REASONS.get(fact, NO_REASON)}".replace("{cores}", str(machine.cores()))
            for what, fact, value, limit, _ in _measured(facts) if value is not None and value > limit]


def _measured(facts):
    """The targets' rows: what, fact, value in its unit or None, limit, unit."""
    for what, section, fact, limit, unit in TARGETS:
        value = facts.get(section, {}).get(fact.format(cores=machine.cores()))
        yield what, fact, 100 * value if unit == "%" and value is not None else value, limit, unit
