# SPDX-License-Identifier: MIT
"""Devices from the figures of a data sheet."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any, NamedTuple, Optional

from beamgyro import _arguments, _checks, _core, _shipped
from beamgyro._device import Device, DeviceLike, device_of
from beamgyro._warnings import warn


class DesignFigure(NamedTuple):
    """A figure that was asked for, and what the program measures."""

    name: str
    unit: str
    asked: float
    measured: float
    is_met: bool


class DesignedDevice(Device):
    """A device that was made from the figures of a data sheet.

    Its text is a device file, as ``beamgyro device`` writes it.
    """

    __slots__ = ("_figures",)

    _figures: tuple[DesignFigure, ...]

    @property
    def figures(self) -> tuple[DesignFigure, ...]:
        """The figures that can be measured, asked for and measured."""
        return self._figures

    @property
    def derivation(self) -> dict[str, str]:
        """Where each key comes from, in words, by its dotted name."""
        found, table = {}, ""
        for line in self.text.splitlines():
            if line.startswith("["):
                table = line.strip("[]")
            elif match := re.match(r"(\S+) = .*?   # (.*)$", line):
                found[f"{table}.{match[1]}"] = match[2]
        return found

    @classmethod
    def _restored(cls, text: str, name: str, overrides: list[str],
                  figures: tuple[DesignFigure, ...]) -> DesignedDevice:
        made = cls._of(_core.Device.parse(text, name, overrides))
        made._figures = figures
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return DesignedDevice._restored, (self.text, self.name, self.overrides,
                                          self.figures)


def _mount(value: Any, name: str) -> str:
    return _checks.text(value, name, '"elastomer", "epoxy" or "metal"')


# Each with its check and what it is; the unit is the end of the name.
_FIGURES: dict[str, tuple[Callable[[Any, str], Any], str]] = {
    "length": (_arguments.number, "length of the beam [m]"),
    "side": (_arguments.number, "side of its section [m]"),
    "frequency_Hz": (_arguments.number, "drive frequency at 25 degC"),
    "split_Hz": (_arguments.number, "sense less drive mode at 25 degC"),
    "quality": (_arguments.number, "quality factor of the drive mode [1]"),
    "air_quality": (_arguments.number,
                    "quality factor that the gas alone leaves [1]"),
    "mount": (_mount, "'elastomer', 'epoxy' or 'metal'"),
    "range_deg_per_s": (_arguments.number, "range, to both sides"),
    "full_scale_deg_per_s": (_arguments.number, "where the output clips"),
    "scale_factor_V_per_deg_per_s": (_arguments.number, "scale factor"),
    "scale_tolerance_percent": (_arguments.number, "limit of its error, +-"),
    "null_deg_per_s": (_arguments.number,
                       "limit of the zero-rate output, +-"),
    "bandwidth_Hz": (_arguments.number, "bandwidth, -3 dB"),
    "noise_deg_per_s_per_sqrt_Hz": (_arguments.number,
                                    "noise density, one-sided"),
    "walk_deg_per_sqrt_h": (_arguments.number,
                            "angle random walk, the same noise"),
    "instability_deg_per_h": (_arguments.number,
                              "bias instability, the least Allan deviation"),
    "adc_bits": (_arguments.count, "bits of the rate"),
    "bits": (_arguments.count, "bits of the temperature"),
    "sensor_range_degC": (_arguments.ends,
                          "(low, high) that these bits divide"),
    "resolution_K": (_arguments.number, "step of the temperature"),
    "sensor_tolerance_K": (_arguments.number, "limit of its error, +-"),
    "supply_V": (_arguments.number, "supply"),
    "current_A": (_arguments.number, "supply current"),
    "power_W": (_arguments.number, "power"),
    "self_heating_K": (_arguments.number,
                       "rise of the sensor in still air"),
    "warm_up_s": (_arguments.number, "time to 95 % of that rise"),
    "temperature_degC": (_arguments.ends,
                         "(low, high) in which the unit works")}


def design_device(like: Optional[DeviceLike] = None,
                  **figures: Any) -> DesignedDevice:
    """Make a device from the figures of a data sheet.

    It is that of ``beamgyro device`` with the same figures. Every key says in
    a comment where it comes from.

    Args:
        like: the device that has what no figure says; without, the shipped
            nominal device.
        figures: as below; the unit is the end of the name.

    Returns:
        The device, with its ``figures`` and ``derivation``.

    Raises:
        ValueError: a figure is out of its range, or figures contradict each
            other.
    """
    for name in figures:
        if name not in _FIGURES:
            raise TypeError("design_device() got an unexpected keyword "
                            f"argument '{name}'")
    base = device_of(_shipped.file("scenarios/devices/nominal.toml")
                     if like is None else like)
    text, met, warnings = _core.design_device(base._native, _checks.given(
        {name: check for name, (check, _) in _FIGURES.items()}, **figures))
    warn(warnings)
    return DesignedDevice._restored(
        text, "device", [], tuple(DesignFigure(*one) for one in met))


def _describe_figures() -> None:
    """Show the figures of `design_device` in its help and its signature."""
    signature = inspect.signature(design_device)
    setattr(design_device, "__signature__", signature.replace(parameters=[
        signature.parameters["like"],
        *(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None)
          for name in _FIGURES)]))
    lines = [f"        {name}: {words}." for name, (_, words)
             in _FIGURES.items()]
    design_device.__doc__ = (design_device.__doc__ or "").replace(
        "\n    Returns:", "\n    Figures:\n" + "\n".join(lines)
        + "\n\n    Returns:", 1)


_describe_figures()
