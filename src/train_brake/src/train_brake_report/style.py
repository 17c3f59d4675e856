"""How all figures look: one palette, readable by the colour-blind and on a projector."""

import contextlib
from typing import Sequence, Tuple

import matplotlib
import matplotlib.ticker
import numpy
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap

# Okabe & Ito, Color Universal Design (2008); without its yellow, which is not seen on white.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"
INK, MUTED, GRID = "#1b1f24", "#59636e", "#d8dde3"
COLOURS = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK]

# The page gives these colours other values on a dark background (page.html).
CSS_NAMES = {
    BLUE: "blue",
    VERMILLION: "vermillion",
    GREEN: "green",
    PURPLE: "purple",
    ORANGE: "orange",
    SKY: "sky",
    INK: "ink",
    MUTED: "muted",
    GRID: "grid",
}

DIVERGING = LinearSegmentedColormap.from_list(
    "tension_compression", ["#00304b", BLUE, "#9fd0ea", "#f7f7f7", "#f6b98c", VERMILLION, "#5f2a00"]
)
SEQUENTIAL = LinearSegmentedColormap.from_list("none_to_much", ["#f7f7f7", "#9fd0ea", BLUE, "#00304b"])
for colours in (DIVERGING, SEQUENTIAL):
    colours.set_bad("#9aa3ad")  # where nothing is known

WIDTH_IN = 10.0

RC = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
    "font.size": 11.5,
    "axes.labelsize": 11.5,
    "xtick.labelsize": 10.5,
    "ytick.labelsize": 10.5,
    "legend.fontsize": 10.5,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": MUTED,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "axes.grid": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.9,
    "lines.linewidth": 1.8,
    "legend.frameon": False,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS),
    "axes.unicode_minus": True,
    "axes.formatter.useoffset": False,
    "text.parse_math": False,
    "svg.fonttype": "none",
    "path.simplify_threshold": 0.3,
    "image.composite_image": False,
}


@contextlib.contextmanager
def applied():
    with matplotlib.rc_context(RC):
        yield


SUPERSCRIPTS = str.maketrans("-0123456789", "\u207b\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079")


def powers_of_ten(axis) -> None:
    """Numbers of a logarithmic axis without the language for formulas, which is off: names may have a "$"."""

    def power(value: float, _) -> str:
        exponent = round(numpy.log10(value))
        return "10" + str(exponent).translate(SUPERSCRIPTS) if numpy.isclose(value, 10.0**exponent) else f"{value:g}"

    axis.set_major_formatter(power)
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def run_line(number: int, runs: int) -> dict:
    """Of the run with this number, from 0. The first is broad: where runs agree, the others are seen upon it."""
    width = 2.0 if runs == 1 else 5.0 if number == 0 else 1.8
    return {
        "color": COLOURS[number % len(COLOURS)],
        "linewidth": width,
        "linestyle": "-" if number < 2 else (0, (4, 2)),
    }


def legend_above(axes: Axes, columns: int = 4) -> None:
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncol=columns,
        borderaxespad=0.2,
        handlelength=2.2,
        columnspacing=1.6,
    )


def legend_beside_title(axes: Axes) -> None:
    """Of a panel whose title stands above it at the left."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncol=2, borderaxespad=0.1, handlelength=2.2)


def label_ends(axes: Axes, ends) -> None:
    """Names lines of a logarithmic panel at their right ends instead of in a legend; ends: (y, text, colour)."""
    size = matplotlib.rcParams["legend.fontsize"]
    axes.figure.draw_without_rendering()  # the panel's height is known only then
    apart = 1.25 * size * axes.figure.dpi / 72 / axes.get_window_extent().height
    low, high = numpy.log(axes.get_ylim())
    ends = sorted(ends)
    exact = [(numpy.log(y) - low) / (high - low) for y, _, _ in ends]
    places = exact[:]
    for i in range(1, len(ends)):
        places[i] = max(exact[i], places[i - 1] + apart)
    for i in reversed(range(len(ends))):  # down again, where they would leave the panel
        places[i] = min(places[i], (places[i + 1] if i + 1 < len(ends) else 1.0 + apart) - apart)
    for (_, text, colour), exact, place in zip(ends, exact, places):
        axes.annotate(
            text,
            (1.0, exact),
            (1.02, place),
            xycoords="axes fraction",
            textcoords="axes fraction",
            va="center",
            color=colour,
            fontsize=size,
            arrowprops={
                "arrowstyle": "-",
                "color": colour,
                "linewidth": 0.7,
                "shrinkA": 0,
                "shrinkB": 0,
                "relpos": (0.0, 0.5),
            },
        )


def _name_of(command: dict) -> str:
    kind = command["kind"].replace("_", " ")
    if kind == "apply":
        return f"reduce pipe by {command.get('reduction_kpa', 0):g} kPa"
    if "pressure_kpa" in command:
        return f"{kind} {command['pressure_kpa']:g} kPa"
    return f"{kind} {command['notch']:g}" if "notch" in command else kind


MOST_COMMANDS = 12  # that a figure names


def mark_commands(
    axes: Axes, marks: Sequence[Tuple[dict, str, str]], named: bool = True, at_bottom: bool = False
) -> None:
    """Thin lines at the times of the driver's commands: of many, those of the brake; of still more, without their
    names.

    marks: (command, colour, whose it is; empty: all runs'). Call it when all is drawn: the names get rows of their own,
    beyond the curves, and no two of them share a place."""
    if len(marks) > MOST_COMMANDS:
        marks = [mark for mark in marks if "notch" not in mark[0]]
        named = named and len(marks) <= MOST_COMMANDS
    for command, colour, _ in marks:
        axes.axvline(command["time_s"], color=colour, linewidth=1.0, linestyle=(0, (1, 2)))
    if not named or not marks:
        return
    size = 9.5
    canvas = axes.figure
    width_pt = 72 * canvas.get_figwidth() * 0.86  # of the panel, roughly: labels and ticks take the rest
    left, right = axes.get_xlim()
    ends, placed = [], []  # where each row's last name ends [pt]
    for command, colour, who in sorted(marks, key=lambda mark: mark[0]["time_s"]):
        text = _name_of(command) + (f" ({who})" if who else "")
        x = width_pt * (command["time_s"] - left) / (right - left)
        wide = 0.6 * size * len(text) + 8
        is_late = x + wide > width_pt  # to the left of its line
        begin = x - wide if is_late else x
        row = next((i for i, end in enumerate(ends) if end <= begin), len(ends))
        ends[row : row + 1] = [begin + wide]
        placed.append((command["time_s"], row, text, colour, is_late))
    height_pt = (
        72
        * canvas.get_figheight()
        * (axes.get_subplotspec().get_position(canvas).height if axes.get_subplotspec() else 0.8)
    )
    share = min(0.4, (1.35 * size * len(ends) + 4) / height_pt)
    scale = axes.yaxis.get_transform()
    low, high = scale.transform(axes.get_ylim())
    room = (high - low) * share / (1 - share)
    axes.set_ylim(*scale.inverted().transform((low - room, high) if at_bottom else (low, high + room)))
    for time_s, row, text, colour, is_late in placed:
        offset = (4 + 1.35 * size * row) if at_bottom else (-3 - 1.35 * size * row)
        axes.annotate(
            text,
            (time_s, 0.0 if at_bottom else 1.0),
            (-4 if is_late else 4, offset),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            va="bottom" if at_bottom else "top",
            ha="right" if is_late else "left",
            fontsize=size,
            color=colour,
        )
