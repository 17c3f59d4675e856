"""Cost of an exchange over the number of ranks, for every kind of call, beside MPI; start-up and shut-down."""
import measure
import profile_ranks
import workspace
from table import Table, number, times

EXCHANGES = {2: 10000, 8: 6000, 22: 3000, 61: 1500, 121: 600, workspace.VEHICLES: 400}
WAYS = {  # how the master calls wagon nodes: arguments of train.launch
    "shared memory": [],
    "TCP": ["shared_memory:=false"],
}
PAIRED = "shared memory"  # beside MPI at any number of ranks; the first of WAYS
MANY_RANKS = 100
PROFILES = [  # way, ranks, simulated seconds: a few seconds of wall time
    (PAIRED, workspace.VEHICLES, 4),
    ("MPI", workspace.VEHICLES, 4),
    (PAIRED, 22, 20),
    ("MPI", 22, 20),
    ("TCP", 22, 10),
]
BUSY = {22: 1500, 121: 300}  # ranks: exchanges beside a program that keeps one core busy


def run():
    cost = {}  # (way, ranks): seconds per exchange, of every run
    ends = {}  # ranks: (start, stop) in seconds
    digests = set()
    for ranks, exchanges in EXCHANGES.items():
        settings = [f"duration_s={exchanges / 1000:g}"]
        launches = [lambda way=way: workspace.Launch(ranks, *WAYS[way], settings=settings) for way in WAYS]
        *of_ways, mpi = _in_turn(ranks, launches, lambda: workspace.mpi_train(ranks, settings))
        for way, of_way in zip(WAYS, of_ways):
            cost[way, ranks] = [launch.per_exchange_s() for launch in of_way]
            digests |= {(ranks, launch.summary["state_digest"]) for launch in of_way}
        if None not in mpi:
            cost["MPI", ranks] = [run["wall_s"] / run["exchanges"] for run in mpi]
            digests |= {(ranks, run["state_digest"]) for run in mpi}
        ends[ranks] = [measure.median([getattr(launch, end) for launch in of_ways[0]]) for end in ("start_s", "stop_s")]
    if len(digests) != len(EXCHANGES):
        raise measure.Failed(f"the digests differ between the ways to call the ranks: {sorted(digests)}")

    columns = [str(ranks) for ranks in EXCHANGES]
    rows = [(way, *[number(_ms(cost.get((way, ranks)))) for ranks in EXCHANGES]) for way in [*WAYS, "MPI"]]
    for way in WAYS:
        ratios = [_to_mpi(cost, way, ranks) for ranks in EXCHANGES]
        rows.append((f"{way} to MPI", *[times(r and measure.median(r)) for r in ratios]))
        if way == PAIRED:
            rows.append(("from ... to", *[f"{number(min(r))} ... {number(max(r))}" if r else "-" for r in ratios]))
    table = Table("ranks; wall time of an exchange [ms]", columns, rows)
    starts = Table(
        "nodes; launch [s]",
        columns,
        [
            ("until the run begins", *[number(ends[ranks][0]) for ranks in EXCHANGES]),
            ("from its end to that of roslaunch", *[number(ends[ranks][1]) for ranks in EXCHANGES]),
        ],
    )
    facts = {"242_ms": _ms(cost[PAIRED, workspace.VEHICLES])}
    for way, name in ((PAIRED, "to_mpi"), ("TCP", "tcp_to_mpi")):
        for ranks in EXCHANGES:
            ratios = _to_mpi(cost, way, ranks)
            facts[f"{name}_{ranks}"] = ratios and measure.median(ratios)
    return [table, starts, _beside_work(), _profiles(facts)], facts


def _beside_work():
    """The same beside other work: ranks that sleep leave it its core, ranks of MPI compete with it while they wait."""
    rows = []
    for ranks, exchanges in BUSY.items():
        settings = [f"duration_s={exchanges / 1000:g}"]
        with workspace.busy_core(0):
            ours = workspace.Launch(ranks, *WAYS[PAIRED], settings=settings).per_exchange_s()
            run = workspace.mpi_train(ranks, settings)
        mpi = run and run["wall_s"] / run["exchanges"]
        cells = (_ms([ours]), _ms(mpi and [mpi]))
        rows.append((f"{ranks} ranks", *map(number, cells), times(mpi and ours / mpi)))
    return Table("beside one busy core [ms]", [PAIRED, "MPI", "to MPI"], rows)


def _profiles(facts):
    """What the ranks' time goes into; facts by way, and by number of ranks where it is not one per vehicle."""
    rows = []
    for way, ranks, simulated_s in PROFILES:
        settings = [f"duration_s={simulated_s}"]
        with profile_ranks.Watch("mpi_train" if way == "MPI" else "wagon_node", ranks) as watch:
            if way == "MPI":
                run = workspace.mpi_train(ranks, settings)
                seconds = run and run["wall_s"] / run["exchanges"]
            else:
                seconds = workspace.Launch(ranks, *WAYS[way], settings=settings).per_exchange_s()
        profile = watch.per_exchange(seconds) if seconds else None
        name = way.replace(" ", "_") + ("" if ranks == workspace.VEHICLES else f"_{ranks}")
        facts.update({f"{name}_{what}": value for what, value in (profile or {}).items()})
        values = profile or dict.fromkeys(("cpu_us", "system", "wait_us", "switches"))
        rows.append(
            (
                f"{way}, {ranks} ranks",
                number(_ms(seconds and [seconds])),
                number(values["cpu_us"]),
                "-" if values["system"] is None else f"{100 * values['system']:.0f} %",
                number(values["wait_us"]),
                number(values["switches"]),
            )
        )
    columns = ["wall [ms]", "on a core [us]", "in the kernel", "waiting for one [us]", "switches"]
    return Table("one exchange, per rank", columns, rows)


def _in_turn(ranks, launches, mpi):
    """Results of all launches and of MPI, in turn.

    To start and end hundreds of processes takes most of the time: of many ranks only the first way is measured beside
    MPI, in turn; the others once.
    """
    if ranks < MANY_RANKS:
        return measure.in_turn(2, *launches, mpi)
    first, of_mpi = measure.in_turn(2, launches[0], mpi)
    return [first, *measure.in_turn(1, *launches[1:]), of_mpi]


def _ms(seconds):
    return None if seconds is None else 1e3 * measure.median(seconds)


def _to_mpi(cost, way, ranks):
    """Ratios pair by pair; of medians where the runs are no pairs; None without both."""
    if (way, ranks) not in cost or ("MPI", ranks) not in cost:
        return None
    of, to = cost[way, ranks], cost["MPI", ranks]
    return measure.ratios(of, to) if len(of) == len(to) else [measure.median(of) / measure.median(to)]
