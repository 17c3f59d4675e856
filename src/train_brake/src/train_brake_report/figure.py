"""A figure of the report, as SVG that follows the page's colours and as files."""

import dataclasses
import io
import pathlib
import re
from typing import List, Optional

import matplotlib
import matplotlib.figure

from train_brake.presentable import presentable

from train_brake_report import style

PNG_DPI = 120


def minus(number: str) -> str:
    """A printed number as it appears in a text: with a minus instead of hyphens, and none before a zero."""
    without = re.sub(r"^-(?=[0.]+(?![\d.e]))", "", number)
    return without.replace("-", "\u2212")


class LeftOut(Exception):
    """The reason why a figure is missing, as a sentence for the page."""


@dataclasses.dataclass
class Table:
    """Rows of texts below a figure, or by themselves."""

    head: List[str]
    rows: List[List[str]]


@dataclasses.dataclass
class Figure:
    name: str  # of its files, without ending
    title: str
    caption: str
    canvas: Optional[matplotlib.figure.Figure] = None  # None: a table only
    table: Optional[Table] = None

    def svg(self) -> str:
        """For embedding in a page: no prologue, colours as CSS variables that fall back to themselves."""
        text = self._file("svg").decode()
        text = presentable(text[text.index("<svg") :])
        text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
        for colour, name in style.CSS_NAMES.items():
            text = re.sub(rf"(?<=: ){colour}\b", f"var(--{name}, {colour})", text)
        return text

    def save(self, folder: pathlib.Path) -> None:
        if self.canvas is None:
            return
        for ending in ("svg", "png"):
            (folder / f"{self.name}.{ending}").write_bytes(self._file(ending))

    def _file(self, ending: str) -> bytes:
        buffer = io.BytesIO()
        # The salt makes the ids in the file depend on the figure only: the same figure, the same file.
        with matplotlib.rc_context({"svg.hashsalt": self.name}):
            if ending == "svg":
                self.canvas.savefig(buffer, format="svg", metadata={"Date": None})
            else:
                self.canvas.savefig(buffer, format="png", dpi=PNG_DPI, facecolor="white")
        return buffer.getvalue()


def new_canvas(height_in: float) -> matplotlib.figure.Figure:
    return matplotlib.figure.Figure(figsize=(style.WIDTH_IN, height_in), layout="constrained")


def panels_with_differences(height_in: float, differences: List[str]) -> tuple:
    """(canvas, the panel of the quantity itself, a lower panel for each difference), one above the other."""
    below_in = 1.7
    canvas = new_canvas(height_in + below_in * len(differences))
    axes, *below = canvas.subplots(
        1 + len(differences), 1, sharex=True, squeeze=False, height_ratios=[height_in] + [below_in] * len(differences)
    )[:, 0]
    for panel, title in zip(below, differences):
        panel.set_title(title, loc="left", fontsize=matplotlib.rcParams["legend.fontsize"])
        panel.axhline(0.0, color=style.MUTED, linewidth=1.0)
    for panel in (axes, *below):
        panel.margins(x=0)
    return canvas, axes, below
