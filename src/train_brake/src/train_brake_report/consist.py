"""The vehicles of a run, as config.yaml describes them."""

from typing import Iterator, Tuple

import numpy


def mass_kg(vehicle: dict) -> float:
    """Of a vehicle of config.yaml with what it carries."""
    load = (vehicle.get("load") or {}).get("mass_kg", 0.0) * vehicle.get("load_fraction", 1.0)
    if vehicle.get("mass_kg"):
        return vehicle["mass_kg"] + load
    return (
        vehicle["carbody"]["mass_kg"]
        + 2 * (vehicle["bolster"]["mass_kg"] + 4 * vehicle["wedge_mass_kg"])
        + 2 * vehicle["bogie_frame"]["mass_kg"]
        + 2 * vehicle.get("wheelsets_per_bogie", 2) * vehicle["wheelset"]["mass_kg"]
        + load
    )


def groups(train: dict) -> Iterator[Tuple[int, int, dict]]:
    """(number of the first vehicle, of the last, the group) of each group of a train of config.yaml."""
    first = 1
    for group in train["consist"]:
        yield first, first + group["count"] - 1, group
        first += group["count"]


def masses_kg(train: dict) -> numpy.ndarray:
    """[vehicle]"""
    return numpy.concatenate([numpy.full(group["count"], mass_kg(group["vehicle"])) for group in train["consist"]])


def lengths_m(train: dict) -> numpy.ndarray:
    """[vehicle], over couplers"""
    return numpy.concatenate([numpy.full(group["count"], group["vehicle"]["length_m"]) for group in train["consist"]])
