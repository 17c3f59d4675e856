"""Runs that are drawn together, and the user's options for them."""

import dataclasses
from typing import Callable, List, Optional, Tuple

from train_brake_report import style
from train_brake_report.figure import LeftOut
from train_brake_report.run import Run
from train_brake_report.series import common_rows

# Names for the page of what figures need.
TABLES = {"state": "TrainState", "forces": "InTrainForces", "pressures": "BrakePressures", "wagon": "WagonState"}


def lacks(run: Run, table: str) -> str:
    """Why the run cannot be drawn from this table; empty if it can."""
    return (
        ""
        if getattr(run.recording, table) is not None
        else (f"the recording has no topic of the type train_brake_msgs/{TABLES[table]}")
    )


@dataclasses.dataclass
class Group:
    name: str  # of the scenario; empty if there is only one group
    runs: List[Run]
    wagon: int
    coupler: Optional[int]  # None: the paper's, or the one with the largest force

    def drawable(self, why_not: Callable[[Run], str]) -> Tuple[List[Run], str]:
        """(the runs without a reason from why_not, a sentence on the others); LeftOut if none can be drawn."""
        reasons = {run: why_not(run) for run in self.runs}
        runs = [run for run, reason in reasons.items() if not reason]
        if not runs:
            same = len(set(reasons.values())) == 1
            text = reasons[self.runs[0]] if same else "; ".join(f"{r.label}: {reason}" for r, reason in reasons.items())
            raise LeftOut(f"{text[0].upper()}{text[1:]}.")
        others = "; ".join(f"{run.label}: {reason}" for run, reason in reasons.items() if reason)
        return runs, f" Not shown: {others}." if others else ""

    def having(self, table: str) -> Tuple[List[Run], str]:
        """The runs whose bag has this table, as drawable."""
        return self.drawable(lambda run: lacks(run, table))

    def line(self, run: Run) -> dict:
        """How the run is drawn in all figures."""
        return style.run_line(self.runs.index(run), len(self.runs))

    def colour(self, run: Run) -> str:
        return self.line(run)["color"]

    @staticmethod
    def comparable(
        runs: List[Run], table: str, same_instants: bool = True, same_train: bool = True
    ) -> Tuple[List[Run], str]:
        """(those of runs[1:] of which differences to the first can be taken, a sentence on the others)"""
        first, found, others = runs[0], [], []
        for run in runs[1:]:
            if same_train and run.vehicles != first.vehicles:
                others.append(f"{run.label} has {run.vehicles} vehicle(s), {first.label} {first.vehicles}")
            elif same_instants and not len(
                common_rows(getattr(first.recording, table).time_s, getattr(run.recording, table).time_s)[0]
            ):
                others.append(f"{run.label} and {first.label} have no instant in common")
            else:
                found.append(run)
        return found, f" No difference: {'; '.join(others)}." if others else ""

    @staticmethod
    def difference(run: Run, first: Run) -> str:
        return f"{run.label} \u2212 {first.label}"

    def commands(self) -> List[Tuple[dict, str, str]]:
        """To be marked in figures: those of all runs, and each run's own in its colour, by its label."""
        common = [c for c in self.runs[0].commands if all(c in run.commands for run in self.runs)]
        own = [(c, self.colour(run), run.label) for run in self.runs for c in run.commands if c not in common]
        return [(c, style.MUTED, "") for c in common] + own
