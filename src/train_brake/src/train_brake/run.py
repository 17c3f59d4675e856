"""A run: its bag, and the files beside it."""

import csv
import functools
import json
import pathlib
from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Union

import numpy
import yaml

from train_brake.bag import BagError, BagFile, Table, Topic, common_prefix
from train_brake.run_files import CONFIG, SUMMARY, checked

BAGS = ("train.bag", "train.bag.active")


class Event(NamedTuple):
    """Something that happened once."""

    time_s: float
    kind: str  # such as "emergency", "stop"
    text: str


def bag_of(given: pathlib.Path) -> pathlib.Path:
    """The bag of a run's folder, or the bag itself. @raises BagError"""
    if not given.exists():
        raise BagError(f"{given}: there is no such file or folder")
    if not given.is_dir():
        return given
    for name in BAGS:
        if (given / name).exists():
            return given / name
    below = sorted(folder.name for folder in given.iterdir() if (folder / BAGS[0]).exists())
    hint = f"; give one or more of its folders {', '.join(below)}" if below else ""
    if (given / "study.json").exists():
        hint = "; it is a study, whose table is results.csv; sweep --keep-records keeps bags, in runs/NUMBER/results"
    raise BagError(f"{given} holds no {BAGS[0]}{hint}")


def parsed(text: str, source: pathlib.Path, parse) -> dict:
    """The keys in a text of JSON or YAML; none in an empty one. @raises BagError"""
    try:
        content = parse(text) if text else {}
    except (ValueError, RecursionError, yaml.YAMLError) as error:
        raise BagError(f"{source} is damaged: {' '.join(str(error).split())}") from None
    if not isinstance(content, dict):
        raise BagError(f"{source} is damaged: it is no list of keys")
    return content


def text_of(file: pathlib.Path) -> str:
    """Empty if there is no such file. @raises BagError"""
    if file.exists() and not file.is_file():
        raise BagError(f"{file} is no file")
    try:
        return file.read_text(encoding="utf-8") if file.exists() else ""
    except (OSError, UnicodeDecodeError) as error:
        raise BagError(f"{file} cannot be read: {error}") from None


def load_yaml(text: str) -> dict:
    return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


def config_from(text: str, source: pathlib.Path) -> Optional[dict]:
    """A run's configuration as text; None if it is empty. @raises BagError  if it is not one"""
    config = parsed(text, source, load_yaml)
    return checked(config, CONFIG, source, "the configuration of a run") if text else None


def summary_from(file: pathlib.Path) -> Optional[dict]:
    """A run's summary.json; None if there is none. @raises BagError  if it is not one"""
    text = text_of(file)
    return checked(parsed(text, file, json.loads), SUMMARY, file, "the summary of a run") if text else None


def read_couplers(file: pathlib.Path) -> Dict[str, numpy.ndarray]:
    """The columns of a run's couplers.csv: largest forces of all exchanges, and when, for each connection."""
    rows = list(csv.DictReader(text_of(file).splitlines()))
    try:
        return {
            name: numpy.array([float(row[name]) for row in rows])
            for name in ("max_tension_n", "max_tension_time_s", "max_compression_n", "max_compression_time_s")
        }
    except (KeyError, TypeError, ValueError) as error:
        raise BagError(f"{file} is damaged: {type(error).__name__}: {error}") from None


def is_scenario(topic: str, found: Topic) -> bool:
    return found.kind == "std_msgs/String" and topic.endswith("/scenario")


class Run:
    """One run. run[topic] is read on first access; names are those of the bag without the train's namespace:
    "state", "in_train_forces", "brake_pressures", "energy_ledger", "wagon_100/state"."""

    def __init__(self, given: Union[str, pathlib.Path]):
        """@raises BagError  if there is no bag, or no run in it"""
        self.path = pathlib.Path(given)
        self.bag = bag_of(self.path)
        with BagFile(self.bag) as bag:
            topics = bag.topics
            self._prefix = common_prefix(
                [t for t, found in topics.items() if found.kind.startswith("train_brake_msgs/")],
                lambda topic: "/live/" not in topic,
            )
            scenario = [topic for topic, found in topics.items() if is_scenario(topic, found)]
            if len(scenario) > 1:
                raise BagError(
                    f"{self.bag}: it holds more than one train: {', '.join(sorted(scenario))}. `rosbag filter` "
                    "parts them"
                )
            self._scenario = bag.first(scenario[0]).data if scenario else ""
        self._topics = {self._short(topic): topic for topic, found in topics.items() if not is_scenario(topic, found)}
        self._tables: Dict[str, Table] = {}

    def _short(self, topic: str) -> str:
        return topic[len(self._prefix) :] if topic.startswith(self._prefix) else topic

    def __repr__(self) -> str:
        return f"<train_brake.Run {self.path}: {', '.join(self.topics)}>"

    @property
    def topics(self) -> List[str]:
        """The names that run[...] knows."""
        return sorted(self._topics)

    def __iter__(self) -> Iterator[str]:
        return iter(self.topics)

    def __contains__(self, topic: str) -> bool:
        return topic in self._topics

    def __getitem__(self, topic: str) -> Table:
        self.read([topic])
        return self._tables[topic]

    def read(self, topics: Sequence[str]) -> None:
        """Reads several topics in one pass through the bag. @raises KeyError, BagError"""
        unknown = [topic for topic in topics if topic not in self._topics]
        if unknown:
            raise KeyError(f"{', '.join(unknown)}: {self.bag} has {', '.join(self.topics)}")
        wanted = [topic for topic in topics if topic not in self._tables]
        if not wanted:
            return
        with BagFile(self.bag) as bag:
            tables = bag.tables([self._topics[topic] for topic in wanted])
        self._tables.update((topic, tables[self._topics[topic]]) for topic in wanted)

    def _beside(self, name: str) -> pathlib.Path:
        return self.bag.parent / name

    @functools.cached_property
    def config(self) -> Optional[dict]:
        """The scenario with everything resolved; None if neither the bag nor its folder holds it."""
        source = self.bag if self._scenario else self._beside("config.yaml")
        belongs = self._scenario or self.bag.name in BAGS
        return config_from(self._scenario or (text_of(source) if belongs else ""), source)

    @functools.cached_property
    def summary(self) -> Optional[dict]:
        """summary.json; None if there is none (a run that was cut off, or a bag alone)."""
        source = self._beside("summary.json")
        return summary_from(source) if self.bag.name in BAGS else None

    @functools.cached_property
    def couplers(self) -> Optional[Dict[str, numpy.ndarray]]:
        """couplers.csv: of each connection the largest forces [N] of all exchanges, and their times [s]; None if there
        is none."""
        source = self._beside("couplers.csv")
        return read_couplers(source) if self.bag.name in BAGS and source.exists() else None

    @property
    def events(self) -> List[Event]:
        """Commands with a given time, stops and partings, in the order of their times."""
        found = [
            Event(
                float(command["time_s"]),
                str(command.get("kind")),
                ", ".join(
                    f"{key} {value}"
                    for key, value in command.items()
                    if key not in ("time_s", "kind") and value is not None
                ),
            )
            for command in (self.config or {}).get("commands") or []
            if command.get("time_s") is not None
        ]
        for stop in (self.summary or {}).get("stops") or []:
            found.append(Event(float(stop["time_s"]), "stop", f"after {stop['distance_m']} m"))
        for parting in (self.summary or {}).get("partings") or []:
            found.append(
                Event(
                    float(parting["time_s"]),
                    "parting",
                    ", ".join(f"{k} {v}" for k, v in parting.items() if k != "time_s"),
                )
            )
        return sorted(found)

    def to_pandas(self, topic: str):
        """A pandas.DataFrame of a topic; see Table.to_pandas."""
        return self[topic].to_pandas()


def load(given: Union[str, pathlib.Path], topics: Sequence[str] = ()) -> Run:
    """A run from its folder or from a bag, recorded by a run or by rosbag.

    @param topics are read at once; the others on first access
    @raises BagError  if it cannot be read; KeyError if it has no such topic
    """
    run = Run(given)
    run.read(list(topics))
    return run
