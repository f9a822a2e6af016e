# SPDX-License-Identifier: MIT
"""Logs of real gyros."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

from beamgyro import _checks, _core, _toml
from beamgyro._dataset import Path, dataset_of

if TYPE_CHECKING:
    import xarray as xr


def import_log(log: Path, map: Union[Path, Mapping[str, Any]], *,
               axis: Optional[str] = None, join: Optional[Path] = None
               ) -> xr.Dataset:
    """Convert a log of a real gyro into a recording.

    Saved, it has the bytes that ``beamgyro import`` writes for the same
    files. ``encoding["beamgyro"]["import"]`` is what that prints: how many
    rows were kept, which were dropped and why.

    Args:
        log: delimiter-separated text with one sample in each row.
        map: what its columns mean: a file, or its contents as a nested
            mapping.
        axis: "x", "y" or "z" where the map has several.
        join: the second log of a map with a table ``join``.

    Raises:
        ValueError: with file, line and column, what is wrong in the log or
            the map.
    """
    text = _toml.text(map) if _checks.is_table(map) else None
    found, report = _core.import_log(
        _checks.path(log, "log"),
        "map" if text is not None else _checks.file(
            map, "map", "a log map", _checks.MAPPING), text,
        "" if axis is None else _checks.text(axis, "axis"),
        "" if join is None else _checks.path(join, "join"))
    dataset = dataset_of(found)
    dataset.encoding["beamgyro"]["import"] = report
    return dataset
