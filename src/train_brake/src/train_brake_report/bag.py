"""The tables of one train in a bag, found by their types."""

import dataclasses
import pathlib
import re
from typing import Dict, List, Optional

import genpy
from train_brake.bag import BagError, BagFile, Table
from train_brake.run import is_scenario
from train_brake_msgs.msg import BrakePressures, EnergyLedger, InTrainForces, TrainState, WagonState

from train_brake_report import paper


@dataclasses.dataclass
class Recording:
    """The tables of a train in a bag. A table is None if the bag lacks the topic."""

    state: Optional[Table] = None
    forces: Optional[Table] = None
    pressures: Optional[Table] = None
    wagon: Optional[Table] = None  # one vehicle in full detail
    scenario: str = ""  # all of the configuration, as YAML
    ledger: List[genpy.Message] = dataclasses.field(default_factory=list)
    detailed_vehicles: List[int] = dataclasses.field(default_factory=list)


def _by_type(bag: BagFile) -> Dict[str, List[str]]:
    """The topics of each type. Without those under live/, which hold a few of the records once more, unless there are
    no others."""
    found: Dict[str, List[str]] = {}
    for topic, info in bag.topics.items():
        found.setdefault(info.kind, []).append(topic)
    return {kind: [t for t in topics if "/live/" not in t] or topics for kind, topics in found.items()}


def _vehicle_of(bag: BagFile, topic: str) -> int:
    numbered = re.search(r"wagon_(\d+)/state$", topic)
    return int(numbered.group(1)) if numbered else bag.first(topic).vehicle


def _scenario(bag: BagFile) -> str:
    """Empty if the bag does not hold it."""
    topic = next((topic for topic, found in bag.topics.items() if is_scenario(topic, found)), None)
    return bag.first(topic).data if topic else ""


def read_bag(path: pathlib.Path, wagon: Optional[int]) -> Recording:
    """All of the train that the bag holds, and one vehicle in full detail if it was recorded so: the given one; if none
    is given, the paper's or the first.

    Topics are found by their type: it does not matter who recorded them, nor in which namespace.
    """
    # pylint: disable=protected-access
    with BagFile(path) as bag:
        by_type = _by_type(bag)
        chosen = {}  # topic of each type
        for message in (TrainState, InTrainForces, BrakePressures, EnergyLedger):
            topics = by_type.get(message._type, [])
            if len(topics) > 1:
                raise BagError(
                    f"{path}: it holds more than one train: {', '.join(sorted(topics))}. `rosbag filter` parts them"
                )
            chosen.update((message._type, topic) for topic in topics)
        details = {_vehicle_of(bag, topic): topic for topic in by_type.get(WagonState._type, [])}
        if wagon is None and details:
            wagon = paper.WAGON if paper.WAGON in details else min(details)
        if wagon in details:
            chosen[WagonState._type] = details[wagon]
        if not set(chosen) - {EnergyLedger._type}:
            raise BagError(
                f"{path}: it holds no records of a train; it has "
                + (", ".join(sorted(t for topics in by_type.values() for t in topics)) or "no message at all")
            )
        ledger = bag.messages(chosen[EnergyLedger._type]) if EnergyLedger._type in chosen else []
        tables = bag.tables([topic for kind, topic in chosen.items() if kind != EnergyLedger._type])
        found = [
            tables.get(chosen.get(message._type)) for message in (TrainState, InTrainForces, BrakePressures, WagonState)
        ]
        return Recording(*found, _scenario(bag), ledger, sorted(details))


def read_scenario(path: pathlib.Path) -> str:
    """The configuration that the bag holds, as YAML; empty if it holds none."""
    with BagFile(path) as bag:
        return _scenario(bag)
