"""The targets, whether they are met, and why not."""
import machine
from table import Table, number

# what, section, fact, limit, unit
TARGETS = [
    ("2D train, one thread, everything included", "runs", "2d_1_ns", 220, "ns per vehicle-step"),
    ("the same with all wheels locked", "vehicles", "locked_ns", 450, "ns per vehicle-step"),
    ("pneumatic brake, share of a 2D train's step", "vehicles", "pneumatic_share", 15, "%"),
    ("pneumatic brake alone, share of real time", "vehicles", "pneumatic_of_real_time", 5, "%"),
    ("a wagon's step against the machine's limit", "limit", "to_limit", 1.9 if machine.lanes() == 8 else 2.2, "x"),
    ("make bench, without the build", "bench", "minutes", 20, "min"),
    ("emergency stop with its bag, 2D, one thread, against before", "against", "2d_bag", 0.75, "x"),
    ("emergency stop with its bag, LTD, one thread, against before", "against", "ltd_bag", 0.6, "x"),
    ("emergency stop with its bag, 2D, one thread", "runs", "2d_1_wall_s", 1.8, "s"),
    ("emergency stop with its bag, 2D, all cores", "runs", "2d_{cores}_wall_s", 1.4, "s"),
    ("emergency stop with its bag, LTD, one thread", "runs", "ltd_1_wall_s", 0.12, "s"),
    ("share of recording, 2D, one thread", "runs", "2d_1_recording", 3, "%"),
    ("share of recording, 2D, all cores", "runs", "2d_{cores}_recording", 3, "%"),
    ("all threads against one, beside one busy core", "features", "threads_beside_1", 1.1, "x"),
    ("ROS, one rank per core: overhead of an exchange", "graph", "overhead_ms", 0.05, "ms"),
    ("ROS, one rank per core: emergency stop with its bag", "graph", "ranks_wall_s", 4.0, "s"),
    *[
        (f"ROS, {ranks} ranks: an exchange against MPI", "exchange", f"to_mpi_{ranks}", 1.0, "x")
        for ranks in (2, 8, 22)
    ],
    ("ROS, 242 ranks: an exchange against MPI", "exchange", "to_mpi_242", 0.64, "x"),
    ("ROS, 242 ranks by TCP: an exchange against MPI", "exchange", "tcp_to_mpi_242", 2.5, "x"),
    ("ROS, 242 ranks: an exchange of 1 ms", "exchange", "242_ms", 1.0, "ms"),
    ("ROS, 242 ranks, interval 5 ms: wall time to simulated", "graph", "every_vehicle_to_real", 1.0, "x"),
    ("cost per vehicle from 50 to 2000 vehicles, 2D", "scaling", "2d_spread", 15, "%"),
    ("cost per vehicle from 50 to 2000 vehicles, LTD", "scaling", "ltd_spread", 15, "%"),
    # Limits of 5, 30, 30, 40, 10, 15, 10 and 60 ns to the 96 ns of a 2D vehicle-step where they were set, and of 3,
    # 10 and 60 ns to the 6.8 ns of an LTD one.
    ("2D with three grades", "features", "grades", 1.05, "x"),
    ("2D with three patches of friction", "features", "patches", 1.31, "x"),
    ("2D with a dip", "features", "dips", 1.31, "x"),
    ("2D with wheel-slide protection", "features", "protected", 1.42, "x"),
    ("2D with damped_stick gears", "features", "gears", 1.10, "x"),
    ("2D with shoes that react on the frames", "features", "reaction", 1.16, "x"),
    ("2D with friction by the tread's speed", "features", "tread", 1.10, "x"),
    ("2D with the pneumatic brake", "features", "pipe", 1.62, "x"),
    ("LTD with three grades", "features", "ltd_grades", 1.44, "x"),
    ("LTD with damped_stick gears", "features", "ltd_gears", 2.47, "x"),
    ("LTD with the pneumatic brake", "features", "ltd_pipe", 9.8, "x"),
]

# By fact, why its target was missed where it was; places as in performance.md.in.
RECORDING = """the recorder's thread works {vehicles.bag_us} us for a record, and recording adds
{runs.2d_{cores}_recording_cpu %} to the CPU time of the run: the numbers of a record are copied into the queue,
converted into the open chunk and copied by the kernel into its page cache, and checkpoints need a digest of the bag.
With a thread of the run on every core, the recorder's takes its time from one of them, and the others wait for that one
at the barrier of the step."""
RANKS = """with many ranks on a core an exchange is bound by changes between processes
([table](#ranks-and-mpi)): {exchange.shared_memory_switches} for each rank and exchange, which takes
{exchange.shared_memory_cpu_us} us of a core from waking up to sleeping, {exchange.shared_memory_system %} of it in the
kernel; the ranks of MPI, which never sleep, change {exchange.MPI_switches} times."""
FEW_RANKS = """with few ranks an exchange is bound by the time that a sleeping process takes to wake up: the master once
and each rank once, {exchange.shared_memory_22_cpu_us} us of a core for each of 22 ranks. Those of MPI stay awake and
take {exchange.MPI_22_cpu_us} us, at the cost of whatever else wants their cores
([lockstep.md](lockstep.md#shared-memory))."""
TCP = """each rank and exchange takes {exchange.TCP_22_cpu_us} us of a core, {exchange.TCP_22_system %} of it in the
kernel, which carries every message through the network's layers on loopback: three system calls of the rank (wait,
receive, send), two of the master, against one through shared memory ({exchange.shared_memory_22_cpu_us} us)."""
SPREAD = """an exchange costs about {scaling.{model}_fixed_us} us however short the train is, and 50 vehicles fill
{scaling.lanes_of_the_last_pack} of the {scaling.lanes} lanes of their last pack, which takes as long as a full one."""
WHOLE_STEP = """a 2D run is its vehicles: creep and slip take {vehicles.creep_share %} of a wagon's step, the
transformations between bodies and elements most of the rest ([table](#one-vehicle)), and its instructions alone
{limit.issue_share %} of the time ([below](#how-far-from-the-machines-limit)). Beside them recording adds
{runs.2d_1_recording_cpu %} of CPU time on one thread, {runs.2d_{cores}_recording %} of wall time on all cores."""
SLOWER = """the limit is of a machine with AVX-512; this one steps {scaling.lanes} wagons side by side, in
{vehicles.alone_ns} ns each ([table](#one-vehicle)), and its instructions alone take {limit.issue_share %} of the time
([below](#how-far-from-the-machines-limit)): the rest is waiting, for divisions and for what shares the core."""
REASONS = {
    "minutes": """most of it are the launches of up to 242 processes, which take longer to start and to end
than to run ([table](#ranks-and-mpi)).""",
    "2d_bag": WHOLE_STEP,
    "2d_1_wall_s": WHOLE_STEP,
    "2d_{cores}_wall_s": WHOLE_STEP,
    "ltd_bag": """without its bag the run has become faster (below); with it, the recorder's thread, {vehicles.bag_us}
us for each record, and the kernel's copies into its page cache are as long as the run, and have not changed.""",
    "ranks_wall_s": """{graph.overhead_ms} ms of each exchange are waking up; the rest is the wagons' own time, on cores
of which one has the master and the recorder besides.""",
    "every_vehicle_to_real": RANKS,
    **{fact: SLOWER if machine.lanes() < 8 else WHOLE_STEP for fact in ("2d_1_ns", "locked_ns")},
    "patches": """wagons side by side that stand on several surfaces look up each wheel's surface, and solve the slip
with a law for each lane; those on one surface pay for its law: falling friction has an exponential in each
iteration.""",
    "ltd_1_wall_s": """couplers take {vehicles.ltd_share_of_couplers %} of an exchange, the vehicles themselves
{vehicles.ltd_share_of_vehicles %} ([table](#one-vehicle)): the law of a draft gear under force has two exponentials
and a division, more than all that an LTD vehicle does. Recording adds {runs.ltd_1_recording %} to the run.""",
    "2d_{cores}_recording": RECORDING,
    "2d_1_recording": RECORDING,
    "to_limit": """a wagon has more in flight than any set of registers holds, so that most of its instructions move
numbers ([below](#how-far-from-the-machines-limit)); instructions alone take {limit.issue_share %} of the time.""",
    **{fact: RANKS for fact in ("to_mpi_242", "242_ms")},
    **{fact: FEW_RANKS for fact in ("to_mpi_2", "to_mpi_8", "to_mpi_22")},
    "tcp_to_mpi_242": TCP,
    "2d_spread": SPREAD.replace("{model}", "2d"),
    "ltd_spread": SPREAD.replace("{model}", "ltd"),
}
NO_REASON = "not explained."


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


def verdict(facts):
    """One line: how many targets are met, and which ones are not."""
    values = [(what, value, limit) for what, _, value, limit, _ in _measured(facts)]
    known = [(what, value > limit) for what, value, limit in values if value is not None]
    misses = [what for what, is_missed in known if is_missed]
    unknown = [what for what, value, _ in values if value is None]
    lines = [f"{len(known) - len(misses)} of {len(values)} targets are met."]
    lines += [f"MISSED: {what}" for what in misses] + [f"not measured: {what}" for what in unknown]
    return "\n".join(lines)


def missed(facts):
    """Items for the page, one for every target that is missed."""
    return [
        f"- **{what}**: {REASONS.get(fact, NO_REASON)}".replace("{cores}", str(machine.cores()))
        for what, fact, value, limit, _ in _measured(facts)
        if value is not None and value > limit
    ]


def _measured(facts):
    """The targets' rows: what, fact, value in its unit or None, limit, unit."""
    for what, section, fact, limit, unit in TARGETS:
        value = facts.get(section, {}).get(fact.format(cores=machine.cores()))
        yield what, fact, 100 * value if unit == "%" and value is not None else value, limit, unit
