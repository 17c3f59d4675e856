"""What an exchange costs over the number of ranks, by every way to call them, beside MPI; start-up and shut-down."""
import measure
import workspace
from table import Table, number, times

EXCHANGES = {2: 10000, 8: 6000, 22: 3000, 61: 1500, 121: 600, workspace.VEHICLES: 400}
WAYS = {  # how the master calls wagon nodes: arguments of train.launch
    "shared memory": [],
    "TCP": ["shared_memory:=false"],
    "blocking client": ["client:=blocking"],
}
BLOCKING_RANKS = (2, workspace.VEHICLES)  # where that one is measured


def run():
    cost = {}    # (way, ranks): seconds per exchange
    ends = {}    # ranks: (start, stop) in seconds
    digests = set()
    for ranks, exchanges in EXCHANGES.items():
        settings = [f"duration_s={exchanges / 1000:g}"]
        ways = [way for way in WAYS if way != "blocking client" or ranks in BLOCKING_RANKS]
        *launches, mpi = measure.in_turn(
            2 if ranks < 100 else 1,  # to start and end hundreds of processes takes most of the time
            *[lambda way=way: workspace.Launch(ranks, *WAYS[way], settings=settings) for way in ways],
            lambda: workspace.mpi_train(ranks, settings))
        for way, of_way in zip(ways, launches):
            cost[way, ranks] = measure.median([launch.per_exchange_s() for launch in of_way])
            digests |= {(ranks, launch.summary["state_digest"]) for launch in of_way}
        if mpi[0] is not None:
            cost["MPI", ranks] = measure.median([run["wall_s"] / run["exchanges"] for run in mpi])
            digests |= {(ranks, run["state_digest"]) for run in mpi}
        ends[ranks] = [measure.median([getattr(launch, end) for launch in launches[0]])
                       for end in ("start_s", "stop_s")]
    if len(digests) != len(EXCHANGES):
        raise measure.Failed(f"the digests differ between the ways to call the ranks: {sorted(digests)}")

    columns = [str(ranks) for ranks in EXCHANGES]
    rows = [(way, *[number(_ms(cost.get((way, ranks)))) for ranks in EXCHANGES]) for way in [*WAYS, "MPI"]]
    rows += [(f"{way} to MPI", *[times(_to_mpi(cost, way, ranks)) for ranks in EXCHANGES]) for way in WAYS]
    table = Table("ranks; wall time of an exchange [ms]", columns, rows)
    starts = Table("nodes; launch [s]", columns, [
        ("until the run begins", *[number(ends[ranks][0]) for ranks in EXCHANGES]),
        ("from its end to that of roslaunch", *[number(ends[ranks][1]) for ranks in EXCHANGES])])
    return [table, starts], {"to_mpi_242": _to_mpi(cost, "shared memory", workspace.VEHICLES)}


def _ms(seconds):
    return None if seconds is None else 1e3 * seconds


def _to_mpi(cost, way, ranks):
    if (way, ranks) not in cost or ("MPI", ranks) not in cost:
        return None
    return cost[way, ranks] / cost["MPI", ranks]
