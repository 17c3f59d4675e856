#!/usr/bin/python3
"""`import train_brake` and `rosrun train_brake export`, as their users meet them."""
import csv
import functools
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest
from unittest import mock

import numpy
import rosbag
import rosunit

import train_brake
from train_brake import export

HERE = pathlib.Path(__file__).resolve().parent
FOLDER = tempfile.TemporaryDirectory()


@functools.lru_cache(maxsize=None)
def six_wagons():
    folder = pathlib.Path(FOLDER.name) / "six_wagons"
    subprocess.run(
        ["rosrun", "train_sim", "train_sim", "run", str(HERE / "short_train.yaml"), "--out", str(folder)],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    return folder


def messages(topic):
    """By a plain loop of rosbag."""
    with rosbag.Bag(str(six_wagons() / "train.bag")) as bag:
        return [message for _, message, _ in bag.read_messages(topic)]


class Load(unittest.TestCase):
    def test_every_topic_holds_what_a_plain_loop_finds(self):
        run = train_brake.load(six_wagons())
        with rosbag.Bag(str(six_wagons() / "train.bag")) as bag:
            recorded = set(bag.get_type_and_topic_info().topics) - {"/train/scenario"}
        self.assertEqual(recorded, {"/train/" + topic for topic in run})
        for topic in run:
            table, expected = run[topic], messages("/train/" + topic)
            self.assertEqual(len(expected), len(table))
            numpy.testing.assert_allclose(table.time_s, [m.header.stamp.to_sec() for m in expected], rtol=0, atol=1e-9)
            for field in table.fields:
                numpy.testing.assert_array_equal(
                    table[field], [getattr(m, field) for m in expected], f"{topic} {field}"
                )

    def test_only_what_is_asked_for_is_read(self):
        read = []

        def tables(bag, topics, whole=train_brake.BagFile.tables):
            read.append(list(topics))
            return whole(bag, topics)

        with mock.patch.object(train_brake.BagFile, "tables", tables):
            run = train_brake.load(six_wagons(), topics=["state", "brake_pressures"])
            self.assertEqual([["/train/state", "/train/brake_pressures"]], read)
            self.assertEqual(len(run["state"]), len(run["brake_pressures"]))
            self.assertEqual(1, len(read))

    def test_units_and_meanings_are_those_of_the_messages(self):
        state = train_brake.load(six_wagons())["state"]
        self.assertEqual(
            ("m/s", "m/s2", "N", "m", ""),
            tuple(
                state.unit(field)
                for field in ("speed_mps", "acceleration_mps2", "wheel_force_n", "position_m", "creepage")
            ),
        )
        self.assertEqual("[n] forward positive", state.meaning("speed_mps"))
        self.assertIn("NaN at the start", state.meaning("shoe_force_n"))  # the second line of its comment
        with self.assertRaisesRegex(KeyError, "speed: the messages have .*speed_mps"):
            state.unit("speed")

    def test_what_stands_beside_the_bag(self):
        run = train_brake.load(six_wagons())
        self.assertEqual(json.loads((six_wagons() / "summary.json").read_text()), run.summary)
        self.assertEqual(run.config["name"], run.summary["scenario"])
        self.assertEqual(5, len(run.couplers["max_tension_n"]))
        self.assertAlmostEqual(run.summary["max_tension_n"]["value"], run.couplers["max_tension_n"].max(), places=3)
        forces = run["in_train_forces"]["coupler_force_n"]
        self.assertTrue((run.couplers["max_tension_n"] >= forces.max(axis=0).clip(0) * (1 - 1e-6)).all())
        self.assertEqual(
            [command["time_s"] for command in run.config["commands"]],
            [event.time_s for event in run.events if event.kind in ("emergency", "apply", "release")],
        )

    def test_a_bag_alone_and_another_namespace(self):
        with tempfile.TemporaryDirectory() as folder:
            moved = pathlib.Path(folder) / "moved.bag"
            with rosbag.Bag(str(six_wagons() / "train.bag")) as old, rosbag.Bag(str(moved), "w") as new:
                for topic, raw, stamp in old.read_messages(raw=True):
                    new.write(topic.replace("/train/", "/line_7/freight/"), raw, stamp, raw=True)
            run, whole = train_brake.load(str(moved)), train_brake.load(six_wagons())
            self.assertEqual(whole.topics, run.topics)
            numpy.testing.assert_array_equal(whole["state"]["speed_mps"], run["state"]["speed_mps"])
            self.assertEqual(whole.config, run.config)
            self.assertEqual((None, None), (run.summary, run.couplers))

    def test_a_table_shows_what_it_holds(self):
        shown = repr(train_brake.load(six_wagons())["state"])
        for word in ("records from 0 to ", "speed_mps[6] m/s", "position_m[6] m", "exchange,"):
            self.assertIn(word, shown)

    def test_to_pandas(self):
        frame = train_brake.load(six_wagons()).to_pandas("state")
        state = train_brake.load(six_wagons())["state"]
        numpy.testing.assert_array_equal(frame["speed_mps_6"], state["speed_mps"][:, 5])
        numpy.testing.assert_array_equal(frame.index, state.time_s)
        self.assertEqual("time_s", frame.index.name)

    def test_what_cannot_be_read_is_named(self):
        with self.assertRaisesRegex(KeyError, "speeds: .*train.bag has .*state"):
            train_brake.load(six_wagons(), topics=["speeds"])
        with self.assertRaisesRegex(train_brake.BagError, "/nowhere: there is no such file or folder"):
            train_brake.load("/nowhere")
        with self.assertRaisesRegex(
            train_brake.BagError, "holds no train.bag; give one or more of its folders six_wagons"
        ):
            train_brake.load(six_wagons().parent)

    def test_a_bag_that_a_run_is_writing_is_no_damage(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "run"
            process = subprocess.Popen(
                [
                    "rosrun",
                    "train_sim",
                    "train_sim",
                    "run",
                    str(HERE / "short_train.yaml"),
                    "--out",
                    str(out),
                    "--set",
                    "duration_s=1e5",
                    "--set",
                    "record_interval_s=0.1",
                    "--set",
                    "ledger_interval_s=1",
                ],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            try:
                while not (out / "train.bag.active").exists():
                    self.assertIsNone(process.poll())
                with self.assertRaisesRegex(train_brake.BagError, "A run is writing it now: wait for its end"):
                    train_brake.load(out)
            finally:
                process.kill()
                process.wait()
            with self.assertRaisesRegex(
                train_brake.BagError, "Once no recorder is writing it any more, `rosbag reindex"
            ):
                train_brake.load(out)


class Export(unittest.TestCase):
    def setUp(self):
        self.out = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.out)

    def export(self, *arguments, code=0):
        done = subprocess.run(
            ["rosrun", "train_brake", "export", *map(str, arguments)], capture_output=True, text=True, check=False
        )
        self.assertEqual(code, done.returncode, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def test_csv_gives_the_same_numbers_again(self):
        self.export(six_wagons(), self.out)
        run = train_brake.load(six_wagons())
        self.assertEqual(
            {topic.replace("/", "_") + ".csv" for topic in run}, {file.name for file in self.out.iterdir()}
        )
        for topic in ("state", "in_train_forces"):
            with open(self.out / f"{topic}.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            for name, column in run[topic].flat():
                numpy.testing.assert_array_equal(
                    column, numpy.array([row[name] for row in rows], dtype=column.dtype), name
                )

    def test_hdf5_has_units_and_the_configuration(self):
        import h5py  # pylint: disable=import-outside-toplevel

        self.export(six_wagons(), self.out / "run.h5")
        run = train_brake.load(six_wagons())
        with h5py.File(self.out / "run.h5") as file:
            for topic in run:
                for field in run[topic].fields:
                    stored = file[topic][field]
                    data = stored.asstr()[()] if run[topic][field].dtype.kind == "U" else stored[()]
                    numpy.testing.assert_array_equal(run[topic][field], data)
                    self.assertEqual(
                        (run[topic].unit(field), run[topic].meaning(field)),
                        (stored.attrs["unit"], stored.attrs["meaning"]),
                    )
            self.assertEqual(run.config, json.loads(file.attrs["config"]))

    def test_chosen_topics_and_the_list(self):
        self.export(six_wagons(), self.out, "--topics", "state")
        self.assertEqual(["state.csv"], [file.name for file in self.out.iterdir()])
        listed = self.export(six_wagons(), "--list")
        self.assertRegex(listed, r"speed_mps \[m/s\] 6  \[n\] forward positive")

    def test_errors(self):
        self.assertIn("has no topic stat: it has", self.export(six_wagons(), self.out, "--topics", "stat", code=1))
        self.assertIn("there is no such file", self.export("/nowhere", self.out, code=1))
        self.assertIn("could not be written", self.export(six_wagons(), "/dev/full/x", code=1))
        self.export(six_wagons(), code=2)

    def test_a_full_output_is_an_error(self):
        for words in (["export", str(six_wagons()), "--list"], ["sweep", "--help"], ["report", "--help"]):
            with self.subTest(words=words), open("/dev/full", "w") as full:
                done = subprocess.run(
                    ["rosrun", "train_brake", *words],
                    stdout=full,
                    stderr=subprocess.PIPE,
                    text=True,
                    check=False,
                    env={name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"},
                )
                self.assertEqual(
                    (1, f"{words[0]}: the output could not be written: No space left on device\n"),
                    (done.returncode, done.stderr),
                )

    def test_hdf5_without_h5py_names_the_package(self):
        with mock.patch.dict("sys.modules", {"h5py": None}), self.assertRaisesRegex(
            train_brake.BagError, "python3-h5py"
        ):
            export.write_hdf5(train_brake.load(six_wagons()), ["state"], self.out / "x.h5")


class AnalysisTest(Export, Load):
    """All of the above."""


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "analysis_test", AnalysisTest)
