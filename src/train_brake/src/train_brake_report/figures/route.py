"""The run over the route: speed against the limits, forces and brakes over the place, and the route below them."""

import numpy
from matplotlib.ticker import MaxNLocator

from train_brake_report import consist, style
from train_brake_report.figure import Figure, LeftOut, Table, minus, new_canvas
from train_brake_report.group import Group
from train_brake_report.run import Run
from train_brake_report.track import PERMILLE, Track

KN, KPA, KM = 1e-3, 1e-3, 1e-3
SHORTEST_WAY_M = 50.0


def front_m(run: Run) -> numpy.ndarray:
    """Where the leading end of the train is, at each record."""
    ends = run.recording.state["position_m"][:, [0, -1]] + 0.5 * numpy.array([run.lengths_m[0], -run.lengths_m[-1]])
    return ends[:, 0] if run.recording.state["speed_mps"][:, 0].sum() >= 0.0 else ends[:, 1]


def permitted_kmh(run: Run, track: Track) -> numpy.ndarray:
    """The lowest limit under the train, at each record."""
    position = run.recording.state["position_m"]
    return track.limits.lowest(position[:, -1] - 0.5 * run.lengths_m[-1], position[:, 0] + 0.5 * run.lengths_m[0])


def notches(run: Run) -> numpy.ndarray:
    """Of the throttle (positive) or the dynamic brake (negative) that the last command asks for, at each record."""
    first = next((group for group in run.config["train"]["consist"] if group["vehicle"].get("traction")), {})
    at_start = first.get("initial_throttle_notch", 0.0) - first.get("initial_dynamic_brake_notch", 0.0)
    commands = [command for command in run.commands if "notch" in command]
    times = numpy.array([command["time_s"] for command in commands])
    values = [at_start] + [(-1.0 if c["kind"] == "dynamic_brake" else 1.0) * c["notch"] for c in commands]
    return numpy.array(values)[numpy.searchsorted(times, run.recording.state.time_s + 1e-9)]


def _why_not(run: Run) -> str:
    if run.recording.state is None:
        return "the recording has no topic of the type train_brake_msgs/TrainState"
    if run.config is None:
        return "the route is not known without the scenario of the run"
    way_m = numpy.ptp(run.recording.state["position_m"][:, 0])
    return f"the train moves by {way_m:.0f} m only" if way_m < SHORTEST_WAY_M else ""


def draw(group: Group) -> Figure:
    runs, not_shown = group.drawable(_why_not)
    first = runs[0]
    track = Track(first.config["track"])
    with_forces = [run for run in runs if run.recording.forces is not None and run.vehicles > 1]
    with_pressures = [run for run in runs if run.recording.pressures is not None]
    with_handles = [run for run in runs if any("notch" in command for command in run.commands)]
    kinds = ["speed"] + ["handles"] * bool(with_handles)
    kinds += ["forces"] * bool(with_forces) + ["pressures"] * bool(with_pressures)
    kinds += ["height", "grade"] * bool(track.grades) + ["curvature"] * bool(track.curvatures)
    sizes = {
        "speed": 3.2,
        "handles": 1.5,
        "forces": 2.4,
        "pressures": 1.7,
        "height": 1.6,
        "grade": 1.5,
        "curvature": 1.5,
    }
    canvas = new_canvas(sum(sizes[kind] for kind in kinds))
    panels = dict(
        zip(
            kinds,
            canvas.subplots(len(kinds), 1, sharex=True, squeeze=False, height_ratios=[sizes[kind] for kind in kinds])[
                :, 0
            ],
        )
    )
    at_m = {run: front_m(run) for run in runs}
    begin_m = min(at.min() for at in at_m.values())
    end_m = max(at.max() for at in at_m.values())
    caption = "Over the place of the train's leading end."

    for run in runs:
        panels["speed"].plot(KM * at_m[run], numpy.abs(run.mean_speed_kmh), label=run.label, **group.line(run))
    panels["speed"].set_ylabel("speed [km/h]")
    if track.limits:
        order = numpy.argsort(at_m[first], kind="stable")
        permitted = permitted_kmh(first, track)
        panels["speed"].plot(
            KM * at_m[first][order],
            permitted[order],
            color=style.INK,
            linewidth=1.3,
            linestyle=(0, (4, 2)),
            label="lowest limit under the train",
        )
        caption += " Dashed: the lowest speed limit under the whole train."
    panels["speed"].set_ylim(bottom=0.0)  # when all is drawn: it ends the search for the top
    if len(runs) > 1 or track.limits:
        style.legend_above(panels["speed"])
    for run in with_handles:
        panels["handles"].plot(KM * at_m[run], notches(run), drawstyle="steps-post", **group.line(run))
    if with_handles:
        panels["handles"].axhline(0.0, color=style.MUTED, linewidth=1.0)
        panels["handles"].set_ylabel("notch")
        panels["handles"].yaxis.set_major_locator(MaxNLocator(4, integer=True))
        caption += (
            " Notch: of the throttle (positive) or the dynamic brake (negative), of the last command to any locomotive."
        )
    for run in with_forces:
        forces = KN * run.recording.forces["coupler_force_n"]
        at = numpy.interp(run.recording.forces.time_s, run.recording.state.time_s, at_m[run])
        panels["forces"].plot(KM * at, forces.max(axis=1), **group.line(run))
        panels["forces"].plot(KM * at, forces.min(axis=1), **group.line(run))
    if with_forces:
        panels["forces"].axhline(0.0, color=style.MUTED, linewidth=1.0)
        panels["forces"].set_ylabel("coupler forces [kN]\nlargest in the train")
        caption += " Coupler forces: the largest tension (positive) and compression anywhere in the train."
    for run in with_pressures:
        at = numpy.interp(run.recording.pressures.time_s, run.recording.state.time_s, at_m[run])
        panels["pressures"].plot(
            KM * at, KPA * run.recording.pressures["cylinder_pressure_pa"].mean(axis=1), **group.line(run)
        )
    if with_pressures:
        panels["pressures"].set_ylabel("mean cylinder\npressure [kPa]")
    _draw_route(panels, track, begin_m, end_m)
    for panel in panels.values():
        panel.margins(x=0)
        panel.set_xlim(KM * begin_m, KM * end_m)
    panels[kinds[-1]].set_xlabel("position [km]")
    return Figure("over_the_distance", "Over the distance", caption + not_shown, canvas)


def _draw_route(panels: dict, track: Track, begin_m: float, end_m: float) -> None:
    if track.grades:
        at_m, height_m = track.heights(begin_m, end_m)
        panels["height"].plot(KM * at_m, height_m, color=style.INK)
        panels["height"].fill_between(
            KM * at_m, height_m, height_m.min() - 0.1 * numpy.ptp(height_m), color=style.MUTED, alpha=0.2, linewidth=0
        )
        panels["height"].set_ylabel("height [m]")
        at_m, grade = track.grades.line(begin_m, end_m)
        panels["grade"].plot(KM * at_m, PERMILLE * grade, color=style.BLUE)
        panels["grade"].axhline(0.0, color=style.MUTED, linewidth=1.0)
        panels["grade"].set_ylabel("grade [‰]")
    if track.curvatures:
        at_m, curvature = track.curvatures.line(begin_m, end_m)
        panels["curvature"].plot(KM * at_m, PERMILLE * curvature, color=style.VERMILLION)
        panels["curvature"].axhline(0.0, color=style.MUTED, linewidth=1.0)
        panels["curvature"].set_ylabel("curvature [1/km]\nright positive")
    last = -numpy.inf
    for at_m, name in track.stations:
        if not begin_m <= at_m <= end_m:
            continue
        for panel in panels.values():
            panel.axvline(KM * at_m, color=style.MUTED, linewidth=0.7, linestyle=":")
        if at_m - last < 0.04 * (end_m - begin_m):
            continue  # no room for the name
        last = at_m
        near_end = at_m > end_m - 0.1 * (end_m - begin_m)
        panels.get("height", panels["speed"]).annotate(
            name,
            (KM * at_m, 1.0),
            (-3 if near_end else 3, -2),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            va="top",
            ha="right" if near_end else "left",
            fontsize=9.5,
            color=style.MUTED,
        )


def braking_distance_m(run: Run) -> list:
    """[(stop's time, distance from the first pressure in any cylinder to the stop)] of each stop of the summary."""
    found = []
    pressures, state = run.recording.pressures, run.recording.state
    if pressures is None or state is None:
        return found
    braked = pressures["cylinder_pressure_pa"].max(axis=1) > 1e3
    way_m = state["position_m"].mean(axis=1)
    for stop in (run.summary or {}).get("stops", []):
        before = pressures.time_s <= stop["time_s"] + 1e-9
        if not before.any() or not braked[before][-1]:
            continue
        released = numpy.flatnonzero(~braked[before])
        begin_s = pressures.time_s[released[-1] + 1] if len(released) else pressures.time_s[0]
        ends = numpy.interp([begin_s, stop["time_s"]], state.time_s, way_m)
        found.append((stop["time_s"], abs(float(ends[1] - ends[0])), begin_s))
    return found


def _percentiles(run: Run) -> dict:
    """Of all recorded forces of all connections [kN]: name -> (tension, compression)."""
    forces = KN * run.recording.forces["coupler_force_n"]
    tension, compression = numpy.maximum(forces, 0.0), numpy.maximum(-forces, 0.0)
    return {
        name: (float(numpy.percentile(tension, share)), float(numpy.percentile(compression, share)))
        for name, share in (("50 %", 50), ("95 %", 95), ("99 %", 99), ("largest", 100))
    }


def _quantities(run: Run) -> list:
    """[(quantity, value with its unit)]: the main results for an engineer."""
    rows = []
    state, energy = run.recording.state, (run.summary or {}).get("energy", {})
    if state is not None:
        way_m = float(numpy.abs(numpy.diff(state["position_m"].mean(axis=1))).sum())
        rows.append(("distance run", f"{KM * way_m:.3f} km"))
        if run.config is not None:
            mass_t = 1e-3 * float(run.masses_kg.sum())
            rows.append(("mass, length of the train", f"{mass_t:.0f} t, {run.lengths_m.sum():.0f} m"))
            for key, name in (("traction_work_j", "work of traction"), ("gravity_work_j", "work of gravity")):
                if energy.get(key) and way_m > SHORTEST_WAY_M:
                    kj_per_tkm = 1e-3 * energy[key] / (mass_t * KM * way_m)
                    rows.append((f"{name} per tonne and km", minus(f"{kj_per_tkm:.1f} kJ ({kj_per_tkm / 3.6:.2f} Wh)")))
    for time_s, distance_m, begin_s in braking_distance_m(run):
        rows.append(
            (
                f"braking distance of the stop at {time_s:.1f} s",
                f"{distance_m:.1f} m from the first pressure in a cylinder at {begin_s:.1f} s",
            )
        )
    if run.recording.forces is not None and run.vehicles > 1:
        shares = _percentiles(run)
        for side, name in enumerate(("tension", "compression")):
            rows.append(
                (
                    f"in-train {name}, percentiles of all records and connections",
                    ", ".join(f"{share}: {values[side]:.0f} kN" for share, values in shares.items()),
                )
            )
    if state is not None and run.config is not None:
        track = Track(run.config["track"])
        if track.limits:
            excess = numpy.abs(run.mean_speed_kmh) - permitted_kmh(run, track)
            over_s = float(((excess > 0.0)[:-1] * numpy.diff(state.time_s)).sum())
            rows.append(
                (
                    "above the lowest limit under the train",
                    f"{over_s:.1f} s, by up to {excess.max():.1f} km/h" if over_s > 0.0 else "never",
                )
            )
    return rows


def quantities(group: Group) -> Figure:
    columns = {run: _quantities(run) for run in group.runs}
    names = []
    for rows in columns.values():
        names += [name for name, _ in rows if name not in names]
    if not names:
        raise LeftOut("The recording has nothing that this table needs.")
    values = {run: dict(rows) for run, rows in columns.items()}
    return Figure(
        "engineering_numbers",
        "Engineering numbers",
        "Percentiles count every record of every connection once."
        + (
            " kJ per tonne and km refer to the whole train's mass."
            if any("per tonne" in name for name in names)
            else ""
        ),
        table=Table(
            [""] + [run.label for run in group.runs],
            [[name] + [values[run].get(name, "") for run in group.runs] for name in names],
        ),
    )


def consist_table(group: Group) -> Figure:
    runs, not_shown = group.drawable(
        lambda run: "" if run.config else "the train is not known without the scenario of the run"
    )
    run = runs[0]
    rows = []
    for first, last, item in consist.groups(run.config["train"]):
        vehicle, count = item["vehicle"], item["count"]
        mass_t = 1e-3 * consist.mass_kg(vehicle)
        rows.append(
            [
                f"{first}" if first == last else f"{first} to {last}",
                vehicle.get("name", ""),
                f"{count}",
                item.get("model") or run.config["model"],
                f"{mass_t:.1f}",
                f"{count * mass_t:.1f}",
                f"{vehicle['length_m']:g}",
                f"{count * vehicle['length_m']:.1f}",
                f"{vehicle['load_fraction']:g}" if vehicle.get("load") and "load_fraction" in vehicle else "",
            ]
        )
    rows.append(
        [
            "all",
            "",
            f"{run.vehicles}",
            "",
            "",
            f"{1e-3 * run.masses_kg.sum():.1f}",
            "",
            f"{run.lengths_m.sum():.1f}",
            "",
        ]
    )
    of = f" Of {run.label}." if len(group.runs) > 1 else ""
    head = [
        "vehicles",
        "kind",
        "count",
        "model",
        "mass of one [t]",
        "of the group [t]",
        "length of one [m]",
        "of the group [m]",
        "load fraction",
    ]
    if not any(row[-1] for row in rows):
        head, rows = head[:-1], [row[:-1] for row in rows]
    return Figure("consist", "Consist", f"From front to rear.{of}{not_shown}", table=Table(head, rows))
