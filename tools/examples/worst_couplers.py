#!/usr/bin/python3
"""The ten connections with the largest forces of a run, and what the brakes did then.

usage: worst_couplers.py RUN
"""
import sys

import numpy
import train_brake

run = train_brake.load(sys.argv[1])
couplers = run.couplers
pressure = run["brake_pressures"]
largest_n = numpy.maximum(couplers["max_tension_n"], -couplers["max_compression_n"])
print("connection   force [kN]   at [s]   cylinder pressure before and behind it [kPa]")
for i in numpy.argsort(-largest_n)[:10]:
    is_tension = couplers["max_tension_n"][i] >= -couplers["max_compression_n"][i]
    time_s = couplers["max_tension_time_s" if is_tension else "max_compression_time_s"][i]
    record = numpy.searchsorted(pressure.time_s, time_s).clip(0, len(pressure) - 1)
    before, behind = pressure["cylinder_pressure_pa"][record, i : i + 2] / 1e3
    print(
        f"{i + 1:10d} {(1 if is_tension else -1) * largest_n[i] / 1e3:12.1f} {time_s:8.2f} {before:10.0f} {behind:8.0f}"
    )
