"""Reads the topics of a bag into tables: a row per message, a column per field.

The bytes of all messages of a topic are joined and seen as one numpy array, in the layout of the installed message,
where all of them have the same length: a record of 242 vehicles costs some microseconds. Other messages are
deserialised one by one (of the paper's train: 1 to 3 s for 7000 records).
"""

import contextlib
import fcntl
import itertools
import os
import pathlib
import re
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import genpy
import numpy
import rosbag
import roslib.message

NUMPY_TYPES = {
    "bool": "?",
    "int8": "<i1",
    "uint8": "<u1",
    "int16": "<i2",
    "uint16": "<u2",
    "int32": "<i4",
    "uint32": "<u4",
    "int64": "<i8",
    "uint64": "<u8",
    "float32": "<f4",
    "float64": "<f8",
}
UNITS = {
    "mps2": "m/s2",
    "mps": "m/s",
    "kmh": "km/h",
    "radps": "rad/s",
    "rad": "rad",
    "pa": "Pa",
    "kpa": "kPa",
    "j": "J",
    "n": "N",
    "m": "m",
    "s": "s",
    "kg": "kg",
    "w": "W",
}
BAG_BEGIN = b"#ROSBAG V"


class BagError(Exception):
    """A bag that cannot be read. The text names the file and the remedy."""


class Damage(BagError):
    """The bytes are not a bag, or only a part of one."""


def unit_of(field: str) -> str:
    """By the suffix of a field's name: "m/s" of speed_mps; empty for numbers without a unit."""
    return UNITS.get(field.rsplit("_", 1)[-1], "") if "_" in field else ""


def _comments(definition: str) -> Dict[str, str]:
    """The comment of each field in the text of a message, continuation lines included."""
    found: Dict[str, str] = {}
    field = None
    for line in definition.split("=" * 80)[0].splitlines():
        code, _, comment = line.partition("#")
        words = code.split()
        if len(words) >= 2 and "=" not in code:
            field = words[1]
            found[field] = comment.strip()
        elif not words and comment and field and line[:1].isspace():
            found[field] = f"{found[field]} {comment.strip()}".strip()
        else:
            field = None
    return found


class Table:
    """The messages of one topic.

    table["speed_mps"]: a row per message, further dimensions as the field has; table.time_s: the simulated times [s]
    (those of reception for messages without a header).
    """

    def __init__(self, columns: Dict[str, numpy.ndarray], time_s: numpy.ndarray, definition: str = ""):
        self._columns = columns
        self.time_s = time_s
        self._definition = definition

    def __len__(self) -> int:
        return len(self.time_s)

    def __repr__(self) -> str:
        columns = [
            name + "".join(f"[{size}]" for size in column.shape[1:]) + (f" {unit_of(name)}" if unit_of(name) else "")
            for name, column in self._columns.items()
        ]
        span = f" from {self.time_s[0]:g} to {self.time_s[-1]:g} s" if len(self) else ""
        return f"<train_brake.Table of {len(self)} records{span}: {', '.join(columns)}>"

    def __getitem__(self, field: str) -> numpy.ndarray:
        try:
            return self._columns[field]
        except KeyError:
            raise KeyError(f"{field}: the messages have {', '.join(self._columns)}") from None

    @property
    def fields(self) -> List[str]:
        return list(self._columns)

    def unit(self, field: str) -> str:
        """Unit of a field; empty for numbers without a unit."""
        self[field]  # pylint: disable=pointless-statement
        return unit_of(field)

    def meaning(self, field: str) -> str:
        """What the message's definition says about a field, its sign among others."""
        self[field]  # pylint: disable=pointless-statement
        return _comments(self._definition).get(field, "")

    def at(self, chosen) -> "Table":
        """The rows of an index, a mask or a slice."""
        return Table(
            {name: column[chosen] for name, column in self._columns.items()}, self.time_s[chosen], self._definition
        )

    def flat(self) -> Iterator[Tuple[str, numpy.ndarray]]:
        """Columns of single numbers (or texts): (name, [records]). Elements of arrays are numbered from 1: speed_mps_1
        is the first vehicle's. Arrays that are not equally long in all messages are left out."""
        for name, column in self._columns.items():
            if column.ndim == 1 and column.dtype != object:
                yield name, column
            elif column.ndim == 2:
                for i in range(column.shape[1]):
                    yield f"{name}_{i + 1}", column[:, i]

    def to_pandas(self):
        """A pandas.DataFrame with the columns of flat(), indexed by time_s."""
        try:
            import pandas  # pylint: disable=import-outside-toplevel
        except ImportError:
            raise ImportError("to_pandas() needs pandas: apt-get install python3-pandas") from None
        return pandas.DataFrame(dict(self.flat()), index=pandas.Index(self.time_s, name="time_s"))


class Topic(NamedTuple):
    kind: str  # its type, such as train_brake_msgs/TrainState
    messages: int


def _words(definition: str) -> List[List[str]]:
    """Of the lines of a message definition, without comments."""
    lines = (line.split("#")[0].split() for line in definition.splitlines())
    return [words for words in lines if words]


def message_class(kind: str) -> Optional[type]:
    """The installed message of a type; None if there is none."""
    return roslib.message.get_message_class(kind) if re.fullmatch(r"\w+/\w+", kind) else None


def _must_be_installed(topic: str, kind: str, md5sum: str, definition: str, _header) -> bool:
    """A filter of connections for rosbag, which turns the definition in the bag into a Python module and imports it: a
    forged bag could execute any code. So only messages with the installed definitions are read."""
    message = message_class(kind)
    # pylint: disable=protected-access
    if message is None or md5sum != message._md5sum or _words(definition) != _words(message._full_text):
        raise BagError(
            f"the bag defines {kind} (topic {topic}) otherwise than this version of train_brake. Read it with the "
            "version that wrote the bag"
        )
    return True


@contextlib.contextmanager
def _damage_named() -> Iterator[None]:
    """Turns errors of rosbag and genpy into a BagError. Only for calls into these."""
    try:
        yield
    except BagError:
        raise
    except OSError as error:
        raise BagError(f"it cannot be read: {error.strerror or error}") from None
    except rosbag.ROSBagUnindexedException:
        raise Damage("is damaged or was not closed: it has no index") from None
    except Exception as error:  # broken bytes are read as lengths and names: anything can follow
        raise Damage(f"is damaged: {type(error).__name__}: {error}") from None


def is_being_written(folder: pathlib.Path) -> bool:
    """Whether a run holds the lock of its folder of results."""
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # a file system without locks
        return False
    finally:
        os.close(descriptor)
    return False


def _layout(message: genpy.Message) -> Optional[numpy.dtype]:
    """Of the serialised bytes of messages whose texts and arrays are as long as those of this one; None if a field is
    neither a number nor an array of numbers."""
    fields: List[tuple] = []
    for name, kind in zip(message.__slots__, message._slot_types):  # pylint: disable=protected-access
        if kind == "std_msgs/Header":
            fields += [
                ("seq", "<u4"),
                ("secs", "<u4"),
                ("nsecs", "<u4"),
                ("frame_id", f"V{4 + len(message.header.frame_id.encode())}"),
            ]
            continue
        element, array, length = re.fullmatch(r"([\w/]+)(\[(\d*)\])?", kind).groups()
        if element not in NUMPY_TYPES:
            return None
        if array and not length:
            fields.append((name + " length", "<u4"))
            length = len(getattr(message, name))
        fields.append((name, NUMPY_TYPES[element], (int(length),) if array else ()))
    return numpy.dtype(fields)


def _column(values: Sequence) -> numpy.ndarray:
    """[messages] or, of arrays that are equally long, [messages, elements]; else an array of objects."""
    if all(isinstance(value, (list, tuple, bytes)) for value in values):
        if len({len(value) for value in values}) == 1 and not any(
            isinstance(x, genpy.Message) for value in values for x in value
        ):
            return numpy.array([list(value) for value in values])
    elif not any(isinstance(value, genpy.Message) for value in values):
        return numpy.array(values)
    column = numpy.empty(len(values), dtype=object)
    column[:] = values
    return column


class BagFile:
    """A bag, read with the installed messages only. In a `with` block."""

    def __init__(self, path: pathlib.Path):
        """@raises BagError  names the file"""
        self.path = pathlib.Path(path)
        with self._named(), _damage_named():
            if self.path.exists() and not self.path.is_file():  # a pipe would be waited for
                raise BagError("this is no file" + (", but a folder" if self.path.is_dir() else ""))
            with open(self.path, "rb") as file:
                begin = file.read(len(BAG_BEGIN))
            if not begin:
                raise BagError("it is empty: nothing was recorded, or the disk was full. Run again")
            if begin != BAG_BEGIN:
                raise BagError("this is not a bag. Give a .bag file, or the folder of a run")
            self._bag = rosbag.Bag(str(self.path))

    def __enter__(self) -> "BagFile":
        return self

    def __exit__(self, *_) -> None:
        self._bag.close()

    @contextlib.contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except Damage as error:
            raise Damage(f"{self.path} {error}. {self._remedy()}") from None
        except BagError as error:
            raise BagError(f"{self.path}: {error}") from None

    def _remedy(self) -> str:
        if is_being_written(self.path.parent):
            return (
                "A run is writing it now: wait for its end, or stop the run (Ctrl-C); a bag that is written to must "
                "not be reindexed"
            )
        once = "Once no recorder is writing it any more, " if self.path.suffix == ".active" else ""
        return f"{once}`rosbag reindex {self.path}` keeps what can be read; then call again"

    @property
    def topics(self) -> Dict[str, Topic]:
        """The topics that have messages."""
        with self._named(), _damage_named():
            infos = self._bag.get_type_and_topic_info().topics
        return {name: Topic(info.msg_type, info.message_count) for name, info in infos.items() if info.message_count}

    def _raw(self, topics: Sequence[str], most: Optional[int] = None) -> Dict[str, List[Tuple[bytes, float]]]:
        """Of each topic: (serialised message, time of reception [s])"""
        found: Dict[str, List[Tuple[bytes, float]]] = {topic: [] for topic in topics}
        with self._named():
            with _damage_named():
                records = self._bag.read_messages(list(topics), raw=True, connection_filter=_must_be_installed)
                for record in itertools.islice(records, most):
                    found[record.topic].append((record.message[1], record.timestamp.to_sec()))
            if not all(found.values()):
                raise Damage(f"is damaged: its index has records of {', '.join(topics)} that are not there")
        return found

    def _deserialised(self, topic: str, data: bytes) -> genpy.Message:
        with self._named(), _damage_named():
            return message_class(self.topics[topic].kind)().deserialize(data)

    def first(self, topic: str) -> genpy.Message:
        ((data, _),) = self._raw([topic], 1)[topic]
        return self._deserialised(topic, data)

    def messages(self, topic: str) -> List[genpy.Message]:
        return [self._deserialised(topic, data) for data, _ in self._raw([topic])[topic]]

    def tables(self, topics: Sequence[str]) -> Dict[str, Table]:
        """Reads these topics in one pass through the bag.
        @raises BagError  if a topic holds more than one train or run, or the bag is damaged"""
        raw = self._raw(topics)
        with self._named():
            return {topic: self._table(topic, raw.pop(topic)) for topic in list(raw)}

    def _table(self, topic: str, raw: List[Tuple[bytes, float]]) -> Table:
        kind = self.topics[topic].kind
        messages = [data for data, _ in raw]
        first = self._deserialised(topic, messages[0])
        layout = _layout(first)
        is_record = kind.startswith("train_brake_msgs/") and "exchange" in first.__slots__
        rows = None
        if layout is not None and all(len(m) == layout.itemsize for m in messages):
            rows = numpy.frombuffer(b"".join(messages), layout)
            if any((rows[name] != rows[name][0]).any() for name in layout.names if name.endswith(" length")):
                rows = None
        if rows is not None:
            columns = {name: rows[name] for name in first.__slots__ if name != "header"}
            time_s = (
                rows["secs"] + 1e-9 * rows["nsecs"]
                if "secs" in layout.names
                else numpy.array([time for _, time in raw])
            )
        elif layout is not None and is_record:
            raise BagError(
                f"the messages of {topic} differ in length: the bag holds more than one train. Record each run "
                "into a bag of its own"
            )
        else:
            whole = [self._deserialised(topic, data) for data in messages]
            columns = {name: _column([getattr(m, name) for m in whole]) for name in first.__slots__ if name != "header"}
            has_header = "header" in first.__slots__
            time_s = numpy.array([m.header.stamp.to_sec() for m in whole] if has_header else [time for _, time in raw])
        table = Table(columns, time_s, type(first)._full_text)  # pylint: disable=protected-access
        if is_record:
            backwards = numpy.flatnonzero(table["exchange"][1:] < table["exchange"][:-1])
            if len(backwards):
                raise BagError(
                    f"after {time_s[backwards[0]]:.3f} s {topic} begins anew: the bag holds more than one run. "
                    "Record each into a bag of its own"
                )
        return table


def common_prefix(topics: Sequence[str], is_ours: Callable[[str], bool]) -> str:
    """The namespace of the train, with its last slash: that of the topics that are ours; "/" if there are none."""
    namespaces = [topic.split("/")[:-1] for topic in topics if is_ours(topic)]
    if not namespaces:
        return "/"
    common = list(itertools.takewhile(lambda names: len(set(names)) == 1, zip(*namespaces)))
    return "/".join(names[0] for names in common) + "/"
