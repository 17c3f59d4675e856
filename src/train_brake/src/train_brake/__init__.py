"""The results of a run as arrays.

    import train_brake

    run = train_brake.load("results/emergency")       # the folder of a run, or a bag
    state = run["state"]                              # a topic: a table with a row per record
    state.time_s                                      # [records] simulated time [s]
    state["speed_mps"]                                # [records, vehicles]
    state.unit("speed_mps"), state.meaning("speed_mps")
    state.to_pandas()                                 # needs python3-pandas
    run.config, run.summary, run.couplers, run.events # of the same run, where its folder has them

Data is read on first access. In arrays indexed by vehicle, vehicle 1 (the front of the train) is at [.., 0].
"""

from train_brake.bag import BagError, BagFile, Damage, Table
from train_brake.run import Event, Run, load

__all__ = ["BagError", "BagFile", "Damage", "Event", "Run", "Table", "load"]
