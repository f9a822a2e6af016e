# SPDX-License-Identifier: MIT
"""Metrics of the user's own, as functions."""

from __future__ import annotations

import math
import numbers as kinds
from collections.abc import Callable
from typing import Any

import numpy as np

from beamgyro import _checks, _core
from beamgyro._words import shown, wrong

Array = np.ndarray[Any, Any]

_FUNCTIONS = ("a mapping of names to functions, or to pairs of a function and "
              "its unit")


class MetricRun:
    """A run as a metric of your own reads it.

    ``run[name]`` is a column of the recording, such as "temperature" or
    "rate", as an array.

    Attributes:
        name: of the run.
        purpose: "soak", "ramp", "rate_table", ...
        rate: the rate that is judged [deg/s]: the recorded one for "before",
            the compensated one for "after". NaN where there is none.
    """

    __slots__ = ("name", "purpose", "rate", "_columns")

    def __init__(self, name: str, purpose: str, recording: _core.Recording,
                 rate: Array) -> None:
        self.name = name
        self.purpose = purpose
        self.rate = rate
        self._columns = recording.arrays()

    @property
    def time(self) -> Array:
        """The times of the samples [s]."""
        return self["time"]

    @property
    def true_rate(self) -> Array:
        """The true rate [deg/s]."""
        return self["true_rate"]

    @property
    def columns(self) -> list[str]:
        """The names of the columns."""
        return list(self._columns)

    def __getitem__(self, name: str) -> Array:
        if name not in self._columns:
            raise KeyError(f"{self.name}: no column {shown(name)}; expected "
                           f"one of {', '.join(self._columns)}")
        found: Array = self._columns[name]
        return found

    def __repr__(self) -> str:
        return f"<beamgyro.MetricRun {self.name}, {self.purpose}>"


def _value(found: Any, name: str) -> float:
    """Return what a function returned; None and NaN are no value."""
    if found is None:
        return math.nan
    if getattr(found, "ndim", None) == 0 and hasattr(found, "item"):
        found = found.item()
    if isinstance(found, bool) or not isinstance(found, kinds.Real):
        raise ValueError(f"metrics: {name} returned {shown(found)}; expected "
                         "a number, or None where there is none")
    try:
        return float(found)
    except OverflowError:
        return math.inf


def _called(name: str, function: Callable[[list[MetricRun]], Any]
            ) -> Callable[[list[Any]], float]:
    def value(runs: list[Any]) -> float:
        try:
            found = function([MetricRun(*run) for run in runs])
        except Exception as error:
            error.add_note(f"while beamgyro evaluated the metric {name}")
            raise
        return _value(found, name)
    return value


def own_metrics(given: Any, keyword: str) -> list[tuple[str, str, Any]]:
    """Return (name, unit, function) of each metric of a mapping."""
    if not _checks.is_table(given):
        raise wrong(given, keyword, _FUNCTIONS)
    found = []
    for name, entry in given.items():
        pair = entry if isinstance(entry, tuple) else (entry, "1")
        if len(pair) != 2 or not callable(pair[0]):
            raise wrong(entry, f"{keyword}: {shown(name)}",
                        "a function, or a pair of a function and its unit")
        found.append((_checks.text(name, keyword),
                      _checks.text(pair[1], f"{keyword}: {shown(name)}"),
                      _called(name, pair[0])))
    return found
