#!/usr/bin/python3
"""rviz with the paper's train in it, on a display without a screen and drawn by software: what is seen there?

Shapes are found by their colour and judged by their extent.
"""
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import rosgraph
import rospy
import rostest
from PIL import Image, ImageChops, ImageGrab
from std_srvs.srv import Trigger
from train_brake_msgs.msg import RunStatus
from train_brake_msgs.srv import SelectView, SetRealTimeFactor, StepExchanges

WORKSPACE = pathlib.Path(__file__).resolve().parents[3]
SCENARIO = WORKSPACE / "config" / "scenarios" / "emergency.yaml"
COMPRESSION, PRESSURE, BOGIE, INK = (0, 114, 178), (0, 158, 115), (86, 180, 233), (27, 31, 36)
LATE = 600.0  # what waits may take on a loaded machine
BAND = ((25, 135, 195), (0, 70, 110))  # colours between which those of vehicles at 300 ... 440 kPa lie


def start_display():
    """Xvfb on a display of its own choice. Returns the process and the display's name."""
    reading, writing = os.pipe()
    display = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", "1600x900x24", "-nolisten", "tcp"],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    with os.fdopen(reading) as number:
        return display, ":" + number.readline().strip()


def mask(picture, low, high=None, tolerance=6):
    """White where each channel lies between those of two colours, or is that of one."""
    channels = []
    for channel, a, b in zip(picture.split(), low, high or low):
        least, most = min(a, b) - tolerance, max(a, b) + tolerance
        channels.append(channel.point(lambda value, least=least, most=most: 255 * (least <= value <= most)))
    return ImageChops.darker(ImageChops.darker(channels[0], channels[1]), channels[2])


class Seen:
    """The smallest rectangle around all pixels of a colour in the rows from top to bottom."""

    def __init__(self, picture, *colours, top=0, bottom=None):
        pixels = mask(picture, *colours).crop((0, top, picture.width, bottom or picture.height))
        box = pixels.getbbox() or (0, 0, 0, 0)
        self.left, self.right = box[0], box[2]
        self.top, self.bottom = box[1] + top, box[3] + top
        self.width, self.height = self.right - self.left, self.bottom - self.top
        self.count = pixels.histogram()[255]


def broad(picture, *colours, top=0):
    """Seen in those rows below `top` half of which has the colour: areas, but neither text nor lines."""
    share = mask(picture, *colours).resize((1, picture.height), Image.BOX).getdata()
    rows = [row for row in range(top, picture.height) if share[row] > 127]
    return Seen(picture, *colours, top=rows[0], bottom=rows[-1] + 1) if rows else Seen(picture, *colours, bottom=1)


def header_of(picture):
    """The numbers over the plots."""
    return Seen(
        picture, INK, top=picture.height // 30, bottom=max(broad(picture, COMPRESSION).top - picture.height // 10, 2)
    )


class Rviz(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        display, self.display = start_display()
        self.addCleanup(display.wait)
        self.addCleanup(display.terminate)
        self.log = pathlib.Path(folder.name) / "log"
        environment = dict(
            os.environ, DISPLAY=self.display, LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1", HOME=folder.name
        )  # rviz keeps its own notes there
        environment.pop("QT_QPA_PLATFORM", None)
        with open(self.log, "w") as log:
            self.launch = subprocess.Popen(
                [
                    "rosrun",
                    "train_brake",
                    "run",
                    str(SCENARIO),
                    folder.name + "/out",
                    "rviz:=true",
                    "start_paused:=true",
                ],
                stdout=log,
                stderr=subprocess.STDOUT,
                env=environment,
                start_new_session=True,
            )
        self.addCleanup(self.end)

    def end(self):
        if self.launch.poll() is None:
            os.killpg(self.launch.pid, signal.SIGINT)  # Ctrl-C in a terminal
        self.launch.wait(LATE)

    def call(self, service, kind, *arguments):
        rospy.wait_for_service(service, LATE)
        reply = rospy.ServiceProxy(service, kind)(*arguments)
        self.assertTrue(reply.success, reply.message)

    def look(self):
        return ImageGrab.grab(xdisplay=self.display).convert("RGB")

    def look_until(self, is_there, timeout_s=LATE):
        """The first picture of which that holds; else the last one."""
        end = time.monotonic() + timeout_s
        while True:
            picture = self.look()
            if is_there(picture) or time.monotonic() > end:
                return picture
            time.sleep(0.5)

    def test_the_train_its_plots_and_its_numbers_are_seen(self):
        self.call("/train/master/step", StepExchanges, 14000)  # the brake wave has passed, the train is compressed
        self.call("/train/view/select", SelectView, "pressure", 100)
        self.call("/train/master/set_real_time_factor", SetRealTimeFactor, 0.1)  # not over before it is drawn
        self.call("/train/master/resume", Trigger)
        picture = self.look_until(  # text comes a moment after what it is on
            lambda p: broad(p, *BAND, top=broad(p, PRESSURE).bottom).width > 0.7 * p.width
            and header_of(p).width > 0.6 * p.width
        )
        self.keep(picture)
        width, height = picture.size

        # Plots: forces above pressures, both along the whole train.
        pressures = broad(picture, PRESSURE)
        self.assertGreater(pressures.width, 0.7 * width)
        self.assertGreater(pressures.height, 0.03 * height)
        forces = broad(picture, COMPRESSION)
        self.assertGreater(forces.width, 0.5 * width)
        self.assertGreater(forces.height, 0.01 * height)
        self.assertLess(forces.bottom, pressures.top)

        # The train: a band of vehicles, as long as the plots over it.
        band = broad(picture, *BAND, top=pressures.bottom)
        self.assertAlmostEqual(pressures.left, band.left, delta=0.01 * width)
        self.assertAlmostEqual(pressures.right, band.right, delta=0.01 * width)
        self.assertGreater(band.height, 0.02 * height)
        self.assertLess(band.height, 0.1 * height)

        # The close-up: two bogies, further apart than either is long.
        bogies = Seen(picture, BOGIE, top=band.bottom)
        third = bogies.width // 3
        middle = mask(picture, BOGIE).crop((bogies.left + third, bogies.top, bogies.right - third, bogies.bottom))
        self.assertGreater(bogies.width, 0.15 * width)
        self.assertLess(bogies.height, 0.1 * height)
        self.assertIsNone(middle.getbbox())

        # Text: numbers over the plots from end to end, on their axes, and a clock that goes on.
        header = header_of(picture)
        self.assertGreater(header.width, 0.6 * width)
        self.assertGreater(header.count, 300)
        axes = mask(picture, INK, tolerance=60).crop((0, forces.top, pressures.left - 10, pressures.bottom))
        self.assertGreater(axes.histogram()[255], 150)
        numbers = (0, header.top, width, header.bottom)
        changes = lambda p: ImageChops.difference(p.crop(numbers), picture.crop(numbers)).getbbox() is not None
        self.assertTrue(changes(self.look_until(changes)))

        status = rospy.wait_for_message("/train/live/status", RunStatus, LATE)
        self.assertEqual(RunStatus.RUNNING, status.state)
        self.assertNotIn("could not be loaded", self.log.read_text())  # the panel

        # Closing rviz ends the launch; the run is kept as interrupted.
        _, _, services = rosgraph.Master("/rviz_test").getSystemState()
        rviz = {node for _, nodes in services for node in nodes if node.startswith("/train/rviz")}
        self.assertEqual(1, len(rviz))
        subprocess.run(["rosnode", "kill", *rviz], check=True, stdout=subprocess.DEVNULL)
        self.assertEqual(130, self.launch.wait(LATE), self.log.read_text())

    def keep(self, picture):
        """What was seen, to explain a failure."""
        folder = os.environ.get("TRAIN_BRAKE_SCREENSHOTS")
        if folder:
            picture.save(pathlib.Path(folder) / "rviz.png")


if __name__ == "__main__":
    rospy.init_node("rviz_test", disable_signals=True)
    rostest.rosrun("train_brake_rviz", "rviz", Rviz)
