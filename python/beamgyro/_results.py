# SPDX-License-Identifier: MIT
"""Results that print as a table, and show as one in notebooks."""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Optional

from beamgyro._scenario import Scenario

from beamgyro import _html, _lazy

if TYPE_CHECKING:
    import pandas as pd  # type: ignore[import]
    import xarray as xr


class Report:
    """A result: a table for people, and JSON for programs."""

    def __init__(self, text: str, json_text: str,
                 warnings: Sequence[str] = ()) -> None:
        self._text = text
        self._json = json_text
        self.warnings = list(warnings)
        self._data: Optional[dict[str, Any]] = None

    @property
    def data(self) -> dict[str, Any]:
        """The contents of the JSON file."""
        if self._data is None:
            self._data = json.loads(self._json)
        return self._data

    def to_json(self) -> str:
        """Return the JSON text, byte for byte what ``--json`` writes."""
        return self._json

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return self._text.rstrip("\n")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Report):
            return NotImplemented
        return type(self) is type(other) and self._json == other._json

    def __hash__(self) -> int:
        return hash(self._json)

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._text)}</pre>"


class AllanResult(Report):
    """Allan deviations and noise coefficients."""

    @property
    def coefficients(self) -> dict[str, Any]:
        """The noise coefficients that the curve shows, of Q, N, B, K and R.

        Each has ``per_second`` and ``per_hour`` with value, interval and
        unit.
        """
        found = self.data["noise"] or {}
        return {symbol: found[symbol] for symbol in "QNBKR"
                if found.get(symbol) is not None}

    def to_dataset(self, kind: str = "oadev") -> xr.Dataset:
        """Return a deviation over the averaging time ``tau`` [s]."""
        points = (self.data.get(kind) if isinstance(kind, str)
                  and kind.endswith("dev") else None)
        if points is None:
            raise ValueError(f"kind {kind!r}: was not computed; expected one "
                             "of the kinds that allan() was given")
        if not points:
            raise ValueError(f"kind {kind!r}: has no averaging time; expected "
                             "a longer series")
        xarray = _lazy.xarray()
        names = [name for name in points[0] if name != "tau_s"
                 and not isinstance(points[0][name], (list, dict))]
        made: xr.Dataset = xarray.Dataset(
            {name: ("tau", [one[name] for one in points]) for name in names},
            {"tau": ("tau", [one["tau_s"] for one in points],
                     {"units": "s"})}, {"kind": kind})
        return made


    def to_dataframe(self, kind: str = "oadev") -> pd.DataFrame:
        """Return a deviation as a table of pandas, indexed by ``tau`` [s]."""
        made: pd.DataFrame = self.to_dataset(kind).to_dataframe()
        return made


class PlanResult(Report):
    """The soaks that a new device needs."""

    def __init__(self, text: str, json_text: str, warnings: Sequence[str],
                 schedule: str, device: Any) -> None:
        super().__init__(text, json_text, warnings)
        self.schedule_text = schedule
        self._device = device

    @property
    def temperatures_degC(self) -> list[float]:
        """The temperatures of the chamber, in their order."""
        return list(self.data["schedule"]["temperatures_degC"])

    def to_dataframe(self) -> pd.DataFrame:
        """Return the soaks as a table of pandas, with begin and end [s]."""
        made: pd.DataFrame = _lazy.module("pandas").DataFrame(
            self.data["schedule"]["visits"])
        return made

    @property
    def schedule(self) -> Scenario:
        """The schedule as a scenario of the device."""
        return Scenario.parse(self.schedule_text, self._device,
                              "schedule.toml")


class CurveFiguresResult(Report):
    """What describes the curves of many units."""

    @property
    def figures(self) -> dict[str, list[Optional[float]]]:
        """The figures of each unit by name; None where there is none."""
        return {name: list(one["values"])
                for name, one in self.data["figures"].items()}


    def to_dataframe(self) -> pd.DataFrame:
        """Return the figures as a table of pandas, a row for each unit."""
        made: pd.DataFrame = _lazy.module("pandas").DataFrame(self.figures)
        return made


class SensitivityResult(Report):
    """Which tolerance causes the spread of which figure."""

    @property
    def figures(self) -> dict[str, list[dict[str, Any]]]:
        """The indices of each figure of merit, largest first."""
        return {name: list(one["indices"])
                for name, one in self.data["figures"].items()}

    def to_dataframe(self) -> pd.DataFrame:
        """Return the indices as a table of pandas, a row for each figure of
        merit and key."""
        made: pd.DataFrame = _lazy.module("pandas").DataFrame(
            [{"figure": name, **one} for name, indices in self.figures.items()
             for one in indices])
        return made

    def _repr_html_(self) -> str:
        parts = []
        for name, indices in self.figures.items():
            rows = [(one["key"], f"{one['first']:.3f}",
                     f"{one['total']:.3f}") for one in indices]
            parts.append(f"<p><b>{html.escape(name)}</b></p>"
                         + _html.table(("key", "first", "total"), rows))
        return "".join(parts)
