#!/usr/bin/python3
"""The fault matrix: what may go wrong x when. Each cell is a whole launch of a small train.

Each cell asserts how long it takes until the log names the culprit, the exit code, the results (those of the
undisturbed run, bit by bit, or else its beginning and a clean stop), that the bag can be read, and that no process is
left. docs/reliability.md has the table.

usage: faults.py [arguments of unittest]       all cells; prints the table
       faults.py --short --gtest_output=xml:F  one cell of most faults, for continuous integration
"""
import contextlib
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rosunit

from launches import SHORT_TRAIN, Launch, LaunchTest, is_beginning, messages, train_sim, wait_until

DURATION = (
    2.0  # [s] of the train, and of wall time: long enough to be met on its way, with a snapshot after the first half
)
EXCHANGES = 1000
PACED = "real_time_factor:=1"
A_QUARTER, THREE_QUARTERS, THE_END = r" 0\.50 of 2 s", r" 1\.50 of 2 s", r" 2\.00 of 2 s"  # the master's progress
SOON = 60.0  # [s] for what is not measured: processes come up, and go
SLACK = 20.0  # [s] beyond what it should take until a fault is named, on a machine that has much else to do
FAULT = "the fault: "  # says test/faulty_rank.py when it spoils a reply
RANK = r"/train/wagon_004 \(vehicles 4-6\)"

table = []  # (fault, phase, what the log says, after how many seconds, what becomes of the run)
undisturbed_runs = {}


def cell(fault, phase):
    """Gives a test its place in the table."""

    def mark(test):
        test.cell = (fault, phase)
        return test

    return mark


def undisturbed(settings):
    """Summary and bag of the same train in one process, without faults."""
    if settings not in undisturbed_runs:
        with tempfile.TemporaryDirectory() as folder:
            arguments = [word for setting in settings.split() for word in ("--set", setting)]
            undisturbed_runs[settings] = train_sim("--out", folder, *arguments), messages(f"{folder}/train.bag")
    return undisturbed_runs[settings]


class Matrix(LaunchTest):
    """What cells are made of."""

    settings = f"duration_s={DURATION:g}"

    def launch(self, *arguments, nodes=2):
        """train.launch, with respawn."""
        return Launch(
            self.master,
            self.folder,
            ("train_brake", "train.launch"),
            f"scenario:={SHORT_TRAIN}",
            "vehicles:=6",
            f"nodes:={nodes}",
            f"set:={self.settings}",
            *arguments,
        )

    def launch_nodes(self, *nodes, behind="", **parameters):
        """A train of two ranks with those nodes (XML), which are not respawned. @param behind  redirections of its
        master in the shell. @param parameters  of its master"""
        values = {"scenario": SHORT_TRAIN, "ranks": 2, "real_time_factor": 1.0, "set": self.settings, **parameters}
        text = "".join(f'<param name="{name}" value="{value}"/>' for name, value in values.items())
        file = self.folder / "nodes.launch"
        prefix = ""
        if behind:
            script = self.folder / "behind.sh"
            script.write_text(f'#!/bin/bash\n{behind}\nexec "$@"\n')
            script.chmod(0o755)
            prefix = f' launch-prefix="{script}"'
        file.write_text(
            f"""<launch><arg name="out"/><arg name="exit_status_file"/><group ns="train">{"".join(nodes)}
          <node pkg="ltd_master" type="ltd_master" name="master" required="true" output="screen"{prefix}>
            <param name="out" value="$(arg out)"/><param name="exit_status_file" value="$(arg exit_status_file)"/>{text}
          </node></group></launch>"""
        )
        return Launch(self.master, self.folder, (str(file),))

    def resume(self):
        """train.launch goes on with what an earlier launch has left."""
        return Launch(
            self.master,
            self.folder,
            ("train_brake", "train.launch"),
            f"resume:={self.folder}/out",
            "vehicles:=6",
            "nodes:=3",
        )

    @staticmethod
    def wagon(name):
        return f'<node pkg="wagon_node" type="wagon_node" name="{name}" output="screen"/>'

    def launch_faulty(self, fault, exchange, **parameters):
        """The second rank is a faulty one, in front of a sound one."""
        faulty = (
            f'<node pkg="train_brake" type="faulty_rank.py" name="wagon_004" args="/train/sound {fault} {exchange}" '
            'output="screen"/>'
        )
        return self.launch_nodes(self.wagon("wagon_001"), self.wagon("sound"), faulty, **parameters)

    def start(self, package, program, *arguments, name="wagon_004"):
        """A node by hand."""
        process = subprocess.Popen(
            ["rosrun", package, program, *arguments, "__ns:=/train", f"__name:={name}"],
            env=self.master.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def call(self, service, *arguments):
        done = subprocess.run(
            ["rosservice", "call", "/train/master/" + service, *arguments],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=60,
        )
        self.assertIn("success: True", done.stdout)

    def signal(self, number, node="wagon_004"):
        """@return when"""
        os.kill(self.master.process_of(node), number)
        return time.monotonic()

    def named(self, launch, pattern, since, outcome, expected_s=0.0):
        """The log names what has happened, little later than expected. A line of the table."""
        seconds = launch.saw(pattern, SOON, since) - since
        self.assertLess(seconds, expected_s + SLACK, launch.log())
        self.note(f"{seconds:.2f}", outcome)

    def note(self, seconds, outcome):
        table.append((*getattr(self, self._testMethodName).cell, seconds, outcome))

    def assert_nothing_left(self, launch):
        self.assertTrue(
            wait_until(lambda: not self.master.processes(), SOON), f"{self.master.processes()}\n{launch.log()}"
        )

    def assert_same(self, launch, timeout_s=60):
        """The run has ended as if nothing had happened."""
        self.assertEqual(0, launch.ended(timeout_s), launch.log())
        self.assert_nothing_left(launch)
        expected, expected_bag = undisturbed(self.settings)
        summary = launch.summary()
        self.assertTrue(summary["complete"])
        for key in ("state_digest", "final_speed_kmh", "max_tension_n", "max_compression_n", "energy", "vehicles"):
            self.assertEqual(expected[key], summary[key], key)
        self.assertTrue(launch.bag() == expected_bag, "the bag is not that of the undisturbed run")

    def assert_stopped(self, launch, exit_code, fault="", timeout_s=60):
        """The run has ended early, and what it has left is the beginning of the undisturbed one. @return records in its
        bag"""
        self.assertEqual(exit_code, launch.ended(timeout_s), launch.log())
        self.assert_nothing_left(launch)
        summary = launch.summary()
        self.assertFalse(summary["complete"])
        self.assertIn(fault, summary["fault"] or "")
        return self.assert_beginning(launch.bag())

    def read_bag(self, launch):
        """What is in the bag of a run that has ended early, after repair if need be."""
        unfinished = launch.out / "train.bag.active"
        if not unfinished.exists():
            return launch.bag()
        copy = shutil.copy(unfinished, self.folder / "copy.bag")
        subprocess.run(["rosbag", "reindex", "-q", str(copy)], check=True, stdout=subprocess.DEVNULL)
        return messages(copy)

    def assert_beginning(self, bag):
        self.assertTrue(
            is_beginning(bag, undisturbed(self.settings)[1]), "the bag is not the beginning of the undisturbed one"
        )
        return len(bag.get("/train/state", []))

    # Cells that differ in little.

    def is_stopped_by_reply(self, fault, exchange, text):
        launch = self.launch_faulty(fault, exchange)
        replied = launch.saw(FAULT, SOON)
        self.named(launch, RANK + f", exchange {exchange}: {text}", replied, "stopped, exit code 4")
        self.assertEqual(1 + exchange // 5, self.assert_stopped(launch, 4, text))  # a record each five exchanges

    def is_refused(self, fault, text, exchange=-1):
        launch = self.launch_faulty(fault, exchange)
        replied = launch.saw(FAULT, SOON)
        self.named(launch, RANK + ".*" + text, replied, "stopped, exit code 4")
        self.assertLess(self.assert_stopped(launch, 4), 2)

    def is_waited_for(self, exchange, when):
        launch = self.launch_faulty("slow", exchange)
        replied = launch.saw(FAULT, SOON)
        self.named(
            launch,
            f"{when}: waiting for 1 s already for 1 of 2 wagon nodes: {RANK}",
            replied,
            "waited for, same bits",
            expected_s=1,
        )
        self.assert_same(launch)


class Short(Matrix):
    """One cell of most faults; those of single replies are also in rank_messages_test.cpp."""

    @cell("kill -9 of a wagon node", "mid-run")
    def test_kill(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        killed = self.signal(signal.SIGKILL)
        self.named(launch, RANK + r", exchange \d+: closed the connection", killed, "brought back, same bits")
        self.assert_same(launch)
        self.assertRegex(launch.log(), RANK + " is back after")

    @cell("SIGSTOP, later SIGCONT", "mid-run")
    def test_stop(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        stopped = self.signal(signal.SIGSTOP)
        self.named(
            launch,
            "waiting for 1 s already for 1 of 2 wagon nodes: " + RANK,
            stopped,
            "waited for, same bits",
            expected_s=1,
        )
        self.signal(signal.SIGCONT)
        self.assert_same(launch)
        self.assertNotIn("is back", launch.log())

    @cell("NaN in a reply", "mid-run")
    def test_nan(self):
        self.is_stopped_by_reply("nan", 500, "replied head_velocity_mps = nan for vehicle 4")

    @cell("stale reply", "mid-run")
    def test_stale(self):
        self.is_stopped_by_reply("stale", 500, "replied to exchange 499")

    @cell("wrong version of the protocol", "start-up")
    def test_version_at_start_up(self):
        self.is_refused("version", "the master speaks protocol version")

    @cell("slow wagon node (1.5 s)", "mid-run")
    def test_slow(self):
        self.is_waited_for(500, "exchange 500")

    @cell("roscore killed", "mid-run")
    def test_roscore(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        self.master.kill()
        self.assert_same(launch)
        self.note("-", "not needed, same bits")

    @cell("Ctrl-C", "mid-run")
    def test_ctrl_c(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        interrupted = launch.interrupt()
        self.named(launch, r"interrupted at \d\.\d+ s of 2 s", interrupted, "stopped, exit code 130")
        self.assertGreater(self.assert_stopped(launch, 130), 50)  # 0.5 s


class SideChannels(Matrix):
    """What the master says cannot be written: neither the run nor its results mind."""

    def is_the_same_behind(self, redirections):
        self.assert_same(self.launch_nodes(self.wagon("wagon_001"), self.wagon("wagon_004"), behind=redirections))
        self.note("-", "messages are lost, same bits")

    @cell("stdout and stderr full", "from the start")
    def test_full(self):
        self.is_the_same_behind("exec >/dev/full 2>&1")

    @cell("stdin, stdout and stderr closed", "from the start")
    def test_closed(self):
        self.is_the_same_behind("exec <&- >&- 2>&-")

    @cell("stdout and stderr: a pipe whose reader has gone", "from the start")
    def test_broken_pipe(self):
        self.is_the_same_behind("exec > >(true) 2>&1\nsleep 0.2")

    @cell("terminal gone, without SIGHUP", "mid-run")
    def test_terminal_gone(self):
        terminal, of_launch = os.openpty()
        log = self.folder / "status"
        launch = subprocess.Popen(
            [
                "roslaunch",
                "train_brake",
                "train.launch",
                f"scenario:={SHORT_TRAIN}",
                "vehicles:=6",
                "nodes:=2",
                PACED,
                f"set:={self.settings}",
                f"out:={self.folder}/out",
                f"exit_status_file:={log}",
            ],
            env=self.master.environment,
            stdin=of_launch,
            stdout=of_launch,
            stderr=of_launch,
            start_new_session=True,
        )
        self.addCleanup(launch.kill)
        os.close(of_launch)
        text = b""
        while b" of 2 s" not in text:
            text += os.read(terminal, 1000)
        os.close(terminal)
        launch.wait(60)
        self.assertIn(log.read_text(), ("0\n", "130\n"))  # roslaunch, too, may go on or interrupt its nodes
        self.assertIsNone(json.loads((self.folder / "out/summary.json").read_text())["fault"])
        self.assert_beginning(messages(self.folder / "out/train.bag"))
        self.note("-", "goes on to its end, same bits; or interrupted by roslaunch, exit code 130")

    @cell("file-size limit (ulimit -f)", "mid-run")
    def test_file_size_limit(self):
        self.settings = LARGE_RECORDS
        launch = self.launch_nodes(
            self.wagon("wagon_001"), self.wagon("wagon_004"), behind="ulimit -f 2000", checkpoint_interval_s=0.2
        )
        since = time.monotonic()
        seconds = launch.saw(r"results could not be written: cannot write .*ulimit -f", 60)
        self.note("-", "stopped, exit code 1; the bag holds what fits")
        self.assertGreater(seconds, since)
        self.assertEqual(1, launch.ended(), launch.log())
        self.assert_nothing_left(launch)
        self.assertGreater(self.assert_beginning(self.read_bag(launch)), 10)

    @unittest.skipUnless(os.geteuid() == 0, "only root can make a small disk")
    @cell("disk of roslaunch's log full", "mid-run")
    def test_full_log(self):
        logs = self.folder / "log"
        logs.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "train_brake_test", str(logs)], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", str(logs)], check=True)
        self.master.environment["ROS_LOG_DIR"] = str(logs)
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        with contextlib.suppress(OSError), open(logs / "filler", "wb", buffering=0) as filler:
            while True:
                filler.write(bytes(1 << 12))
        self.assert_same(launch)
        self.note("-", "messages are lost, same bits")

    @cell("a second launch of the same train", "mid-run")
    def test_second_launch(self):
        self.settings = "duration_s=12"
        launch = self.launch(PACED)
        launch.saw(r" 3\.00 of 12 s", SOON)
        started = time.monotonic()
        folder = self.folder / "second"
        folder.mkdir()
        second = Launch(
            self.master, folder, ("train_brake", "train.launch"), f"scenario:={SHORT_TRAIN}", "vehicles:=6", "nodes:=2"
        )
        seconds = second.saw("/train/master runs already under the ROS master", SOON, started) - started
        self.assertEqual(2, second.ended(), second.log())
        self.assertFalse(second.out.exists())
        self.assert_same(launch)
        self.note(f"{seconds:.2f}", "refused, its exit code is 2; the first: same bits")

    @cell("report, export and verify of the run", "mid-run, while it is recorded")
    def test_readers_of_a_run_in_progress(self):
        self.settings = "duration_s=4"
        launch = self.launch(PACED)
        launch.saw(r" 1\.00 of 4 s", SOON)
        self.call("pause")  # it is in progress for as long as the readers need

        def read(*command):
            return subprocess.run(
                ["rosrun", *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60
            )

        page = self.folder / "page.html"
        for done in (
            read("train_brake", "report", str(launch.out), "--out", str(page)),
            read("train_brake", "export", str(launch.out), str(self.folder / "tables")),
        ):
            self.assertTrue(done.returncode == 0 or "is writing it now" in done.stdout, done.stdout)
        self.assertIn(read("train_sim", "train_sim", "verify", str(launch.out)).returncode, (6, 7))
        self.assertIn(
            "another run is writing into",
            read("train_sim", "train_sim", "run", str(SHORT_TRAIN), "--out", str(launch.out)).stdout,
        )
        self.call("resume")
        self.assert_same(launch)
        self.note("-", "read as far as it goes, or refused; the run: same bits")

    @cell("roscore restarted", "mid-run")
    def test_roscore_restarted(self):
        self.settings = "duration_s=6"
        launch = self.launch(PACED)
        launch.saw(r" 1\.50 of 6 s", SOON)
        self.master.kill()
        self.master.start()
        self.assertTrue(wait_until(lambda: "/train/master/pause" in self.master.services(), SOON), launch.log())
        self.assert_same(launch)
        self.note("-", "registers again, same bits")


LARGE_RECORDS = (
    f"duration_s={DURATION:g} record_interval_s=0.002 detail_vehicles=[1,2,3,4,5,6]"  # several chunks of a bag
)


@unittest.skipUnless(os.geteuid() == 0, "only root can make a small disk")
class FullDisk(Matrix):
    settings = LARGE_RECORDS

    def setUp(self):
        super().setUp()
        self.disk = self.folder / "out"
        self.disk.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16m", "train_brake_test", str(self.disk)], check=True)
        self.addCleanup(subprocess.run, ["umount", "--lazy", str(self.disk)], check=True)
        self.filler = self.disk / "filler"

    def fill(self):
        """@return when"""
        with open(self.filler, "wb", buffering=0) as filler:
            for size in (1 << 20, 1 << 12):
                with contextlib.suppress(OSError):
                    while True:
                        filler.write(bytes(size))
        return time.monotonic()

    def assert_ended(self, launch):
        """@return records in its bag"""
        self.assertEqual(1, launch.ended(), launch.log())
        self.assert_nothing_left(launch)
        summary = launch.out / "summary.json"
        if summary.exists():
            json.loads(summary.read_text())  # whole, then
        return self.assert_beginning(self.read_bag(launch))

    @cell("disk full", "start-up")
    def test_at_start_up(self):
        filled = self.fill()
        launch = self.launch(PACED)
        self.named(
            launch, "cannot write .*/out/config.yaml", filled, "stopped, exit code 1", expected_s=2
        )  # of the launch
        self.assertEqual(1, launch.ended(), launch.log())
        self.assertEqual([self.filler], list(launch.out.iterdir()))

    @cell("disk full", "mid-run")
    def test_in_mid_run(self):
        launch = self.launch(PACED, "checkpoint_interval:=0.2")
        launch.saw(THREE_QUARTERS, SOON)
        filled = self.fill()
        self.named(
            launch,
            "results could not be written: cannot write .*/out/",
            filled,
            "stopped, exit code 1; with room again, resumed to the same bits",
        )
        self.assertGreater(self.assert_ended(launch), 100)
        self.filler.unlink()
        self.assert_same(self.resume())

    @cell("disk full", "mid-run, without checkpoints")
    def test_without_checkpoints(self):
        launch = self.launch(PACED, "checkpoint_interval:=0")
        launch.saw(THREE_QUARTERS, SOON)
        filled = self.fill()
        self.named(
            launch,
            "results could not be written: cannot write .*/out/train.bag: No space left on device",
            filled,
            "stopped at the next chunk of the bag, exit code 1; the bag holds the whole ones",
        )
        self.assertGreater(self.assert_ended(launch), 10)
        self.assertTrue((launch.out / "train.bag").exists())

    @cell("disk full", "mid-run, on_write_error:=go_on")
    def test_go_on(self):
        launch = self.launch(PACED, "checkpoint_interval:=0.2", "on_write_error:=go_on")
        launch.saw(THREE_QUARTERS, SOON)
        filled = self.fill()
        self.named(
            launch,
            "cannot write .*/out/.*: the run goes on without records",
            filled,
            "goes on to its end, exit code 1; same digest",
        )
        self.assertGreater(self.assert_ended(launch), 100)
        self.assertIn(undisturbed(self.settings)[0]["state_digest"], launch.log())

    @cell("disk full", "shut-down")
    def test_at_shut_down(self):
        launch = self.launch(PACED, "checkpoint_interval:=0")
        launch.saw(THE_END, SOON)
        filled = self.fill()
        self.named(
            launch,
            "results could not be written: cannot write .*/out/",
            filled,
            "stopped, exit code 1; the bag holds the whole chunks",
        )
        self.assertGreater(self.assert_ended(launch), 10)


class Full(Matrix):
    """The other cells."""

    @cell("kill -9 of a wagon node", "start-up, before it is found")
    def test_kill_at_start_up(self):
        launch = self.launch(PACED)
        killed = self.signal(signal.SIGKILL)
        self.named(launch, r"\[train/wagon_004-\d+\] restarting process", killed, "respawned, same bits")
        self.assert_same(launch)

    @cell("kill -9 of a wagon node", "start-up, while it is configured")
    def test_kill_while_configured(self):
        launch = self.launch_faulty("slow", -1)
        launch.saw("configuration: waiting for 1 s", SOON)
        killed = self.signal(signal.SIGKILL)
        self.named(launch, RANK + ", configuration: closed the connection", killed, "brought back, same bits")
        self.start("wagon_node", "wagon_node")
        self.assert_same(launch)

    @cell("kill -9 of a wagon node", "shut-down")
    def test_kill_at_shut_down(self):
        launch = self.launch(PACED)
        launch.saw(THE_END, SOON)
        self.signal(signal.SIGKILL)
        self.assert_same(launch)
        self.note("-", "no effect")

    @cell("kill -9 of a wagon node", "mid-run, on_lost_node:=stop")
    def test_kill_and_stop(self):
        launch = self.launch(PACED, "on_lost_node:=stop")
        launch.saw(A_QUARTER, SOON)
        killed = self.signal(signal.SIGKILL)
        self.named(
            launch,
            "the run failed: " + RANK + r", exchange \d+: closed the connection",
            killed,
            "stopped, exit code 4",
            expected_s=1,
        )
        self.assertGreater(self.assert_stopped(launch, 4, "closed the connection"), 50)  # 0.5 s

    @cell("kill -9 of a wagon node", "mid-run, shared_memory:=false")
    def test_kill_by_tcp(self):
        launch = self.launch(PACED, "shared_memory:=false")
        launch.saw(A_QUARTER, SOON)
        killed = self.signal(signal.SIGKILL)
        self.named(
            launch, RANK + r", exchange \d+: c", killed, "brought back, same bits"
        )  # closed, or connection broke
        self.assert_same(launch)

    @cell("kill -9 of all wagon nodes", "paused before an exchange that takes snapshots")
    def test_kill_all_while_paused(self):
        launch = self.launch("start_paused:=true", nodes=3)
        self.assertTrue(wait_until(lambda: "/train/master/step" in self.master.services(), SOON))
        self.call("step", "499")
        for node in ("wagon_001", "wagon_003", "wagon_005"):
            self.signal(signal.SIGKILL, node)
        resumed = time.monotonic()
        self.call("resume")
        self.named(
            launch,
            r"wagon_005 \(vehicles 5-6\), exchange 499: ",
            resumed,
            "brought back when the run goes on, same bits",
        )
        self.assert_same(launch)
        self.assertEqual(3, launch.log().count(" is back after "))

    @cell("kill -9 of a wagon node", "mid-run, not respawned")
    def test_kill_in_vain(self):
        launch = self.launch_nodes(self.wagon("wagon_001"), self.wagon("wagon_004"), recovery_timeout_s=2)
        launch.saw(A_QUARTER, SOON)
        killed = self.signal(signal.SIGKILL)
        self.named(
            launch,
            "no node has taken its place within 2 s: ",
            killed,
            "stopped at recovery_timeout (here 2 s), exit code 4",
            expected_s=2,
        )
        self.assertGreater(
            self.assert_stopped(launch, 4, "closed the connection; no node has taken its place within 2 s: "), 50
        )

    @cell("SIGSTOP, later SIGCONT", "start-up")
    def test_stop_at_start_up(self):
        launch = self.launch(PACED)
        stopped = self.signal(signal.SIGSTOP)
        # Whether it had been found before is up to chance.
        self.named(
            launch,
            "(1 of 2 wagon nodes are missing after 5 s|waiting for 1 s already for 1 of 2 wagon nodes): " + RANK,
            stopped,
            "waited for, same bits",
            expected_s=5,
        )
        self.signal(signal.SIGCONT)
        self.assert_same(launch)

    def stop_beyond_deadline(self, *arguments):
        launch = self.launch(PACED, "exchange_timeout:=1.5", *arguments)
        launch.saw(A_QUARTER, SOON)
        stopped = self.signal(signal.SIGSTOP)
        self.named(
            launch,
            RANK + r", exchange \d+: no reply within 1.5 s",
            stopped,
            "lost at exchange_timeout (here 1.5 s), brought back, same bits",
            expected_s=1.5,
        )
        return launch

    @cell("SIGSTOP, later SIGCONT", "mid-run, awake again after the deadline")
    def test_stop_beyond_deadline(self):
        launch = self.stop_beyond_deadline()
        time.sleep(1)
        self.signal(signal.SIGCONT)
        launch.saw(RANK + " is back after", SOON)
        self.assert_same(launch)

    @cell("SIGSTOP, later SIGCONT", "mid-run, the same with shared_memory:=false")
    def test_stop_beyond_deadline_by_tcp(self):
        launch = self.stop_beyond_deadline("shared_memory:=false")
        time.sleep(1)
        self.signal(signal.SIGCONT)
        launch.saw(RANK + " is back after", SOON)
        self.assert_same(launch)

    @cell("SIGSTOP, later SIGCONT", "mid-run, awake again beside its replacement")
    def test_stop_and_replace(self):
        launch = self.stop_beyond_deadline()
        old = self.master.process_of("wagon_004")
        self.start("wagon_node", "wagon_node")
        launch.saw(RANK + " is back after", SOON)
        os.kill(
            old, signal.SIGCONT
        )  # its ROS master tells it to leave, and roslaunch respawns it: lost and found once more
        self.assert_same(launch)

    @cell("SIGSTOP, later SIGCONT", "shut-down, no SIGCONT")
    def test_stop_at_shut_down(self):
        launch = self.launch(PACED)
        launch.saw(THE_END, SOON)
        stopped = self.signal(signal.SIGSTOP)
        self.named(
            launch,
            r"\[train/wagon_004-\d+\] escalating to SIGTERM",
            stopped,
            "killed by roslaunch (here: --sigint-timeout=5), same bits",
            expected_s=5,
        )
        self.assert_same(launch)

    @cell("NaN in a record of a reply", "mid-run")
    def test_nan_in_record(self):
        self.is_stopped_by_reply("record", 499, "replied speed_mps = nan for vehicle 4")

    @cell("fault of a vehicle that the rank does not have", "mid-run")
    def test_fault_of_absent_vehicle(self):
        self.is_stopped_by_reply("absent", 500, "replied a fault of vehicle 4294967295, which it does not have")

    @cell("NaN in a reply", "start-up")
    def test_nan_at_start_up(self):
        self.is_refused("nan", "configuration: replied head_velocity_mps = nan for vehicle 4")

    @cell("NaN in a reply", "shut-down, last exchange")
    def test_nan_at_shut_down(self):
        self.is_stopped_by_reply("nan", EXCHANGES - 1, "replied head_velocity_mps = nan for vehicle 4")

    @cell("stale reply", "start-up, second exchange")
    def test_stale_at_start_up(self):
        self.is_refused("stale", "exchange 1: replied to exchange 0", exchange=1)

    @cell("stale reply", "shut-down, last exchange")
    def test_stale_at_shut_down(self):
        self.is_stopped_by_reply("stale", EXCHANGES - 1, f"replied to exchange {EXCHANGES - 2}")

    @cell("wrong version of the messages", "start-up")
    def test_md5sum_at_start_up(self):
        self.is_refused("md5sum", "connection: .*md5sum")

    @cell("wrong version of the protocol", "mid-run, of a replacement")
    def test_version_of_a_replacement(self):
        launch = self.launch_nodes(self.wagon("wagon_001"), self.wagon("wagon_004"), self.wagon("sound"))
        launch.saw(A_QUARTER, SOON)
        self.signal(signal.SIGKILL)
        started = time.monotonic()
        other = self.start("train_brake", "faulty_rank.py", "/train/sound", "version", "-1")
        self.named(
            launch,
            RANK + ", configuration: the master speaks protocol version .*: not taken in its place",
            started,
            "not taken; with another replacement, same bits",
            expected_s=2,
        )  # and its start
        other.kill()
        self.start("wagon_node", "wagon_node")
        self.assert_same(launch)

    @cell("slow wagon node (1.5 s)", "start-up")
    def test_slow_at_start_up(self):
        self.is_waited_for(-1, "configuration")

    @cell("slow wagon node (1.5 s)", "shut-down, last exchange")
    def test_slow_at_shut_down(self):
        self.is_waited_for(EXCHANGES - 1, f"exchange {EXCHANGES - 1}")

    @cell("roscore killed", "start-up, a wagon node still to come")
    def test_roscore_at_start_up(self):
        launch = self.launch_nodes(self.wagon("wagon_001"), startup_timeout_s=3)
        self.assertTrue(
            wait_until(lambda: {"/train/master/pause", "/train/wagon_001/step"} <= self.master.services(), SOON)
        )
        self.master.kill()
        self.named(
            launch,
            r"/train/wagon_00\d: cannot be looked up: the ROS master at .* does not answer",
            time.monotonic(),
            "stopped at startup_timeout (here 3 s), exit code 4",
            expected_s=3,
        )
        self.assertEqual(0, self.assert_stopped(launch, 4, "the ROS master at"))

    @cell("roscore killed", "start-up, before the master knows it; Ctrl-C")
    def test_no_roscore(self):
        self.master.kill()
        master = self.start("ltd_master", "ltd_master", name="master")
        program = pathlib.Path(f"/proc/{master.pid}/comm")
        self.assertTrue(wait_until(lambda: program.read_text() == "ltd_master\n", SOON))  # no longer rosrun
        time.sleep(1)
        interrupted = time.monotonic()
        master.send_signal(signal.SIGINT)
        self.assertEqual(130, master.wait(SOON))
        self.note(f"{time.monotonic() - interrupted:.1f}", "waits for it; ended by Ctrl-C, exit code 130")

    @cell("roscore killed", "mid-run, then a wagon node")
    def test_roscore_and_wagon(self):
        launch = self.launch(PACED, "recovery_timeout:=3")
        launch.saw(A_QUARTER, SOON)
        self.master.kill()
        killed = self.signal(signal.SIGKILL)
        self.named(
            launch,
            RANK + r", .*within 3 s: cannot be looked up: the ROS master at .* does not answer",
            killed,
            "stopped at recovery_timeout (here 3 s), exit code 4",
            expected_s=3,
        )
        self.assertGreater(self.assert_stopped(launch, 4, "the ROS master at"), 50)

    @cell("roscore killed", "mid-run, then a wagon node; later a new roscore")
    def test_roscore_and_wagon_and_another_roscore(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        self.master.kill()
        killed = self.signal(signal.SIGKILL)
        self.named(
            launch,
            "waiting for 5 s already for a node in the place of " + RANK + ": cannot be looked up",
            killed,
            "brought back with the new roscore, same bits",
            expected_s=5,
        )
        self.master.start()
        self.assert_same(launch)

    @cell("roscore killed", "shut-down")
    def test_roscore_at_shut_down(self):
        launch = self.launch(PACED)
        launch.saw(THE_END, SOON)
        self.master.kill()
        self.assert_same(launch)
        self.note("-", "not needed, same bits")

    @cell("Ctrl-C", "start-up, a wagon node still to come")
    def test_ctrl_c_at_start_up(self):
        launch = self.launch_nodes(self.wagon("wagon_001"))
        self.assertTrue(
            wait_until(lambda: {"/train/master/pause", "/train/wagon_001/step"} <= self.master.services(), SOON)
        )
        interrupted = launch.interrupt()
        self.named(launch, r"interrupted at 0\.000 s", interrupted, "stopped, exit code 130")
        self.assertEqual(0, self.assert_stopped(launch, 130))

    @cell("Ctrl-C", "mid-run, while a lost wagon node is waited for")
    def test_ctrl_c_while_waiting(self):
        launch = self.launch_nodes(self.wagon("wagon_001"), self.wagon("wagon_004"))
        launch.saw(A_QUARTER, SOON)
        self.signal(signal.SIGKILL)
        launch.saw("The train waits", SOON)
        interrupted = launch.interrupt()
        self.named(launch, r"interrupted at \d\.\d+ s of 2 s", interrupted, "stopped, exit code 130")
        self.assertGreater(self.assert_stopped(launch, 130), 50)

    @cell("Ctrl-C", "shut-down")
    def test_ctrl_c_at_shut_down(self):
        launch = self.launch(PACED)
        launch.saw(THE_END, SOON)
        launch.interrupt()
        self.assert_same(launch)
        self.note("-", "comes too late, same bits")

    @cell("kill -9 of roslaunch", "mid-run")
    def test_kill_launcher(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        launch.process.kill()
        self.assertTrue(wait_until(launch.status_file.exists, SOON))
        self.assert_same(launch)
        self.note("-", "not needed, same bits")

    @cell("kill -9 of a replacement", "mid-run, while it catches up")
    def test_kill_replacement(self):
        launch = self.launch_nodes(self.wagon("wagon_001"), self.wagon("wagon_004"), self.wagon("sound"))
        launch.saw(A_QUARTER, SOON)
        self.signal(signal.SIGKILL)
        replacement = self.start("train_brake", "faulty_rank.py", "/train/sound", "slow", "100")
        launch.saw("exchange 100: waiting for 1 s already for 1 of 2 wagon nodes: " + RANK, SOON)
        killed = time.monotonic()
        replacement.kill()
        self.named(
            launch,
            RANK + ", exchange 100: closed the connection: not taken in its place",
            killed,
            "the next one is taken, same bits",
        )
        self.start("wagon_node", "wagon_node")
        self.assert_same(launch)

    @cell("kill -9 of two wagon nodes", "mid-run, together")
    def test_kill_two(self):
        launch = self.launch(PACED, nodes=3)
        launch.saw(A_QUARTER, SOON)
        for node in ("wagon_003", "wagon_005"):
            killed = self.signal(signal.SIGKILL, node)
        self.named(launch, r"wagon_005 \(vehicles 5-6\), exchange \d+: ", killed, "brought back, same bits")
        self.assert_same(launch)
        self.assertEqual(2, launch.log().count(" is back after "))

    @cell("kill -9 of a wagon node", "mid-run, 5000 exchanges per second")
    def test_kill_with_many_exchanges(self):
        self.settings = f"duration_s={DURATION:g} dt_s=0.0002 exchange_interval_s=0.0002"
        launch = self.launch("real_time_factor:=0.5")
        launch.saw(A_QUARTER, SOON)
        time.sleep(0.5)
        killed = self.signal(signal.SIGKILL)
        self.named(
            launch, RANK + r", exchange \d+: ", killed, "brought back with less than 1000 exchanges replayed, same bits"
        )
        self.assert_same(launch)
        self.assertLess(int(re.search(r"(\d+) exchanges replayed", launch.log())[1]), 1000)

    @cell("read-only folder of results", "start-up")
    def test_read_only_folder(self):
        launched = time.monotonic()
        launch = self.launch(PACED, "out:=/proc/results")  # where not even root may make anything
        self.named(launch, "/proc/results", launched, "stopped, exit code 1", expected_s=2)  # of the launch
        self.assertEqual(1, launch.ended(), launch.log())
        self.assert_nothing_left(launch)

    @cell("SIGSTOP of the master, later SIGCONT", "start-up")
    def test_stop_master_at_start_up(self):
        launch = self.launch(PACED)
        self.signal(signal.SIGSTOP, "master")
        time.sleep(3)
        self.signal(signal.SIGCONT, "master")
        self.assert_same(launch)
        self.note("-", "no effect, same bits")

    @cell("SIGSTOP of the master, later SIGCONT", "mid-run, for longer than exchange_timeout")
    def test_stop_master(self):
        launch = self.launch(PACED, "exchange_timeout:=1")
        launch.saw(A_QUARTER, SOON)
        self.signal(signal.SIGSTOP, "master")
        time.sleep(3)
        self.signal(signal.SIGCONT, "master")
        self.assert_same(launch)
        self.note("-", "no effect, same bits")

    @cell("another master, with a clock of its own (global_clock:=false)", "mid-run")
    def test_other_master(self):
        launch = self.launch(PACED)
        launch.saw(A_QUARTER, SOON)
        self.call("pause")  # it goes on for as long as the other needs to come up
        started = time.monotonic()
        other = self.start(
            "ltd_master", "ltd_master", f"_scenario:={SHORT_TRAIN}", "_ranks:=2", "_global_clock:=false", name="other"
        )
        self.assertEqual(4, other.wait(SOON))
        self.named(
            launch,
            "refused to be configured by /train/other: this wagon node is driven in another run",
            started,
            "refused, its exit code is 4; same bits",
            expected_s=1,
        )  # and its start
        self.call("resume")
        self.assert_same(launch)


class Resumed(Matrix):
    """Runs whose master has ended, in whatever way, and that go on from their last checkpoint with other nodes."""

    settings = LARGE_RECORDS

    def launch_checkpointed(self):
        return self.launch(PACED, "checkpoint_interval:=0.2")

    def assert_killed(self, launch):
        self.assertIsNone(launch.ended())
        self.assert_nothing_left(launch)

    @cell("kill -9 of the master", "start-up")
    def test_kill_at_start_up(self):
        launch = self.launch_checkpointed()
        killed = self.signal(signal.SIGKILL, "master")
        self.named(launch, r"REQUIRED process \[train/master-\d+\] has died", killed, "ended; nothing to resume yet")
        self.assert_killed(launch)
        self.assertEqual(2, self.resume().ended())

    @cell("kill -9 of the master", "mid-run")
    def test_kill(self):
        launch = self.launch_checkpointed()
        launch.saw(THREE_QUARTERS, SOON)
        killed = self.signal(signal.SIGKILL, "master")
        self.named(launch, r"REQUIRED process \[train/master-\d+\] has died", killed, "ended; resumed to the same bits")
        self.assert_killed(launch)
        self.assertFalse((launch.out / "summary.json").exists())
        self.assertGreater(self.assert_beginning(self.read_bag(launch)), 100)
        self.assert_same(self.resume())

    @cell("kill -9 of the master", "shut-down")
    def test_kill_at_shut_down(self):
        launch = self.launch_checkpointed()
        launch.saw(THE_END, SOON)
        killed = self.signal(signal.SIGKILL, "master")
        self.named(
            launch,
            r"REQUIRED process \[train/master-\d+\] has died",
            killed,
            "ended; results complete, or resumed to the same bits",
        )
        self.assert_killed(launch)
        again = self.resume()
        if again.ended() == 2:
            self.assertIn("nothing is left to simulate", again.log())
        else:
            self.assert_same(again)

    @cell("Ctrl-C", "mid-run, resumed")
    def test_ctrl_c(self):
        launch = self.launch_checkpointed()
        launch.saw(THREE_QUARTERS, SOON)
        launch.interrupt()
        self.assertGreater(self.assert_stopped(launch, 130), 100)
        interrupted_s = launch.summary()["simulated_s"]
        launch = self.resume()
        self.assert_same(launch)
        self.assertEqual(interrupted_s, launch.summary()["resumed_at_s"])  # Ctrl-C leaves a checkpoint of the end
        self.note("-", "same bits")


class RandomKills(Matrix):
    """One run in which random wagon nodes are killed, spread over its simulated time; some are killed again at once."""

    settings = "duration_s=30"
    last_kill_s = 25  # the call that asks for the time takes its own, on a busy machine
    pace = 0.5
    kills = 20
    seed = 20200401
    arguments = ()

    def simulated_s(self):
        """Time of the train; before all if the master, with much else to do, let the tool's time-out pass."""
        done = subprocess.run(
            ["rosservice", "call", "/train/master/step", "0"],
            env=self.master.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
        )
        told = re.search(r"simulated_s: (\S+)", done.stdout)
        return float(told[1]) if told else -1.0

    @cell("20 kill -9 of random wagon nodes", "spread over a run of 30 s, four of them while one is brought back")
    def test_random_kills(self):
        nodes = ("wagon_001", "wagon_003", "wagon_005")
        launch = self.launch(f"real_time_factor:={self.pace}", *self.arguments, nodes=len(nodes))
        back = lambda: launch.log().count(" is back after ")
        random_numbers = random.Random(self.seed)
        self.assertTrue(wait_until(lambda: "/train/master/step" in self.master.services(), SOON))
        doubles = self.kills // 5
        rounds = self.kills - doubles
        for i in range(rounds):
            due_s = self.last_kill_s * (i + random_numbers.random()) / rounds
            self.assertTrue(wait_until(lambda: self.simulated_s() >= due_s, 60), launch.log())
            before = back()
            node = random_numbers.choice(nodes)
            killed = self.master.process_of(node)
            os.kill(killed, signal.SIGKILL)
            if i % 4 == 3 and i // 4 < doubles:  # its replacement, or another one, at once
                other = random_numbers.choice(nodes)
                self.assertTrue(wait_until(lambda: killed not in self.master.processes(), SOON))
                self.signal(signal.SIGKILL, other)
            self.assertTrue(wait_until(lambda: back() > before, SOON), launch.log())
        self.assert_same(launch, 120)
        self.assertGreaterEqual(back(), rounds)
        self.assertLessEqual(back(), self.kills)
        self.note("-", f"{back()} times brought back, same bits")


class RandomKillsByTcp(RandomKills):
    seed = 20200402
    arguments = ("shared_memory:=false",)

    @cell("20 kill -9 of random wagon nodes", "the same with shared_memory:=false")
    def test_random_kills(self):
        super().test_random_kills()


def short():
    """A suite of about a minute."""
    RandomKills.kills, RandomKills.settings, RandomKills.last_kill_s = 5, "duration_s=8", 4
    load = unittest.defaultTestLoader
    return unittest.TestSuite(
        [
            load.loadTestsFromTestCase(Short),
            SideChannels("test_full"),
            SideChannels("test_file_size_limit"),
            FullDisk("test_in_mid_run"),
            Resumed("test_kill"),
            RandomKills("test_random_kills"),
        ]
    )


if __name__ == "__main__":
    if "--short" in sys.argv:
        sys.argv.remove("--short")
        rosunit.unitrun("train_brake", "faults", "faults.short")
    else:
        program = unittest.main(exit=False, warnings="ignore", catchbreak=True)
        print("| fault | when | named after [s] | what becomes of the run |")
        for row in sorted(table):
            print("| " + " | ".join(row) + " |")
        sys.exit(not program.result.wasSuccessful())
