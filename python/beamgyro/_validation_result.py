# SPDX-License-Identifier: MIT
"""What a validation found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Optional

from beamgyro import _lazy
from beamgyro._compensation import Compensator
from beamgyro._results import Report
from beamgyro._validation_html import page

if TYPE_CHECKING:
    import pandas as pd  # type: ignore[import]


def _ends(estimate: Any, prefix: str) -> dict[str, Any]:
    """Return the value of a figure and the ends of its interval."""
    known = estimate or {}
    low, high = known.get("interval") or (None, None)
    return {prefix: known.get("value"), f"{prefix}_low": low,
            f"{prefix}_high": high}


def _metric_row(one: dict[str, Any]) -> dict[str, Any]:
    return {"name": one["name"], "unit": one["unit"],
            **_ends(one.get("before"), "before"),
            **_ends(one.get("after"), "after"), "result": one.get("result")}


def _limit_row(one: dict[str, Any]) -> dict[str, Any]:
    return {"metric": one["metric"], "min": one["min"], "max": one["max"],
            **_ends(one.get("compared"), "value"), "margin": one.get("margin"),
            "result": one.get("result"), "source": one.get("source")}


class ValidationResult(Report):
    """Whether a compensator removes the drift and keeps the rate."""

    def __init__(self, text: str, json_text: str, warnings: Sequence[str],
                 page: str, junit: str, trained: Optional[Compensator]) -> None:
        super().__init__(text, json_text, warnings)
        self._page = page
        self._junit = junit
        self._trained = trained

    @property
    def verdict(self) -> str:
        """ "pass", "fail" or "undecided"."""
        return str(self.data["verdict"])

    @property
    def passed(self) -> bool:
        """Whether the verdict is "pass"."""
        return self.verdict == "pass"

    @property
    def metrics(self) -> dict[str, dict[str, Any]]:
        """The metrics by name, with your own: unit, before, after, result."""
        return {one["name"]: one for one in self._metrics()}

    def _metrics(self) -> list[dict[str, Any]]:
        return [*self.data["metrics"], *self.data["own_metrics"]]

    @property
    def checks(self) -> dict[str, dict[str, Any]]:
        """The checks by name: passed, value, limit, words."""
        return {one["name"]: one for one in self.data["checks"]}

    @property
    def trained(self) -> Optional[Compensator]:
        """The compensator that was trained and judged, of a model; or None."""
        return self._trained

    def to_dataframe(self, table: str = "metrics") -> pd.DataFrame:
        """Return a table of pandas, indexed by name.

        Args:
            table: "metrics", with the ends of the intervals in columns of
                their own, "limits" or "checks".

        Raises:
            ValueError: there is no such table.
        """
        rows: dict[str, Any] = {
            "metrics": [_metric_row(one) for one in self._metrics()],
            "limits": [_limit_row(one) for one in self.data["limits"]],
            "checks": self.data["checks"]}
        if table not in rows:
            raise ValueError(f"table {table!r}: expected one of "
                             f"{', '.join(rows)}")
        made: pd.DataFrame = _lazy.module("pandas").DataFrame(rows[table])
        return made if made.empty else made.set_index(
            "metric" if table == "limits" else "name")

    def to_html(self) -> str:
        """Return the page that ``--report`` writes."""
        return self._page

    def to_junit(self) -> str:
        """Return the XML that ``--junit`` writes."""
        return self._junit

    def _repr_html_(self) -> str:
        return page(self.data)
