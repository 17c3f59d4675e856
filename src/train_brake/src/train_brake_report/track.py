"""The route of a run, as config.yaml describes it: what is at a position along it."""

from typing import List, Optional, Tuple

import numpy

PERMILLE = 1e3


class Steps:
    """A quantity that is constant between positions; the first value holds before its position as well."""

    def __init__(self, steps: List[Tuple[float, float]]):
        self.from_m = numpy.array([s[0] for s in steps])
        self.value = numpy.array([s[1] for s in steps])

    def __bool__(self) -> bool:
        return len(self.value) > 0

    def at(self, position_m) -> numpy.ndarray:
        return self.value[numpy.maximum(numpy.searchsorted(self.from_m, position_m, side="right") - 1, 0)]

    def lowest(self, rear_m: numpy.ndarray, front_m: numpy.ndarray) -> numpy.ndarray:
        """Under a train from its rear to its front, position by position."""
        first = numpy.maximum(numpy.searchsorted(self.from_m, rear_m, side="right") - 1, 0)
        last = numpy.maximum(numpy.searchsorted(self.from_m, front_m, side="right") - 1, 0)
        return numpy.array([self.value[a : b + 1].min() for a, b in zip(first, last)])

    def line(self, begin_m: float, end_m: float) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """Its corners between two positions, to be drawn as straight lines."""
        inner = self.from_m[(self.from_m > begin_m) & (self.from_m < end_m)]
        ends = numpy.concatenate(([begin_m], inner, [end_m]))
        return numpy.repeat(ends, 2)[1:-1], numpy.repeat(self.at(ends[:-1]), 2)


class Track:
    """A track of config.yaml; grades as ratio, curvatures in 1/m to the right positive, limits in km/h."""

    def __init__(self, config: dict):
        points = [
            dict(point, at=point["position_m"] if "position_m" in point else 1e3 * point["position_km"])
            for point in config.get("points") or []
        ]

        def of_points(key: str, factor: float = 1.0) -> list:
            return [(point["at"], factor * point[key]) for point in points if key in point]

        heights = [(h["position_m"], h["height_m"]) for h in config.get("heights") or []] or of_points("height_m")
        self.grades = Steps(
            [(g["from_m"], 0.01 * g["grade_percent"]) for g in config.get("grades") or []]
            or sorted(of_points("grade_permille", 1e-3) + of_points("grade_percent", 0.01))
            or _grades_between(heights)
        )
        curves = []
        for curve in config.get("curves") or []:
            if curves and curves[-1][0] == curve["from_m"]:
                curves.pop()
            elif not curves:
                curves.append((curve["from_m"] - 1.0, 0.0))
            curves += [(curve["from_m"], 1.0 / curve["radius_m"]), (curve["to_m"], 0.0)]
        self.curvatures = Steps(
            curves or [(at, 1.0 / radius if radius else 0.0) for at, radius in of_points("radius_m")]
        )
        self.limits = Steps(
            [(limit["from_m"], limit["limit_kmh"]) for limit in config.get("speed_limits") or []]
            or of_points("speed_limit_kmh")
        )
        self.stations = sorted(
            [(s["position_m"], s["name"]) for s in config.get("stations") or []]
            + [(point["at"], point["station"]) for point in points if point.get("station")]
        )
        self._known: Optional[Tuple[float, float]] = heights[0] if heights else None

    def heights(self, begin_m: float, end_m: float) -> Tuple[numpy.ndarray, numpy.ndarray]:
        """(positions, heights [m]): as given, or 0 where the stretch begins."""
        known = self._known or (begin_m, 0.0)
        cuts = self.grades.from_m if self.grades else numpy.array([])
        inner = cuts[(cuts > begin_m) & (cuts < end_m)]
        at = numpy.unique(numpy.concatenate(([begin_m, known[0], end_m], inner, cuts if self._known else [])))
        rise = numpy.diff(at) * (self.grades.at(at[:-1]) if self.grades else 0.0)
        height = numpy.concatenate(([0.0], numpy.cumsum(rise)))
        height += known[1] - height[numpy.searchsorted(at, known[0])]
        shown = (at >= begin_m) & (at <= end_m)
        return at[shown], height[shown]


def _grades_between(heights: list) -> list:
    if not heights:
        return []
    steps = [(heights[0][0] - 1.0, 0.0)]
    for (here, low), (there, high) in zip(heights, heights[1:]):
        steps.append((here, (high - low) / (there - here)))
    return steps + [(heights[-1][0], 0.0)]
