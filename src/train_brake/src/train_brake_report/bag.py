"""Reads a bag of a train into arrays: each topic one table, a row per record.

A bag of the paper's train holds 7000 records of 242 vehicles. Deserialised one by one they would take a minute; here
the bytes of all records of a topic are joined and seen as one numpy array. The layout comes from the message definition
that the bag itself carries.
"""

import contextlib
import dataclasses
import pathlib
import re
from typing import Dict, Iterator, List, Optional

import genpy
import numpy
import rosbag

from train_brake_report import paper

TRAIN_STATE = "train_brake_msgs/TrainState"
IN_TRAIN_FORCES = "train_brake_msgs/InTrainForces"
BRAKE_PRESSURES = "train_brake_msgs/BrakePressures"
ENERGY_LEDGER = "train_brake_msgs/EnergyLedger"
WAGON_STATE = "train_brake_msgs/WagonState"

NUMPY_TYPES = {"uint8": "<u1", "uint32": "<u4", "uint64": "<u8", "float32": "<f4", "float64": "<f8"}


BAG_BEGIN = b"#ROSBAG V"


class BagError(Exception):
    """A bag that cannot be reported on. The text names the file and the remedy."""


class Table:
    """The records of one topic: table["speed_mps"] has a row per record, table.time_s the simulated times [s]."""

    def __init__(self, rows: numpy.ndarray):
        self.rows = rows
        self.time_s = rows["secs"] + 1e-9 * rows["nsecs"]

    def __len__(self) -> int:
        return len(self.rows)

    def __contains__(self, field: str) -> bool:
        return field in self.rows.dtype.names

    def __getitem__(self, field: str) -> numpy.ndarray:
        if field not in self:
            raise BagError(f"a message in the bag has no field {field}: another version of train_brake wrote it. Make the "
                           "report with that one")
        return self.rows[field]


@dataclasses.dataclass
class Recording:
    """What a bag holds of a train. A table is None where the bag lacks the topic."""

    state: Optional[Table] = None
    forces: Optional[Table] = None
    pressures: Optional[Table] = None
    wagon: Optional[Table] = None  # one vehicle in full detail
    scenario: str = ""  # all of the configuration, as YAML
    ledger: List[genpy.Message] = dataclasses.field(default_factory=list)
    detailed_vehicles: List[int] = dataclasses.field(default_factory=list)


def _layout(message: genpy.Message) -> numpy.dtype:
    """Of the serialised bytes of messages whose texts and arrays are as long as those of this one."""
    fields = [("seq", "<u4"), ("secs", "<u4"), ("nsecs", "<u4"), ("frame_id", f"V{4 + len(message.header.frame_id)}")]
    for name, kind in zip(message.__slots__, message._slot_types):  # pylint: disable=protected-access
        if name == "header":
            continue
        element, array, length = re.fullmatch(r"(\w+)(\[(\d*)\])?", kind).groups()
        if array and not length:
            fields.append((name + " length", "<u4"))
            length = len(getattr(message, name))
        fields.append((name, NUMPY_TYPES[element], (int(length),) if array else ()))
    return numpy.dtype(fields)


def _table(topic: str, messages: List[bytes], message_type: type) -> Table:
    layout = _layout(message_type().deserialize(messages[0]))
    rows = numpy.frombuffer(b"".join(messages), layout) if all(len(m) == layout.itemsize for m in messages) else None
    if rows is None or any((rows[name] != rows[name][0]).any() for name in layout.names if name.endswith(" length")):
        raise BagError(f"the messages of {topic} differ in length: the bag holds more than one train. Record each run "
                       "into a bag of its own")
    backwards = numpy.flatnonzero(rows["exchange"][1:] < rows["exchange"][:-1])
    if len(backwards):
        time_s = Table(rows).time_s[backwards[0]]
        raise BagError(f"after {time_s:.3f} s {topic} begins anew: the bag holds more than one run. Record each into a "
                       "bag of its own")
    return Table(rows)


def _topics_by_type(bag: rosbag.Bag) -> Dict[str, List[str]]:
    """Without those under live/, which hold a few of the records once more, unless there are no others."""
    found: Dict[str, List[str]] = {}
    for topic, info in bag.get_type_and_topic_info().topics.items():
        found.setdefault(info.msg_type, []).append(topic)
    return {kind: [t for t in topics if "/live/" not in t] or topics for kind, topics in found.items()}


def _vehicle_of(bag: rosbag.Bag, topic: str) -> int:
    numbered = re.search(r"wagon_(\d+)/state$", topic)
    if numbered:
        return int(numbered.group(1))
    return next(bag.read_messages(topic)).message.vehicle


def _scenario(bag: rosbag.Bag) -> str:
    """Empty if the bag does not hold it."""
    topic = next((t for t in _topics_by_type(bag).get("std_msgs/String", []) if t.endswith("/scenario")), None)
    return next(bag.read_messages(topic)).message.data if topic else ""


def _read(bag: rosbag.Bag, wagon: Optional[int]) -> Recording:
    by_type = _topics_by_type(bag)
    chosen = {}
    for kind in (TRAIN_STATE, IN_TRAIN_FORCES, BRAKE_PRESSURES, ENERGY_LEDGER):
        topics = by_type.get(kind, [])
        if len(topics) > 1:
            raise BagError(f"it holds more than one train: {', '.join(sorted(topics))}. `rosbag filter` parts them")
        chosen.update((topic, kind) for topic in topics)
    details = {_vehicle_of(bag, topic): topic for topic in by_type.get(WAGON_STATE, [])}
    if wagon is None and details:
        wagon = paper.WAGON if paper.WAGON in details else min(details)
    if wagon in details:
        chosen[details[wagon]] = WAGON_STATE
    if not set(chosen.values()) - {ENERGY_LEDGER}:
        raise BagError("it holds no records of a train; it has "
                       + (", ".join(sorted(t for topics in by_type.values() for t in topics)) or "no message at all"))

    messages: Dict[str, List[bytes]] = {kind: [] for kind in chosen.values()}
    types = {}
    for topic, (_, data, _, _, message_type), _ in bag.read_messages(list(chosen), raw=True):
        messages[chosen[topic]].append(data)
        types[chosen[topic]] = message_type
    tables = {kind: _table(topic, messages[kind], types[kind]) for topic, kind in chosen.items() if kind != ENERGY_LEDGER}
    return Recording(tables.get(TRAIN_STATE), tables.get(IN_TRAIN_FORCES), tables.get(BRAKE_PRESSURES),
                     tables.get(WAGON_STATE), _scenario(bag),
                     [types[ENERGY_LEDGER]().deserialize(data) for data in messages.get(ENERGY_LEDGER, [])],
                     sorted(details))


@contextlib.contextmanager
def _opened(path: pathlib.Path) -> Iterator[rosbag.Bag]:
    """The bag; what goes wrong with it, then and later, becomes a BagError."""
    try:
        with open(path, "rb") as file:
            begin = file.read(len(BAG_BEGIN))
        if not begin:
            raise BagError("it is empty: nothing was recorded, or the disk was full. Run again")
        if begin != BAG_BEGIN:
            raise BagError("this is not a bag. Give a .bag file, or the folder of a run")
        with rosbag.Bag(str(path)) as bag:
            yield bag
    except BagError as error:
        raise BagError(f"{path}: {error}") from None
    except OSError as error:
        raise BagError(f"{path} cannot be read: {error.strerror or error}") from None
    except rosbag.ROSBagUnindexedException:
        raise BagError(f"{path} is damaged or was not closed: it has no index. `rosbag reindex {path}` keeps what can be "
                       "read; then call report again") from None
    except Exception as error:  # rosbag reads broken bytes as lengths and names: anything can follow
        raise BagError(f"{path} is damaged: {type(error).__name__}: {error}. `rosbag reindex {path}` keeps what can be "
                       "read; then call report again") from None


def read_bag(path: pathlib.Path, wagon: Optional[int]) -> Recording:
    """All of the train that the bag holds, and one vehicle in full detail if it was recorded so: the given one; if none
    is given, the paper's or the first.

    Topics are found by their type: it does not matter who recorded them, nor in which namespace.
    """
    with _opened(path) as bag:
        return _read(bag, wagon)


def read_scenario(path: pathlib.Path) -> str:
    """The configuration that the bag holds, as YAML; empty if it holds none."""
    with _opened(path) as bag:
        return _scenario(bag)
