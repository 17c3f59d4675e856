#!/usr/bin/env python3
"""Prints the man page train_sim(1), made from the program's --help.

    tools/man_page.py devel/lib/train_sim/train_sim > train_sim.1
"""

import re
import subprocess
import sys


def output_of(*command):
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"(?m)^([.'])", r"\\&\1", text)


def parts_of(help_text):
    """The text before `Usage:`, and what is listed under each heading, as pairs of name and description."""
    about, _, rest = help_text.partition("Usage:")
    lists, heading = {}, None
    for line in rest.splitlines()[1:]:
        if re.match(r"\S.*:$", line):
            heading = line[:-1]
            lists[heading] = []
        elif heading and re.match(r"  \S", line):
            name, _, text = line.strip().partition("  ")
            lists[heading].append([name, text.strip()])
        elif heading and line.strip() and lists[heading]:
            lists[heading][-1][1] += " " + line.strip()
    return about.strip(), rest.splitlines()[0].strip(), lists


def entries(pairs):
    for name, text in pairs:
        print(f".TP\n.B {escaped(name)}\n{escaped(text).strip()}")


def print_page(program):
    version = output_of(program, "--version").split()[-1]
    about, _, lists = parts_of(output_of(program, "--help"))
    summary, _, rest = about.partition("\n\n")
    examples, _, exit_codes = rest.partition("Exit codes:")
    commands = next(pairs for heading, pairs in lists.items() if heading.lower() == "subcommands")
    print(f'.TH TRAIN_SIM 1 "" "train_sim {version}" "User commands"')
    print(f".SH NAME\ntrain_sim \\- {escaped('simulate the braking of long trains')}")
    print(".SH SYNOPSIS\n.B train_sim\n.I COMMAND\n[\\fIARGUMENTS\\fR]")
    print(f".SH DESCRIPTION\n{escaped(summary)}\n.SH COMMANDS")
    entries(commands)
    for name, _ in commands:
        _, usage, of_command = parts_of(output_of(program, name, "--help"))
        print(f".SH {escaped(name.upper())}\n.B {escaped(usage.split('/')[-1])}")
        for pairs in of_command.values():
            entries(pair for pair in pairs if not pair[0].startswith("-h,"))
    print(f".SH EXIT STATUS\n{escaped(' '.join(exit_codes.split()))}")
    print(
        ".SH ENVIRONMENT\n.TP\n.B TRAIN_BRAKE_CONFIG\nfolders of parts, separated by colons, in which names are looked "
        "for\nbesides the folders above a scenario"
    )
    lines = "\n".join(line.strip() for line in examples.strip().splitlines())
    print(f".SH EXAMPLES\n.nf\n{escaped(lines)}\n.fi")


if __name__ == "__main__":
    print_page(sys.argv[1])
