"""Tables for the terminal and for Markdown."""
import dataclasses


@dataclasses.dataclass
class Table:
    """A title, the names of the columns, rows of a label and as many cells of text, and a remark."""

    title: str
    columns: list
    rows: list
    remark: str = ""

    def as_markdown(self):
        lines = [[self.title, *self.columns], *([label, *cells] for label, *cells in self.rows)]
        widths = [max(3, *(len(line[i]) for line in lines)) for i in range(len(self.columns) + 1)]

        def row(cells):
            label, *numbers = cells
            padded = [f"{label:<{widths[0]}}", *(f"{cell:>{width}}" for cell, width in zip(numbers, widths[1:]))]
            return "| " + " | ".join(padded) + " |"

        rule = "|" + "-" * (widths[0] + 2) + "|" + "".join("-" * (width + 1) + ":|" for width in widths[1:])
        text = [row(lines[0]), rule, *map(row, lines[1:])]
        return "\n".join(text + (["", self.remark] if self.remark else []))


def as_text(tables):
    """All tables as one: labels in one column, numbers right-aligned beside them."""
    labels = max(len(text) for table in tables for text in [table.title, *(f"  {row[0]}" for row in table.rows)])
    lines = []
    for table in tables:
        widths = [
            max(8, len(column), *(len(row[i]) for row in table.rows)) + 2 for i, column in enumerate(table.columns, 1)
        ]

        def line(label, cells):
            return f"{label:<{labels}}" + "".join(f"{cell:>{width}}" for cell, width in zip(cells, widths))

        heading = line(table.title, table.columns)
        lines += ["", heading, "-" * len(heading), *(line(f"  {label}", cells) for label, *cells in table.rows)]
        if table.remark:
            lines.append(f"  {table.remark}")
    return "\n".join(lines)


def number(value, digits=3):
    """Three significant digits, no exponent; a dash where there is no value."""
    if value is None:
        return "-"
    if value == 0.0:
        return "0"
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:.0f}"
    text = f"{value:.{digits}g}"
    return f"{value:.6f}".rstrip("0") if "e" in text else text


def times(value):
    return "-" if value is None else f"{number(value)} x"


def percent(value):
    return "-" if value is None else f"{100 * value:+.1f} %"
