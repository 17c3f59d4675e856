#!/usr/bin/env python3
"""Prints docs/ros_interface.md: messages, services, topics, parameters and launch arguments, from their sources.

Messages and services come from the .msg and .srv files, launch arguments from the launch files, topics, services and
parameters of the nodes from their C++ code. What a parameter means is the doc of the launch argument that sets it, or
the comment beside its option in a header. Ends with 1 where a call is not understood or a meaning is missing.

    tools/ros_interface.py > docs/ros_interface.md
"""

import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = ROOT / "src"
MESSAGES = SOURCE / "train_brake_msgs"

# Nodes: executable, package folder, name in the launch files.
NODES = [("ltd_master", "master"), ("wagon_node", "wagon_NNN"), ("train_brake_rviz", "view")]

# Where node handles of the code lead.
HANDLES = {"node": "", "own": "~", "own_": "~", "private_": "~", "node_": "", "train": "", "train_": ""}
LIVE_HANDLE = "live_topics.cpp"

# What topics are of types of other packages.
MEANINGS = {
    "rosgraph_msgs/Clock": "simulated time",
    "diagnostic_msgs/DiagnosticArray": "how the run goes, once per second",
    "visualization_msgs/MarkerArray": "the drawing, for rviz",
    "scenario": "the scenario as YAML, everything resolved",
    "identify": "what runs here, and since when",
    "pause": "pauses the run at the next exchange",
    "resume": "lets a paused run go on",
}


class NotUnderstood(Exception):
    pass


def row(*cells):
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"


def table(heads, rows):
    return "\n".join([row(*heads), "|" + "---|" * len(heads)] + [row(*cells) for cells in rows])


def interface_file(path):
    """The comment above the first field and the parts (request, reply) of a .msg or .srv file."""
    intro, parts, seen_field = [], [[]], False
    for line in path.read_text().splitlines():
        if line.strip() == "---":
            parts.append([])
            seen_field = True
            continue
        match = re.match(r"([\w/\[\]]+)\s+(\w+)\s*(=\s*[^#]*)?(?:#\s*(.*))?$", line)
        if match:
            kind, name, value, comment = match.groups()
            name += " " + value.strip() if value else ""
            parts[-1].append([name, kind, comment or ""])
            seen_field = True
        elif line.strip().startswith("#"):
            comment = line.strip().lstrip("#").strip()
            indented = line.startswith(" ")
            if not seen_field:
                intro.append(comment)
            elif indented and parts[-1]:
                parts[-1][-1][2] += " " + comment  # goes on from the line before
            else:
                parts[-1].append(["", "", comment])
    return intro, parts


def first_sentence(text):
    return re.split(r"(?<=[.:])\s", text.strip(), maxsplit=1)[0].rstrip(".:")


def meaning_of_type(kind):
    package, name = kind.split("/")
    if package != "train_brake_msgs":
        return MEANINGS.get(kind, "")
    for folder, suffix in (("msg", ".msg"), ("srv", ".srv")):
        path = MESSAGES / folder / (name + suffix)
        if path.exists():
            return first_sentence(" ".join(interface_file(path)[0]))
    raise NotUnderstood(f"{kind} has no file in {MESSAGES}")


def sources(package):
    for folder in ("include", "src"):
        yield from sorted((SOURCE / package / folder).rglob("*.h"))
        yield from sorted((SOURCE / package / folder).rglob("*.cpp"))


def constants():
    """String constants of all headers by name: topics are named by some."""
    found = {}
    for path in SOURCE.rglob("*"):
        if path.suffix in (".h", ".cpp") and "test" not in path.parts:
            for name, value in re.findall(r'constexpr const char\* (k\w+) = "([^"]*)"', path.read_text()):
                found[name] = value
    return found


CONSTANTS = constants()


def text_of(expression):
    """The value of a string expression of the code."""
    expression = expression.strip()
    if re.fullmatch(r'"[^"]*"', expression):
        return expression[1:-1]
    name = expression.split("::")[-1]
    if name in CONSTANTS:
        return CONSTANTS[name]
    joined = {'source_ + "state"': "[live/]state", 'name + "/state"': "wagon_NNN/state"}
    joined.update({f'source_ + "{topic}"': f"[live/]{topic}" for topic in ("in_train_forces", "brake_pressures")})
    if expression in joined:
        return joined[expression]
    raise NotUnderstood(f"the name {expression}")


def arguments(text, begin):
    """The arguments of a call whose bracket opens at begin."""
    depth, current, found = 0, "", []
    for i in range(begin, len(text)):
        c = text[i]
        if c in "([{":
            depth += 1
            if depth == 1:
                continue
        elif c in ")]}":
            depth -= 1
            if depth == 0:
                return [part.strip() for part in found + [current]]
        if c == "," and depth == 1:
            found.append(current)
            current = ""
        else:
            current += c
    raise NotUnderstood("a call without an end")


def message_type(name):
    return name.replace("::", "/")


def resolved(handle, name, path):
    if name.startswith("/"):
        return name
    prefix = "live/" if path.name == LIVE_HANDLE else HANDLES.get(handle)
    if prefix is None:
        raise NotUnderstood(f"the handle {handle} in {path.name}")
    return prefix + name


def handler_type(package, handler):
    """The type of the message or service that a method takes."""
    for path in sources(package):
        match = re.search(r"\b" + handler + r"\(\s*(?:const )?(\w+::\w+?)(?:::Request|ConstPtr)?&", path.read_text())
        if match:
            return message_type(match.group(1))
    raise NotUnderstood(f"the method {handler} of {package}")


def interface_of(package):
    """Published topics, subscribed topics and services of a node."""
    published, subscribed, services = [], [], []
    for path in sources(package):
        text = path.read_text()
        text = re.sub(r"//[^\n]*", "", text)
        for call in re.finditer(r"(\w+)\.advertise<([\w:]+)>\(", text):
            handle, kind = call.groups()
            values = arguments(text, call.end() - 1)
            if kind == "Message":
                continue  # of a helper, whose uses are below
            keeps = "the newest" if len(values) > 2 and values[2] == "true" else ""
            published.append((resolved(handle, text_of(values[0]), path), message_type(kind), keeps))
        for kind, handle, name in re.findall(r'Latched<([\w:]+)>\((\w+), ("\w+")\)', text):
            published.append((resolved(handle, text_of(name), path), message_type(kind), "the newest"))
        for name, handle, topic in re.findall(r'(\w+_topic_)\((\w+), ("\w+"), kQueue\)', text):
            kind = re.search(
                r"RecordTopic<([\w:]+)> " + name,
                (SOURCE / package / "include").joinpath(package, "master_node.h").read_text(),
            )
            published.append(
                (resolved(handle, text_of(topic), path), message_type(kind.group(1)), "while the train stands")
            )
        for call in re.finditer(r"(\w+)\.subscribe(?:<([\w:]+)>)?\(", text):
            handle, kind = call.groups()
            values = arguments(text, call.end() - 1)
            if kind is None:
                kind = handler_type(package, values[2].split("::")[-1])
            name = "[live/]wagon_NNN/state" if "VehicleName" in values[0] else text_of(values[0])
            subscribed.append((resolved(handle, name, path), message_type(kind)))
        for call in re.finditer(r"(\w+)\.advertiseService\(", text):
            values = arguments(text, call.end() - 1)
            if len(values) == 1:  # options, made a few lines above
                made = re.search(r'initBySpecType<(\w+)>\("(\w+)"', text)
                services.append(
                    (
                        resolved(call.group(1), made.group(2), path),
                        "train_brake_msgs/" + made.group(1).replace("Spec", ""),
                    )
                )
            else:
                kind = handler_type(package, values[1].split("::")[-1])
                services.append((resolved(call.group(1), text_of(values[0]), path), kind))
        for name in re.findall(r'StepService>\(\s*private_\.resolveName\(("\w+")\)', text):
            services.append(("~" + text_of(name), "train_brake_msgs/Step"))
    return published, subscribed, services


def launch_files():
    return sorted(path for path in (ROOT / "launch").glob("*.launch"))


def launch_documents():
    """By node package and parameter: the doc of the launch argument that sets it."""
    found = {}
    for path in launch_files():
        root = ElementTree.parse(path).getroot()
        docs = {arg.get("name"): arg.get("doc") for arg in root.iter("arg") if arg.get("doc")}
        for node in root.iter("node"):
            for param in node.iter("param"):
                arg = re.search(r"\$\(arg (\w+)\)", param.get("value") or "")
                name = arg and arg.group(1)
                if name in docs:
                    found.setdefault((node.get("pkg"), param.get("name")), docs[name])
    return found


def option_in_headers(package, name):
    """Default and comment of an option in a struct of the package."""
    for path in sources(package):
        match = re.search(
            r"\b(?:double|int|bool|std::string) " + name + r" = ([^;]+);(?:\s*///<\s*(.*))?", path.read_text()
        )
        if match:
            return match.group(1).strip(), match.group(2) or ""
    return None, ""


def parameters_of(package, docs):
    found = []
    types = {
        "Text": "string",
        "Words": "words, separated by blanks",
        "Flag": "true or false",
        "Integer": "integer",
        "NonNegative": "number >= 0",
    }
    for path in sources(package):
        text = path.read_text()
        for call in re.finditer(r"parameters\.(Text|Words|Flag|Integer|NonNegative|IsFirstOf|Choice)\(", text):
            kind = call.group(1)
            values = arguments(text, call.end() - 1)
            name = text_of(values[0])
            default, comment = (values[1] if len(values) > 1 else '""'), ""
            if kind in ("IsFirstOf", "Choice"):
                words = re.findall(r'"(\w+)"', " ".join(values[1:]))
                shown, default = "one of " + ", ".join(words), words[0]
            else:
                shown = types[kind]
            known, comment = option_in_headers(package, name)
            if re.fullmatch(r"options_?\.\w+", default):
                default = known
            elif not re.fullmatch(r'"\w*"|[-\d.]+|true|false|\w+', default):
                default = "coupler_force" if name == "quantity" else None
            if default is None:
                raise NotUnderstood(f"the default of {package}'s parameter {name}")
            default = default.strip('"')
            meaning = PARAMETERS.get((package, name)) or docs.get((package, name)) or comment
            if not meaning:
                raise NotUnderstood(f"{package}'s parameter {name} has neither a doc in a launch file nor a comment")
            found.append((f"`~{name}`", shown, f"`{default}`" if default else "", meaning))
    return found


def launch_arguments(root):
    """Name, default and meaning of each argument that can be given."""
    found = []
    for arg in root.findall("arg"):
        if arg.get("value") is not None:
            continue
        given = arg.get("default")
        default = "must be given" if given is None else f"`{given.strip()}`" if given.strip() else ""
        found.append((f"`{arg.get('name')}`", default, arg.get("doc") or ""))
    return found


def print_launch_files():
    print("## Launch files\n")
    scenarios, common = [], None
    for path in launch_files():
        root = ElementTree.parse(path).getroot()
        comment = re.search(r"<launch>\s*<!--(.*?)-->", path.read_text(), re.S)
        about = first_sentence(" ".join(comment.group(1).split())) if comment else ""
        args = launch_arguments(root)
        includes = [include.get("file") or "" for include in root.iter("include")]
        if any(file.endswith("/train.launch") for file in includes):
            model = next((default for name, default, _ in args if name == "`model`"), "")
            scenarios.append((f"`{path.name}`", about, model))
            others = [arg for arg in args if arg[0] != "`model`"]
            if common is not None and others != common:
                raise NotUnderstood(f"{path.name} has other arguments than the other launch files of scenarios")
            common = others
            continue
        print(f"### {path.name}\n\n{about}.\n")
        if args:
            print(table(["argument", "default", "meaning"], args) + "\n")
    print(
        "### Scenarios\n\nEach runs a scenario of its name with `train.launch`, all of whose arguments can be given, "
        "too.\n"
    )
    print(table(["launch file", "what", "default of `model`"], scenarios) + "\n")
    print(table(["argument", "default", "meaning"], common) + "\n")


# Of parameters that no launch file sets, or not by an argument of the same meaning.
PARAMETERS = {
    ("ltd_master", "ranks"): "number of wagon nodes; 0: the vehicles are in the master's own process",
    (
        "ltd_master",
        "nodes",
    ): "number of wagon nodes that the user asked for, to tell where `~ranks` is another; auto: any",
    (
        "train_brake_rviz",
        "vehicle",
    ): "of the close-up at first, from 1, or from -1 for the last; 0: the first one in full "
    "detail",
    ("train_brake_rviz", "quantity"): "that colours the vehicles at first",
}


def print_interface():
    print(
        """# ROS interface

Made by `tools/ros_interface.py` from the `.msg` and `.srv` files, the launch files and the nodes' code; do not edit it.
`make reference` renews it. What passes between master and ranks, and when: [lockstep.md](lockstep.md); driving a
running train: [driving.md](driving.md).

Names are in the train's namespace, `/train` in the shipped launch files: `state` is `/train/state`, `~pause` of the
master `/train/master/pause`. Quantities are in SI units; the unit is in the field's name or beside it.
"""
    )
    docs = launch_documents()
    for package, node in NODES:
        executable = "train_view" if package == "train_brake_rviz" else package
        print(f"## Node {executable}\n\nPackage `{package}`; in the launch files `{node}`.\n")
        published, subscribed, services = interface_of(package)
        if published:
            print("Publishes:\n")
            print(
                table(
                    ["topic", "type", "late subscribers get", "what"],
                    [
                        (
                            f"`{name}`",
                            f"`{kind}`",
                            keeps or "nothing",
                            MEANINGS.get(name.split("/")[-1]) or meaning_of_type(kind),
                        )
                        for name, kind, keeps in sorted(published)
                    ],
                )
                + "\n"
            )
        if subscribed:
            print("Subscribes:\n")
            print(table(["topic", "type"], [(f"`{name}`", f"`{kind}`") for name, kind in sorted(subscribed)]) + "\n")
        if services:
            print("Serves:\n")
            print(
                table(
                    ["service", "type", "what"],
                    [
                        (f"`{name}`", f"`{kind}`", MEANINGS.get(name.lstrip("~")) or meaning_of_type(kind))
                        for name, kind in sorted(services)
                    ],
                )
                + "\n"
            )
        print("Private parameters; another name, type or value is an error:\n")
        print(table(["parameter", "type", "default", "meaning"], parameters_of(package, docs)) + "\n")

    print_launch_files()
    for folder, title in (("msg", "Messages"), ("srv", "Services")):
        print(f"## {title}\n")
        for path in sorted((MESSAGES / folder).glob("*." + folder)):
            intro, parts = interface_file(path)
            print(f"### train_brake_msgs/{path.stem}\n")
            print("\n".join(line for line in intro).strip() + "\n")
            for title_of_part, fields in zip(("Request", "Reply") if folder == "srv" else ("",), parts):
                if title_of_part:
                    print(f"{title_of_part}:\n" if fields else f"{title_of_part}: empty.\n")
                if fields:
                    print(
                        table(
                            ["field", "type", "meaning"],
                            [
                                (f"`{name}`" if name else "", f"`{kind}`" if kind else "", comment)
                                for name, kind, comment in fields
                            ],
                        )
                        + "\n"
                    )


if __name__ == "__main__":
    try:
        print_interface()
    except NotUnderstood as error:
        sys.exit(f"ros_interface.py: not understood: {error}")
