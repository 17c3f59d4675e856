"""docs/performance.md: the text of performance.md.in, the tables in their places."""
import pathlib
import re

import workspace

TEMPLATE = pathlib.Path(__file__).with_name("performance.md.in")
PAGE = workspace.ROOT / "docs" / "performance.md"


def write(machine, targets, tables):
    """@param tables  {section: its tables}; in the text, {section} stands for all of them, {section 2} for one"""
    def fill(place):
        name, _, index = place.group(1).partition(" ")
        if name == "machine":
            return "\n".join(f"- {label}: {text}" for label, text in machine)
        if name == "targets":
            return targets.as_markdown()
        if name not in tables:
            return f"*Not measured: `make bench ONLY={name}`.*"
        chosen = [tables[name][int(index) - 1]] if index else tables[name]
        return "\n\n".join(table.as_markdown() for table in chosen)
    PAGE.write_text(re.sub(r"^\{(\w+(?: \d)?)\}$", fill, TEMPLATE.read_text(), flags=re.MULTILINE))
