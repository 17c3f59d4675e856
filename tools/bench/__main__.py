"""Measures the simulator on this machine: one table to the terminal, the same with words to docs/performance.md.

Every section writes its results to results/bench/, so that one can be measured again alone, and an interrupted
measurement is continued with `missing`.
"""
import argparse
import dataclasses
import importlib
import json
import pathlib
import sys
import time
import traceback

import machine
import measure
import page
import targets
import workspace
from table import Table, as_text, number

SECTIONS = ["vehicles", "runs", "scaling", "features", "exchange", "graph", "intervals", "limit"]
AGAINST = "against"  # the section that needs another build, so is not one of all
MISSING = "missing"
RESULTS = workspace.ROOT / "results" / "bench"


def main():
    parser = argparse.ArgumentParser(
        prog="make bench", description=__doc__, epilog="sections: " + " ".join([*SECTIONS, AGAINST])
    )
    parser.add_argument(
        "--only",
        default="",
        metavar="NAME,...",
        help="measure these sections; the others keep their results. missing: those without results of this commit",
    )
    parser.add_argument(
        "--against", default="", metavar="FOLDER", help="compare with the build in that workspace, in turn"
    )
    arguments = parser.parse_args()
    if arguments.against:
        workspace.OTHER = pathlib.Path(arguments.against).resolve()
    chosen = _chosen(arguments.only.replace(",", " ").split())
    unknown = [name for name in chosen if name not in [*SECTIONS, AGAINST]]
    if unknown:
        parser.error(f"{unknown[0]} is not a section; the sections are {', '.join(SECTIONS)}")

    failures = [failure for name in chosen if (failure := _measure(name))]

    results = _load()
    tables = {name: [Table(**t) for t in result["tables"]] for name, result in results.items()}
    facts = {name: result["facts"] for name, result in results.items()}
    times = _times(results)
    facts["bench"] = {"minutes": sum(times.values()) / 60 if all(name in times for name in SECTIONS) else None}
    tables["times"] = [_table_of(times)]
    print(as_text([targets.table(facts), *(t for name in [*SECTIONS, AGAINST, "times"] for t in tables.get(name, []))]))
    print(f"\n{targets.verdict(facts)}")
    try:
        page.write([*machine.describe(), ("commit", _commits(results))], tables, facts)
    except OSError as error:
        failures.append(f"make bench: the page is not written: {error}")
    if failures:
        sys.exit("\n".join(["", *failures]))


def _chosen(names):
    """The sections to measure: those of the command line, or all, or those that have no results of this commit."""
    if names == [MISSING]:
        commit, results = workspace.commit(), _load()
        names = [name for name in SECTIONS if name not in results or results[name]["commit"] != commit]
    else:
        names = names or SECTIONS
    return [*names, AGAINST] if workspace.OTHER and AGAINST not in names else names


def _times(results):
    """Seconds that each section took."""
    return {name: result["seconds"] for name, result in results.items() if name in SECTIONS}


def _table_of(times):
    rows = [(name, number(seconds)) for name, seconds in times.items()]
    return Table("make bench, without the build [s]", ["time"], [*rows, ("together", number(sum(times.values())))])


def _measure(name):
    """Measures a section and keeps its results. Returns the error, or nothing: a failed section does not stop the
    others."""
    print(f"{name} ...", file=sys.stderr, flush=True)
    begin = time.monotonic()
    file = RESULTS / f"{name}.json"
    try:
        RESULTS.mkdir(parents=True, exist_ok=True)
        file.unlink(missing_ok=True)
        tables, facts = importlib.import_module(name).run()
        result = {
            "machine": machine.describe(),
            "commit": workspace.commit(),
            "tables": [dataclasses.asdict(t) for t in tables],
            "facts": facts,
            "seconds": time.monotonic() - begin,
        }
        file.write_text(json.dumps(result, indent=1) + "\n")
    except (measure.Failed, OSError) as failure:
        return f"make bench: {name}: {failure}"
    except Exception:
        return f"make bench: {name}: a mistake in tools/bench:\n{traceback.format_exc()}"
    print(f"{name}: {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
    return ""


def _load():
    """Results of this machine and of this version of the tool, by section."""
    results = {}
    for name in [*SECTIONS, AGAINST]:
        file = RESULTS / f"{name}.json"
        if not file.exists():
            continue
        result = json.loads(file.read_text())
        if "seconds" in result and result["machine"] == [list(pair) for pair in machine.describe()]:
            results[name] = result
        else:
            print(
                f"{file.relative_to(workspace.ROOT)} is of another machine, or of an older make bench: left out",
                file=sys.stderr,
            )
    return results


def _commits(results):
    """The commit of all measurements, or that of each section: with ONLY= they may differ."""
    sections = {}
    for name, result in results.items():
        sections.setdefault(result["commit"], []).append(name)
    if len(sections) < 2:
        return "".join(sections)
    mixed = "; ".join(f"{commit} ({', '.join(names)})" for commit, names in sections.items())
    print(f"The sections are of different commits: {mixed}", file=sys.stderr)
    return mixed


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
