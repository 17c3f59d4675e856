#!/usr/bin/python3
"""docs/ros_interface.md is what its generator makes of messages, launch files and code, and that is complete."""

import pathlib
import re
import subprocess
import sys
import unittest

import rosunit

ROOT = pathlib.Path(__file__).resolve().parent.parent


def page():
    return subprocess.run(
        [sys.executable, ROOT / "tools" / "ros_interface.py"], stdout=subprocess.PIPE, text=True, check=True
    ).stdout


class InterfacePage(unittest.TestCase):
    def test_is_fresh(self):
        stored = (ROOT / "docs" / "ros_interface.md").read_text()
        self.assertEqual(page(), stored, "docs/ros_interface.md is stale; renew it: make reference")

    def test_has_every_message_service_and_field(self):
        text = page()
        for path in (ROOT / "src" / "train_brake_msgs").glob("*/*.??[gv]"):
            section = text.partition(f"### train_brake_msgs/{path.stem}\n")[2].partition("\n### ")[0]
            fields = re.findall(r"(?m)^[\w/\[\]]+ +(\w+)", re.sub("#.*", "", path.read_text()))
            self.assertTrue(fields or path.suffix == ".srv", path)
            for field in fields:
                self.assertIn(f"`{field}", section, f"{path.name}: {field}")

    def test_has_every_topic_service_and_parameter_that_the_nodes_name(self):
        text = page()
        names = set()
        for package in ("ltd_master", "wagon_node", "train_brake_rviz"):
            for path in (ROOT / "src" / package / "src").rglob("*.cpp"):
                code = path.read_text()
                names |= {"~" + name for name in re.findall(r'parameters\.\w+\(\s*"(\w+)"', code)}
                names |= set(re.findall(r'dvertise(?:Service|<[\w:]+>)\("([\w/]+)"', code))
                names |= set(re.findall(r'subscribe\("([\w/]+)"', code))
        names.discard("~Complain")
        self.assertGreater(len(names), 30)
        for name in names:
            self.assertRegex(text, rf"`~?{re.escape(name)}`")

    def test_has_every_launch_argument(self):
        text = page()
        for path in (ROOT / "launch").glob("*.launch"):
            self.assertIn(path.name, text)
            for name in re.findall(r'<arg name="(\w+)"\s+default=', path.read_text()):
                self.assertIn(f"`{name}`", text)


if __name__ == "__main__":
    rosunit.unitrun("train_brake", "interface_page", InterfacePage)
