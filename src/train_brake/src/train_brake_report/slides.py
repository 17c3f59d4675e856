"""Wheel slides: when a vehicle's wheels turn much slower than it runs."""

import dataclasses
from typing import List

import numpy

from train_brake.bag import Table

SLIDING = 0.10  # creepage; at 80 km/h adhesion is largest at 3 % on dry and 7 % on wet rail
LOCKED = 0.99
SLOWEST_MPS = 0.5  # below, creepage says little: a train that stops rocks on its standing wheels
JOINED_S = 0.5  # slides of a vehicle that are closer together are one


@dataclasses.dataclass
class Slide:
    vehicle: int  # from 1
    begin_s: float
    end_s: float
    largest_creepage: float

    @property
    def locked(self) -> bool:
        return abs(self.largest_creepage) >= LOCKED


def find_slides(state: Table) -> List[Slide]:
    """All of the train, in the order in which they begin. Creepage is that of the vehicle's worst wheelset."""
    creepage = state["creepage"]
    sliding = (numpy.abs(creepage) > SLIDING) & (numpy.abs(state["speed_mps"]) > SLOWEST_MPS)
    slides = []
    for vehicle in numpy.flatnonzero(sliding.any(axis=0)):
        records = numpy.flatnonzero(sliding[:, vehicle])
        parts = numpy.split(records, numpy.flatnonzero(numpy.diff(state.time_s[records]) > JOINED_S) + 1)
        for part in parts:
            during = creepage[part, vehicle]
            slides.append(
                Slide(
                    int(vehicle) + 1,
                    float(state.time_s[part[0]]),
                    float(state.time_s[part[-1]]),
                    float(during[numpy.abs(during).argmax()]),
                )
            )
    return sorted(slides, key=lambda slide: (slide.begin_s, slide.vehicle))
