# SPDX-License-Identifier: MIT
"""Gyros, as device files describe them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy, _toml
from beamgyro._checks import Path as Path
from beamgyro._native import Native, Wrapper
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

Keys = Mapping[str, Any]
DeviceLike = Union["Device", Path, Keys]


class Device(Wrapper):
    """A gyro: what a device file says, read and checked.

    It does not change. Two devices are equal when their texts and their
    replaced keys are; a device pickles as these.

    Args:
        source: a device file, or its contents as a nested mapping.
        set: keys to replace, dotted or nested:
            ``{"beam.length_m": 0.041}``.

    Raises:
        ValueError: with file, line and key, what is wrong.
    """

    __slots__ = ()

    _native: _core.Device

    def __init__(self, source: DeviceLike,
                 set: Optional[Keys] = None) -> None:
        overrides = _toml.overrides(set)
        if isinstance(source, Device):
            self._native = (source._native.with_(overrides) if overrides
                          else source._native)
        elif _checks.is_table(source):
            self._native = _core.Device.parse(_toml.text(source), "device",
                                              overrides)
        else:
            self._native = _core.Device.read(
                _checks.file(source, "device", "a device file",
                             _checks.MAPPING),
                overrides)

    @classmethod
    def parse(cls, text: str, name: str = "device",
              set: Optional[Keys] = None) -> Device:
        """Read the text of a device file, called `name` in messages."""
        return cls._parsed(_checks.text(text, "text"),
                           _checks.text(name, "name"), _toml.overrides(set))

    def with_(self, keys: Optional[Keys] = None, /, **more: Any) -> Device:
        """Return the device with further keys replaced.

        >>> device.with_({"beam.length_m": 0.041})
        >>> device.with_(beam={"length_m": 0.041})
        """
        return Device._of(
            self._native.with_(_toml.overrides(_toml.merged(keys, more))))

    text = Native(str, "The text of the device file.")
    name = Native(str, "The name of the file, as messages give it.")
    overrides = Native(list[str], "The keys that were replaced, as KEY=VALUE.")

    def _identity(self) -> Any:
        return self.text, tuple(self.overrides)

    def __repr__(self) -> str:
        changes = "".join(f", {text}" for text in self.overrides)
        return f"<beamgyro.Device {self.name}{changes}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Device._parsed, (self.text, self.name, self.overrides)


def device_of(source: DeviceLike) -> Device:
    """Return a device of anything that tells one."""
    return source if isinstance(source, Device) else Device(source)


_GRID = "START, STOP and STEP, or temperatures"


def _temperatures(given: Union[slice, float, Iterable[float]]) -> list[float]:
    name = "beam_temperature"
    if isinstance(given, slice):
        ends = (given.start, given.stop, given.step)
        if None in ends:
            raise ValueError(f"{name} {given}: expected {_GRID}")
        numbers = [_arguments.number(one, name) for one in ends]
        try:
            return _core.even_temperatures(*numbers)
        except ValueError as error:
            raise ValueError(f"{name} {given}: {error}") from None
    one_or_more: Any = list(given) if isinstance(given, Iterator) else given
    if np.ndim(one_or_more) == 0:
        one_or_more = np.atleast_1d(one_or_more)
    found = _arguments.numbers(one_or_more, name)
    _arguments.not_empty(found, name)
    return list(found.tolist())


def characterise(
        device: DeviceLike,
        beam_temperature: Union[slice, float, Iterable[float]] = slice(
            -40.0, 60.0, 0.25),
        *, set: Optional[Keys] = None) -> xr.Dataset:
    """Tabulate the steady state of a device over its beam's temperature.

    Args:
        device: a device, its file, or a mapping.
        beam_temperature: temperatures in degC: one, several, or
            ``slice(start, stop, step)`` with both ends included, of at most
            1,000,000.
        set: keys of the device to replace.

    Returns:
        A dataset over ``temperature``: ``bias``, its parts ``in_phase`` and
        ``quadrature`` (degree/s), ``drive_frequency`` and ``split`` (Hz),
        ``q_drive``, ``q_sense``, ``drive_voltage`` (V), ``scale_factor``.
        The table of ``beamgyro characterise`` is ``encoding["csv"]``.
        ``encoding["crossings"]`` lists where spurious modes meet the drive
        frequency: ``mode``, its name, ``temperature`` (degC), and ``height``
        (degree/s, signed) and ``width`` (K) of the bump of the bias.

    Raises:
        ValueError: something is wrong in the device, or a temperature is
            beyond -100 to 150 degC.
    """
    found = _core.characterise(Device(device, set)._native,
                               _temperatures(beam_temperature))
    warn(found["warnings"])
    xarray = _lazy.xarray()
    columns = {name: xarray.Variable("temperature", values, {"units": units})
               for name, (values, units) in found["columns"].items()}
    temperature = xarray.Variable("temperature", found["temperature"],
                              {"units": "degC",
                               "long_name": "temperature of the beam"})
    table: xr.Dataset = xarray.Dataset(
        columns, {"temperature": temperature},
        {"filetype": "beamgyro-characteristic",
         "beamgyro_version": _core.version})
    table.encoding["csv"] = found["csv"]
    table.encoding["crossings"] = found["crossings"]
    return table
