#!/usr/bin/env python3
"""The reference of all keys and the schemas for editors: complete, fresh, and of one mind with the reader.

usage: keys_test.py TRAIN_SIM CONFIG_FOLDER [--gtest_output=xml:FILE]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import jsonschema
import rosunit
import yaml

TRAIN_SIM, CONFIG = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
ROOT = CONFIG.parent
RENEW = "renew it: make reference"


def train_sim(*arguments):
    return subprocess.run(
        [TRAIN_SIM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=300
    )


def keys(*arguments):
    done = train_sim("keys", *arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


class Yaml12(yaml.SafeLoader):
    """Numbers as YAML 1.2 has them (1e8), and only true and false for flags."""


Yaml12.yaml_implicit_resolvers = {
    first: [
        (tag, pattern) for tag, pattern in resolvers if tag not in ("tag:yaml.org,2002:bool", "tag:yaml.org,2002:float")
    ]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Yaml12.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile("^(?:true|false)$"), list("tf"))
Yaml12.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?$"), list("-+.0123456789")
)


KINDS = {
    "scenario": "scenarios",
    "train": "trains",
    "vehicle": "vehicles",
    "coupler": "couplers",
    "brake": "brakes",
    "traction": "traction",
    "track": "tracks",
    "adhesion": "adhesion",
    "slide_protection": "slide_protection",
}


def errors(kind, text):
    """What the schema says of a file, as text."""
    folder = CONFIG / "schema"
    schema = json.loads((folder / f"{kind}.schema.json").read_text())
    resolver = jsonschema.RefResolver(f"{folder.as_uri()}/{kind}.schema.json", schema)
    validator = jsonschema.Draft7Validator(schema, resolver=resolver)
    return [
        f"{'.'.join(map(str, error.absolute_path))}: {error.message}"
        for error in validator.iter_errors(yaml.load(text, Yaml12))
    ]


def text_of(kind, name):
    return (CONFIG / KINDS[kind] / f"{name}.yaml").read_text()


class Reference(unittest.TestCase):
    def setUp(self):
        os.environ["TRAIN_BRAKE_CONFIG"] = str(CONFIG)

    def test_every_key_that_a_header_lists_has_its_place(self):
        text = keys()
        shown = set(re.findall(r"^[\w\[\].]*?(\w+)(?:  \[|$)", text, re.M))
        listed = {}
        for header in (ROOT / "src/train_dynamics/include").rglob("*.h"):
            for key in re.findall(r'\bv\.(?!Check)[A-Z]\w+\("(\w+)"', header.read_text()):
                listed.setdefault(key, header.name)
        self.assertGreater(len(listed), 250)
        # Of recorded runs' old form, and the brake's own list, which are read through others.
        self.assertEqual({key: name for key, name in listed.items() if key not in shown}, {})

    def test_page_and_schemas_are_fresh(self):
        page = (ROOT / "docs/configuration.md").read_text()
        self.assertEqual(keys("--markdown"), page, f"docs/configuration.md is stale; {RENEW}")
        folders = set(re.findall(r"^Files in `(\w+)/`", page, re.M))
        kinds = keys("--kinds").split()
        self.assertLessEqual(set(KINDS.values()), folders)
        self.assertEqual(
            sorted(f"{kind}.schema.json" for kind in kinds),
            sorted(path.name for path in (CONFIG / "schema").iterdir()),
            RENEW,
        )
        for kind in kinds:
            self.assertEqual(
                keys("--json-schema", kind),
                (CONFIG / "schema" / f"{kind}.schema.json").read_text(),
                f"config/schema/{kind}.schema.json is stale; {RENEW}",
            )

    def test_every_value_has_a_default_or_an_example(self):
        rows = re.findall(r"^\| `([^`]+)` \| (.*?) \| (.*?) \| (.*?) \| (.*) \| (.*?) \|$", keys("--markdown"), re.M)
        self.assertGreater(len(rows), 500)
        without = [
            key
            for key, unit, value, default, meaning, example in rows
            if not example and not default.startswith("`") and "map" not in value
        ]
        self.assertEqual(without, [])

    def test_a_path_is_that_of_a_file_of_a_setting_or_its_end(self):
        whole = keys("coupler.draft_gear.slack_m")
        self.assertIn("coupler.draft_gear.slack_m  [m]\n    total free play of the connection\n", whole)
        self.assertIn(">= 0; must be given", whole)
        self.assertIn("example: ", whole)
        self.assertEqual(keys("train.connection.draft_gear.slack_m"), whole)
        self.assertEqual(keys("scenario.train.connection.draft_gear.slack_m"), whole)
        self.assertIn(whole, keys("slack_m"))
        self.assertIn("coupler.table.slack_m", keys("slack_m"))
        self.assertEqual(keys("train.consist[3].vehicle.brake_rigging.shoes"), keys("vehicle.brake_rigging.shoes"))
        self.assertIn("only with law table", keys("vehicle.curving_resistance.table"))
        self.assertIn("default 8", keys("vehicle.brake_rigging.shoes"))

    def test_a_path_that_names_nothing_is_refused_with_the_nearest_key(self):
        done = train_sim("keys", "vehicle.brake_riging")
        self.assertEqual(done.returncode, 2)
        self.assertIn("vehicle.brake_riging names no key; did you mean brake_rigging?", done.stderr)
        self.assertEqual(train_sim("keys", "--json-schema", "wagon").returncode, 2)


class Schema(unittest.TestCase):
    def test_takes_every_shipped_file(self):
        files = 0
        for kind, folder in KINDS.items():
            for file in sorted((CONFIG / folder).glob("*.yaml")):
                self.assertEqual(errors(kind, file.read_text()), [], file)
                files += 1
        self.assertGreater(files, 80)

    def test_editors_find_the_schema_of_every_shipped_file(self):
        settings = json.loads((ROOT / ".vscode" / "settings.json").read_text())["yaml.schemas"]
        for kind, folder in KINDS.items():
            self.assertEqual(settings.get(f"./config/schema/{kind}.schema.json"), f"**/{folder}/*.yaml")
        for schema in settings:
            self.assertTrue((ROOT / schema).exists(), schema)

    def test_refuses_what_the_reader_refuses(self):
        # File, what is changed, what it becomes; a word of the reader's complaint.
        cases = [
            ("adhesion", "wet", r"friction_coefficient", "friction_coeficient", "friction_coefficient"),
            ("adhesion", "wet", r"friction_coefficient: [\d.]+", "friction_coefficient: 1.5", "(0, 1]"),
            ("adhesion", "wet", r"friction_coefficient: [\d.]+", "friction_coefficient: '0.1'", "quotes"),
            ("adhesion", "wet", r"friction_coefficient: [\d.]+", "friction_coefficient: 0.1 ", None),
            ("vehicle", "ore_wagon", r"length_m: .*", "length_m: [10]", "number"),
            ("vehicle", "ore_wagon", r"\blength_m: .*", "", "missing"),
            ("vehicle", "ore_wagon", r"\blength_m:", "length_mm:", "length_m"),
            ("vehicle", "ore_wagon", r"(?m)^brake_rigging:\n", "brake_rigging:\n  shoes: 2.5\n", "whole"),
            ("vehicle", "ore_wagon", r"(?m)^brake_rigging:\n", "brake_rigging:\n  shoes: 2\n", None),
            ("vehicle", "ore_wagon", r"(?m)^brake_rigging:\n", "brake_rigging:\n  shoe_load: per_cylinder\n", "one of"),
            ("vehicle", "ore_wagon", r"(?m)^brake_rigging:\n", "brake_rigging:\n  cut_out: yes\n", "true or false"),
            ("vehicle", "ore_wagon", r"\A", "axles: 4\n", "known"),  # of a vehicle that is one mass
            ("scenario", "dip", r"model: .*", "model: 3d", "one of"),
            ("scenario", "dip", r"duration_s: .*", "duration_s: 0", "(0, 1000000)"),
            ("scenario", "dip", r"\A", "until: {standing: true, speed: 3}\n", "known"),
            ("scenario", "emergency", r"kind: emergency", "kind: emergency, notch: 3", "known"),
            ("scenario", "emergency", r"kind: emergency", "kind: apply", "missing"),
        ]
        for kind, name, pattern, becomes, complaint in cases:
            with self.subTest(file=name, becomes=becomes), tempfile.TemporaryDirectory() as folder:
                text, count = re.subn(pattern, becomes, text_of(kind, name), count=1)
                self.assertEqual(count, 1)
                found = errors(kind, text)
                self.assertEqual(found == [], complaint is None, found)
                if TRAIN_SIM_READS:
                    self.assertEqual(self.complaint_of_the_reader(kind, text, folder) == "", complaint is None)
                    if complaint:
                        self.assertIn(complaint, self.complaint_of_the_reader(kind, text, folder))

    @staticmethod
    def complaint_of_the_reader(kind, text, folder):
        file = pathlib.Path(folder) / KINDS[kind] / "mine.yaml"
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        os.environ["TRAIN_BRAKE_CONFIG"] = str(CONFIG)
        if kind == "adhesion":
            done = train_sim("adhesion", CONFIG / "vehicles/ore_wagon.yaml", "--set", f"wheel_rail.adhesion={file}")
        elif kind == "vehicle":
            done = train_sim("modes", file)
        else:
            done = train_sim("resolve", file)
        return done.stderr if done.returncode == 2 else ""


def leaves(value, path=""):
    """The paths of a summary's numbers as the page names them: a.b within a map, a[].b in a list of maps."""
    if isinstance(value, dict):
        return {leaf for key, below in value.items() for leaf in leaves(below, f"{path}.{key}" if path else key)}
    if isinstance(value, list):
        return {leaf for below in value for leaf in leaves(below, f"{path}[]")}
    return {path}


class ResultFiles(unittest.TestCase):
    """What runs of several kinds leave, against the page."""

    RUNS = (
        ("lock_order", "duration_s=30", "detail_vehicles=[1]"),
        ("mixed_g_p", "duration_s=1"),
        ("drive_and_stop", "duration_s=150", "record_interval_s=1", "--twin"),
        ("single_wagon_stop", "duration_s=0.1"),
    )

    @classmethod
    def setUpClass(cls):
        os.environ["TRAIN_BRAKE_CONFIG"] = str(CONFIG)
        cls.page = keys("--results")
        tables = re.findall(r"^### (\S+)\n\nWritten .+\n\n\| column .*\n.*\n((?:\|.*\n)+)", cls.page, re.M)
        cls.tables = {
            file: re.findall(r"`(.*?)`", "".join(re.findall(r"^\| (.*?) \|", rows, re.M))) for file, rows in tables
        }
        cls.fields = set(re.findall(r"^\| `(\S+)` \|", cls.page.split("## summary.json")[1], re.M))
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folders = []
        for number, (scenario, *changes) in enumerate(cls.RUNS):
            folder = pathlib.Path(cls.temporary.name) / str(number)
            arguments = [a for change in changes for a in ([change] if change.startswith("--") else ["--set", change])]
            done = train_sim("run", CONFIG / f"scenarios/{scenario}.yaml", *arguments, "--csv", "--out", folder)
            assert done.returncode == 0, done.stderr
            cls.folders.append(folder)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_page_is_fresh(self):
        self.assertEqual(
            self.page, (ROOT / "docs/result_files.md").read_text(), f"docs/result_files.md is stale; {RENEW}"
        )

    def test_every_table_has_the_columns_of_the_page_and_every_file_is_on_it(self):
        self.assertGreater(len(self.tables), 9)
        files = set(re.findall(r"^\| `(\S+)` \|", self.page.split("## Tables")[0], re.M))
        seen = set()
        for folder in self.folders:
            for file in folder.iterdir():
                name = re.sub(r"^wagon_\d+", "wagon_NNN", file.name)
                if name in files:
                    continue
                self.assertIn(name, self.tables, folder)
                seen.add(name)
                header = file.read_text().split("\n")[0].split(",")
                expected = self.tables[name]
                if "vehicle_1" in "".join(expected):
                    vehicles = json.loads((folder / "summary.json").read_text())["vehicles"]
                    expected = ["time_s"] + [expected[1].replace("1", str(i)) for i in range(1, vehicles + 1)]
                self.assertEqual(header, expected, f"{folder}/{name}")
        self.assertEqual(seen, set(self.tables))

    def test_every_number_of_the_summary_is_on_the_page_and_the_other_way_round(self):
        seen = set()
        for folder in self.folders:
            for leaf in leaves(json.loads((folder / "summary.json").read_text())):
                named = leaf if leaf in self.fields else re.sub(r"\.\w+$", ".*", leaf)
                if named in ("twin", "max_tension_n", "max_compression_n"):  # null
                    continue
                self.assertIn(named, self.fields, folder)
                seen.add(named)
        others = {
            field for field in self.fields if re.match(r"external|partings\[\]", field)
        }  # of trains that are not run here
        self.assertEqual(seen, self.fields - others)


class KeysTest(Reference, Schema, ResultFiles):
    pass


TRAIN_SIM_READS = not os.environ.get("KEYS_TEST_SCHEMA_ONLY")

if __name__ == "__main__":
    rosunit.unitrun("train_sim", "keys_test", KeysTest)
