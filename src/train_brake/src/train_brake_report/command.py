"""The command `report`: arguments, files, exit codes."""

import argparse
import datetime
import pathlib
import platform
import re
import sys
from typing import Dict, Iterable, List, Optional

import matplotlib
import numpy

from train_brake_report import cards, contents, page, paper, style
from train_brake.bag import BagError
from train_brake.presentable import accept_all_characters, presentable, tell
from train_brake_report.group import Group
from train_brake_report.run import Run, label_runs, scenario_of

DESCRIPTION = """Makes a page with figures of one or several runs of the train: one HTML file that needs no network.

RUN is the folder of a run, or a bag recorded by a run or by rosbag. Several runs are drawn over one another, with
differences to the first."""
EPILOG = "Exit codes: 0 done; 1 a run cannot be read, or the page cannot be written; 2 wrong arguments."


def _natural(text: str) -> int:
    try:
        number = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a whole number, got {text!r}") from None
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be >= 1, got {number}")
    return number


def _html_file(text: str) -> pathlib.Path:
    path = pathlib.Path(text)
    if path.suffix != ".html":
        raise argparse.ArgumentTypeError(f"must end in .html, got {text}")
    return path


def _arguments(argv: List[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        "report", description=DESCRIPTION, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("runs", nargs="*", metavar="RUN", type=pathlib.Path, help="folder of a run, or a bag")
    parser.add_argument(
        "--out",
        type=_html_file,
        metavar="FILE.html",
        help="the page; default: report.html in the run's folder, or here if there are several runs",
    )
    parser.add_argument(
        "--figures", type=pathlib.Path, metavar="FOLDER", help="write each figure there, too, as SVG and PNG"
    )
    parser.add_argument(
        "--wagon",
        type=_natural,
        metavar="N",
        help=f"vehicle whose shoe and wheel are shown (default {paper.WAGON}, or the last of a shorter train)",
    )
    parser.add_argument(
        "--coupler",
        type=_natural,
        metavar="N",
        help=f"connection whose force is shown (default {paper.COUPLER} on the paper's train, else the one "
        "with the largest force)",
    )
    parser.add_argument("--by-scenario", action="store_true", help="overlay only runs of the same scenario")
    parser.add_argument("--vehicle", metavar="FILE.yaml", help="show adhesion and modes of this vehicle, too")
    options = parser.parse_args(argv)
    if not options.runs and not options.vehicle:
        parser.error("nothing to report on: give a RUN (a folder or a bag), or --vehicle")
    return options


def _grouped(given: List[pathlib.Path], by_scenario: bool) -> Dict[str, List[pathlib.Path]]:
    if not by_scenario:
        return {"": given} if given else {}
    groups: Dict[str, List[pathlib.Path]] = {}
    for path in given:
        groups.setdefault(scenario_of(path), []).append(path)
    return groups


def _read(given: List[pathlib.Path], wagon: Optional[int]) -> List[Run]:
    """All of them, or one error that names all that is wrong."""
    runs, errors = [], []
    for path in given:
        try:
            runs.append(Run(path, wagon))
        except BagError as error:
            errors.append(str(error))
    if errors:
        raise BagError("\n".join(errors))
    label_runs(runs)
    return runs


def _anchor(text: str) -> str:
    return re.sub(r"\W+", "_", text).strip("_").lower() or "runs"


def anchors_of(names: Iterable[str]) -> Dict[str, str]:
    """A word for ids and names of files for each name; different ones for different names ("a b", "a-b")."""
    found: Dict[str, str] = {}
    for name in names:
        word, number = _anchor(name), 1
        while word in found.values():
            number += 1
            word = f"{_anchor(name)}_{number}"
        found[name] = word
    return found


class Report:
    """Collects the page group by group, so that only the runs of one group are in memory at a time."""

    def __init__(self, options: argparse.Namespace, train_sim: List[str]):
        self.options = options
        self.train_sim = train_sim
        self.cards: List[cards.Card] = []
        self.sections: List[page.Section] = []
        self.rows: List[cards.PaperRow] = []
        self.longest = 0  # [vehicles] of all trains

    def add_runs(self, name: str, anchor: str, given: List[pathlib.Path]) -> None:
        runs = _read(given, self.options.wagon)
        self.longest = max(self.longest, *(run.vehicles for run in runs))
        for run in runs:
            paper.judge(run, self.train_sim)
        group = Group(
            anchor if self.options.by_scenario else "",
            runs,
            self.options.wagon or min(paper.WAGON, runs[0].vehicles),
            self.options.coupler,
        )
        self.sections.append(page.Section(name or "Figures", f"section_{anchor}", contents.of_runs(group)))
        for run in runs:
            card = cards.card_of(run)
            card.label = f"{name}: {card.label}" if name else card.label
            self.cards.append(card)
            self.rows += filter(None, [cards.paper_row(run)])

    def warn_of_numbers(self) -> None:
        """An option that fits no train: the figure is left out, with the reason in its place."""
        for option, number, last in (
            ("--wagon", self.options.wagon, self.longest),
            ("--coupler", self.options.coupler, self.longest - 1),
        ):
            if number is not None and self.longest and number > last:
                print(f"report: warning: {option} {number} is not shown: the train has {last}", file=sys.stderr)

    def add_tables(self) -> None:
        if self.rows:
            self.sections.append(
                page.Section("Tables of the paper", "tables", [cards.table_1(self.rows), cards.table_2(self.rows)])
            )

    def add_vehicle(self) -> None:
        self.sections.append(
            page.Section("One vehicle", "vehicle", contents.of_vehicle(self.options.vehicle, self.train_sim))
        )

    def html(self) -> str:
        title = "Train braking: " + (
            self.cards[0].name
            if len(self.cards) == 1
            else f"{len(self.cards)} runs"
            if self.cards
            else pathlib.Path(self.options.vehicle).stem
        )
        made = (
            f"Made on {datetime.datetime.now():%Y-%m-%d %H:%M} by report of train_brake, with Python "
            f"{platform.python_version()}, NumPy {numpy.__version__}, Matplotlib {matplotlib.__version__}."
        )
        return page.render(title, self.cards, self.sections, made)


def _default_out(runs: List[pathlib.Path]) -> pathlib.Path:
    if len(runs) != 1:
        return pathlib.Path("report.html")
    return (runs[0] if runs[0].is_dir() else runs[0].parent) / "report.html"


def write_report(options: argparse.Namespace, train_sim: List[str]) -> pathlib.Path:
    out = options.out or _default_out(options.runs)
    with style.applied():
        report = Report(options, train_sim)
        groups = _grouped(options.runs, options.by_scenario)
        anchors = anchors_of(groups)
        for name, given in groups.items():
            report.add_runs(name, anchors[name], given)
        report.warn_of_numbers()
        report.add_tables()
        if options.vehicle:
            report.add_vehicle()
        html = report.html()
        if options.figures:
            options.figures.mkdir(parents=True, exist_ok=True)
            for section in report.sections:
                for figure in section.figures:
                    figure.save(options.figures)
    out.parent.mkdir(parents=True, exist_ok=True)
    unfinished = out.with_name(out.name + ".unfinished")
    unfinished.write_text(html, encoding="utf-8")
    unfinished.replace(out)
    return out


def main(argv: List[str], train_sim: List[str] = ("rosrun", "train_sim", "train_sim")) -> int:
    accept_all_characters()
    options = _arguments(argv)
    try:
        out = write_report(options, list(train_sim))
    except BagError as error:
        print("\n".join(f"report: {line}" for line in presentable(error).split("\n")), file=sys.stderr)
        return 1
    except OSError as error:
        print(presentable(f"report: the page could not be written: {error}"), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    tell(f"report: wrote {out}")
    return 0
