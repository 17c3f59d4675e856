"""Time series of many vehicles: common instants of two runs, and what is left of them in a picture."""

from typing import Tuple

import numpy


def common_rows(time_a_s: numpy.ndarray, time_b_s: numpy.ndarray) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """Indices of the records of two runs that are of the same instants, to the microsecond."""
    _, a, b = numpy.intersect1d(numpy.round(1e6 * time_a_s), numpy.round(1e6 * time_b_s), return_indices=True)
    return a, b


def decimate(values: numpy.ndarray, columns: int) -> numpy.ndarray:
    """[record, vehicle] to [vehicle, column]: of the records of a column the value of the largest size, so that no peak
    is lost. Columns share the records evenly; with fewer records than columns each record is a column."""
    records = len(values)
    columns = min(columns, records)
    edges = numpy.linspace(0, records, columns + 1).astype(int)
    largest = numpy.maximum.reduceat(values, edges[:-1])
    smallest = numpy.minimum.reduceat(values, edges[:-1])
    return numpy.where(largest >= -smallest, largest, smallest).T
