"""Runs that are drawn together, and what the user chose to see of them."""

import dataclasses
from typing import List, Optional

from train_brake_report import style
from train_brake_report.figure import LeftOut
from train_brake_report.run import Run

# Names for the page of what figures need.
TABLES = {"state": "TrainState", "forces": "InTrainForces", "pressures": "BrakePressures", "wagon": "WagonState"}


@dataclasses.dataclass
class Group:
    name: str  # of the scenario; empty if there is only one group
    runs: List[Run]
    wagon: int
    coupler: Optional[int]  # None: the paper's, or the one with the largest force

    def having(self, table: str) -> List[Run]:
        """The runs whose bag has this table; LeftOut if none has."""
        runs = [run for run in self.runs if getattr(run.recording, table) is not None]
        if not runs:
            raise LeftOut(f"The recording has no topic of the type train_brake_msgs/{TABLES[table]}.")
        return runs

    def line(self, run: Run) -> dict:
        """How the run is drawn in all figures."""
        return style.run_line(self.runs.index(run), len(self.runs))

    def colour(self, run: Run) -> str:
        return self.line(run)["color"]

    def comparable(self, runs: List[Run]) -> List[Run]:
        """Those of runs[1:] with as many vehicles as the first, to take differences to it."""
        return [run for run in runs[1:] if run.vehicles == runs[0].vehicles]

    @staticmethod
    def difference(run: Run, first: Run) -> str:
        return f"{run.label} \u2212 {first.label}"

    def without(self, runs: List[Run], table: str) -> str:
        """A sentence on the runs that a figure cannot show; empty if there are none."""
        missing = [run.label for run in self.runs if run not in runs]
        return f" Not shown, because the bag has no {TABLES[table]}: {', '.join(missing)}." if missing else ""

    def commands(self) -> list:
        return self.runs[0].commands
