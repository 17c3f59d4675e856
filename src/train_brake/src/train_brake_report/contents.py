"""The contents of the page, in reading order."""

from typing import Callable, List, Tuple, Union

from train_brake_report.figure import Figure, LeftOut
from train_brake_report.figures import (
    air_brake,
    brake_table,
    changes,
    couplers,
    dip,
    energy,
    pressures,
    route,
    space_time,
    speeds,
    vehicle,
    wheel_forces,
    wheel_slides,
)
from train_brake_report.group import Group

Item = Union[Figure, Tuple[str, str]]  # a figure, or (title, why it is left out)

OF_RUNS: List[Tuple[str, Callable[[Group], Figure]]] = [
    ("What differs between the runs", changes.table),
    ("Speed", speeds.draw),
    ("Over the distance", route.draw),
    ("Engineering numbers", route.quantities),
    ("Consist", route.consist_table),
    ("Cylinder pressures", pressures.draw),
    ("Cylinder pressure and wave speed over the reduction", brake_table.draw),
    ("Shoe and wheel", wheel_forces.draw),
    ("Largest coupler forces along the train", couplers.draw_largest),
    ("Force of a coupler", couplers.draw_history),
    ("Coupler force, whole train", space_time.draw_force),
    ("Cylinder pressure, whole train", space_time.draw_pressure),
    ("Brake pipe, whole train", space_time.draw_pipe),
    ("Air in the brake", air_brake.draw),
    ("Brake wave", space_time.draw_wave),
    ("Wheel slip, whole train", space_time.draw_slip),
    ("Wheels that slide", wheel_slides.draw_slides),
    ("Wear and brake force along the track", wheel_slides.draw_wear),
    ("Acceleration, whole train", space_time.draw_acceleration),
    ("Energy ledger", energy.draw),
    ("A wagon over the dip", dip.draw),
]


def _draw(title: str, draw: Callable, *arguments) -> Item:
    try:
        return draw(*arguments)
    except LeftOut as left_out:
        return title, str(left_out)


def of_runs(group: Group) -> List[Item]:
    items = [_draw(title, draw, group) for title, draw in OF_RUNS]
    items = [
        item for item in items if isinstance(item, Figure) or item[1]
    ]  # without a reason: there is nothing to miss
    if group.name:
        for item in items:
            if isinstance(item, Figure):
                item.name = f"{group.name}_{item.name}"
    return items


def of_vehicle(vehicle_file: str, train_sim: List[str]) -> List[Item]:
    return [
        _draw("Adhesion characteristics", vehicle.draw_adhesion, vehicle_file, train_sim),
        _draw("Modes of vibration", vehicle.mode_table, vehicle_file, train_sim),
    ]
