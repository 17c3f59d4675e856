"""The speed of the brake wave, from the recorded cylinder pressures alone.

1. When it reaches a vehicle: a straight line through the pressure's first rise (or fall), from 0.5 % to 5 % of it,
   meets the pressure before at the arrival t_i. The rise is no straight line; that shifts t_i by about 1 % of 1/beta
   times 0.1 (1 ms), nearly the same for neighbours.
2. Along the train t_i goes up and down: waves leave several sources and meet. A branch is a stretch where t_i climbs or
   falls steadily with the distance d_i behind the first vehicle, without its end: there the other wave may be first.
3. All branches share one slowness s = 1/c [s/m], each has its own start: least squares over

     t_i = t_b +- s (d_i - d_b)      =>      s = sum_b +- sum_i (d_i - d_b)(t_i - t_b) / sum_b sum_i (d_i - d_b)^2

   with t_b, d_b the branch's means. Its standard error follows from the residuals.
"""

import dataclasses
from typing import Callable, List, Optional, Tuple

import numpy

from train_brake_report.figure import LeftOut
from train_brake_report.run import Run

MOVED_PA = 100.0  # less is the rounding of a standing pressure
FIRST, LAST = 0.005, 0.05  # of the rise: the samples that the arrival is found from
FIRST_RECORDS = 3  # what begins to fall within them may have begun before
SYSTEMATIC = 2e-4  # of the speed: the rise is curved, and that shifts the arrivals (measured on the paper's scenarios)
STEADY = 0.1  # how far the slowness between two neighbours of a branch may be from the typical one, as a share


@dataclasses.dataclass
class Branch:
    first: int  # index from 0 of its vehicle nearest to the front
    last: int
    sign: int  # +1: the wave runs to the rear
    time_s: numpy.ndarray  # fitted arrivals of first ... last


@dataclasses.dataclass
class Wave:
    arrival_s: numpy.ndarray  # [vehicle]
    distance_m: numpy.ndarray  # [vehicle] behind the first
    branches: List[Branch]
    speed_mps: float
    speed_error_mps: float  # standard error
    residual_s: float  # root of the mean square

    def sources(self) -> List[Tuple[int, float]]:
        """Vehicles, from 1, where waves are seen to begin, and when: before both of their neighbours."""
        starts = {b.first if b.sign > 0 else b.last for b in self.branches}
        around = numpy.concatenate([[numpy.inf], self.arrival_s, [numpy.inf]])  # of vehicle i: i and i + 2
        return [
            (i + 1, float(self.arrival_s[i]))
            for i in sorted(starts)
            if self.arrival_s[i] <= around[i] and self.arrival_s[i] <= around[i + 2]
        ]


def arrivals(time_s: numpy.ndarray, pressure_pa: numpy.ndarray) -> numpy.ndarray:
    """[vehicle] when the pressure [record, vehicle] begins to rise from its first value; nan where it does not."""
    rise = pressure_pa - pressure_pa[0]
    full = rise.max(axis=0)
    found = numpy.full(rise.shape[1], numpy.nan)
    for vehicle in numpy.flatnonzero(full > MOVED_PA):
        share = rise[:, vehicle] / full[vehicle]
        above = share > FIRST
        begin = above.argmax()
        end = begin + (share[begin:] > LAST).argmax()
        if end - begin >= 2:
            slope, offset = numpy.polyfit(time_s[begin:end], share[begin:end], 1)
            found[vehicle] = -offset / slope
    return found


def _branches(arrival_s: numpy.ndarray, distance_m: numpy.ndarray) -> List[Tuple[int, int, int]]:
    """(first, last, sign) of each stretch of at least three vehicles, its end left out."""
    slowness = numpy.diff(arrival_s) / numpy.diff(distance_m)
    if not numpy.isfinite(slowness).any():
        return []
    typical = numpy.nanmedian(numpy.abs(slowness))
    steady = numpy.abs(numpy.abs(slowness) - typical) < STEADY * typical
    kind = numpy.where(steady, numpy.sign(slowness), 0)
    edges = numpy.flatnonzero(numpy.diff(kind)) + 1
    stretches = zip(numpy.concatenate([[0], edges]), numpy.concatenate([edges, [len(kind)]]))
    return [
        (int(a), int(b) - 1, 1) if kind[a] > 0 else (int(a) + 1, int(b), -1)
        for a, b in stretches
        if kind[a] != 0 and b - a >= 3
    ]


def fit(
    time_s: numpy.ndarray,
    pressure_pa: numpy.ndarray,
    distance_m: numpy.ndarray,
    moving: Callable[[numpy.ndarray], numpy.ndarray] = lambda arrival_s: numpy.zeros(len(arrival_s), bool),
) -> Wave:
    """Raises LeftOut if no wave is to be seen. moving: at which vehicles, by their arrivals, it had begun before."""
    if len(distance_m) < 4:
        raise LeftOut("A wave is seen on a train of four vehicles or more.")
    arrival = arrivals(time_s, pressure_pa)
    before = moving(arrival)
    arrival[before] = numpy.nan
    if before.any() and numpy.isfinite(arrival).sum() < 4:
        raise LeftOut(
            f"The pressures of {before.sum()} of {len(before)} vehicles had begun to move before the recording: "
            "when the wave reached them is not known."
        )
    if numpy.isfinite(arrival).sum() < 4:
        raise LeftOut("Fewer than four vehicles were seen to begin to brake or release.")
    stretches = _branches(arrival, distance_m)
    if not stretches:
        raise LeftOut("The pressures begin to move in no order along the train that would be a wave.")
    cross = square = 0.0
    for first, last, sign in stretches:
        d, t = distance_m[first : last + 1], arrival[first : last + 1]
        cross += sign * ((d - d.mean()) * (t - t.mean())).sum()
        square += ((d - d.mean()) ** 2).sum()
    slowness = cross / square
    branches, residuals = [], []
    for first, last, sign in stretches:
        d, t = distance_m[first : last + 1], arrival[first : last + 1]
        branches.append(Branch(first, last, sign, t.mean() + sign * slowness * (d - d.mean())))
        residuals.append(t - branches[-1].time_s)
    residual = numpy.concatenate(residuals)
    freedom = max(1, len(residual) - len(branches) - 1)
    slowness_error = numpy.sqrt((residual**2).sum() / freedom / square)
    return Wave(
        arrival,
        distance_m,
        branches,
        1.0 / slowness,
        slowness_error / slowness**2,
        float(numpy.sqrt((residual**2).mean())),
    )


def _distances(run: Run) -> numpy.ndarray:
    if run.recording.state is None:
        raise LeftOut("The wave's speed needs the positions of the vehicles, and the bag has no TrainState.")
    position = run.recording.state["position_m"][0]
    return position[0] - position


def application(run: Run) -> Wave:
    """The first rise of the pressures."""
    table = run.recording.pressures
    pressure = table["cylinder_pressure_pa"].astype(float)
    return fit(table.time_s, pressure, _distances(run), lambda _: pressure[0] > MOVED_PA)


def release(run: Run) -> Wave:
    """The fall of the pressures from their largest values."""
    table = run.recording.pressures
    pressure = table["cylinder_pressure_pa"].astype(float)
    fall = numpy.maximum.accumulate(pressure, axis=0) - pressure
    end_s = table.time_s[min(FIRST_RECORDS, len(table)) - 1]
    return fit(table.time_s, fall, _distances(run), lambda arrival_s: arrival_s < end_s)


def configured_speed_mps(run: Run, is_release: bool) -> Optional[float]:
    """Of the first command of that kind; None if the configuration does not say it."""
    brake = (run.config or {}).get("brake")
    commands = [c for c in run.brake_commands if (c["kind"] == "release") == is_release]
    if not brake or not commands or run.config.get("pressure_table") or "service" not in brake:
        return None
    if is_release:
        return brake["release"]["wave_speed_mps"]
    if commands[0]["kind"] == "emergency":
        return brake["emergency"]["wave_speed_mps"]
    # Between the measured reductions the simulation interpolates more smoothly than this: no statement there.
    service = brake["service"]
    measured = dict(zip(service["reduction_kpa"], service["wave_speed_mps"]))
    return measured.get(commands[0]["reduction_kpa"])
