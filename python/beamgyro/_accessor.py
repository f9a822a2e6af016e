# SPDX-License-Identifier: MIT
"""The accessor `.beamgyro` of xarray datasets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import xarray

from beamgyro import _lazy
from beamgyro._analysis import allan
from beamgyro._compensation import compensate
from beamgyro._dataset import Path, save_recording, warn_of_lost_units
from beamgyro._results import AllanResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class RecordingAccessor:
    """What beamgyro does with a recording: ``dataset.beamgyro``."""

    def __init__(self, dataset: xarray.Dataset) -> None:
        self._dataset = dataset

    def measured(self) -> xarray.Dataset:
        """Return the measured variables: what a compensator may see."""
        names = [name for name, variable in self._dataset.data_vars.items()
                 if variable.attrs.get("role") == "measured"]
        return self._dataset[names]

    def compensate(self, compensator: Any) -> xarray.Dataset:
        """Add what a compensator answers; see `beamgyro.compensate`."""
        return compensate(compensator, self._dataset)

    def allan(self, **options: Any) -> AllanResult:
        """Compute Allan deviations; see `beamgyro.allan`."""
        return allan(self._dataset, **options)

    def save(self, path: Path) -> None:
        """Write the recording; see `beamgyro.save_recording`."""
        save_recording(self._dataset, path)

    def plot(self, ax: Optional[Axes] = None, panel: str = "rate") -> Figure:
        """Draw the recording, and return the figure of matplotlib.

        Args:
            ax: axes of yours, in which one panel is drawn; without it a new
                figure has all of them, and a notebook shows it.
            panel: which one: "rate", "error", "left" (what a compensator
                leaves), "temperature", "drive_frequency" or "quadrature".
        """
        _lazy.module("matplotlib")
        warn_of_lost_units(self._dataset)
        plots = _lazy.module("beamgyro.plots")
        drawn: Figure = plots.plot(self._dataset) if ax is None else \
            plots.plot_recording(self._dataset, ax=ax, panel=panel)
        return drawn


def _register() -> None:
    register: Any = xarray.register_dataset_accessor
    if not hasattr(xarray.Dataset, "beamgyro"):
        register("beamgyro")(RecordingAccessor)


_register()
