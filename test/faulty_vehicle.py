#!/usr/bin/python3
"""External vehicles with a fault, for tests: those of the example own_vehicle, spoilt.

usage: faulty_vehicle.py FAULT

FAULT is one of
  none
  active    they push themselves forward: their energy grows by itself
  velocity  the velocity that they tell is not the rate of their displacement
  nan       from exchange 20 on a velocity is not a number
  slow      exchange 20 takes 1.5 s
  light     they move as a tenth of their mass would
  random    the same loads move them otherwise each time
  deaf      they take loads that are not finite
"""
import importlib.machinery
import importlib.util
import math
import pathlib
import random
import time

import rospy
from train_brake_msgs.srv import StepResponse

EXAMPLE = pathlib.Path(__file__).resolve().parent.parent / "src" / "train_brake_examples" / "scripts" / "own_vehicle"
FAULT_EXCHANGE = 20


def load_example():
    loader = importlib.machinery.SourceFileLoader("own_vehicle", str(EXAMPLE))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("own_vehicle", loader))
    loader.exec_module(module)
    return module


class FaultyVehicles(load_example().OwnVehicles):
    def __init__(self, fault):
        self.fault = fault
        super().__init__()

    def move(self, i, pull_n, brake_n, dt_s, steps):
        if self.fault == "active":
            pull_n += 1e-3 * self.mass_kg[i]
        if self.fault == "light":
            pull_n *= 10
        if self.fault == "random":
            pull_n += random.uniform(-1, 1)
        super().move(i, pull_n, brake_n, dt_s, steps)

    def step(self, request):
        if self.fault == "deaf":
            request.coupler_force_n = [f if math.isfinite(f) else 0.0 for f in request.coupler_force_n]
        if self.fault == "slow" and request.exchange == FAULT_EXCHANGE:
            time.sleep(1.5)
        reply = super().step(request)
        told = StepResponse(
            ok=reply.ok,
            message=reply.message,
            exchange=reply.exchange,
            head_displacement_m=reply.head_displacement_m,
            head_velocity_mps=list(reply.head_velocity_mps),
        )
        if self.fault == "velocity":
            told.head_velocity_mps = [1.02 * v for v in told.head_velocity_mps]
        if self.fault == "nan" and request.exchange >= FAULT_EXCHANGE and told.ok:
            told.head_velocity_mps[-1] = math.nan
        return told


if __name__ == "__main__":
    rospy.init_node("faulty_vehicle", disable_rostime=True)
    FaultyVehicles(rospy.myargv()[1])
    rospy.spin()
