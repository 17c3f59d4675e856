#!/usr/bin/python3
"""Two trains under one ROS master, each in its namespace with a driver in lockstep, a cab and an rviz: nothing of one
reaches the other one."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import rosgraph
import rospy
import rostest
from PIL import ImageChops, ImageGrab
from sensor_msgs.msg import Joy
from std_srvs.srv import Trigger
from train_brake_msgs.msg import DriverView, GivenCommand

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from rviz import Seen, mask, start_display

WORKSPACE = pathlib.Path(__file__).resolve().parents[3]
SCENARIO = WORKSPACE / "config" / "scenarios" / "drive_and_stop.yaml"
TRAINS = {"/train": ("plain", 30), "/north/train": ("north", 15)}  # namespace: (folder, speed to be held [km/h])
EMERGENCY_BUTTON = ((250, 165, 100), (220, 115, 40))  # colours between which its own lie, once a train runs
LATE = 600.0  # a loaded machine draws two trains slowly


def wait_until(condition, timeout_s=LATE):
    end = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.2)
    return True


class TwoCabs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.displays = {}
        for namespace in TRAINS:
            display, self.displays[namespace] = start_display()
            self.addCleanup(display.wait)
            self.addCleanup(display.terminate)
        self.master = rosgraph.Master("/two_cabs_test")

    def start(self, *words, namespace, display=""):
        environment = dict(
            os.environ, DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1", HOME=str(self.folder)
        )
        environment.pop("ROS_NAMESPACE", None)
        if namespace:
            environment["ROS_NAMESPACE"] = namespace
        environment.pop("QT_QPA_PLATFORM", None)
        process = subprocess.Popen(
            words,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
        )
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def nodes(self, which, topic):
        """Who publishes (0) or subscribes (1) to a topic, or serves it (2)."""
        return {node for name, nodes in self.master.getSystemState()[which] for node in nodes if name == topic}

    def look(self, namespace):
        picture = ImageGrab.grab(xdisplay=self.displays[namespace]).convert("RGB")
        if os.environ.get("TRAIN_BRAKE_SCREENSHOTS"):
            folder = pathlib.Path(os.environ["TRAIN_BRAKE_SCREENSHOTS"])
            picture.save(folder / f"two_cabs_{TRAINS[namespace][0]}.png")
        return picture

    def cab(self, namespace):
        """The picture of the cab, and its button EMERGENCY."""
        picture = self.look(namespace)
        picture = picture.crop((0, 0, picture.width // 4, picture.height))
        return picture, Seen(picture, *EMERGENCY_BUTTON)

    def shows_a_train(self, namespace):
        return self.cab(namespace)[1].width > 100

    def handle(self, namespace):
        """The line of the cab that tells where the brake handle stands: under the button EMERGENCY."""
        picture, button = self.cab(namespace)
        return picture.crop((button.right - 120, button.bottom + 4, button.right, button.bottom + 26))

    def test_nothing_of_one_train_reaches_the_other(self):
        trains, given = {}, {namespace: [] for namespace in TRAINS}
        for namespace, (name, speed_kmh) in TRAINS.items():
            self.start(
                "rosrun",
                "train_brake_examples",
                "hold_speed",
                "__name:=driver",
                f"_speed_kmh:={speed_kmh}",
                namespace=namespace,
            )
            self.start("rosrun", "train_brake_examples", "cab_controls", namespace=namespace)
            trains[namespace] = self.start(
                "rosrun",
                "train_brake",
                "run",
                str(SCENARIO),
                str(self.folder / name),
                "rviz:=true",
                "cab:=true",
                "report:=false",
                "driver:=driver",
                "real_time_factor:=5",
                "start_paused:=true",
                "set:=commands=[] until=null duration_s=100 exchange_interval_s=0.005",
                namespace=namespace.rpartition("/")[0],
                display=self.displays[namespace],
            )
            self.assertTrue(wait_until(lambda: self.nodes(2, f"{namespace}/master/resume")), namespace)
            rospy.Subscriber(f"{namespace}/driver/given", GivenCommand, given[namespace].append)

        # Each cab and each view listens to its own train.
        for namespace in TRAINS:
            of_rviz = lambda topic: {n for n in self.nodes(1, f"{namespace}/{topic}") if "rviz" in n}
            self.assertTrue(wait_until(lambda: of_rviz("live/driver_view") and of_rviz("view/markers")), namespace)
            for topic in ("live/driver_view", "live/status", "view/markers", "clock"):
                self.assertTrue(all(n.rpartition("/")[0] == namespace for n in of_rviz(topic)), (namespace, topic))
        self.assertEqual({"/train/master"}, self.nodes(0, "/clock"))
        self.assertEqual({"/north/train/master"}, self.nodes(0, "/north/train/clock"))

        self.assertTrue(wait_until(lambda: all(self.shows_a_train(namespace) for namespace in TRAINS)))
        same = lambda one, other: ImageChops.difference(one, other).getbbox() is None
        ink = lambda picture: mask(picture, (0, 0, 0), tolerance=90).histogram()[255]
        self.assertTrue(  # both released: a word, no longer a dash
            wait_until(
                lambda: ink(self.handle("/train")) > 50 and same(self.handle("/train"), self.handle("/north/train"))
            )
        )
        released = self.handle("/train")

        # A joystick of one train, while both stand.
        joystick = rospy.Publisher("/north/train/joy", Joy, queue_size=1, latch=True)
        joystick.publish(Joy(axes=[0.0, 0.0], buttons=[1, 0, 0]))
        for namespace in TRAINS:
            rospy.ServiceProxy(f"{namespace}/master/resume", Trigger)()
        self.assertTrue(wait_until(lambda: any(g.command.kind == "apply" for g in given["/north/train"])))
        views = {}
        for namespace in TRAINS:
            views[namespace] = rospy.wait_for_message(f"{namespace}/live/driver_view", DriverView, LATE)
        self.assertTrue(wait_until(lambda: not same(self.handle("/north/train"), released)))
        self.assertTrue(same(self.handle("/train"), released))
        self.assertFalse([g for g in given["/train"] if g.command.kind == "apply"])
        self.assertEqual(0, views["/train"].reduction_kpa)
        self.assertEqual(50, views["/north/train"].reduction_kpa)

        # The run of each ends when its rviz is closed, and the other one goes on.
        rviz = [n for n in self.nodes(1, "/north/train/live/driver_view") if "rviz" in n]
        subprocess.run(["rosnode", "kill", *rviz], check=True, stdout=subprocess.DEVNULL)
        trains["/north/train"].wait(LATE)
        self.assertIsNone(trains["/train"].poll())
        rviz = [n for n in self.nodes(1, "/train/live/driver_view") if "rviz" in n]
        subprocess.run(["rosnode", "kill", *rviz], check=True, stdout=subprocess.DEVNULL)
        trains["/train"].wait(LATE)
        commands = {
            namespace: json.loads((self.folder / name / "summary.json").read_text())["commands"]
            for namespace, (name, _) in TRAINS.items()
        }
        self.assertIn("apply 50 kPa", [c["command"] for c in commands["/north/train"]])
        self.assertNotIn("apply 50 kPa", [c["command"] for c in commands["/train"]])


if __name__ == "__main__":
    rospy.init_node("two_cabs_test", disable_signals=True)
    rostest.rosrun("train_brake_rviz", "two_cabs", TwoCabs)
