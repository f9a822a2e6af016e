# SPDX-License-Identifier: MIT
"""The units that a recording may have, and the ones that are drawn."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .documents import PlotError

_DEG = 180 / math.pi
# As docs/reference/recording.md has them: unit: (factor, offset), to the first
# unit of the line.
_UNITS: dict[str, dict[str, tuple[float, float]]] = {
    "s": {"s": (1, 0), "ms": (1e-3, 0), "us": (1e-6, 0), "ns": (1e-9, 0),
          "min": (60, 0), "h": (3600, 0)},
    "deg/s": {"degree/s": (1, 0), "deg/s": (1, 0), "degree s-1": (1, 0),
              "degree/h": (1 / 3600, 0), "deg/h": (1 / 3600, 0),
              "rad/s": (_DEG, 0), "rad s-1": (_DEG, 0),
              "mrad/s": (_DEG / 1e3, 0)},
    "degC": {"degC": (1, 0), "Celsius": (1, 0), "K": (1, -273.15),
             "Kelvin": (1, -273.15), "degF": (1 / 1.8, -32 / 1.8)},
    "V": {"V": (1, 0), "mV": (1e-3, 0), "uV": (1e-6, 0)},
    "Hz": {"Hz": (1, 0), "kHz": (1e3, 0), "MHz": (1e6, 0)},
}


# Unit, its seconds, and the least span that is drawn in it.
TIME_UNITS = [("d", 86400.0, 3 * 86400.0), ("h", 3600.0, 3 * 3600.0),
              ("min", 60.0, 300.0), ("s", 1.0, 0.05), ("ms", 1e-3, 0.0)]


def time_unit(span: float) -> tuple[str, float]:
    """Unit of the axis of a span of time, and its seconds."""
    return next((unit, scale) for unit, scale, least in TIME_UNITS
                if span >= least) if span > 0 else ("s", 1.0)


def duration(seconds: float) -> str:
    return next(f"{seconds / scale:.3g} {unit}" for unit, scale, _ in
                TIME_UNITS if seconds >= scale or unit == "ms")


def unit_of(name: str) -> str:
    """The unit in which a variable of a recording is drawn."""
    if name == "time":
        return "s"
    if name.endswith("temperature"):
        return "degC"
    if name.endswith("frequency"):
        return "Hz"
    return "V" if name in ("output", "drive_voltage") else "deg/s"


def converted(name: str, values: npt.NDArray[np.float64], unit: str,
              where: str = "") -> npt.NDArray[np.float64]:
    """Values of a variable in the unit in which it is drawn."""
    known = _UNITS[unit_of(name)]
    if unit not in known:
        raise PlotError(f"{where}{name}: unit \"{unit}\"; expected "
                        f"{', '.join(known)}")
    factor, offset = known[unit]
    return values if factor == 1 and offset == 0 else values * factor + offset
