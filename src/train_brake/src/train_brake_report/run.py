"""A run of the train: its bag, and the config.yaml and summary.json of the same run where there are any."""

import functools
import pathlib
import re
from typing import List, Optional

import numpy
from train_brake.bag import BagError
from train_brake.presentable import presentable
from train_brake.run import bag_of, config_from, load_yaml, parsed, read_couplers, summary_from, text_of

from train_brake_report import consist
from train_brake_report.bag import Recording, read_bag, read_scenario

KMH_PER_MPS = 3.6
VALUE_OF = {  # the key of the number that follows a command's kind in summary.json
    "apply": "reduction_kpa",
    "independent_brake": "pressure_kpa",
    "throttle": "notch",
    "dynamic_brake": "notch",
    "friction": "friction_coefficient",
}
MODEL_NAMES = {"2d": "2D train", "ltd": "LTD", "ltd-no-inertia": "LTD without rotational inertia"}


class Run:
    """One run, read. Values that neither the bag nor its folder has are None."""

    def __init__(self, given: pathlib.Path, wagon: Optional[int]):
        self.given = given
        self.bag = bag_of(given)
        self.recording: Recording = read_bag(self.bag, wagon)
        self.notes: List[str] = []
        self.label = ""  # set by label_runs
        self.is_of_paper = False  # set by paper.judge
        self._find_companions()
        self._judge_records()

    def _find_companions(self) -> None:
        """summary.json and config.yaml belong to the train.bag beside them; to another bag if the digests agree."""
        folder = self.bag.parent
        is_named = self.bag.name.startswith("train.bag")
        try:
            summary = summary_from(folder / "summary.json")
        except BagError:
            if is_named:
                raise
            summary = None  # of something else than this bag
        proved = summary is not None and self.digest is not None and summary.get("state_digest") == self.digest
        belong = proved or is_named
        if belong and summary is not None and self.digest is not None and not proved:
            self.notes.append(
                "The last record of the bag is not the last of the run (summary.json has another digest): the "
                "end of the bag is missing."
            )
        self.summary = summary if belong else None
        self.config_file = folder / "config.yaml" if belong and (folder / "config.yaml").exists() else None
        self.slides_file = folder / "slides.csv" if belong and (folder / "slides.csv").exists() else None
        self.track_wear_file = folder / "track_wear.csv" if belong and (folder / "track_wear.csv").exists() else None
        self.couplers_file = folder / "couplers.csv" if belong and (folder / "couplers.csv").exists() else None
        self.config_text = self.recording.scenario or (text_of(self.config_file) if self.config_file else "")
        self.config = config_from(self.config_text, self.bag if self.recording.scenario else self.config_file)

    def _judge_records(self) -> None:
        table = self.records
        intervals = numpy.diff(table.time_s)
        usual = numpy.median(intervals) if len(intervals) else 0.0
        begins_late = table.time_s[0] > 1.5 * usual
        if begins_late:
            self.notes.append(f"The bag begins at {table.time_s[0]:.2f} s.")
        gaps = intervals > 1.5 * usual
        self.has_all_records = not begins_late and not gaps.any()  # up to its end
        if usual > 0.0 and gaps.any():
            missing = int(numpy.round(intervals[gaps] / usual - 1).sum())
            self.notes.append(
                f"{missing} records are missing from the bag, the first after " f"{table.time_s[:-1][gaps][0]:.2f} s."
            )
        if self.complete is False and self.reached_its_end is not False:
            self.notes.append("INCOMPLETE: only a part of the run was recorded.")
        elif self.complete is False:
            self.notes.append(
                f"INCOMPLETE: the run ended at {self.end_s:.2f} s"
                + (f" of {self.config['duration_s']:g} s" if self.config else "")
                + (f", because {self.summary['fault']}." if self.fault else ", stopped by its user or cut off.")
            )

    @property
    def records(self):
        """Any of the tables: when the run was recorded."""
        r = self.recording
        return next(t for t in (r.state, r.forces, r.pressures, r.wagon) if t is not None)

    @property
    def end_s(self) -> float:
        return float(self.records.time_s[-1])

    @property
    def reached_its_end(self) -> Optional[bool]:
        """None: unknown, because there is only a bag."""
        if self.summary is not None:
            return bool(self.summary.get("complete"))
        if self.config is not None:
            return self.end_s >= self.config["duration_s"] - 1e-6
        return None

    @property
    def complete(self) -> Optional[bool]:
        """With a summary the numbers are those of the whole run, whatever the bag lacks. None: unknown."""
        if self.summary is None and not self.has_all_records:
            return False
        return self.reached_its_end

    @property
    def fault(self) -> Optional[str]:
        return (self.summary or {}).get("fault")

    @property
    def model(self) -> str:
        named = (self.config or self.summary or {}).get("model")
        if named:
            return named
        state = self.recording.state
        return "2d" if state is not None and numpy.isfinite(state["creepage"]).any() else "ltd"

    @property
    def scenario(self) -> str:
        """Empty if unknown."""
        return (self.config or {}).get("name") or (self.summary or {}).get("scenario", "")

    @property
    def vehicles(self) -> int:
        r = self.recording
        for table, field, more in (
            (r.state, "position_m", 0),
            (r.pressures, "cylinder_pressure_pa", 0),
            (r.forces, "coupler_force_n", 1),
        ):
            if table is not None:
                return table[field].shape[1] + more
        return max(r.detailed_vehicles)

    @property
    def digest(self) -> Optional[str]:
        """Of all states up to the last record of the bag."""
        state = self.recording.state
        return f"{state['state_digest'][-1]:016x}" if state is not None else None

    @functools.cached_property
    def masses_kg(self) -> numpy.ndarray:
        """Of each vehicle; equal if the configuration is not known."""
        if self.config is None:
            return numpy.ones(self.vehicles)
        return consist.masses_kg(self.config["train"])

    @functools.cached_property
    def lengths_m(self) -> numpy.ndarray:
        """Of each vehicle over couplers; 0 if the configuration is not known."""
        return consist.lengths_m(self.config["train"]) if self.config else numpy.zeros(self.vehicles)

    @functools.cached_property
    def largest_coupler_forces_n(self) -> numpy.ndarray:
        """[0: tension, 1: compression][connection]: of all exchanges if the run wrote couplers.csv, else of the
        records."""
        if self.couplers_file is None:
            forces = self.recording.forces["coupler_force_n"]
            return numpy.array([numpy.maximum(forces.max(axis=0), 0.0), numpy.minimum(forces.min(axis=0), 0.0)])
        couplers = read_couplers(self.couplers_file)
        return numpy.array([couplers["max_tension_n"], couplers["max_compression_n"]])

    @functools.cached_property
    def mean_speed_kmh(self) -> numpy.ndarray:
        """Of the train's momentum, at each record of its state."""
        return KMH_PER_MPS * (self.recording.state["speed_mps"] @ (self.masses_kg / self.masses_kg.sum()))

    @property
    def commands(self) -> List[dict]:
        """Commands with a time, and those given during the run: by a condition of the scenario, or live."""
        listed = (self.config or {}).get("commands") or []
        timed = [
            c for c in listed if c.get("time_s") is not None and c["kind"] != "friction"
        ]  # which is given on the way
        for given in (self.summary or {}).get("commands") or []:
            kind, *value = given["command"].split()
            command = {"time_s": given["time_s"], "kind": kind}
            if value:
                command[VALUE_OF[kind]] = float(value[0])
            timed.append(command)
        return sorted(timed, key=lambda command: command["time_s"])

    @property
    def brake_commands(self) -> List[dict]:
        return [command for command in self.commands if command["kind"] in ("apply", "emergency", "release")]


def scenario_of(given: pathlib.Path) -> str:
    """The scenario's name; empty if unknown."""
    bag = bag_of(given)
    beside = bag.parent / "config.yaml"
    return parsed(read_scenario(bag) or text_of(beside), beside, load_yaml).get("name", "")


def label_runs(runs: List[Run]) -> None:
    """Names each run by what distinguishes it from the others: its model, else its scenario, its folder, its path."""
    for name in (
        lambda r: MODEL_NAMES.get(r.model, r.model),
        lambda r: r.scenario,
        lambda r: r.given.stem if r.given.suffix == ".bag" and r.given.stem != "train" else r.bag.parent.name,
        lambda r: str(r.given),
    ):
        labels = [name(run) for run in runs]
        if len(set(labels)) == len(runs) and all(label.strip() for label in labels):
            break
    for run, label in zip(runs, labels):
        # Matplotlib keeps labels that begin with "_" out of legends: a space of no width stands before it.
        run.label = re.sub("^_", "\u200b_", " ".join(presentable(label).split()))
