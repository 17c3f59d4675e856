"""Reads a bag of a train into arrays: each topic one table, a row per record.

A bag of the paper's train holds 7000 records of 242 vehicles. Deserialised one by one they would take a minute; here
the bytes of all records of a topic are joined and seen as one numpy array, in the layout of the installed message.
"""

import contextlib
import dataclasses
import itertools
import pathlib
import re
from typing import Dict, Iterator, List, Optional, Tuple
from unittest import mock

import genpy
import numpy
import rosbag
from std_msgs.msg import String
from train_brake_msgs.msg import BrakePressures, EnergyLedger, InTrainForces, TrainState, WagonState

from train_brake_report import paper

MESSAGES = {message._type: message  # pylint: disable=protected-access
            for message in (BrakePressures, EnergyLedger, InTrainForces, TrainState, WagonState, String)}
NUMPY_TYPES = {"uint8": "<u1", "uint32": "<u4", "uint64": "<u8", "float32": "<f4", "float64": "<f8"}
BAG_BEGIN = b"#ROSBAG V"


class BagError(Exception):
    """A bag that cannot be reported on. The text names the file and the remedy."""


class _Damage(BagError):
    """Bytes that are no bag, or not all of one."""


class Table:
    """The records of one topic: table["speed_mps"] has a row per record, table.time_s the simulated times [s]."""

    def __init__(self, rows: numpy.ndarray):
        self.rows = rows
        self.time_s = rows["secs"] + 1e-9 * rows["nsecs"]

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, field: str) -> numpy.ndarray:
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


def _words(definition: str) -> List[List[str]]:
    """Of the lines of a message definition, without comments."""
    lines = (line.split("#")[0].split() for line in definition.splitlines())
    return [words for words in lines if words]


def _installed(connection) -> type:
    """The installed message of a connection's type. rosbag would make a Python module of the definition in the bag and
    import it: whoever wrote the bag could have any program run."""
    message = MESSAGES.get(connection.datatype)
    # pylint: disable=protected-access
    if message is None or connection.md5sum != message._md5sum or _words(connection.msg_def) != _words(message._full_text):
        raise BagError(f"the bag defines {connection.datatype} (topic {connection.topic}) otherwise than this version of "
                       "train_brake. Make the report with the version that wrote the bag")
    return message


@contextlib.contextmanager
def _damage_named() -> Iterator[None]:
    """What goes wrong in rosbag and genpy becomes a BagError. Only calls into them belong here."""
    try:
        yield
    except BagError:
        raise
    except OSError as error:
        raise BagError(f"it cannot be read: {error.strerror or error}") from None
    except rosbag.ROSBagUnindexedException:
        raise _Damage("is damaged or was not closed: it has no index") from None
    except Exception as error:  # broken bytes are read as lengths and names: anything can follow
        raise _Damage(f"is damaged: {type(error).__name__}: {error}") from None


class _Bag:
    """A bag, read with the installed messages only."""

    def __init__(self, bag: rosbag.Bag):
        self._bag = bag

    def topics(self) -> Dict[str, List[str]]:
        """By type. Without those under live/, which hold a few of the records once more, unless there are no others."""
        with _damage_named():
            infos = self._bag.get_type_and_topic_info().topics
        found: Dict[str, List[str]] = {}
        for topic, info in infos.items():
            if info.message_count:
                found.setdefault(info.msg_type, []).append(topic)
        return {kind: [t for t in topics if "/live/" not in t] or topics for kind, topics in found.items()}

    def records(self, topics: List[str], most: Optional[int] = None) -> List[Tuple[str, bytes]]:
        """(topic, serialised message)"""
        with _damage_named(), mock.patch.object(rosbag.bag, "_get_message_type", _installed):
            records = itertools.islice(self._bag.read_messages(topics, raw=True), most)
            found = [(record.topic, record.message[1]) for record in records]
        if len({topic for topic, _ in found}) < len(topics):
            raise _Damage(f"is damaged: its index has records of {', '.join(topics)} that are not there")
        return found

    def first(self, topic: str, kind: str) -> genpy.Message:
        (_, data), = self.records([topic], 1)
        return deserialised(kind, data)


def deserialised(kind: str, data: bytes) -> genpy.Message:
    with _damage_named():
        return MESSAGES[kind]().deserialize(data)


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


def _table(topic: str, messages: List[bytes], kind: str) -> Table:
    layout = _layout(deserialised(kind, messages[0]))
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


def _vehicle_of(bag: _Bag, topic: str) -> int:
    numbered = re.search(r"wagon_(\d+)/state$", topic)
    return int(numbered.group(1)) if numbered else bag.first(topic, WagonState._type).vehicle


def _scenario(bag: _Bag) -> str:
    """Empty if the bag does not hold it."""
    topic = next((t for t in bag.topics().get(String._type, []) if t.endswith("/scenario")), None)
    return bag.first(topic, String._type).data if topic else ""


def _read(bag: _Bag, wagon: Optional[int]) -> Recording:
    by_type = bag.topics()
    chosen = {}  # type of each topic
    for message in (TrainState, InTrainForces, BrakePressures, EnergyLedger):
        topics = by_type.get(message._type, [])
        if len(topics) > 1:
            raise BagError(f"it holds more than one train: {', '.join(sorted(topics))}. `rosbag filter` parts them")
        chosen.update((topic, message._type) for topic in topics)
    details = {_vehicle_of(bag, topic): topic for topic in by_type.get(WagonState._type, [])}
    if wagon is None and details:
        wagon = paper.WAGON if paper.WAGON in details else min(details)
    if wagon in details:
        chosen[details[wagon]] = WagonState._type
    if not set(chosen.values()) - {EnergyLedger._type}:
        raise BagError("it holds no records of a train; it has "
                       + (", ".join(sorted(t for topics in by_type.values() for t in topics)) or "no message at all"))

    messages: Dict[str, List[bytes]] = {topic: [] for topic in chosen}
    for topic, data in bag.records(list(chosen)):
        messages[topic].append(data)
    ledger = [deserialised(kind, data) for topic, kind in chosen.items() if kind == EnergyLedger._type
              for data in messages[topic]]
    tables = {kind: _table(topic, messages[topic], kind) for topic, kind in chosen.items() if kind != EnergyLedger._type}
    return Recording(*(tables.get(message._type) for message in (TrainState, InTrainForces, BrakePressures, WagonState)),
                     _scenario(bag), ledger, sorted(details))


@contextlib.contextmanager
def _opened(path: pathlib.Path) -> Iterator[_Bag]:
    """A BagError then names the file."""
    try:
        with _damage_named():
            with open(path, "rb") as file:
                begin = file.read(len(BAG_BEGIN))
            if not begin:
                raise BagError("it is empty: nothing was recorded, or the disk was full. Run again")
            if begin != BAG_BEGIN:
                raise BagError("this is not a bag. Give a .bag file, or the folder of a run")
            bag = rosbag.Bag(str(path))
        with bag:
            yield _Bag(bag)
    except _Damage as error:
        raise BagError(f"{path} {error}. `rosbag reindex {path}` keeps what can be read; then call report again") from None
    except BagError as error:
        raise BagError(f"{path}: {error}") from None


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
