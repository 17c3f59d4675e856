"""One wagon over a dip of the track (the paper's Figure 5)."""

import numpy

from train_brake_report import style
from train_brake_report.figure import Figure, LeftOut, minus, new_canvas
from train_brake_report.group import Group

CARBODY, FRAME_FRONT = 0, 3  # of WagonState
WHEELS = 2  # of a wheelset
KN, MRAD = 1e-3, 1e3
AFTER_S = 1.5  # for which the wagon is shown after its last wheel has left the dip


def _passage(wagon, config: dict, dip: dict) -> numpy.ndarray:
    """The records from just before the first wheel enters until after the last has left."""
    vehicle = config["train"]["consist"][0]["vehicle"]
    reach = vehicle["half_bogie_spacing_m"] + vehicle["half_wheelset_spacing_m"]
    way = wagon["body_x_m"][:, CARBODY] + config["start_position_m"]
    inside = numpy.flatnonzero((way > dip["from_m"] - reach) & (way < dip["from_m"] + dip["length_m"] + reach))
    if not len(inside):
        raise LeftOut("The wagon did not cross the dip.")
    begin, end = wagon.time_s[inside[0]] - 0.2, wagon.time_s[inside[-1]] + AFTER_S
    return (wagon.time_s >= begin) & (wagon.time_s <= end)


def draw(group: Group) -> Figure:
    run = next((r for r in group.runs if (r.config or {}).get("track", {}).get("dips")), None)
    if run is None:
        raise LeftOut("The track has no dip.")
    wagon = run.recording.wagon
    if wagon is None:
        raise LeftOut(
            f"Vehicle {group.wagon} was not recorded in detail"
            + (
                f"; these were: {', '.join(map(str, run.recording.detailed_vehicles))}."
                if run.recording.detailed_vehicles
                else ", nor any other."
            )
        )
    dip = run.config["track"]["dips"][0]
    shown = _passage(wagon, run.config, dip)
    time_s = wagon.time_s[shown]
    canvas = new_canvas(6.0)
    above, below = canvas.subplots(2, 1, sharex=True)

    force_kn = KN / WHEELS * wagon["normal_force_n"][shown, 0]
    above.plot(time_s, force_kn, color=style.BLUE, label="wheel of the first wheelset")
    above.axhline(force_kn[0], color=style.MUTED, linewidth=1.0, linestyle=(0, (4, 3)), label="before the dip")
    above.set_ylabel("vertical force [kN]")
    style.legend_above(above)

    pitch = MRAD * wagon["body_pitch_rad"][shown]
    below.plot(time_s, pitch[:, FRAME_FRONT], color=style.VERMILLION, label="front bogie frame")
    below.plot(time_s, pitch[:, CARBODY], color=style.BLUE, label="carbody")
    half = run.config["train"]["consist"][0]["vehicle"]["half_wheelset_spacing_m"]
    geometric = MRAD * dip["depth_m"] * numpy.sin(2 * numpy.pi * half / dip["length_m"]) / (2 * half)
    for sign in (-1, 1):
        below.axhline(
            sign * geometric,
            color=style.MUTED,
            linewidth=1.0,
            linestyle=(0, (4, 3)),
            label="frame, by geometry alone" if sign > 0 else None,
        )
    below.set_ylabel("pitch, nose down [mrad]")
    below.set_xlabel("time [s]")
    for axes in (above, below):
        axes.margins(x=0)
    style.legend_above(below)

    frame = pitch[:, FRAME_FRONT]
    caption = (
        f"Dip of {1e3 * dip['depth_m']:g} mm on {dip['length_m']:g} m at {run.config['initial_speed_kmh']:g} km/h. "
        f"The wheel's force goes from {force_kn.min():.1f} to {force_kn.max():.1f} kN, {force_kn[0]:.1f} before; the "
        f"frame pitches by {minus(f'{frame.min():.2f}')} ... {minus(f'{frame.max():+.2f}')} mrad, where a rigid frame "
        f"on the rail's shape "
        f"would by ±{geometric:.2f}. The paper prints no numbers of it."
    )
    return Figure("dip", "A wagon over the dip", caption, canvas)
