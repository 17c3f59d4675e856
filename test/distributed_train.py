#!/usr/bin/python3
"""The distributed train as its users launch it: whole launches, judged by the train in one process, bit for bit."""
import contextlib
import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import rosbag
import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger
from train_brake_msgs.msg import RunStatus, TrainState
from train_brake_msgs.srv import SetRealTimeFactor, StepExchanges

HERE = pathlib.Path(__file__).resolve().parent
SHORT_TRAIN = HERE / "short_train.yaml"  # six wagons, 0.2 s
SLIDING_TRAIN = HERE / "sliding_train.yaml"  # ten wagons, 10 s, slides on leaves from the first second on
EXCHANGE_INTERVAL = 0.002  # of that scenario
CONFIG = HERE.parent / "config"
LATE = 600.0  # what waits may take on a loaded machine


class Launch:
    """A roslaunch of train.launch, and what came of it."""

    def __init__(self, folder, *arguments, scenario=SHORT_TRAIN, vehicles=6):
        self.out = pathlib.Path(folder) / "out"
        self.status_file = pathlib.Path(folder) / "status"
        self.log = pathlib.Path(folder) / "launch.log"
        self.log_file = open(self.log, "w")
        self.process = subprocess.Popen(
            [
                "roslaunch",
                "train_brake",
                "train.launch",
                f"scenario:={scenario}",
                f"vehicles:={vehicles}",
                f"out:={self.out}",
                f"exit_status_file:={self.status_file}",
                *arguments,
            ],
            stdout=self.log_file,
            stderr=subprocess.STDOUT,
        )

    def wait(self, timeout_s=LATE):
        """The master's exit code."""
        self.process.wait(timeout_s)
        self.log_file.close()
        return int(self.status_file.read_text()) if self.status_file.exists() else None

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(60)
            except subprocess.TimeoutExpired:
                self.process.kill()


def train_sim(*arguments, scenario=SHORT_TRAIN):
    done = subprocess.run(
        ["rosrun", "train_sim", "train_sim", "run", "--json", str(scenario), *arguments],
        check=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    return json.loads(done.stdout)


def verify(recording):
    done = subprocess.run(
        ["rosrun", "train_sim", "train_sim", "verify", str(recording)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    return done.returncode, done.stdout + done.stderr


def wagon_nodes():
    """Process numbers of the wagon nodes that run on this machine under this test's ROS master."""
    master = ("ROS_MASTER_URI=" + os.environ["ROS_MASTER_URI"]).encode()
    found = []
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if (process / "comm").read_text().strip() == "wagon_node" and master in (process / "environ").read_bytes():
                found.append(int(process.name))
    return found


def share_memory(processes):
    """Whether all of these, or none, have memory in common with a master."""
    found = {"/memfd:train_brake" in pathlib.Path(f"/proc/{process}/maps").read_text() for process in processes}
    assert len(found) == 1, found
    return found.pop()


def wait_until(condition, timeout_s):
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.05)
    return False


class DistributedTrain(unittest.TestCase):
    def setUp(self):
        if rospy.has_param("/train"):
            rospy.delete_param("/train")  # a ROS master keeps the parameters of launches that have ended
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(lambda: self.assertTrue(wait_until(lambda: not wagon_nodes(), LATE), "wagon nodes left behind"))

    def launch(self, *arguments, **options):
        launch = Launch(self.folder.name, *arguments, **options)
        self.addCleanup(launch.end)
        return launch

    def assert_complete(self, launch, expected, timeout_s=LATE):
        self.assertEqual(0, launch.wait(timeout_s), launch.log.read_text())
        summary = launch.summary()
        self.assertTrue(summary["complete"])
        for key in ("state_digest", "final_speed_kmh", "max_tension_n", "max_compression_n", "energy", "vehicles"):
            self.assertEqual(expected[key], summary[key], key)
        return summary

    def test_same_as_in_one_process_for_every_number_of_nodes(self):
        expected = train_sim()
        for arguments in (
            ["nodes:=1"],
            ["nodes:=3"],
            ["nodes:=6"],
            ["nodes:=2", "threads:=2"],
            ["nodes:=3", "shared_memory:=false"],
        ):
            with self.subTest(arguments):
                self.assert_complete(self.launch(*arguments), expected)

    def test_slides_are_the_same_for_any_number_of_nodes(self):
        """Protected and locked wheels, reaction, patches, gears with memory; resumed in the middle of slides."""
        expected = train_sim(scenario=SLIDING_TRAIN)
        self.assertGreater(expected["slides"]["slides"], 20)
        options = {"scenario": SLIDING_TRAIN, "vehicles": 10}
        for arguments in (["nodes:=1", "threads:=2"], ["nodes:=3"], ["nodes:=10"]):
            with self.subTest(arguments):
                launch = self.launch(*arguments, **options)
                self.assertEqual(expected["slides"], self.assert_complete(launch, expected)["slides"])
        code, verdict = verify(launch.out)
        self.assertEqual(0, code, verdict)
        # Two records only, with more slides than memory has room for: these replies travel by TCP.
        rare = ["record_interval_s=5", "ledger_interval_s=5"]
        expected = train_sim(*(word for key in rare for word in ("--set", key)), scenario=SLIDING_TRAIN)
        self.assertGreater(expected["slides"]["slides"], 20)
        launch = self.launch("nodes:=3", "set:=" + " ".join(rare), **options)
        self.assertEqual(expected["slides"], self.assert_complete(launch, expected)["slides"])

    def test_a_run_goes_on_in_the_middle_of_slides(self):
        expected = train_sim(scenario=SLIDING_TRAIN)
        begun = pathlib.Path(self.folder.name) / "begun"
        train_sim("--set", "duration_s=7", "--out", str(begun), scenario=SLIDING_TRAIN)
        launch = self.launch("nodes:=3", f"resume:={begun}", "set:=duration_s=10", scenario=" ", vehicles=10)
        summary = self.assert_complete(launch, expected)
        self.assertEqual(7, summary["resumed_at_s"])
        self.assertEqual(expected["slides"], summary["slides"])

    def test_exchange_interval_and_set(self):
        expected = train_sim("--set", "exchange_interval_s=0.005", "--set", "initial_speed_kmh=50")
        self.assert_complete(self.launch("nodes:=2", "exchange_interval:=0.005", "set:=initial_speed_kmh=50"), expected)
        self.assertNotEqual(expected["state_digest"], train_sim()["state_digest"])

    def test_models_mixed_in_one_train(self):
        mixed = "train.consist[1].model=ltd"
        expected = train_sim("--set", mixed)
        for nodes in 1, 3:
            with self.subTest(nodes=nodes):
                self.assert_complete(self.launch(f"nodes:={nodes}", f"set:={mixed}"), expected)
        self.assertNotEqual(expected["state_digest"], train_sim()["state_digest"])

    def test_the_pneumatic_brake_is_the_same_from_every_mapping(self):
        expected = train_sim("--set", "brake=ab_head_end")
        for nodes in 1, 3, 6:
            with self.subTest(nodes=nodes):
                self.assert_complete(self.launch(f"nodes:={nodes}", "set:=brake=ab_head_end"), expected)
        self.assertNotEqual(expected["state_digest"], train_sim()["state_digest"])

    def test_a_brake_wave_is_the_same_from_every_mapping_and_goes_on_from_its_middle(self):
        """A shipped train with valves of two kinds; its first reduction, at 2 s, is half way to the tail at 3 s."""
        scenario = CONFIG / "scenarios" / "mixed_g_p.yaml"
        settings = ["model=2d", "exchange_interval_s=0.005", "duration_s=4"]
        begun = pathlib.Path(self.folder.name) / "begun"
        expected = train_sim(*(word for key in settings for word in ("--set", key)), scenario=scenario)
        begin = [*settings[:-1], "duration_s=3"]
        train_sim(*(word for key in begin for word in ("--set", key)), "--out", str(begun), scenario=scenario)
        with rosbag.Bag(str(begun / "train.bag")) as bag:
            pressure_pa = [m.pipe_pressure_pa for _, m, _ in bag.read_messages("/train/brake_pressures")][-1]
        self.assertLess(pressure_pa[0], pressure_pa[-1] - 1e3)  # it is on its way
        for nodes in 1, 3:
            with self.subTest(nodes=nodes):
                launch = self.launch(f"nodes:={nodes}", "set:=" + " ".join(settings), scenario=scenario, vehicles=50)
                self.assert_complete(launch, expected)
        launch = self.launch("nodes:=7", f"resume:={begun}", "set:=duration_s=4", scenario=" ", vehicles=50)
        self.assertEqual(3, self.assert_complete(launch, expected)["resumed_at_s"])

    def test_ltd_runs_in_the_master_alone(self):
        expected = train_sim("--model", "ltd")
        launch = self.launch("model:=ltd")
        self.assert_complete(launch, expected)
        self.assertNotIn("wagon_node", launch.log.read_text())

    @unittest.skipIf("TSAN_OPTIONS" in os.environ, "242 nodes with the thread sanitizer take 17 GB")
    def test_the_paper_s_shape_one_node_per_vehicle(self):
        """242 nodes come up and run 200 exchanges."""
        emergency = CONFIG / "scenarios" / "emergency.yaml"
        expected = train_sim("--set", "duration_s=0.2", scenario=emergency)
        launch = self.launch(
            "nodes:=242", "set:=duration_s=0.2", "startup_timeout:=120", scenario=emergency, vehicles=242
        )
        self.assert_complete(launch, expected)
        self.assertEqual(242, len(set(re.findall(r"process\[train/(wagon_\d+)-", launch.log.read_text()))))

    def test_the_bag_is_that_of_train_sim(self):
        launch = self.launch("nodes:=2")
        self.assertEqual(0, launch.wait(), launch.log.read_text())
        other = pathlib.Path(self.folder.name) / "in_process"
        train_sim("--out", str(other))
        with rosbag.Bag(str(launch.out / "train.bag")) as ours, rosbag.Bag(str(other / "train.bag")) as theirs:
            self.assertEqual(theirs.get_message_count(), ours.get_message_count())
            for (topic, a, t), (other_topic, b, u) in zip(ours.read_messages(raw=True), theirs.read_messages(raw=True)):
                self.assertEqual((other_topic, u), (topic, t))
                self.assertEqual(b[1], a[1], topic)  # serialised
        code, verdict = verify(launch.out)
        self.assertEqual(0, code, verdict)

    def test_pause_step_resume_and_topics(self):
        clock, states, diagnostics = [], [], []
        rospy.Subscriber("/clock", Clock, lambda m: clock.append(m.clock.to_sec()), queue_size=10000)
        rospy.Subscriber("/train/state", TrainState, states.append, queue_size=10000)
        rospy.Subscriber("/diagnostics", DiagnosticArray, diagnostics.append, queue_size=100)
        launch = self.launch("nodes:=2", "start_paused:=true", "real_time_factor:=0.2")
        rospy.wait_for_service("/train/master/step", LATE)
        pause, resume = (rospy.ServiceProxy("/train/master/" + name, Trigger) for name in ("pause", "resume"))
        step = rospy.ServiceProxy("/train/master/step", StepExchanges)

        reply = step(25)
        self.assertTrue(reply.success, reply.message)
        self.assertAlmostEqual(25 * EXCHANGE_INTERVAL, reply.simulated_s, places=9)
        self.assertFalse(step(0).success)
        time.sleep(1.0)  # paused: nothing moves
        self.assertAlmostEqual(30 * EXCHANGE_INTERVAL, step(5).simulated_s, places=9)
        self.assertTrue(wait_until(lambda: diagnostics, LATE))
        values = {v.key: v.value for v in diagnostics[-1].status[0].values}
        self.assertEqual("paused", diagnostics[-1].status[0].message)
        self.assertEqual(
            {
                "simulated_s",
                "real_time_factor",
                "exchange_p50_ms",
                "exchange_p99_ms",
                "ranks",
                "slowest_rank",
                "late_exchanges",
                "recoveries",
            },
            set(values),
        )
        self.assertTrue(resume().success)
        self.assertFalse(resume().success)
        self.assertFalse(step(1).success)
        self.assertTrue(pause().success)
        self.assertTrue(resume().success)
        self.assert_complete(launch, train_sim())

        self.assertTrue(wait_until(lambda: len(clock) >= 3, LATE))
        for earlier, later in zip(clock, clock[1:]):
            self.assertGreater(later, earlier)  # monotone, and at least 100 Hz of simulated time
            self.assertLessEqual(later - earlier, 0.01 + 1e-6)
        self.assertEqual(launch.summary()["state_digest"], "%016x" % states[-1].state_digest)

    def test_live_topics_and_pace(self):
        status, live = [], []
        rospy.Subscriber("/train/live/status", RunStatus, status.append, queue_size=10000)
        rospy.Subscriber("/train/live/state", TrainState, live.append, queue_size=10000)
        launch = self.launch("nodes:=2", "start_paused:=true", "set:=duration_s=3")
        rospy.wait_for_service("/train/master/set_real_time_factor", LATE)
        pace = rospy.ServiceProxy("/train/master/set_real_time_factor", SetRealTimeFactor)
        for wrong in (-1.0, float("nan"), float("inf")):
            reply = pace(wrong)
            self.assertFalse(reply.success)
            self.assertIn("real_time_factor must be >= 0", reply.message)
        self.assertTrue(pace(2.0).success)
        self.assertTrue(wait_until(lambda: status and status[-1].wanted_real_time_factor == 2.0, LATE))
        self.assertEqual(RunStatus.PAUSED, status[-1].state)
        self.assertTrue(wait_until(lambda: live, LATE))  # latched: the start is there, however late we came
        self.assertEqual(0, live[0].exchange)
        self.assertTrue(rospy.ServiceProxy("/train/master/step", StepExchanges)(50).success)
        nothing_is_held_back = lambda: status[-1].exchange == live[-1].exchange == 50
        self.assertTrue(wait_until(nothing_is_held_back, LATE))

        begin = time.monotonic()
        self.assertTrue(rospy.ServiceProxy("/train/master/resume", Trigger)().success)
        self.assertTrue(wait_until(lambda: status[-1].exchange >= 1000, LATE))  # 2 s
        paced_s = time.monotonic() - begin
        self.assertGreater(paced_s, 0.9)  # (2 - 0.1) / 2 s: the pace began before `begin`, by an exchange at most
        self.assertLess(len([s for s in status if s.exchange > 50]), 20 * paced_s + 2)  # at most 20 per second
        self.assertTrue(pace(0).success)  # as fast as possible, from now on
        self.assertEqual(0, launch.wait(), launch.log.read_text())

        self.assertTrue(wait_until(lambda: status[-1].state == RunStatus.ENDED and live[-1].exchange == 1500, LATE))
        last = status[-1]
        self.assertEqual(1500, last.exchange)
        self.assertAlmostEqual(sum(live[-1].speed_mps) / 6, last.mean_speed_mps, places=6)  # equal vehicles
        moved = [end - start for start, end in zip(live[0].position_m, live[-1].position_m)]
        self.assertAlmostEqual(sum(moved) / 6, last.travelled_m, places=6)
        self.assertGreaterEqual(last.max_tension_n, 0)
        self.assertLessEqual(last.max_compression_n, 0)

    def test_nodes_on_this_machine_share_memory_with_the_master_unless_told_not_to(self):
        for choice in (True, False):
            launch = self.launch("nodes:=2", "start_paused:=true", f"shared_memory:={str(choice).lower()}")
            rospy.wait_for_service("/train/master/step", LATE)
            self.assertTrue(rospy.ServiceProxy("/train/master/step", StepExchanges)(1).success)
            self.assertEqual(2, len(wagon_nodes()))
            self.assertEqual(choice, share_memory(wagon_nodes()))
            launch.end()
            self.assertTrue(wait_until(lambda: not wagon_nodes(), LATE))

    def test_names_are_what_a_ros_user_expects(self):
        launch = self.launch("nodes:=3", "start_paused:=true")
        rospy.wait_for_service("/train/master/step", LATE)
        self.assertTrue(rospy.ServiceProxy("/train/master/step", StepExchanges)(1).success)
        graph = rosgraph.Master("/distributed_train")
        topics = {name: kind for name, kind in graph.getTopicTypes()}
        for topic, kind in (
            ("/train/state", "TrainState"),
            ("/train/in_train_forces", "InTrainForces"),
            ("/train/brake_pressures", "BrakePressures"),
            ("/train/energy_ledger", "EnergyLedger"),
            ("/train/wagon_004/state", "WagonState"),
            ("/train/live/status", "RunStatus"),
            ("/train/live/wagon_004/state", "WagonState"),
        ):
            self.assertEqual("train_brake_msgs/" + kind, topics.get(topic), topic)
        self.assertEqual("std_msgs/String", topics.get("/train/scenario"))
        _, _, services = graph.getSystemState()
        nodes = {node for _, providers in services for node in providers}
        self.assertLessEqual({"/train/master", "/train/wagon_001", "/train/wagon_003", "/train/wagon_005"}, nodes)
        launch.end()

    def test_rosbag_record_works_beside(self):
        bag = pathlib.Path(self.folder.name) / "beside.bag"
        topics = ["/train/" + t for t in ("state", "scenario", "in_train_forces", "energy_ledger", "wagon_004/state")]
        recorder = subprocess.Popen(
            ["rosbag", "record", "-q", "-O", str(bag), *topics, "__name:=beside"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        # Three seconds: a recorder starts with the first message after the first /clock, and takes a moment.
        launch = self.launch("nodes:=2", "start_paused:=true", "real_time_factor:=1", "set:=duration_s=3")
        rospy.wait_for_service("/train/master/resume", LATE)
        graph = rosgraph.Master("/distributed_train")
        self.assertTrue(
            wait_until(
                lambda: any(t == "/train/state" and "/beside" in nodes for t, nodes in graph.getSystemState()[1]), 30
            )
        )
        time.sleep(1.0)  # for the connection itself
        self.assertTrue(rospy.ServiceProxy("/train/master/resume", Trigger)().success)
        self.assertEqual(0, launch.wait(), launch.log.read_text())
        time.sleep(1.0)
        recorder.send_signal(signal.SIGINT)
        recorder.wait(LATE)
        self.assertTrue(wait_until(bag.exists, LATE))  # the rosbag command ends before the recorder that it has started
        with rosbag.Bag(str(bag)) as recorded:
            last = [m for _, m, _ in recorded.read_messages("/train/state")][-1]
        self.assertEqual(launch.summary()["state_digest"], "%016x" % last.state_digest)
        code, verdict = verify(bag)  # by the scenario that it holds; it begins late, and may lack messages
        self.assertEqual(0, code, verdict)

    def test_a_missing_rank_is_named(self):
        """The launch file deals the train to two nodes, the master expects three."""
        launch_file = pathlib.Path(self.folder.name) / "missing.launch"
        launch_file.write_text(
            f"""
          <launch><group ns="train">
            <node pkg="wagon_node" type="wagon_node" name="wagon_001"/>
            <node pkg="wagon_node" type="wagon_node" name="wagon_005"/>
            <node pkg="ltd_master" type="ltd_master" name="master" required="true" output="screen">
              <param name="scenario" value="{SHORT_TRAIN}"/> <param name="ranks" value="3"/>
              <param name="startup_timeout_s" value="3"/>
              <param name="exit_status_file" value="{self.folder.name}/status"/>
            </node></group></launch>"""
        )
        done = subprocess.run(
            ["roslaunch", str(launch_file)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60
        )
        self.assertEqual("4", (pathlib.Path(self.folder.name) / "status").read_text().strip(), done.stdout)
        self.assertIn("/train/wagon_003", done.stdout)
        self.assertNotIn("/train/wagon_005 (", done.stdout)

    def test_wagons_leave_when_the_master_is_killed(self):
        launch_file = pathlib.Path(self.folder.name) / "orphans.launch"
        launch_file.write_text(
            """
          <launch><group ns="train">
            <node pkg="wagon_node" type="wagon_node" name="wagon_001"/>
            <node pkg="wagon_node" type="wagon_node" name="wagon_004"/></group></launch>"""
        )
        wagons = subprocess.Popen(["roslaunch", str(launch_file)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(wagons.wait, 30)
        self.addCleanup(wagons.send_signal, signal.SIGINT)
        master = subprocess.Popen(
            [
                "rosrun",
                "ltd_master",
                "ltd_master",
                "__ns:=train",
                "__name:=master",
                f"_scenario:={SHORT_TRAIN}",
                "_ranks:=2",
                "_real_time_factor:=0.01",
            ],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        self.assertTrue(wait_until(lambda: len(wagon_nodes()) == 2, LATE))
        rospy.wait_for_message("/train/state", TrainState, 60)  # under way
        self.assertTrue(share_memory(wagon_nodes()))  # which has no name: it goes with the last of them
        os.killpg(master.pid, signal.SIGKILL)
        master.wait()
        self.assertTrue(wait_until(lambda: not wagon_nodes(), LATE), "wagon nodes still there")

    def test_ctrl_c_ends_cleanly(self):
        launch = self.launch("nodes:=3", "real_time_factor:=0.02")
        rospy.wait_for_message("/train/state", TrainState, 60)
        time.sleep(0.5)
        launch.process.send_signal(signal.SIGINT)
        self.assertEqual(130, launch.wait(60), launch.log.read_text())
        self.assertFalse(launch.summary()["complete"])
        with rosbag.Bag(str(launch.out / "train.bag")) as bag:
            self.assertGreater(bag.get_message_count("/train/state"), 1)

    def test_bad_input_ends_with_2(self):
        for arguments, complaint in (
            (["set:=dt_s=abc"], "dt_s must be"),
            (["vehicles:=7"], "vehicles:=6"),
            (["checkpoint_interval:=nan"], "checkpoint_interval_s must be"),
            (["on_lost_node:=foo"], "on_lost_node must be"),
        ):
            with self.subTest(arguments):
                launch = self.launch(*arguments, "nodes:=2")
                self.assertEqual(2, launch.wait(60))
                self.assertIn(complaint, launch.log.read_text())
                self.assertFalse(launch.out.exists())


if __name__ == "__main__":
    rospy.init_node("distributed_train", disable_rostime=True)
    threading.Thread(target=rospy.spin, daemon=True).start()
    rostest.rosrun("train_brake", "distributed_train", DistributedTrain)
