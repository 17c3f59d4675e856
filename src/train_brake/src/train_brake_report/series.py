"""Time series of many vehicles: common instants of two runs, and their reduction to the columns of a picture."""

from typing import Tuple

import numpy


def common_rows(time_a_s: numpy.ndarray, time_b_s: numpy.ndarray) -> Tuple[numpy.ndarray, numpy.ndarray]:
    """Indices of the records of two runs at the same instants, to the microsecond."""
    _, a, b = numpy.intersect1d(numpy.round(1e6 * time_a_s), numpy.round(1e6 * time_b_s), return_indices=True)
    return a, b


def decimate(time_s: numpy.ndarray, values: numpy.ndarray, columns: int) -> Tuple[numpy.ndarray, float, float]:
    """([vehicle, column], begin, end) of values [record, vehicle]: of the records in a column's time the value of the
    largest size, so that no peak is lost; nan without any. Columns share the time between begin and end evenly, at most
    so many that each has one record where none is missing."""
    interval_s = numpy.median(numpy.diff(time_s))
    columns = min(columns, int(round((time_s[-1] - time_s[0]) / interval_s)) + 1)
    begin_s, end_s = time_s[0] - 0.5 * interval_s, time_s[-1] + 0.5 * interval_s
    column = numpy.floor((time_s - begin_s) / (end_s - begin_s) * columns).astype(int)
    filled, first = numpy.unique(column, return_index=True)
    largest = numpy.maximum.reduceat(values, first)
    smallest = numpy.minimum.reduceat(values, first)
    picture = numpy.full((columns, values.shape[1]), numpy.nan)
    picture[filled] = numpy.where(largest >= -smallest, largest, smallest)
    return picture.T, begin_s, end_s
