#!/usr/bin/env python3
"""Runs of train_sim that were broken off and go on: the same bits, one continuous bag; and what is refused.

usage: resume_test.py TRAIN_SIM CONFIG_FOLDER [--gtest_output=xml:FILE]
"""

import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rosunit

TRAIN_SIM, CONFIG = sys.argv[1], pathlib.Path(sys.argv[2])
EMERGENCY = str(CONFIG / "scenarios" / "emergency.yaml")
# Long enough to be broken off anywhere, short enough to wait for.
RUN = [EMERGENCY, "--set", "duration_s=30", "--checkpoint-interval", "2"]


def train_sim(*arguments, **options):
    return subprocess.run(
        [TRAIN_SIM, "run", "--json", *map(str, arguments)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        timeout=300,
        **options,
    )


def messages(bag_file):
    """Everything in a bag, byte by byte."""
    with rosbag.Bag(str(bag_file)) as bag:
        return [(topic, raw[1], time.to_nsec()) for topic, raw, time in bag.read_messages(raw=True)]


def xxh64(data):
    """XXH64 with seed 0, as its specification says."""
    p1, p2, p3, p4, p5 = (
        11400714785074694791,
        14029467366897019727,
        1609587929392839161,
        9650029242287828579,
        2870177450012600261,
    )
    mask, at = (1 << 64) - 1, 0
    rotate = lambda x, n: (x << n | x >> (64 - n)) & mask
    turn = lambda lane, word: rotate(lane + word * p2 & mask, 31) * p1 & mask
    word = lambda: int.from_bytes(data[at : at + 8], "little")
    if len(data) < 32:
        state = p5
    else:
        lanes = [p1 + p2 & mask, p2, 0, -p1 & mask]
        while at <= len(data) - 32:
            for i in range(4):
                lanes[i] = turn(lanes[i], word())
                at += 8
        state = sum(rotate(lane, n) for lane, n in zip(lanes, (1, 7, 12, 18))) & mask
        for lane in lanes:
            state = (state ^ turn(0, lane)) * p1 + p4 & mask
    state = state + len(data) & mask
    while at <= len(data) - 8:
        state = rotate(state ^ turn(0, word()), 27) * p1 + p4 & mask
        at += 8
    if at <= len(data) - 4:
        state = rotate(state ^ int.from_bytes(data[at : at + 4], "little") * p1 & mask, 23) * p2 + p3 & mask
        at += 4
    for byte in data[at:]:
        state = rotate(state ^ byte * p5 & mask, 11) * p1 & mask
    for shift, factor in ((33, p2), (29, p3)):
        state = (state ^ state >> shift) * factor & mask
    return state ^ state >> 32


def with_checksum(content):
    """A forged checkpoint: the checksum guards against accidents only."""
    return bytes(content[:-8]) + xxh64(bytes(content[:-8])).to_bytes(8, "big")


class ResumeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)
        cls.whole = pathlib.Path(cls.shared.name) / "whole"
        done = train_sim(*RUN, "--out", cls.whole, "--csv")
        assert done.returncode == 0, done.stderr
        cls.summary = json.loads(done.stdout)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"

    def break_off(self, how, *arguments):
        """Runs until there is a checkpoint and a little more, and ends it by a signal."""
        process = subprocess.Popen(
            [TRAIN_SIM, "run", *RUN, "--out", str(self.out), *arguments],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        deadline = time.monotonic() + 60
        while not (self.out / "checkpoint").exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(how)
        return process.wait(60)

    def refused(self, text, *arguments):
        before = {file: file.read_bytes() for file in self.out.iterdir()} if self.out.exists() else {}
        done = train_sim(*arguments)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn(text, done.stderr)
        for file, content in before.items():
            self.assertEqual(content, file.read_bytes(), file)

    def test_an_interrupted_run_goes_on_to_the_same_files(self):
        self.assertEqual(130, self.break_off(signal.SIGINT, "--csv"))
        interrupted = json.loads((self.out / "summary.json").read_text())
        done = train_sim("--resume", self.out, "--threads", "1")
        self.assertEqual(0, done.returncode, done.stderr)
        summary = json.loads(done.stdout)
        self.assertEqual(interrupted["simulated_s"], summary["resumed_at_s"])  # Ctrl-C leaves a checkpoint of the end
        for key in set(summary) - {"wall_s", "real_time_factor", "ns_per_vehicle_step", "resumed_at_s"}:
            self.assertEqual(self.summary[key], summary[key], key)
        for table in self.whole.glob("*.csv"):
            self.assertEqual(table.read_text(), (self.out / table.name).read_text(), table.name)
        self.assertEqual(messages(self.whole / "train.bag"), messages(self.out / "train.bag"))

    def test_a_killed_run_goes_on_from_its_last_checkpoint(self):
        self.break_off(signal.SIGKILL)
        self.assertFalse((self.out / "summary.json").exists())
        done = train_sim("--resume", self.out)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual(0, json.loads(done.stdout)["resumed_at_s"] % 2)
        self.assertEqual(messages(self.whole / "train.bag"), messages(self.out / "train.bag"))

    def test_broken_off_again_and_again(self):
        self.break_off(signal.SIGKILL)
        for _ in range(3):
            process = subprocess.Popen(
                [TRAIN_SIM, "run", "--resume", str(self.out), "--checkpoint-interval", "1"],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            time.sleep(0.3)
            process.kill()
            process.wait()
        done = train_sim("--resume", self.out)
        if done.returncode == 2:  # the kills came too late
            self.assertIn("nothing is left to simulate", done.stderr)
        else:
            self.assertEqual(self.summary["state_digest"], json.loads(done.stdout)["state_digest"])
            self.assertEqual(messages(self.whole / "train.bag"), messages(self.out / "train.bag"))

    def test_a_branch_is_a_run_of_its_own(self):
        self.break_off(signal.SIGINT)
        before = (self.out / "train.bag").read_bytes()
        branch = self.folder / "branch"
        change = ["--set", "track.friction_patches=[{from_m: -1e6, to_m: 1e6, friction_coefficient: 0.1}]"]
        self.refused("a folder of its own", "--resume", self.out, *change)
        done = train_sim("--resume", self.out, *change, "--out", branch)
        self.assertEqual(0, done.returncode, done.stderr)
        summary = json.loads(done.stdout)
        self.assertTrue(summary["complete"])
        self.assertNotEqual(self.summary["state_digest"], summary["state_digest"])
        self.assertEqual(before, (self.out / "train.bag").read_bytes())  # what it branched from stays
        verified = subprocess.run([TRAIN_SIM, "verify", str(branch)], stdout=subprocess.PIPE, text=True)
        self.assertEqual(0, verified.returncode, verified.stdout)
        self.assertIn("from %g s, where it left another run" % summary["resumed_at_s"], verified.stdout)
        # One bag: up to the checkpoint that of the run, from there on another.
        at_ns = round(1e9 * summary["resumed_at_s"])
        states = [
            [m for m in messages(folder / "train.bag") if m[0] == "/train/state"] for folder in (self.whole, branch)
        ]
        self.assertEqual(len(states[0]), len(states[1]))
        for a, b in zip(*states):
            self.assertEqual(a[2], b[2])
            self.assertEqual(a[2] <= at_ns, a == b, a[2])

    def test_a_longer_duration_goes_on_behind_the_end(self):
        longer = self.folder / "longer"
        done = train_sim("--resume", self.whole, "--set", "duration_s=31", "--out", longer)
        self.assertEqual(0, done.returncode, done.stderr)
        at_once = train_sim(EMERGENCY, "--set", "duration_s=31")
        self.assertEqual(json.loads(at_once.stdout)["state_digest"], json.loads(done.stdout)["state_digest"])

    def test_what_does_not_fit_is_refused(self):
        self.refused("nothing is left to simulate", "--resume", self.whole)
        self.refused("has left no checkpoint", "--resume", self.folder)
        self.refused("give a scenario, or --resume", "--resume", self.whole, EMERGENCY)
        self.refused("give a scenario, or --resume")
        self.refused("with the tables that it began with", "--resume", self.whole, "--csv")
        for change, text in (
            ("dt_s=0.0005", "dt_s must stay 0.001"),
            ("model=ltd", "model must stay 2d"),
            ("train.consist[1].count=118", "number of vehicles must stay 242"),
            ("detail_vehicles=[7]", "detail_vehicles must stay"),
            ("initial_speed_kmh=60", "initial_speed_kmh must stay 80"),
            ("initial_slack=bunched", "initial_slack must stay"),
            (
                "commands=[{time_s: 3, kind: emergency}]",
                "commands up to 30 s must stay (2 s: emergency) when a run is resumed, got (3 s: emergency)",
            ),
            ("duration_s=abc", "duration_s must be"),
        ):
            self.refused(text, "--resume", self.whole, "--set", change, "--out", self.out)

    def test_a_checkpoint_ends_with_its_xxh64(self):
        content = (self.whole / "checkpoint").read_bytes()
        self.assertEqual(xxh64(b""), 0xEF46DB3751D8E999)
        self.assertEqual(content[-8:].hex(), "%016x" % xxh64(content[:-8]))

    def test_a_changed_or_damaged_folder_is_refused(self):
        shutil.copytree(self.whole, self.out)
        config = self.out / "config.yaml"
        text = config.read_text()
        config.write_text(text.replace("duration_s: 30", "duration_s: 40"))
        self.refused("there is now 'duration_s: 40', was 'duration_s: 30'", "--resume", self.out)
        config.write_text(text)
        checkpoint = self.out / "checkpoint"
        content = bytearray(checkpoint.read_bytes())
        checkpoint.write_bytes(content[:-100])
        self.refused("checkpoint is damaged or cut short", "--resume", self.out)
        content[1000] ^= 1
        checkpoint.write_bytes(content)
        self.refused("its checksum is wrong", "--resume", self.out)
        checkpoint.write_text("something else")
        self.refused("is not a checkpoint of a train", "--resume", self.out)
        content[8] = 77
        checkpoint.write_bytes(content)
        self.refused("format version 77", "--resume", self.out)

    def test_records_that_are_not_those_of_the_checkpoint_are_refused(self):
        shutil.copytree(self.whole, self.out)
        longer = self.folder / "longer"
        for name, text in (
            ("train.bag", "is not the bag that the checkpoint is of"),
            ("pressures.csv", "is not the table that the checkpoint is of"),
            ("wagon_100.csv", "is not the table that the checkpoint is of"),
        ):
            file = self.out / name
            content = bytearray(file.read_bytes())
            content[len(content) // 2] ^= 1
            file.write_bytes(content)
            self.refused(text, "--resume", self.out, "--set", "duration_s=31", "--out", longer)
            content[len(content) // 2] ^= 1
            file.write_bytes(content[: len(content) // 2])
            self.refused(
                "shorter than it was at the checkpoint", "--resume", self.out, "--set", "duration_s=31", "--out", longer
            )
            file.unlink()
            self.refused(f"{name}", "--resume", self.out, "--set", "duration_s=31", "--out", longer)
            file.write_bytes(content)
        done = train_sim("--resume", self.out, "--set", "duration_s=31", "--out", longer)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_a_refused_run_stays_as_it_is(self):
        self.break_off(signal.SIGINT, "--csv")
        with open(self.out / "train.bag", "r+b") as bag:
            bag.seek(100000)
            bag.write(b"something else")
        self.refused("train.bag is not the bag that the checkpoint is of", "--resume", self.out)
        (self.out / "train.bag").unlink()
        self.refused("train.bag.active does not exist", "--resume", self.out)
        self.assertTrue((self.out / "summary.json").exists())

    def test_tables_keep_their_rows_when_the_bag_is_refused(self):
        self.break_off(signal.SIGKILL, "--csv")
        with open(self.out / "train_history.csv", "a", encoding="utf-8") as table:
            table.write("a row behind the checkpoint\n")
        with open(self.out / "train.bag.active", "r+b") as bag:
            bag.seek(100000)
            bag.write(b"something else")
        self.refused("train.bag.active is not the bag that the checkpoint is of", "--resume", self.out)

    def test_what_never_ends_is_not_read(self):
        shutil.copytree(self.whole, self.out)
        checkpoint = self.out / "checkpoint"
        checkpoint.unlink()
        os.mkfifo(checkpoint)
        done = train_sim("--resume", self.out)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn("checkpoint is not a regular file", done.stderr)
        checkpoint.unlink()
        checkpoint.symlink_to("/dev/zero")
        done = train_sim("--resume", self.out)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn("checkpoint is not a regular file", done.stderr)
        empty = self.folder / "empty"
        empty.mkdir()
        os.mkfifo(empty / "config.yaml")
        done = train_sim(EMERGENCY, "--set", "duration_s=0.1", "--out", empty)
        self.assertEqual(1, done.returncode, done.stderr)
        self.assertIn("no run of train_brake", done.stderr)

    def test_another_version_is_refused(self):
        shutil.copytree(self.whole, self.out)
        checkpoint = self.out / "checkpoint"
        content = checkpoint.read_bytes()
        version = re.search(rb"# train_brake (\d)", content)
        changed = bytearray(content)
        changed[version.start(1)] += 1
        checkpoint.write_bytes(with_checksum(changed))
        self.refused("was written by 'train_brake %d." % (int(version.group(1)) + 1), "--resume", self.out)

    def test_no_checkpoints_when_none_are_wanted(self):
        done = train_sim(EMERGENCY, "--set", "duration_s=1", "--checkpoint-interval", "0", "--out", self.out)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertFalse((self.out / "checkpoint").exists())

    def test_without_room_for_records_a_run_may_go_on(self):
        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000000, 1000000))

        done = train_sim(*RUN, "--out", self.out, "--go-on-without-records", preexec_fn=small_files)
        self.assertEqual(1, done.returncode)
        self.assertIn(
            "train.bag (ulimit -f limits the size of files): File too large: the run goes on without records",
            done.stderr,
        )
        self.assertIn("could not be written", done.stderr.splitlines()[-1])
        summary = json.loads(done.stdout)
        self.assertTrue(summary["complete"])
        self.assertEqual(self.summary["state_digest"], summary["state_digest"])
        self.assertEqual(summary, json.loads((self.out / "summary.json").read_text()))
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            self.assertGreater(bag.get_message_count("/train/state"), 0)


if __name__ == "__main__":
    rosunit.unitrun("ltd_master", "resume_test", ResumeTest)
