"""Cost of each feature that the paper's train lacks, and two threads beside other work."""
import contextlib

import machine
import measure
import workspace
from table import Table, number, times

STOP = "commands=[{time_s: 0, kind: emergency}]"
PATCHES = (
    "track={name: patches, friction_patches: [{from_m: -5000, to_m: 50, adhesion: wet}, "
    "{from_m: 50, to_m: 60, adhesion: dry}, {from_m: 60, to_m: 5000, adhesion: wet}]}"
)
GRADES = (
    "track={name: grades, grades: [{from_m: -2500, grade_percent: 0.1}, {from_m: -1000, grade_percent: -0.1}, "
    "{from_m: 50, grade_percent: 0.0}]}"
)
DIPS = "track={name: dips, dips: [{from_m: 40, depth_m: 0.01, length_m: 10}]}"
PROTECTED = [f"train.consist[{group}].vehicle.wheel_slide_protection=threshold_3state" for group in range(4)]


def _rigging(setting):
    return [f"train.consist[{group}].vehicle.brake_rigging.{setting}" for group in range(4)]


# fact, what, model, settings
FEATURES = [
    ("grades", "three grades under the train", "2d", [GRADES]),
    ("patches", "three patches of friction", "2d", [PATCHES]),
    ("dips", "a dip in the rail", "2d", [DIPS]),
    ("protected", "wheel-slide protection on every vehicle", "2d", PROTECTED),
    ("mixed", "one half of the vehicles LTD", "2d", ["train.consist[1].model=ltd"]),
    ("gears", "draft gears of damped_stick friction", "2d", ["train.connection=friction_gear"]),
    ("reaction", "shoes that react on the frames", "2d", _rigging("reaction=frame")),
    ("tread", "friction by the tread's speed", "2d", _rigging("friction_speed=tread")),
    ("pipe", "the pneumatic brake", "2d", ["brake=ab_head_end"]),
    ("ltd_grades", "three grades under the train", "ltd", [GRADES]),
    ("ltd_gears", "draft gears of damped_stick friction", "ltd", ["train.connection=friction_gear"]),
    ("ltd_pipe", "the pneumatic brake", "ltd", ["brake=ab_head_end"]),
]
SIMULATED_S = {"2d": 4, "ltd": 20}
REPETITIONS = 5


def run():
    rows, facts = [], {}
    for fact, what, model, settings in FEATURES:
        plain, with_it = measure.in_turn(REPETITIONS, lambda: _ns(model, []), lambda: _ns(model, settings))
        added = measure.median([b - a for a, b in zip(plain, with_it)])
        facts[fact] = measure.ratio(with_it, plain)
        rows.append(
            (
                f"{model}: {what}",
                number(measure.median(plain)),
                number(measure.median(with_it)),
                f"{added:+.1f}",
                times(facts[fact]),
            )
        )
    table = Table("parts of a train [ns per vehicle-step]", ["without", "with", "it adds", "ratio"], rows)
    return [table, _beside_work(facts)], facts


def _ns(model, settings):
    run = workspace.train_sim(
        "--model",
        model,
        "--threads",
        1,
        settings=[STOP, "detail_vehicles=[]", f"duration_s={SIMULATED_S[model]}", *settings],
    )
    return run.summary["ns_per_vehicle_step"]


def _beside_work(facts):
    """All threads against one, on an idle machine and beside programs that keep cores busy."""
    cores = machine.cores()
    rows = []
    for busy in (0, 1):
        with contextlib.ExitStack() as stack:
            for core in range(busy):
                stack.enter_context(workspace.busy_core(core))
            one, all_cores = measure.in_turn(REPETITIONS, lambda: _wall_s(1), lambda: _wall_s(cores))
        ratio = measure.ratio(all_cores, one)
        facts[f"threads_beside_{busy}"] = ratio
        rows.append(
            (f"{busy} busy core(s)", number(measure.median(one)), number(measure.median(all_cores)), times(ratio))
        )
    return Table(
        f"2D train, its first 20 s [s], {cores} threads against one", ["1 thread", f"{cores} threads", "ratio"], rows
    )


def _wall_s(threads):
    return workspace.train_sim("--model", "2d", "--threads", threads, settings=["duration_s=20"]).summary["wall_s"]
