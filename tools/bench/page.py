"""docs/performance.md: the text of performance.md.in, tables and numbers in their places."""
import pathlib
import re
import textwrap

import targets
import workspace
from table import number

TEMPLATE = pathlib.Path(__file__).with_name("performance.md.in")
PAGE = workspace.ROOT / "docs" / "performance.md"


def write(machine, tables, facts):
    """In the text, {section} on a line stands for all tables of a section, {section 2} for one, {section.fact} anywhere
    for a number, {section.fact %} for a share.

    @param machine  pairs of label and text
    @param tables   {section: its tables}
    @param facts    {section: {fact: value}}
    """
    facts = {**facts, "both": _of_two_sections(facts)}

    def fact(place):
        section, name, is_share = place.groups()
        value = facts.get(section, {}).get(name)
        if value is None:
            return "(not measured)"
        return f"{100 * value:.0f} %" if is_share else number(value)

    def with_facts(text):
        return re.sub(r"\{(\w+)\.(\w+)( %)?\}", fact, text)

    blocks = {
        "machine": "\n".join(f"- {label}: {text}" for label, text in machine),
        "targets": targets.table(facts).as_markdown(),
        "missed": _missed([with_facts(item) for item in targets.missed(facts)]),
    }

    def block(place):
        name, _, index = place.group(1).partition(" ")
        if name in blocks:
            return blocks[name]
        chosen = tables.get(name, [])
        chosen = chosen[int(index) - 1 : int(index)] if index else chosen
        return "\n\n".join(table.as_markdown() for table in chosen) or (
            f"*Not measured: `make bench {'AGAINST=FOLDER' if name == 'against' else f'ONLY={name}'}`.*"
        )

    text = re.sub(r"^\{(\w+(?: \d)?)\}$", block, with_facts(TEMPLATE.read_text()), flags=re.MULTILINE)
    PAGE.write_text(re.sub(r"\n{3,}", "\n\n", text))


def _missed(items):
    """A section of its own, if there is anything to say."""
    wrapped = [textwrap.fill(item, 120, subsequent_indent="  ", break_on_hyphens=False) for item in items]
    return "\n".join(["## What is missed, and why", "", *wrapped]) if items else ""


def _of_two_sections(facts):
    """Facts that take more than one section's."""
    at_1_ms, at_5_ms = facts.get("exchange", {}).get("242_ms"), facts.get("graph", {}).get("every_vehicle_ms")
    return {"share_at_5_ms": at_5_ms / (5 * at_1_ms) if at_1_ms and at_5_ms else None}
