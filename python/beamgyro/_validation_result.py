# SPDX-License-Identifier: MIT
"""What a validation found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

from beamgyro._compensation import Compensator
from beamgyro._results import Report
from beamgyro._validation_html import page


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

    def to_html(self) -> str:
        """Return the page that ``--report`` writes."""
        return self._page

    def to_junit(self) -> str:
        """Return the XML that ``--junit`` writes."""
        return self._junit

    def _repr_html_(self) -> str:
        return page(self.data)
