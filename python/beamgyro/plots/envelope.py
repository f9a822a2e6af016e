# SPDX-License-Identifier: MIT
"""Long series as the lowest, mean and highest value of each short time.

A million samples become about a thousand bins; no extreme value is lost, as it
would be if every thousandth sample were drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Values = npt.NDArray[np.float64]
BINS = 1000  # finer than a picture in a document shows
MEANS = 250  # of a noisy series, so that noise does not hide its drift
GAP = 5.0  # median distances of samples
SHORTEST_LINE = 500  # of them make a picture wide


@dataclass
class Bins:
    """Which samples each bin holds."""

    time: Values  # middle of each bin, or of each sample
    starts: npt.NDArray[np.int64]  # first sample of each bin
    samples: int
    breaks: npt.NDArray[np.int64]  # bins before which a gap lies

    @property
    def merged(self) -> bool:
        return len(self.starts) < self.samples

    @property
    def width(self) -> float:
        """Duration of a bin."""
        return float(np.median(np.diff(self.time))) \
            if len(self.time) > 1 else 0.0


def bins_of(time: Values, most: int = BINS) -> Bins:
    """Bins of equal duration; those without a sample are left out."""
    count = len(time)
    step = np.diff(time)
    usual = np.median(step) if count > 1 else 0.0
    if count <= 2 * most:
        return Bins(time, np.arange(count), count,
                    np.flatnonzero(step > GAP * usual) + 1)
    edges = np.linspace(time[0], time[-1], most + 1)
    starts = np.unique(np.searchsorted(time, edges[:-1]))
    ends = np.append(starts[1:], count) - 1
    middle = (time[starts] + time[ends]) / 2
    width = (time[-1] - time[0]) / most
    gaps = time[starts[1:]] - time[ends[:-1]]
    return Bins(middle, starts, count,
                np.flatnonzero(gaps > GAP * max(usual, width / GAP)) + 1)


@dataclass
class Envelope:
    """Lowest, mean and highest value of each bin; NaN breaks the lines."""

    time: Values
    low: Values
    mean: Values
    high: Values


def means_of(starts: npt.NDArray[np.int64], values: Values) -> Values:
    """The mean of the finite values of each bin, by its first sample."""
    finite = np.isfinite(values)
    count = np.add.reduceat(finite, starts, dtype=float)
    count[count == 0] = np.nan
    means: Values = np.add.reduceat(np.where(finite, values, 0), starts) \
        / count
    return means


def envelope(bins: Bins, values: Values) -> Envelope:
    starts = bins.starts
    series = [bins.time, values, values, values]
    if bins.merged:
        series = [bins.time, np.fmin.reduceat(values, starts),
                  means_of(starts, values), np.fmax.reduceat(values, starts)]
    return Envelope(*(np.insert(one, bins.breaks, np.nan)
                      for one in series))


def lonely(found: Envelope, span: float) -> npt.NDArray[np.int64]:
    """The middle of each stretch of values that is too short to be seen as a
    line in a picture of this span."""
    there = np.isfinite(found.mean).astype(np.int8)
    edges = np.flatnonzero(np.diff(there, prepend=0, append=0))
    begins, lasts = edges[::2], edges[1::2] - 1
    short = found.time[lasts] - found.time[begins] <= span / SHORTEST_LINE
    middles: npt.NDArray[np.int64] = ((begins + lasts) // 2)[short]
    return middles


def spans(bins: Bins, flags: npt.NDArray[np.bool_]
          ) -> list[tuple[float, float]]:
    """Begin and end of each stretch of bins that hold a flagged sample. None
    is narrower than a bin."""
    flagged = np.logical_or.reduceat(flags, bins.starts)
    edges = np.flatnonzero(np.diff(flagged.astype(np.int8), prepend=0,
                                   append=0))
    half = bins.width / 2
    return [(float(bins.time[begin] - half), float(bins.time[end - 1] + half))
            for begin, end in zip(edges[::2], edges[1::2])]
