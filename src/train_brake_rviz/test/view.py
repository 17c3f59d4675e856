#!/usr/bin/python3
"""What train_view publishes when a bag is played."""
import pathlib
import subprocess
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from tf2_msgs.msg import TFMessage
from train_brake_msgs.msg import ViewSelection
from train_brake_msgs.srv import SelectView
from visualization_msgs.msg import Marker, MarkerArray

SHORT_TRAIN = pathlib.Path(__file__).resolve().parents[3] / "test" / "short_train.yaml"  # six wagons
DURATION = 1.0
LATE = 600.0  # what waits may take on a loaded machine


def wait_until(condition, timeout_s=LATE):
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.05)
    return False


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name) / "out"
        subprocess.run(
            [
                "rosrun",
                "train_sim",
                "train_sim",
                "run",
                str(SHORT_TRAIN),
                "--set",
                f"duration_s={DURATION}",
                "--out",
                str(cls.out),
            ],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.markers, self.frames, self.pictures, self.selection = {}, {}, 0, None
        for subscriber in (
            rospy.Subscriber("/train/view/markers", MarkerArray, self.on_markers),
            rospy.Subscriber("/train/view/selection", ViewSelection, self.on_selection),
            rospy.Subscriber("/tf", TFMessage, self.on_transforms),
        ):
            self.addCleanup(subscriber.unregister)

    def on_markers(self, message):
        self.pictures += 1
        for marker in message.markers:
            self.markers[marker.ns, marker.id] = marker

    def on_selection(self, message):
        self.selection = message

    def on_transforms(self, message):
        for transform in message.transforms:
            self.frames[transform.child_frame_id] = transform

    def start(self, *command):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait, LATE)
        self.addCleanup(process.terminate)
        return process

    def start_view(self, *parameters):
        self.start(
            "rosrun", "train_brake_rviz", "train_view", "__ns:=/train", "__name:=view", "_live:=false", *parameters
        )
        self.assertTrue(wait_until(lambda: self.markers), "no markers")

    def play(self, *options):
        self.start("rosbag", "play", "--quiet", "--delay=1", *options, str(self.out / "train.bag"))

    def words(self):
        return [
            m.text for m in list(self.markers.values()) if m.action == Marker.ADD and m.type == Marker.TEXT_VIEW_FACING
        ]

    def shapes(self, namespace):
        marker = self.markers.get((namespace, 0))
        return len(marker.points) // 3 if marker and marker.action == Marker.ADD else 0

    def assert_shown(self):
        self.assertTrue(wait_until(lambda: f"{DURATION:.2f} s" in self.words()), self.words())
        for namespace, least in (("plots", 20), ("train", 6), ("close-up", 50), ("legend", 50)):
            self.assertGreater(self.shapes(namespace), least, namespace)
        for marker in list(self.markers.values()):
            self.assertEqual("board", marker.header.frame_id)

    def test_a_bag_is_shown_from_beginning_to_end(self):
        self.start_view()
        self.assertIn("waiting for a train on /train/scenario", self.words())
        begin, pictures_before = time.monotonic(), self.pictures
        self.play()
        self.assert_shown()
        self.assertLess(self.pictures - pictures_before, 20 * (time.monotonic() - begin) + 2)
        self.assertIn("6 vehicles, 2D model", self.words())
        self.assertIn("vehicle 4", self.words())  # in full detail, and no locomotive
        self.assertNotIn("waiting for a train on /train/scenario", self.words())

        # tf has the locomotives and the followed wagon, where the last record has them.
        self.assertEqual({"wagon_001", "wagon_004", "wagon_006"}, set(self.frames))
        with rosbag.Bag(str(self.out / "train.bag")) as bag:
            last = [message for _, message, _ in bag.read_messages("/train/state")][-1]
        for vehicle in (1, 4, 6):
            transform = self.frames["wagon_%03d" % vehicle]
            self.assertEqual("track", transform.header.frame_id)
            self.assertAlmostEqual(last.position_m[vehicle - 1], transform.transform.translation.x, places=9)

    def test_what_is_seen_can_be_chosen(self):
        self.start_view(f"_scenario:={self.out}/config.yaml", "_quantity:=slip", "_vehicle:=-1")
        self.assertTrue(wait_until(lambda: self.selection and self.selection.vehicles == 6))
        self.assertEqual(("slip", 6), (self.selection.quantity, self.selection.vehicle))
        self.assertEqual((1, 4, 6), tuple(self.selection.detailed))
        select = rospy.ServiceProxy("/train/view/select", SelectView)
        for quantity, vehicle, words in (
            (
                "colour",
                0,
                "quantity must be one of coupler_force, pressure, " "pipe_pressure, slip, acceleration, got colour",
            ),
            ("", 7, "vehicle 7 is not in a train of 6 vehicles"),
        ):
            reply = select(quantity, vehicle)
            self.assertEqual((False, words), (reply.success, reply.message))
        for quantity in self.selection.quantities:
            self.assertTrue(select(quantity, 2).success)
            self.assertTrue(wait_until(lambda name=quantity: self.selection.quantity == name))
        self.assertEqual(2, self.selection.vehicle)

    def test_a_bag_without_the_scenario_or_half_of_the_topics(self):
        self.start_view(f"_scenario:={self.out}/config.yaml")
        self.play("--topics", "/train/state", "/train/wagon_004/state", "--bags=" + str(self.out / "train.bag"))
        self.assert_shown()

    def test_wrong_parameters(self):
        for parameter, words in (
            ("_quantity:=colour", "parameter quantity must be one of coupler_force, pressure"),
            ("_vertical_exaggeration:=-2", "parameter vertical_exaggeration must be >= 0 and finite, got -2"),
            ("_scenario:=/no/such.yaml", "/no/such.yaml"),
        ):
            done = subprocess.run(
                ["rosrun", "train_brake_rviz", "train_view", "__ns:=/wrong", parameter],
                timeout=LATE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            )
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn(words, done.stdout)
            rospy.delete_param("/wrong")


if __name__ == "__main__":
    rospy.init_node("view_test")
    rostest.rosrun("train_brake_rviz", "view", View)
