# SPDX-License-Identifier: MIT
"""Export of trained compensators and devices to firmware and simulators."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path as FilePath
from typing import Any, Optional

from beamgyro import _arguments, _checks, _core
from beamgyro._compensation import compensator_of
from beamgyro._dataset import Path
from beamgyro._device import Device, device_of
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
_SIMULATOR_OPTIONS: dict[str, Callable[[Any, str], Any]] = {
    "name": _checks.text, "axes": _checks.texts, "fit_cubic": _checks.flag,
    "instance": _int32, "range_degC": _arguments.ends,
    "temperature_degC": _arguments.number,
    "update_rate_Hz": _arguments.number}
_SIMULATORS = ("ardupilot-sitl", "sdf")


def _is_device(source: Any) -> bool:
    return (isinstance(source, Device) or _checks.is_table(source)
            or isinstance(source, (str, os.PathLike))
            and "a device file" in _core.kinds_of(
                _checks.path(source, "compensators")))


def _export_to_simulator(sources: Sequence[Any], format: str,
                         options: dict[str, Any]
                         ) -> tuple[list[tuple[str, str]], list[str]]:
    return _core.export_for_simulator(
        [device_of(one)._native for one in sources if _is_device(one)],
        [compensator_of(one)._trained("formula") for one in sources
         if not _is_device(one)],
        format, options)


def export(compensators: Any, format: str,
           directory: Optional[Path] = None, **options: Any
           ) -> dict[str, str]:
    """Export compensators and devices as ``beamgyro export`` does.

    Args:
        compensators: one, or a sequence of up to three for the axes. For
            "ardupilot-sitl" devices, compensators or both; for "sdf" one
            device.
        format: "c", "px4", "ardupilot" or "ekf"; for simulators
            "ardupilot-sitl" or "sdf".
        directory: where the files are written; without, nowhere.
        options: name, axes, force, fit_cubic, instance, device_id, rest,
            ramp_K_per_min, correlation_K, temperature_degC; for simulators
            name, axes, fit_cubic, instance, range_degC, temperature_degC,
            update_rate_Hz.

    Returns:
        The texts of the files by name.

    Raises:
        ValueError: the format cannot hold the compensator, an option is not
            for it, or the directory cannot be made.
        RuntimeError: writing failed.
    """
    is_for_simulator = _checks.text(format, "format") in _SIMULATORS
    checks = _SIMULATOR_OPTIONS if is_for_simulator else _EXPORT_OPTIONS
    for name in options:
        if name not in checks:
            raise ValueError(f"{name}: no option of the format {format}; "
                             f"expected one of {', '.join(sorted(checks))}")
    several = (compensators if isinstance(compensators, (list, tuple))
               else [compensators])
    folder = None if directory is None else FilePath(_checks.path(
        directory, "directory", "the name of a directory"))
    given = _checks.given(checks, **options)
    files, warnings = (
        _export_to_simulator(several, format, given) if is_for_simulator
        else _core.export_files(
            [compensator_of(one)._trained("formula") for one in several],
            format, given))
    warn(warnings)
    if folder is not None:
        _core.write_texts(folder, files)
    return dict(files)
