"""The command `export`: a run as CSV tables or as one HDF5 file."""

import argparse
import csv
import json
import pathlib
import sys
from typing import List

import numpy

from train_brake.bag import BagError
from train_brake.presentable import accept_all_characters, presentable, tell
from train_brake.run import Run, load

DESCRIPTION = """Writes what a run has recorded as CSV tables, one per topic, or as one HDF5 file.

RUN is the folder of a run or a bag, whether train_sim, ltd_master or `rosbag record` wrote it."""
EPILOG = """CSV: the columns are time_s and the fields; elements of arrays are numbered from 1 (speed_mps_1: the first
vehicle).
HDF5: a group per topic, a dataset per field with the attributes unit and meaning; the configuration, the summary and
the events as JSON in the attributes of the file.

Exit codes: 0 done; 1 the run cannot be read, or the tables cannot be written; 2 wrong arguments."""


def _arguments(argv: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        "export", description=DESCRIPTION, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("run", metavar="RUN", type=pathlib.Path, help="folder of a run, or a bag")
    parser.add_argument(
        "out", nargs="?", metavar="OUT", type=pathlib.Path, help="folder for CSV tables, or a file that ends in .h5"
    )
    parser.add_argument("--topics", metavar="TOPIC", nargs="+", help="only these (default: all); --list shows them")
    parser.add_argument("--list", action="store_true", help="show topics and fields, write nothing")
    options = parser.parse_args(argv)
    if options.out is None and not options.list:
        parser.error("OUT is missing: where to write (or --list)")
    return options


def _describe(run: Run) -> None:
    for topic in run:
        table = run[topic]
        print(f"{topic}: {len(table)} records")
        for field in table.fields:
            unit = f" [{table.unit(field)}]" if table.unit(field) else ""
            print(
                f"  {field}{unit} {'x'.join(str(n) for n in table[field].shape[1:])}  {table.meaning(field)}".rstrip()
            )


def write_csv(run: Run, topics: List[str], folder: pathlib.Path) -> List[pathlib.Path]:
    """One table per topic: TOPIC.csv, "/" in its name as "_"."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for topic in topics:
        table = run[topic]
        columns = dict(table.flat())
        file = folder / (topic.strip("/").replace("/", "_") + ".csv")
        unfinished = file.with_name(file.name + ".unfinished")
        with open(unfinished, "w", newline="", encoding="utf-8") as out:
            writer = csv.writer(out, lineterminator="\n")
            writer.writerow(["time_s", *columns])
            # str() of Python's numbers is the shortest text that gives the same number again
            writer.writerows(zip(table.time_s.round(9).tolist(), *(_texts(column) for column in columns.values())))
        unfinished.replace(file)
        written.append(file)
    return written


def _texts(column: numpy.ndarray) -> list:
    if column.dtype == numpy.float32:
        return [str(number) for number in column]  # shortest as float32: "0.1", not "0.10000000149011612"
    return column.tolist()


def write_hdf5(run: Run, topics: List[str], file: pathlib.Path) -> List[pathlib.Path]:
    try:
        import h5py  # pylint: disable=import-outside-toplevel
    except ImportError:
        raise BagError("HDF5 needs h5py: apt-get install python3-h5py") from None
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(file.name + ".unfinished")
    with h5py.File(unfinished, "w") as out:
        out.attrs["config"] = json.dumps(run.config)
        out.attrs["summary"] = json.dumps(run.summary)
        out.attrs["events"] = json.dumps(run.events)
        for topic in topics:
            table = run[topic]
            group = out.create_group(topic)
            group.create_dataset("time_s", data=table.time_s).attrs["unit"] = "s"
            for field in table.fields:
                column = table[field]
                if column.dtype == object:
                    continue  # not equally long in all messages
                data = column.astype(h5py.string_dtype()) if column.dtype.kind == "U" else column
                dataset = group.create_dataset(field, data=data, compression="gzip", compression_opts=1)
                dataset.attrs["unit"], dataset.attrs["meaning"] = table.unit(field), table.meaning(field)
    unfinished.replace(file)
    return [file]


def _export(options: argparse.Namespace) -> None:
    run = load(options.run)
    if options.list:
        _describe(run)
        return
    topics = options.topics or run.topics
    unknown = [topic for topic in topics if topic not in run]
    if unknown:
        raise BagError(f"{options.run} has no topic {', '.join(unknown)}: it has {', '.join(run.topics)}")
    run.read(topics)
    is_hdf5 = options.out.suffix in (".h5", ".hdf5")
    for file in (write_hdf5 if is_hdf5 else write_csv)(run, topics, options.out):
        tell(f"export: wrote {file}")
    for topic in topics:
        left_out = [field for field in run[topic].fields if run[topic][field].dtype == object]
        if left_out:
            print(f"export: {topic}: left out {', '.join(left_out)}: not equally long in all messages", file=sys.stderr)


def main(argv: List[str]) -> int:
    accept_all_characters()
    options = _arguments(argv)
    try:
        _export(options)
    except BagError as error:
        print(presentable(f"export: {error}"), file=sys.stderr)
        return 1
    except BrokenPipeError:  # of --list into a closed pipe
        return 1
    except OSError as error:
        print(presentable(f"export: the tables could not be written: {error}"), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0
