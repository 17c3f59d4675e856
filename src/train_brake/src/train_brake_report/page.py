"""Puts everything into one HTML file that needs nothing else: no network, no other file."""

import dataclasses
import pathlib
import re
from typing import List

import jinja2

from train_brake.presentable import presentable

from train_brake_report.cards import Card
from train_brake_report.contents import Item
from train_brake_report.figure import Figure, Table

HERE = pathlib.Path(__file__).resolve().parent


@dataclasses.dataclass
class Section:
    title: str
    anchor: str
    items: List[Item]

    @property
    def figures(self) -> List[Figure]:
        return [item for item in self.items if isinstance(item, Figure)]

    @property
    def left_out(self) -> list:
        """(title, reason)"""
        return [item for item in self.items if not isinstance(item, Figure)]


def _shown(value: object) -> object:
    """A value as text of the page. (Markup is our own.)"""
    return presentable(value) if isinstance(value, str) and not hasattr(value, "__html__") else value


def _is_of_numbers(table: Table, column: int) -> bool:
    """Whether a column is of numbers, hence aligned at the right: every cell of it that is not empty is one."""
    cells = [str(row[column]) for row in table.rows]
    return any(cells) and all(re.fullmatch(r"[-+\u2212]?[\d.]*", cell) for cell in cells)


def render(title: str, cards: List[Card], sections: List[Section], made: str) -> str:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(HERE)),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
        finalize=_shown,
    )
    environment.globals["is_of_numbers"] = _is_of_numbers
    return environment.get_template("page.html").render(title=title, cards=cards, sections=sections, made=made)
