#!/usr/bin/python3
"""The report as its users meet it: bags from train_sim, ltd_master and rosbag record; whole, lacking and damaged."""
import contextlib
import functools
import html
import io
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest
from unittest import mock

import matplotlib.text
import numpy
import rosbag
import rosunit

import train_brake
import train_brake.run_files
from train_brake import Table
from train_brake import bag as bag_reader
from train_brake_report import cards, command, consist, figure, paper, series, slides, style, wave
from train_brake_report.figures import changes, route, space_time
from train_brake_report.group import Group
from train_brake_report.run import Run, label_runs
from train_brake_report.track import Track

HERE = pathlib.Path(__file__).resolve().parent
CONFIG = HERE.parent / "config"
FOLDER = tempfile.TemporaryDirectory()


@functools.lru_cache(maxsize=None)
def simulated(name, scenario, *arguments):
    """The folder of a run of train_sim, made once."""
    folder = pathlib.Path(FOLDER.name) / name
    subprocess.run(
        [
            "rosrun",
            "train_sim",
            "train_sim",
            "run",
            str(CONFIG / "scenarios" / f"{scenario}.yaml"),
            "--out",
            str(folder),
            *arguments,
        ],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    return folder


def two_d():
    return simulated("two_d", "emergency", "--set", "duration_s=10")


def ltd():
    return simulated("ltd", "emergency", "--model", "ltd", "--set", "duration_s=10")


def six_wagons():
    return simulated("six_wagons", "../../test/short_train")


def rewritten(bag, out, change):
    """A bag of the messages (topic, raw, time) that change returns for each of the old one's; None drops it."""
    with rosbag.Bag(str(bag)) as old, rosbag.Bag(str(out), "w") as new:
        for topic, raw, stamp in old.read_messages(raw=True):
            message = change(topic, raw, stamp)
            if message is not None:
                new.write(*message, raw=True)
    return out


def group_of(*folders):
    runs = [Run(folder, None) for folder in folders]
    label_runs(runs)
    return Group("", runs, 100, None)


class Page:
    """What a browser would make of the page's text."""

    def __init__(self, path):
        self.text = path.read_text()
        self.figures = {
            name: html.unescape(content)
            for name, content in re.findall(r'<figure id="([^"]+)">(.*?)</figure>', self.text, flags=re.DOTALL)
        }
        self.left_out = {
            title: html.unescape(reason) for title, reason in re.findall(r"<li><b>(.*?)</b>: (.*?)</li>", self.text)
        }
        self.numbers = [
            dict(re.findall(r'data-key="([^"]+)" data-value="([^"]+)"', card))
            for card in re.findall(r'<article class="card">(.*?)</article>', self.text, flags=re.DOTALL)
        ]

    def caption(self, name):
        return re.search(r"<figcaption>(.*?)</figcaption>", self.figures[name], flags=re.DOTALL).group(1)


class ReportTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.here = pathlib.Path(self.folder.name)

    def report(self, *arguments, code=0):
        """(page or None, what it printed)"""
        out = self.here / "report.html"
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
            self.assertEqual(code, command.main([*map(str, arguments), "--out", str(out)]), printed.getvalue())
        return Page(out) if code == 0 else None, printed.getvalue()

    def page(self, *arguments):
        return self.report(*arguments)[0]

    # Names and files of users

    def copy(self, name, of=None):
        """A copy of a run's folder under a name of its own."""
        folder = self.here / name
        shutil.copytree(of or six_wagons(), folder)
        return folder

    def test_any_name_stands_in_legends_as_it_is_written(self):
        names = ["_beginsso", r"$x_1$ cost\$5", "50% #3", "a\x1b[31mb\u202ec", "two\nlines"]
        group = group_of(*(self.copy(name) for name in names))
        self.assertEqual(
            ["\u200b_beginsso", r"$x_1$ cost\$5", "50% #3", "a?[31mb?c", "two lines"], [r.label for r in group.runs]
        )
        page, printed = self.report(*(self.here / name for name in names))
        speeds = re.findall(r"<text[^>]*>([^<]*)</text>", page.figures["speeds"])
        for run in group.runs:  # whole, and not as a formula, whose characters stand one by one
            self.assertIn(run.label, speeds)
        self.assertEqual([], [c for c in page.text + printed if ord(c) < 32 and c not in "\n\t" or c == "\u202e"])

    def test_numbers_of_logarithmic_axes_need_no_formula(self):
        axis = mock.Mock()
        style.powers_of_ten(axis)
        power = axis.set_major_formatter.call_args[0][0]
        self.assertEqual(
            ["10\u207b\u00b3", "10\u2070", "10\u00b9\u2075", "5", "0.02"],
            [power(x, 0) for x in (1e-3, 1.0, 1e15, 5.0, 0.02)],
        )

    def test_different_names_have_different_anchors(self):
        self.assertEqual(
            {"a b": "a_b", "a-b": "a_b_2", "A_B": "a_b_3", "": "runs", "$": "runs_2"},
            command.anchors_of(["a b", "a-b", "A_B", "", "$"]),
        )

    def test_files_of_other_programs_are_told(self):
        for name, text, complaint in (
            ("summary.json", '{"a": 1}', "summary.json is not the summary of a run: scenario is missing"),
            ("summary.json", "[1]", "summary.json is damaged: it is no list of keys"),
            ("slides.csv", "x,y\n1,2\n", "slides.csv is damaged: it has no column vehicle, "),
            ("track_wear.csv", "from_m,creep_j\n1,2\n", "damaged: it has no column brake_j"),
            ("couplers.csv", "x,y\n1,2\n", "couplers.csv is damaged: "),
        ):
            folder = self.copy(f"foreign {name} {text[:4]}")
            (folder / name).write_text(text)
            _, printed = self.report(folder, code=1)
            self.assertIn(complaint, printed)
            self.assertNotIn("Traceback", printed)

    def test_each_number_of_a_summary_must_be_one(self):
        summary = json.loads((six_wagons() / "summary.json").read_text())
        good = train_brake.run_files.checked(summary, train_brake.run_files.SUMMARY, pathlib.Path("x"), "y")
        self.assertEqual(summary, good)
        for change, complaint in (
            ({"simulated_s": "5"}, "simulated_s is '5'"),
            ({"vehicles": True}, "vehicles is True"),
            ({"energy": []}, "energy is not a map"),
            ({"stops": [{"time_s": 1}]}, "stops[0].distance_m is missing"),
            ({"max_tension_n": {"value": None}}, "max_tension_n.value is missing (and 2 more)"),
        ):
            with self.assertRaisesRegex(train_brake.BagError, re.escape(complaint)):
                train_brake.run_files.checked(
                    {**summary, **change}, train_brake.run_files.SUMMARY, pathlib.Path("x"), "y"
                )

    def test_a_summary_of_something_else_is_not_of_a_bag_with_a_name_of_its_own(self):
        folder = self.copy("mine")
        (folder / "train.bag").rename(folder / "measured.bag")
        (folder / "summary.json").write_text('{"a": 1}')
        self.assertEqual("0.2", self.page(folder / "measured.bag").numbers[0]["simulated_s"][:3])

    def test_what_is_no_file_is_not_waited_for(self):
        for name in ("train.bag", "summary.json", "couplers.csv", "slides.csv", "track_wear.csv"):
            folder = self.copy(f"pipe {name}")
            (folder / name).unlink(missing_ok=True)
            os.mkfifo(folder / name)
            self.assertIn("no file", self.report(folder, code=1)[1], name)

    def test_a_deep_summary_is_told(self):
        folder = self.copy("deep")
        (folder / "summary.json").write_text("[" * 100000)
        self.assertIn("summary.json is damaged: maximum recursion depth", self.report(folder, code=1)[1])

    def test_a_full_output_does_not_deny_the_page(self):
        out = self.here / "page.html"
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                ["rosrun", "train_brake", "report", str(six_wagons()), "--out", str(out)],
                stdout=full,
                stderr=subprocess.PIPE,
                text=True,
                # Python writes its buffer once more at its end, unless it has none.
                env={name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"},
            )
        self.assertEqual((0, True), (done.returncode, out.exists()), done.stderr)
        self.assertEqual("", done.stderr)

    def test_a_page_needs_no_locale(self):
        folder = self.copy("Z\u00fcge")
        done = subprocess.run(
            ["rosrun", "train_brake", "report", str(folder)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env={
                **os.environ,
                "LC_ALL": "C",
                "PYTHONUTF8": "0",
                "PYTHONCOERCECLOCALE": "0",
                "PYTHONIOENCODING": "ascii",
            },
        )
        self.assertEqual(0, done.returncode, done.stdout)

    # What the page says

    def test_numbers_are_those_of_the_summary(self):
        page = self.page(two_d())
        summary = json.loads((two_d() / "summary.json").read_text())
        for key in (
            "vehicles",
            "simulated_s",
            "final_speed_kmh.mean",
            "max_tension_n.value",
            "max_compression_n.value",
            "energy.residual_j",
            "real_time_factor",
        ):
            expected = summary
            for part in key.split("."):
                expected = expected[part]
            self.assertEqual(expected, float(page.numbers[0][key]), key)
        self.assertIn(summary["state_digest"], page.text)
        self.assertIn(f"version {summary['version']}", page.text)
        self.assertIn(f"train_sim run {two_d()}/config.yaml", page.text)
        _, *configuration = (two_d() / "config.yaml").read_text().splitlines()  # without the mark of a run's folder
        self.assertEqual(
            configuration, html.unescape(re.search("<pre>(.*?)</pre>", page.text, re.DOTALL).group(1)).splitlines()
        )

    def test_numbers_of_a_bag_alone(self):
        """Without summary.json the same numbers come from the records."""
        run = Run(pathlib.Path(shutil.copy(two_d() / "train.bag", self.here / "alone.bag")), None)
        self.assertTrue(run.complete)  # the bag holds the scenario, hence its duration
        numbers = {fact.key: fact.value for fact in cards.facts_of(run)}
        summary = json.loads((two_d() / "summary.json").read_text())
        # Equal masses; summary.json has ten digits.
        self.assertAlmostEqual(summary["final_speed_kmh"]["mean"], numbers["final_speed_kmh.mean"], places=7)
        for key in ("max_tension_n", "max_compression_n"):
            of_records, of_exchanges = abs(numbers[key + ".value"]), abs(summary[key]["value"])
            # Records see every tenth exchange: never more, and in a smooth run hardly less.
            self.assertLessEqual(of_records, of_exchanges * (1 + 1e-6))
            self.assertGreater(of_records, 0.99 * of_exchanges)
        of_all, of_bag = "Of all exchanges (couplers.csv)", "Of the records of the bag."
        self.assertIn(of_bag, self.page(self.here / "alone.bag").text)
        whole = self.page(two_d()).text
        self.assertIn(of_all, whole)
        self.assertNotIn(of_bag, whole)

    def test_a_bag_without_its_scenario(self):
        def without(topic, *rest):
            return None if topic == "/train/scenario" else (topic, *rest)

        bag = rewritten(six_wagons() / "train.bag", self.here / "alone.bag", without)
        page = self.page(bag)
        self.assertIn("unknown: a bag alone does not tell", page.text)
        self.assertIn("The configuration is not known", page.text)
        self.assertIn("speeds", page.figures)
        shutil.copy(six_wagons() / "config.yaml", self.here)
        shutil.copy(six_wagons() / "summary.json", self.here)  # with the digest of this run
        self.assertEqual("short_train", Run(bag, None).config["name"])
        (self.here / "summary.json").write_text('{"state_digest": "0000000000000000"}')
        self.assertIsNone(Run(bag, None).config)
        (self.here / "summary.json").write_text("{")
        self.assertIsNone(Run(bag, None).config)  # it may be of something else; of train.bag it is
        shutil.copy(bag, self.here / "train.bag")
        self.assert_refused(self.here / "train.bag", "summary.json is damaged: ")

    def test_everything_there_is_to_see_of_a_2d_train(self):
        page = self.page(two_d(), "--figures", self.here / "figures")
        names = [
            "speeds",
            "over_the_distance",
            "engineering_numbers",
            "consist",
            "pressures",
            "brake_table",
            "shoe_and_wheel_100",
            "largest_coupler_forces",
            "coupler_105",
            "coupler_force_picture",
            "pressure_picture",
            "brake_wave",
            "slip_picture",
            "track_wear",
            "acceleration_picture",
            "energy",
        ]
        self.assertEqual(names, list(page.figures))  # in this order
        self.assertEqual(
            {"Brake pipe, whole train", "Air in the brake", "Wheels that slide", "A wagon over the dip"},
            set(page.left_out),
        )
        self.assertEqual("The track has no dip.", page.left_out["A wagon over the dip"])
        tables = {"engineering_numbers", "consist"}
        for name in (name for name in names if name not in tables):
            self.assertIn("<svg", page.figures[name])
            self.assertGreater((self.here / "figures" / f"{name}.png").stat().st_size, 10000)
            self.assertIn("<svg", (self.here / "figures" / f"{name}.svg").read_text())
        self.assertIn("No wheel slid", page.caption("slip_picture"))

    def test_two_runs_are_overlaid_and_subtracted(self):
        page = self.page(ltd(), two_d())
        difference = "2D train \u2212 LTD"
        for name in (
            "speeds",
            "largest_coupler_forces",
            "coupler_105",
            "coupler_force_picture",
            "acceleration_picture",
        ):
            self.assertIn(difference, page.figures[name], name)
        self.assertIn("2D train has the same", page.caption("pressures"))
        of_runs = [
            json.loads((folder / "summary.json").read_text())["final_speed_kmh"]["mean"] for folder in (ltd(), two_d())
        ]
        self.assertIn(
            f"{difference}: {figure.minus(f'{of_runs[1] - of_runs[0]:+.4f}')} km/h at the last common instant",
            page.caption("speeds"),
        )

    def test_what_differs_is_a_table_of_the_changed_keys(self):
        slower = simulated(
            "slower",
            "emergency",
            "--model",
            "ltd",
            "--set",
            "duration_s=10",
            "--set",
            "initial_speed_kmh=60",
            "--set",
            "commands[0].time_s=3",
        )
        table = changes.table(group_of(ltd(), slower)).table
        self.assertEqual([["commands[0].time_s", "2", "3"], ["initial_speed_kmh", "80", "60"]], sorted(table.rows))
        self.assertIsNone(changes.table(group_of(ltd(), ltd())).table)

    def test_each_runs_own_commands_are_marked_by_its_name_beyond_the_curves(self):
        later = simulated(
            "later", "emergency", "--model", "ltd", "--set", "duration_s=10", "--set", "commands[0].time_s=3"
        )
        group = group_of(ltd(), later)
        self.assertEqual([(2, "ltd"), (3, "later")], [(command["time_s"], who) for command, _, who in group.commands()])
        for scale, at_bottom in (("linear", False), ("linear", True), ("log", False), ("log", True)):
            with self.subTest(scale=scale, at_bottom=at_bottom), style.applied():
                axes = figure.new_canvas(4.0).subplots()
                axes.plot([0, 10], [1, 1e6])
                axes.set_yscale(scale)
                axes.set_xlim(0, 10)
                style.mark_commands(axes, group.commands(), at_bottom=at_bottom)
                names = [text for text in axes.texts if "emergency" in text.get_text()]
                axes.figure.draw_without_rendering()
                bottom, top = axes.transData.transform([(0, 1), (0, 1e6)])[:, 1]  # of the curve
                boxes = [text.get_window_extent() for text in names]
                self.assertEqual(2, len(boxes))
                self.assertTrue(all(box.y1 <= bottom if at_bottom else box.y0 >= top for box in boxes))
                self.assertFalse(boxes[0].overlaps(boxes[1]))

    def test_names_at_the_ends_of_lines_stay_beside_their_panel_and_apart(self):
        with style.applied():
            axes = figure.new_canvas(4.0).subplots()
            axes.semilogy([0, 1], [1, 1e6])
            ends = [(10.0**k, f"line {k}", style.INK) for k in (0.0, 0.1, 5.8, 5.9, 6.0)]
            axes.set_ylim(1, 1e6)
            style.label_ends(axes, ends)
            axes.figure.draw_without_rendering()
            boxes = sorted(
                (matplotlib.text.Text.get_window_extent(text) for text in axes.texts), key=lambda box: box.y0
            )
            panel = axes.get_window_extent()
            middles = [(box.y0 + box.y1) / 2 for box in boxes]
            self.assertEqual(5, len(boxes))
            self.assertLessEqual(middles[-1], panel.y1 + 1e-6)
            self.assertTrue(all(below.y1 <= above.y0 + 0.5 for below, above in zip(boxes, boxes[1:])))
            self.assertTrue(all(box.x0 > panel.x1 for box in boxes))

    def test_runs_of_unlike_trains_are_not_subtracted(self):
        page = self.page(ltd(), six_wagons())
        self.assertNotIn("\u2212 LTD", page.caption("speeds"))
        self.assertEqual(2, len(page.numbers))

    def test_pictures_reach_as_far_as_the_longest_run(self):
        group = group_of(simulated("short", "emergency", "--model", "ltd", "--set", "duration_s=4"), two_d())
        for panel in space_time.draw_acceleration(group).canvas.axes[:2]:
            self.assertEqual((0.0, 10.0), tuple(numpy.round(panel.get_xlim(), 1)))

    def test_runs_that_share_no_instant_are_not_subtracted(self):
        early, late = (
            rewritten(
                two_d() / "train.bag",
                self.here / f"{name}.bag",
                lambda topic, raw, stamp: (topic, raw, stamp) if is_in(stamp.to_sec()) else None,
            )
            for name, is_in in (("early", lambda t: t < 4.995), ("late", lambda t: t > 4.995))
        )
        page = self.page(early, late)
        for name in ("speeds", "pressures", "coupler_105", "coupler_force_picture", "pressure_picture"):
            self.assertIn("No difference: late and early have no instant in common.", page.caption(name), name)
            self.assertNotIn("the same", page.caption(name))

    def test_runs_that_cannot_be_drawn_are_named_with_their_reason(self):
        page = self.page(simulated("dip", "dip"), ltd())
        for name in ("largest_coupler_forces", "coupler_105"):
            self.assertIn("Not shown: 2D train: a single vehicle has no coupler.", page.caption(name))
        self.assertIn(
            "Not shown: 2D train: a picture along the train needs more than one vehicle.",
            page.caption("acceleration_picture"),
        )
        self.assertIn(
            "Not shown: 2D train: a wave is seen on a train of four vehicles or more.", page.caption("brake_wave")
        )

    def test_a_train_at_rest(self):
        page = self.page(simulated("rest", "../../test/short_train", "--set", "initial_speed_kmh=0"))
        self.assertIn("The train stood all the time", page.left_out["Energy ledger"])

    def test_a_train_that_starts_has_its_energy_and_its_notches(self):
        run = simulated(
            "started",
            "drive_and_stop",
            "--set",
            "duration_s=200",
            "--set",
            "dt_s=0.002",
            "--set",
            "exchange_interval_s=0.002",
            "--set",
            "commands=[{time_s: 0, kind: throttle, notch: 8}, {time_s: 60, kind: throttle, notch: 3}, "
            "{time_s: 100, kind: friction, from_m: 9000, to_m: 9100, friction_coefficient: 0.2}, "
            "{time_s: 150, kind: throttle, notch: 0}]",
        )
        page = self.page(run)
        summary = json.loads((run / "summary.json").read_text())["energy"]
        told = page.caption("energy")
        self.assertIn(f"Traction added {1e-6 * summary['traction_work_j']:.0f} MJ", told)
        share = float(re.search(r"residual (\S+) of the energy turned over", told)[1].replace("\u2212", "-"))
        self.assertAlmostEqual(1.0, share / summary["residual_share"], delta=0.05)
        at = Run(run, None)
        of_time = dict(zip(at.recording.state.time_s.round(3), route.notches(at)))
        self.assertEqual([8, 8, 3, 3, 0], [of_time[t] for t in (0.0, 59.9, 60.0, 149.9, 150.0)])
        self.assertEqual(
            [(0, "throttle"), (60, "throttle"), (100, "friction"), (150, "throttle")],
            [(command["time_s"], command["kind"]) for command in at.commands],
        )

        # Percentiles and energy per tonne and km by the records themselves.
        table = dict(route.quantities(group_of(run)).table.rows)
        recorded = train_brake.load(run)
        state, forces = recorded["state"], recorded["in_train_forces"]["coupler_force_n"].ravel()
        tension = numpy.sort(numpy.where(forces > 0, forces, 0.0))[::-1]
        at_95 = float(
            re.search(r"95 %: (\d+) kN", table["in-train tension, percentiles of all records and connections"])[1]
        )
        self.assertAlmostEqual(1e-3 * tension[len(tension) // 20], at_95, delta=0.6)  # a twentieth of them are larger
        tonnes = 80.0 + 10 * 84.0  # a V 90, ten loaded Facs
        km = 1e-3 * (state["position_m"][-1].mean() - state["position_m"][0].mean())
        per_tkm = float(re.match(r"([\d.]+) kJ", table["work of traction per tonne and km"])[1])
        self.assertAlmostEqual(1e-3 * summary["traction_work_j"] / (tonnes * km), per_tkm, delta=0.051)

    def test_an_ltd_run_has_no_slip(self):
        page = self.page(ltd())
        self.assertEqual("The LTD models have no wheels that could slip.", page.left_out["Wheel slip, whole train"])
        self.assertIn("An LTD vehicle has no wheels", page.caption("shoe_and_wheel_100"))

    def test_tables_of_the_paper(self):
        run = simulated("paper", "emergency", "--model", "ltd")
        page = self.page(run)
        ours = json.loads((run / "summary.json").read_text())["final_speed_kmh"]["mean"]
        printed = paper.SPEED_KMH["ltd", "emergency"]
        self.assertRegex(
            page.figures["table_1"],
            rf"{printed:.2f}</td>.*{ours:.3f}</td>.*" + re.escape(figure.minus(f"{ours - printed:+.3f}")) + "</td>",
        )
        self.assertIn("table_2", page.figures)
        self.assertIn("Circles: the paper's values", page.caption("speeds"))
        self.assertNotIn("Not compared with the paper", page.text)
        self.assertNotIn("table_1", self.page(ltd()).figures)  # 10 s are not the paper's run

    def test_a_changed_run_is_not_the_papers(self):
        for change, reason in (
            ("initial_speed_kmh=60", "initial_speed_kmh is 60, there 80"),
            ("commands[0].kind=release", "commands[0].kind is release, there emergency"),
            ("track=down_half_percent", "track.name is down_half_percent, there level"),
        ):
            name = "changed_" + change.partition("=")[0].partition("[")[0]
            page = self.page(
                simulated(name, "emergency", "--model", "ltd", "--set", change, "--set", "exchange_interval_s=0.001")
            )
            self.assertIn(f"Not compared with the paper&#39;s emergency: {reason}.", page.text)
            self.assertNotIn("table_1", page.figures)
            self.assertNotIn("Circles", page.caption("speeds"))

    def test_groups_by_scenario(self):
        page = self.page(ltd(), two_d(), six_wagons(), "--by-scenario")
        self.assertEqual(1, list(page.figures).count("emergency_speeds"))
        self.assertIn("short_train_speeds", page.figures)

    # The brake wave, fitted from recorded pressures

    def assert_speed(self, expected_mps, fitted):
        # A straight line through the first 5 % of an exponential rise begins about a millisecond too early, within
        # 1 ms equally for all vehicles of a branch that the wave crosses in 5 s and more: 2e-4. Records are 10 ms
        # apart, but a vehicle's arrival is found from 20 of them, to 0.2 ms.
        self.assertAlmostEqual(expected_mps, fitted.speed_mps, delta=1e-3 * expected_mps)

    def test_wave_speed_is_the_configured_one(self):
        emergency = Run(ltd(), None)
        self.assert_speed(250.0, wave.application(emergency))
        self.assertEqual(250.0, wave.configured_speed_mps(emergency, False))
        self.assertEqual([1, 122, 242], [vehicle for vehicle, _ in wave.application(emergency).sources()])
        minimum = Run(
            simulated(
                "minimum", "minimum", "--model", "ltd", "--set", "commands[1].time_s=20", "--set", "duration_s=35"
            ),
            None,
        )
        self.assert_speed(150.0, wave.application(minimum))
        self.assert_speed(180.0, wave.release(minimum))
        self.assertEqual(
            (150.0, 180.0), (wave.configured_speed_mps(minimum, False), wave.configured_speed_mps(minimum, True))
        )

    def test_a_brake_without_a_table_has_no_configured_wave_speed(self):
        run = Run(ltd(), None)
        for kind in ("pneumatic", "of_a_later_version"):
            run.config["brake"] = {"name": "other", "kind": kind}
            self.assertIsNone(wave.configured_speed_mps(run, False), kind)

    def test_wave_speed_of_pressures_made_up(self):
        """Straight rises that begin at known times: the fit is then exact, but for the rounding of the pressures."""
        distance_m = 12.0 * numpy.arange(50)
        arrival_s = numpy.minimum(1.0 + distance_m / 333.0, 1.4 + (distance_m[-1] - distance_m) / 333.0)
        time_s = numpy.arange(0.0, 10.0, 0.01)
        pressure_pa = 5e4 * numpy.clip(time_s[:, None] - arrival_s, 0.0, None)
        fitted = wave.fit(time_s, pressure_pa, distance_m)
        self.assertAlmostEqual(333.0, fitted.speed_mps, places=6)
        self.assertEqual([1, 50], [vehicle for vehicle, _ in fitted.sources()])
        noise = numpy.random.default_rng(1).normal(0.0, 20.0, pressure_pa.shape)
        noisy = wave.fit(time_s, numpy.where(pressure_pa > 0.0, pressure_pa + noise, 0.0), distance_m)
        self.assertAlmostEqual(333.0, noisy.speed_mps, delta=5 * noisy.speed_error_mps)
        with self.assertRaises(figure.LeftOut):
            wave.fit(time_s, 0.0 * pressure_pa, distance_m)

    def test_a_wave_that_began_before_the_recording(self):
        def begun(at_s):
            run = Run(ltd(), None)
            for table in ("state", "pressures"):
                old = getattr(run.recording, table)
                setattr(run.recording, table, old.at(old.time_s > at_s))
            return run

        with self.assertRaisesRegex(figure.LeftOut, "242 of 242 vehicles had begun to move before the recording"):
            wave.application(begun(8.5))
        part = wave.application(begun(3.0))  # under way: what is still to come has the same speed
        self.assert_speed(250.0, part)
        self.assertEqual([122, 242], [vehicle for vehicle, _ in part.sources()])  # the first was not seen to begin
        self.assertTrue(numpy.isnan(part.arrival_s[0]))

    # Slides, the dip, a vehicle

    def test_no_pressures_are_drawn_where_no_brake_was_applied(self):
        page = self.page(simulated("impact", "impact"))
        self.assertIn("largest_coupler_forces", page.figures)
        self.assertFalse({"pressures", "pressure_picture"} & set(page.figures))
        self.assertEqual("No brake was applied.", page.left_out["Cylinder pressure, whole train"])

    def test_air_brake(self):
        parted = simulated("parted", "hose_parted", "--set", "duration_s=14")
        page = self.page(parted)
        self.assertLessEqual(
            {"pressure_picture", "pipe_pressure_picture", "air_brake", "brake_wave"}, set(page.figures)
        )
        self.assertNotIn("Charging", page.caption("air_brake"))
        found = wave.application(Run(parted, None))
        # A drop of 20 kPa travels at 268.1 m/s at most in a pipe that is 1.1 times as long as the train; vents of 6.35
        # mm and two cells per vehicle make it slower, by no more than a tenth.
        self.assertLess(found.speed_mps, 1.01 * 268.1 / 1.1)
        self.assertGreater(found.speed_mps, 0.9 * 268.1 / 1.1)
        self.assertLessEqual({vehicle for vehicle, _ in found.sources()}, {75, 76})
        charging = simulated("charging", "charging", "--set", "train.consist[1].count=9", "--set", "duration_s=200")
        table = train_brake.load(str(charging))["brake_pressures"]
        first, *_, last = table["pipe_pressure_pa"].T
        self.assertIn(
            f"after {table.time_s[last >= 0.95 * first.max()][0]:.1f} s", self.page(charging).caption("air_brake")
        )

    def test_wheel_slides(self):
        run = simulated(
            "slide",
            "single_wagon_stop",
            "--set",
            "duration_s=50",
            "--set",
            "train.consist[0].vehicle.brake_rigging.shoe_load_per_pressure_n_per_pa=0.8",
            "--set",
            "track={name: patch, friction_patches: [{from_m: 550, to_m: 580, friction_coefficient: 0.05}]}",
        )
        found = slides.find_slides(Run(run, None).recording.state)
        # docs/validation.md: wheels of this run are locked from 38.18 to 40.19 s; before, they slow down on the patch.
        self.assertEqual(1, len(found))
        self.assertTrue(found[0].locked)
        self.assertAlmostEqual(40.19, found[0].end_s, delta=0.1)
        self.assertLess(found[0].begin_s, 38.18)
        self.assertIn("1 on 1 vehicle(s), 1 of them with a locked wheel", self.page(run).caption("slip_picture"))

    def test_a_standing_train_does_not_slide(self):
        standing = Table(
            {"creepage": numpy.full((3, 1), 0.9), "speed_mps": numpy.array([[0.4], [5.0], [0.01]])},
            numpy.array([1.0, 2.0, 3.0]),
        )
        self.assertEqual([(2.0, 2.0)], [(s.begin_s, s.end_s) for s in slides.find_slides(standing)])

    def test_the_dip(self):
        page = self.page(simulated("dip", "dip"))
        caption = page.caption("dip")
        self.assertIn("±15.10", caption)  # H sin(2 pi l / L) / (2 l), docs/validation.md
        low, high = map(
            float, re.search(r"pitches by (-[\d.]+) \.\.\. \+([\d.]+) mrad", caption.replace("\u2212", "-")).groups()
        )
        self.assertAlmostEqual(15.10, -low, delta=0.2)
        self.assertAlmostEqual(15.10, high, delta=0.2)
        for title in ("Largest coupler forces along the train", "Brake wave", "Acceleration, whole train"):
            self.assertIn(title, page.left_out)

    def test_over_the_distance(self):
        run = simulated(
            "hills",
            "../../test/short_train",
            "--model",
            "ltd",
            "--set",
            "duration_s=90",
            "--set",
            "record_interval_s=0.1",
            "--set",
            "ledger_interval_s=1",
            "--set",
            "detail_vehicles=[]",
            "--set",
            "track={name: hills, heights: [{position_m: -100, height_m: 500}, {position_m: 100, height_m: 501}, "
            "{position_m: 300, height_m: 498}], curves: [{from_m: 50, to_m: 150, radius_m: -400}], "
            "speed_limits: [{from_m: -1000, limit_kmh: 90}, {from_m: 120, limit_kmh: 60}], "
            "stations: [{name: Halt & Ford, position_m: 200}]}",
        )
        page = self.page(run)
        self.assertIn("over_the_distance", page.figures)
        self.assertIn("Halt &amp; Ford", page.text)
        state = train_brake.load(run)["state"]
        # Above 60 km/h from when the front is at 120 m; LTD trains of equal wagons: the mean speed is that of the
        # momentum.
        front_m = state["position_m"][:, 0] + 0.5 * 10.5
        over = (front_m >= 120) & (3.6 * state["speed_mps"].mean(axis=1) > 60)
        self.assertGreater(over.sum(), 5)
        told_s = float(re.search(r"([\d.]+) s, by up to", page.text)[1])
        self.assertAlmostEqual(0.1 * over.sum(), told_s, delta=0.11)  # a record at either edge
        self.assertIn("2 to 5", page.text)  # the consist's second group
        stop = json.loads((run / "summary.json").read_text())["stops"][0]
        pressures = train_brake.load(run)["brake_pressures"]
        begin = numpy.argmax(pressures["cylinder_pressure_pa"].max(axis=1) > 1e3)
        way = numpy.interp([pressures.time_s[begin], stop["time_s"]], state.time_s, state["position_m"].mean(axis=1))
        self.assertIn(f"{way[1] - way[0]:.1f} m from the first pressure", page.text)

    def test_a_route_by_points_is_that_by_lists(self):
        lists = Track(
            {
                "grades": [{"from_m": 0, "grade_percent": 1}, {"from_m": 500, "grade_percent": -0.5}],
                "curves": [{"from_m": 250, "to_m": 500, "radius_m": -400}],
                "speed_limits": [{"from_m": 0, "limit_kmh": 80}, {"from_m": 750, "limit_kmh": 50}],
            }
        )
        points = Track(
            {
                "points": [
                    {"position_m": 0, "grade_permille": 10, "radius_m": 0, "speed_limit_kmh": 80},
                    {"position_m": 250, "radius_m": -400},
                    {"position_km": 0.5, "grade_percent": -0.5, "radius_m": 0},
                    {"position_m": 750, "speed_limit_kmh": 50, "station": "Zell"},
                ]
            }
        )
        at = numpy.arange(-300.0, 1200.0, 12.5)
        for one, other in (
            (lists.grades, points.grades),
            (lists.curvatures, points.curvatures),
            (lists.limits, points.limits),
        ):
            numpy.testing.assert_allclose(one.at(at), other.at(at), rtol=1e-14)
        for track in (lists, points):
            place, height = track.heights(-100.0, 1000.0)
            expected = numpy.interp([-100, 0, 500, 1000], place, height) - height[0]
            numpy.testing.assert_allclose(expected, [0, 1, 6, 3.5], atol=1e-12)
        numpy.testing.assert_array_equal(
            points.limits.lowest(numpy.array([0.0, 700.0, 800.0]), numpy.array([700.0, 760.0, 900.0])), [80, 50, 50]
        )
        heights = Track({"heights": [{"position_m": 0, "height_m": 7}, {"position_m": 100, "height_m": 9}]})
        numpy.testing.assert_allclose(
            heights.grades.at(numpy.array([-1.5, -0.5, 0.0, 99.0, 100.0])), [0, 0, 0.02, 0.02, 0]
        )
        place, height = heights.heights(50.0, 200.0)
        numpy.testing.assert_allclose([height[0], height[-1]], [8, 9])

    def test_masses_are_those_of_all_wheelsets_and_of_the_load(self):
        six_axles = {
            "carbody": {"mass_kg": 100.0},
            "bolster": {"mass_kg": 10.0},
            "wedge_mass_kg": 0.0,
            "bogie_frame": {"mass_kg": 20.0},
            "wheelset": {"mass_kg": 3.0},
            "wheelsets_per_bogie": 3,
        }
        self.assertEqual(100 + 2 * 10 + 2 * 20 + 6 * 3, consist.mass_kg(six_axles))

    def test_a_vehicle_without_a_run(self):
        page = self.page("--vehicle", CONFIG / "vehicles" / "ore_wagon.yaml")
        self.assertIn("paper 0.400, dry 0.375, wet 0.211, low 0.066", page.caption("adhesion"))  # docs/validation.md
        self.assertRegex(page.figures["modes"], r"<td>1</td><td>2\.0\d+</td>")  # bounce
        page = self.page("--vehicle", self.here / "none.yaml")
        self.assertIn("none.yaml", page.left_out["Adhesion characteristics"])

    # Bags of all origins

    def test_ltd_master_and_rosbag_record(self):
        """One launch gives both: the master's own bag, and one that was recorded beside it in part."""
        with socket.socket() as free:
            free.bind(("localhost", 0))
            port = free.getsockname()[1]
        environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{port}", "ROS_HOSTNAME": "localhost"}
        with contextlib.ExitStack() as stack:

            def start(*arguments):
                process = subprocess.Popen(
                    arguments, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
                stack.callback(process.wait, 60)
                stack.callback(process.send_signal, signal.SIGINT)
                return process

            def until(condition):
                end = time.monotonic() + 60
                while not condition():
                    self.assertLess(time.monotonic(), end)
                    time.sleep(0.1)

            def ask(*arguments):
                return subprocess.run(
                    arguments, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
                ).stdout

            start("roscore", "-p", str(port))
            until(lambda: "/rosout" in ask("rosnode", "list"))
            beside = self.here / "beside.bag"
            start("rosbag", "record", "-q", "-a", "-O", str(beside), "__name:=beside")
            launch = start(
                "roslaunch",
                "train_brake",
                "train.launch",
                f"scenario:={HERE}/short_train.yaml",
                "vehicles:=6",
                f"out:={self.here}/run",
                "nodes:=2",
                "start_paused:=true",
                "real_time_factor:=1",
                "set:=duration_s=2",
            )
            until(lambda: "/beside" in ask("rostopic", "info", "/train/state"))
            time.sleep(1.0)  # for the connection itself
            until(lambda: "True" in ask("rosservice", "call", "/train/master/resume"))
            self.assertEqual(0, launch.wait(60))
        until(beside.exists)  # the rosbag command ends before the recorder that it has started

        # Both together: of the same run, so nowhere different.
        page = self.page(self.here / "run", beside)
        of_master, recorded = page.numbers
        summary = json.loads((self.here / "run" / "summary.json").read_text())
        self.assertEqual(summary["final_speed_kmh"]["mean"], float(of_master["final_speed_kmh.mean"]))
        self.assertAlmostEqual(summary["final_speed_kmh"]["mean"], float(recorded["final_speed_kmh.mean"]), places=7)
        self.assertEqual(2.0, float(recorded["simulated_s"]))
        self.assertEqual(2, page.text.count("<dd>yes</dd>"))
        self.assertIn("+0.0000 km/h at the last common instant", page.caption("speeds"))
        self.assertEqual(
            {
                "Over the distance",
                "Brake pipe, whole train",
                "Air in the brake",
                "Wheels that slide",
                "A wagon over the dip",
            },
            set(page.left_out),
        )

    def test_another_namespace(self):
        bag = rewritten(
            six_wagons() / "train.bag",
            self.here / "moved.bag",
            lambda topic, raw, stamp: (topic.replace("/train/", "/line_7/freight/"), raw, stamp),
        )
        recording, expected = Run(bag, 4).recording, Run(six_wagons(), 4).recording
        for table in ("state", "forces", "pressures", "wagon"):
            old, new = getattr(expected, table), getattr(recording, table)
            self.assertEqual(old.fields, new.fields)
            for field in old.fields:
                numpy.testing.assert_array_equal(old[field], new[field], field)
        self.assertEqual((len(expected.ledger), expected.scenario), (len(recording.ledger), recording.scenario))

    # Bags that lack something

    def test_a_bag_that_lacks_topics(self):
        bag = rewritten(
            six_wagons() / "train.bag",
            self.here / "part.bag",
            lambda topic, *rest: (topic, *rest) if topic == "/train/brake_pressures" else None,
        )
        page = self.page(bag)
        self.assertEqual(["pressures", "pressure_picture"], list(page.figures))
        self.assertEqual("The recording has no topic of the type train_brake_msgs/TrainState.", page.left_out["Speed"])
        self.assertIn("InTrainForces", page.left_out["Largest coupler forces along the train"])
        self.assertIn("EnergyLedger", page.left_out["Energy ledger"])
        self.assertIn("no TrainState", page.left_out["Brake wave"])
        beside_a_whole_one = self.page(six_wagons(), bag)
        self.assertIn(
            "Not shown: LTD: the recording has no topic of the type train_brake_msgs/TrainState.",
            beside_a_whole_one.caption("speeds"),
        )

    def test_a_run_of_one_record(self):
        bag = rewritten(
            six_wagons() / "train.bag",
            self.here / "first.bag",
            lambda topic, raw, stamp: (topic, raw, stamp) if stamp.to_sec() < 0.001 else None,
        )
        self.assertIn("Energy ledger", self.page(bag).left_out)

    def test_a_vehicle_or_coupler_that_is_not_there(self):
        page, printed = self.report(six_wagons(), "--wagon", 7, "--coupler", 6)
        self.assertIn("warning: --wagon 7 is not shown: the train has 6", printed)
        self.assertIn("warning: --coupler 6 is not shown: the train has 5", printed)
        self.assertNotIn("warning", self.report(six_wagons(), "--wagon", 6, "--coupler", 5)[1])
        self.assertEqual("There is no wagon 7: the train has 6 vehicle(s).", page.left_out["Shoe and wheel"])
        self.assertEqual("There is no coupler 6: the train has 5.", page.left_out["Force of a coupler"])

    def test_an_interrupted_run_is_marked(self):
        out = self.here / "run"
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
                "duration_s=1e4",
                "--set",
                "record_interval_s=0.1",
                "--set",
                "ledger_interval_s=1",
            ],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        while not (out / "train.bag.active").exists():
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(130, process.wait(60))
        page = self.page(out)
        self.assertRegex(
            page.text, r"INCOMPLETE: the run ended at [\d.]+ s of 10000 s, stopped by its user or cut off\."
        )
        self.assertIn("<dd>no</dd>", page.text)
        # The process died instead: no summary, and the bag under its working name.
        (out / "summary.json").unlink()
        (out / "train.bag").rename(out / "train.bag.active")
        self.assertIn("INCOMPLETE", Run(out, None).notes[-1])

    def test_missing_records_are_counted(self):
        bag = rewritten(
            six_wagons() / "train.bag",
            self.here / "gap.bag",
            lambda topic, raw, stamp: None if 0.055 < stamp.to_sec() < 0.085 else (topic, raw, stamp),
        )
        run = Run(bag, None)
        self.assertEqual(
            [
                "3 records are missing from the bag, the first after 0.05 s.",
                "INCOMPLETE: only a part of the run was recorded.",
            ],
            run.notes,
        )
        self.assertFalse(run.complete)
        self.assertIn("of the recorded part", {fact.more for fact in cards.facts_of(run) if fact.name == "distance"})

    def test_a_bag_begun_late_is_a_part(self):
        def late(topic, raw, stamp):
            return (topic, raw, stamp) if stamp.to_sec() > 4.0 or "scenario" in topic else None

        run = Run(rewritten(two_d() / "train.bag", self.here / "late.bag", late), None)
        self.assertFalse(run.complete)
        self.assertIn("INCOMPLETE: only a part of the run was recorded.", run.notes)
        of_part = {fact.name: fact.more for fact in cards.facts_of(run) if "of the recorded part" in fact.more}
        self.assertEqual({"distance", "largest tension", "largest compression"}, set(of_part))

    def test_pictures_leave_missing_records_blank(self):
        """A column is a stretch of time, whatever is missing before it."""
        time_s = numpy.concatenate([numpy.arange(0.0, 2.0, 0.01), numpy.arange(8.0, 10.0, 0.01)])
        picture, begin_s, end_s = series.decimate(time_s, time_s[:, None] * [1.0, -1.0], 100)
        middle_s = begin_s + (numpy.arange(100) + 0.5) / 100 * (end_s - begin_s)
        known = numpy.isfinite(picture[0])
        self.assertTrue((known == ((middle_s < 2.0) | (middle_s > 7.98))).all())
        numpy.testing.assert_allclose(picture[0, known], middle_s[known], atol=0.06)  # half a column and an interval
        numpy.testing.assert_array_equal(-picture[0, known], picture[1, known])
        bag = rewritten(
            two_d() / "train.bag",
            self.here / "gap.bag",
            lambda topic, raw, stamp: None if 3.0 < stamp.to_sec() < 6.0 else (topic, raw, stamp),
        )
        self.assertIn("Grey: no records.", self.page(bag).caption("acceleration_picture"))
        self.assertNotIn("Grey", self.page(two_d()).caption("acceleration_picture"))

    # What cannot be read

    def assert_refused(self, path, *words):
        (self.here / "report.html").unlink(missing_ok=True)
        _, printed = self.report(path, code=1)
        self.assertFalse((self.here / "report.html").exists())
        for word in (str(path.parent), *words):
            self.assertIn(word, printed)
        self.assertNotIn("Traceback", printed)

    def test_damaged_bags(self):
        whole = (six_wagons() / "train.bag").read_bytes()
        cut = self.here / "cut.bag"
        cut.write_bytes(whole[: len(whole) // 2])
        self.assert_refused(cut, f"{cut} is damaged or was not closed", f"rosbag reindex {cut}")
        broken = self.here / "broken.bag"
        half = len(whole) // 2
        broken.write_bytes(whole[:half] + b"\xff" * 3000 + whole[half + 3000 :])
        self.assert_refused(broken, f"{broken} is damaged", f"rosbag reindex {broken}")
        empty = self.here / "empty.bag"
        empty.touch()
        self.assert_refused(empty, "empty.bag: it is empty", "Run again")
        self.assert_refused(self.here / "none.bag", "none.bag: there is no such file or folder")
        self.assert_refused(HERE / "short_train.yaml", "short_train.yaml: this is not a bag")
        for drop in (lambda *_: None, lambda topic, *rest: (topic, *rest) if "ledger" in topic else None):
            other = rewritten(six_wagons() / "train.bag", self.here / "other.bag", drop)
            self.assert_refused(other, "no records of a train")

    def test_a_bag_cannot_bring_a_program(self):
        """rosbag makes Python of the definitions in a bag; the report must not, whatever they are attached to."""
        sign = self.here / "ran"
        evil = f"int32 _type;open({str(sign)!r}, 'w');Y=1\n"
        for topic, kind in (("/train/state", "TrainState"), ("/train/scenario", "std_msgs/String"), ("/x", "x/X")):
            for md5sum in (None, "0" * 32):
                bag = self.here / "evil.bag"
                with rosbag.Bag(str(six_wagons() / "train.bag")) as old, rosbag.Bag(str(bag), "w") as new:
                    for name, raw, stamp, header in old.read_messages(raw=True, return_connection_header=True):
                        if name == topic or topic == "/x":
                            header = {**header, "message_definition": evil, "md5sum": md5sum or header["md5sum"]}
                            raw = (raw[0], raw[1], header["md5sum"], *raw[3:])
                        new.write(name, raw, stamp, raw=True, connection_header=header)
                self.assert_refused(
                    bag, "defines", kind if topic != "/x" else "train_brake_msgs/", "the version that wrote"
                )
                self.assertFalse(sign.exists())

    def test_a_zero_has_no_minus(self):
        self.assertEqual(
            ["0.000", "\u22120.001", "+0.0", "\u22122.5e\u221210", "0.0 kN"],
            list(map(figure.minus, ["-0.000", "-0.001", "+0.0", "-2.5e-10", "-0.0 kN"])),
        )

    def test_our_own_errors_are_not_called_damage(self):
        with mock.patch.object(bag_reader.BagFile, "_table", side_effect=ZeroDivisionError), self.assertRaises(
            ZeroDivisionError
        ):
            Run(six_wagons(), None)

    def test_rosbag_reindex_is_a_remedy(self):
        whole = (two_d() / "train.bag").read_bytes()
        cut = self.here / "cut.bag"
        cut.write_bytes(whole[: len(whole) // 2])
        subprocess.run(["rosbag", "reindex", "-q", str(cut)], check=True, stdout=subprocess.DEVNULL)
        self.assertGreater(len(Run(cut, None).recording.state), 100)

    def test_all_errors_are_named_at_once(self):
        _, printed = self.report(self.here / "a.bag", six_wagons(), self.here / "b.bag", code=1)
        self.assertIn("a.bag", printed)
        self.assertIn("b.bag", printed)

    def test_a_folder_of_runs(self):
        folder = six_wagons().parent
        self.assert_refused(folder, "holds no train.bag", "six_wagons")

    def test_more_than_one_run_or_train_in_a_bag(self):
        with rosbag.Bag(str(six_wagons() / "train.bag")) as bag:
            messages = [(topic, raw) for topic, raw, _ in bag.read_messages("/train/state", raw=True)]
        twice = self.here / "twice.bag"
        with rosbag.Bag(str(twice), "w") as bag:
            for i, (topic, raw) in enumerate(messages + messages):
                bag.write(topic, raw, rosbag.bag.genpy.Time(1 + i), raw=True)
        self.assert_refused(twice, "more than one run")
        two_trains = self.here / "two_trains.bag"
        with rosbag.Bag(str(two_trains), "w") as bag:
            for i, (topic, raw) in enumerate(messages + messages):
                bag.write(f"/train_{i % 2}/state", raw, rosbag.bag.genpy.Time(1 + i), raw=True)
        self.assert_refused(two_trains, "more than one train", "/train_0/state, /train_1/state", "rosbag filter")

    def test_wrong_arguments(self):
        for arguments in ([], [six_wagons(), "--wagon", "0"], [six_wagons(), "--wagn", "3"]):
            with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(io.StringIO()):
                command.main(list(map(str, arguments)))
            self.assertEqual(2, ended.exception.code)
        bag = six_wagons() / "train.bag"
        with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(io.StringIO()) as printed:
            command.main([str(bag), "--out", str(bag)])
        self.assertEqual(2, ended.exception.code)
        self.assertIn("must end in .html", printed.getvalue())

    def test_the_command(self):
        run = shutil.copytree(six_wagons(), self.here / "run")
        done = subprocess.run(
            ["rosrun", "train_brake", "report", str(run)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        self.assertIn(f"wrote {run}/report.html", done.stdout)
        self.assertTrue((run / "report.html").exists())
        # The next run into the folder takes it away: it would show another run.
        subprocess.run(
            ["rosrun", "train_sim", "train_sim", "run", str(HERE / "short_train.yaml"), "--out", str(run)],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.assertFalse((run / "report.html").exists())

    # In a browser

    def browse(self, page_text):
        """(the page after its scripts, what it wrote to the console) in headless Chromium."""
        page = self.here / "browse.html"
        page.write_text(page_text)
        done = subprocess.run(
            [
                "chromium",
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--enable-logging=stderr",
                f"--user-data-dir={self.here}/chromium",
                "--virtual-time-budget=5000",
                "--dump-dom",
                f"file://{page}",
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            timeout=120,
        )
        # What the browser's own pages (chrome://) say of the network is not of ours.
        return done.stdout, [
            line for line in done.stderr.splitlines() if ":CONSOLE" in line and "source: chrome://" not in line
        ]

    def test_the_page_in_a_browser(self):
        """No error, and no request: the page's content security policy makes an error of each."""
        text = self.page(ltd(), two_d()).text
        # Presses every button and writes down what would be saved.
        press = """<script>
          HTMLAnchorElement.prototype.click = function () {
            fetched.textContent += this.download + " ";
          };
          const fetched = document.body.appendChild(document.createElement("pre"));
          fetched.id = "fetched";
          for (const button of document.querySelectorAll("button")) button.click();
        </script></body>"""
        shown, console = self.browse(text.replace("</body>", press))
        self.assertEqual([], console)
        saved = re.search(r'<pre id="fetched">(.*?)</pre>', shown).group(1).split()
        names = re.findall(r'<figure id="([^"]+)">\s*<h3>[^<]*</h3>\s*<div class="scroll"><svg', text)
        self.assertEqual(sorted(f"{name}.{ending}" for name in names for ending in ("svg", "png")), sorted(saved))

        _, console = self.browse(text.replace("</body>", '<img src="http://localhost:9/a.png"></body>'))
        self.assertEqual(1, len(console), console)  # this test can fail


if __name__ == "__main__":
    os.environ.pop("TRAIN_BRAKE_CONFIG", None)
    rosunit.unitrun("train_brake", "report_test", ReportTest)
