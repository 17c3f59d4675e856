"""`rosrun train_brake run`: launches a train as a ROS graph and ends with the run's own exit code, which roslaunch does
not return."""

import contextlib
import difflib
import json
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import time
import urllib.parse

from train_brake.presentable import accept_all_characters, presentable

USAGE = """usage: rosrun train_brake run SCENARIO [OUT] [ARG:=VALUE ...]
       rosrun train_brake run [OUT] resume:=FOLDER [ARG:=VALUE ...]

Launches the train of a scenario file as a ROS graph. The number of its vehicles is found in the file. With a folder
OUT results are written there, and a report on the run, OUT/report.html (report:=false: none). ARG is an argument of
train.launch (roslaunch --ros-args train_brake train.launch lists them). Relative paths are those of the caller's
folder.

Exit codes are those of the train's master (train_sim --help lists them; 4: a wagon node is missing, dead or late).
Code 1 also stands for a master that was killed or was not started."""


def parse(words):
    """Splits the command line. @return (scenario or None, results folder or "", {argument: value})
    @raise ValueError: with what is wrong, for the user"""
    arguments = {}
    places = []
    for word in words:
        name, assigned, value = word.partition(":=")
        if not assigned:
            if word.startswith("-"):
                raise ValueError(f"'{word}' is no option; arguments of the launch are given as name:=value")
            places.append(word)
        elif name in arguments:
            raise ValueError(f"{name} is given twice")
        else:
            arguments[name] = value
    for name in ("scenario", "out"):
        if name in arguments:
            raise ValueError(f"{name.upper()} is given without a name: run SCENARIO [OUT] [ARG:=VALUE ...]")
    scenario = None
    if not arguments.get("resume"):
        if not places:
            raise ValueError("SCENARIO is missing")
        scenario = places.pop(0)
    if len(places) > 1:
        raise ValueError(f"'{places[1]}' is one too many; arguments of the launch are given as name:=value")
    return scenario, places[0] if places else "", arguments


def scenario_of(file):
    """Checks a scenario file; errors go to the terminal. @return the output of `train_sim check --json`; None: the
    scenario cannot be used"""
    check = subprocess.run(
        ["rosrun", "train_sim", "train_sim", "check", "--json", file], stdout=subprocess.PIPE, text=True, check=False
    )
    return json.loads(check.stdout) if check.returncode == 0 else None


def call_nodes_by_a_name_that_is_known(arguments):
    """ROS lets nodes call each other by their machine's name. A bare machine or a container may not know its own: then
    a run on that machine alone uses localhost, and the user is informed. ROS_HOSTNAME and ROS_IP, where set, stay as
    they are.
    """
    uri = urllib.parse.urlsplit(os.environ.get("ROS_MASTER_URI", "http://localhost:11311"))
    is_alone = not arguments.get("machines") and uri.hostname in ("localhost", "127.0.0.1", socket.gethostname())
    if not is_alone or os.environ.get("ROS_HOSTNAME") or os.environ.get("ROS_IP"):
        return
    try:
        socket.getaddrinfo(socket.gethostname(), None)
    except OSError:
        os.environ["ROS_HOSTNAME"] = "localhost"
        text = (
            f"this machine's name, {socket.gethostname()}, leads nowhere: nodes use localhost "
            "(ROS_HOSTNAME=... for another)"
        )
        print(presentable(f"run: {text}"), file=sys.stderr)


class EndOfMaster:
    """Learns from roslaunch that the train's master has ended."""

    def __init__(self):
        self.came = False

    def process_died(self, process_name, exit_code):  # of roslaunch.pmon.ProcessListener
        del exit_code  # also negative, after a signal; the master's own code is in a file
        if re.search(r"(^|/)master-\d+$", process_name) and not process_name.startswith("rosmaster"):
            self.came = True


def launch(arguments, watched):
    """Runs train.launch until the train's master has ended, or everything has. @raise roslaunch.RLException"""
    import roslaunch

    import roslaunch.arg_dump

    file = roslaunch.rlutil.resolve_launch_arguments(["train_brake", "train.launch"])[0]
    known = roslaunch.arg_dump.get_args([file])
    for name in arguments:  # roslaunch itself takes no notice of what it does not know
        if name not in known:
            close = difflib.get_close_matches(name, known, 1)
            raise roslaunch.RLException(
                f"train.launch has no argument '{name}'" + (f"; meant: {close[0]}?" if close else "")
            )
    words = [f"{name}:={value}" for name, value in arguments.items()]
    uuid = roslaunch.rlutil.get_or_generate_uuid(None, False)
    roslaunch.configure_logging(uuid)
    end = EndOfMaster()
    parent = roslaunch.parent.ROSLaunchParent(uuid, [(file, words)], process_listeners=[end])
    try:
        parent.start()
        while (watched or not end.came) and parent.pm and parent.pm.is_alive():
            parent.spin_once()
            time.sleep(0.05)
    except KeyboardInterrupt:
        pass  # Ctrl-C has reached roslaunch's monitor, which ends the nodes
    finally:
        parent.shutdown()


@contextlib.contextmanager
def outlived_output():
    """The reader of the output may end, or its disk may be full, which would end roslaunch and the run. A terminal gets
    the output directly; any other reader gets it from a process that never stops reading."""
    shields = []
    for descriptor in (1, 2):
        try:
            if os.isatty(descriptor):
                continue
            os.fstat(descriptor)
        except OSError:  # closed
            null = os.open(os.devnull, os.O_WRONLY)
            if null != descriptor:
                os.dup2(null, descriptor)
            continue
        reader = subprocess.Popen(
            ["bash", "-c", "trap '' INT TERM PIPE; cat || cat > /dev/null"],
            stdin=subprocess.PIPE,
            stdout=descriptor,
            stderr=subprocess.DEVNULL,
        )
        os.dup2(reader.stdin.fileno(), descriptor)
        reader.stdin.close()
        shields.append((descriptor, reader))
    try:
        yield
    finally:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:  # of a closed descriptor
                stream.flush()
        for descriptor, reader in shields:
            os.dup2(os.open(os.devnull, os.O_WRONLY), descriptor)
            with contextlib.suppress(subprocess.TimeoutExpired):
                reader.wait(10)


def in_short(out):
    """The main results of a run as text; empty if they are not known."""
    command = ["rosrun", "train_sim", "train_sim", "summary", out]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False).stdout


def main(words):
    accept_all_characters()
    with outlived_output():
        return run(words)


def run(words):
    if "-h" in words or "--help" in words:
        print(USAGE)
        return 0
    try:
        scenario, out, arguments = parse(words)
    except ValueError as error:
        print(presentable(f"run: {error}\n\n{USAGE}"), file=sys.stderr)
        return 2

    wants_report = arguments.pop("report", "true").lower() not in ("false", "0")
    os.environ["PWD"] = os.getcwd()  # what the launch file takes relative paths from
    checked = scenario or str(pathlib.Path(arguments["resume"]).expanduser() / "config.yaml")
    told = scenario_of(checked)
    if told is None:
        return 2
    arguments.setdefault("vehicles", told["vehicles"])
    # The launch file cannot read the scenario: unless told, it starts wagon nodes, which only 2D vehicles need.
    if "model" not in arguments:
        arguments["model"] = told["default_model"]
        arguments.setdefault("on_nodes", str("2d" in told["model"].split(", ")).lower())
    if scenario:
        arguments["scenario"] = os.path.abspath(scenario)
    if out:
        out = arguments["out"] = os.path.abspath(out)

    call_nodes_by_a_name_that_is_known(arguments)
    import roslaunch

    with tempfile.TemporaryDirectory() as folder:
        status = pathlib.Path(arguments.setdefault("exit_status_file", f"{folder}/status"))
        status.unlink(missing_ok=True)
        watched = arguments.get("rviz", "false").lower() in ("true", "1")
        try:
            launch({**arguments, "end_with_master": "false"}, watched)
        except (roslaunch.RLException, roslaunch.XmlParseException) as error:
            print(presentable(f"run: {error}"), file=sys.stderr)
            return 2
        code = int(status.read_text()) if status.exists() else None

    # Code 2: nothing was written. Files in the folder are those of an earlier run.
    if wants_report and out and code not in (None, 2) and os.path.exists(f"{out}/train.bag"):
        if subprocess.run(["rosrun", "train_brake", "report", out], check=False).returncode:
            print(f"The report on the run could not be made. The run itself ended with code {code}.", file=sys.stderr)
    if out and code not in (None, 2):
        page = pathlib.Path(out, "report.html")
        print(presentable("\n" + in_short(out) + (f"  page with figures: {page}" if page.exists() else "")))
    return 1 if code is None else code
