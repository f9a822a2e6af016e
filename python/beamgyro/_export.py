# SPDX-License-Identifier: MIT
"""Export of trained compensators to firmware and autopilots."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any, Optional

from beamgyro import _arguments, _checks, _core
from beamgyro._compensation import compensator_of
from beamgyro._dataset import Path
from beamgyro._warnings import warn


def _int32(value: Any, name: str) -> int:
    return _arguments.whole(value, name, -2 ** 31, 2 ** 31 - 1)


def _rest(value: Any, name: str) -> str:
    return _checks.file(value, name, "a recording")


_EXPORT_OPTIONS: dict[str, Callable[[Any, str], Any]] = {
    "name": _checks.text, "axes": _checks.texts, "force": _checks.flag,
    "fit_cubic": _checks.flag, "instance": _int32,
    "device_id": _arguments.whole, "rest": _rest,
    "ramp_K_per_min": _arguments.number, "correlation_K": _arguments.number,
    "temperature_degC": _arguments.number}


def export(compensators: Any, format: str,
           directory: Optional[Path] = None, **options: Any
           ) -> dict[str, str]:
    """Export trained compensators as ``beamgyro export`` does.

    Args:
        compensators: one, or a sequence of up to three for the axes.
        format: "c", "px4", "ardupilot" or "ekf".
        directory: where the files are written; without, nowhere.
        options: name, axes, force, fit_cubic, instance, device_id, rest,
            ramp_K_per_min, correlation_K, temperature_degC.

    Returns:
        The texts of the files by name.

    Raises:
        ValueError: the format cannot hold the compensator, an option is not
            for it, or the directory cannot be made.
        RuntimeError: writing failed.
    """
    for name in options:
        if name not in _EXPORT_OPTIONS:
            raise ValueError(f"{name}: no option of export; expected one of "
                             f"{', '.join(sorted(_EXPORT_OPTIONS))}")
    several = (compensators if isinstance(compensators, (list, tuple))
               else [compensators])
    folder = None if directory is None else FilePath(_checks.path(
        directory, "directory", "the name of a directory"))
    files, warnings = _core.export_files(
        [compensator_of(one)._trained("formula") for one in several],
        _checks.text(format, "format"),
        _checks.given(_EXPORT_OPTIONS, **options))
    warn(warnings)
    if folder is not None:
        _core.write_texts(folder, files)
    return dict(files)
