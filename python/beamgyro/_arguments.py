# SPDX-License-Identifier: MIT
"""Checks of numbers and arrays that a caller gives.

What NumPy would convert with a loss, or guess, is refused.
"""

from __future__ import annotations

import math
import numbers as kinds
from collections.abc import Sized
from typing import Any, Optional

import numpy as np

from beamgyro._warnings import warn
from beamgyro._words import shown, wrong

Array = np.ndarray[Any, Any]

_LARGEST_SEED = 2 ** 64 - 1
LARGEST_JSON_SEED = 2 ** 53 - 1  # whole for every reader of JSON
LARGEST_TOML_SEED = 2 ** 63 - 1  # an integer of TOML is signed
_LARGEST_NUMBER = 2 ** 32 - 1  # of devices, samples and the like
_MOST_JOBS = 4096


def number(value: Any, name: str, *, above: Optional[float] = None,
           least: Optional[float] = None) -> float:
    """Return a finite number; neither true nor false is one."""
    right = "a finite number" + (
        f" above {above:g}" if above is not None
        else f" of at least {least:g}" if least is not None else "")
    if isinstance(value, bool) or not isinstance(value, kinds.Real):
        raise ValueError(f"{name} {shown(value)}: is no number; expected "
                         f"{right}")
    try:
        found = float(value)
    except OverflowError:
        found = math.inf
    if (not math.isfinite(found) or (above is not None and not found > above)
            or (least is not None and not found >= least)):
        raise wrong(value, name, right)
    return found


def whole(value: Any, name: str, least: int = 0,
          most: int = _LARGEST_NUMBER) -> int:
    """Return a whole number; neither true nor 2.0 is one."""
    if (isinstance(value, bool) or not isinstance(value, kinds.Integral)
            or not least <= int(value) <= most):
        raise wrong(value, name, f"a whole number from {least} to {most}")
    return int(value)


def count(value: Any, name: str) -> int:
    """Return a whole number of one or more."""
    return whole(value, name, least=1)


def jobs(value: Any) -> int:
    """Return a number of threads; 0: one for each core."""
    return whole(value, "jobs", 0, _MOST_JOBS)


def ends(value: Any, name: str) -> tuple[float, float]:
    """Return both ends of a range."""
    try:
        low, high = [value] if isinstance(value, str) else value
    except (TypeError, ValueError):
        raise wrong(value, name,
                    "two numbers, the lower one first") from None
    return number(low, name), number(high, name)


def seed(value: Any, most: int = _LARGEST_SEED) -> int:
    """Return the seed of a random stream."""
    return whole(value, "seed", 0, most)


def _given(values: Any, name: str) -> Array:
    """Return an array with one dimension, of any numbers."""
    if hasattr(values, "detach"):  # of torch
        values = _dense(values.detach().cpu(), name)
    if hasattr(getattr(values, "dtype", None), "numpy_dtype"):
        values = _without_missing(values, name)
    if isinstance(values, np.ma.MaskedArray) and np.any(values.mask):
        raise ValueError(f"{name}: has masked values; expected an array "
                         "without, such as .filled(numpy.nan)")
    try:
        array = np.asarray(values)
    except (ValueError, TypeError):  # rows of several lengths
        array = np.empty(0, dtype=object)
    if array.dtype.kind in "OSUV":
        raise ValueError(f"{name}: holds {_kind(values, array)}; expected "
                         "numbers")
    if array.ndim != 1:
        raise ValueError(f"{name}: has the shape {array.shape}; expected one "
                         "dimension")
    return array


def _dense(tensor: Any, name: str) -> Any:
    """Return a tensor of torch as an array."""
    if str(tensor.dtype) == "torch.bfloat16":  # NumPy has none
        tensor = tensor.float()
    try:
        return tensor.numpy()
    except TypeError:  # a sparse one
        raise ValueError(f"{name}: is a tensor of the layout {tensor.layout}; "
                         "expected a dense one") from None


def _without_missing(values: Any, name: str) -> Any:
    """Return a series of a nullable type of pandas as an array."""
    if values.isna().any():
        raise ValueError(f"{name}: has missing values; expected a number for "
                         "each sample")
    return values.to_numpy(dtype=values.dtype.numpy_dtype)


def _kind(values: Any, array: Array) -> str:
    if array.dtype.kind in "SU":
        return "texts"
    if array.ndim == 0:
        return f"a {type(values).__name__}"
    return f"values of the type {array.dtype}"


def numbers(values: Any, name: str) -> Array:
    """Return real numbers in one dimension, in double precision."""
    array = _given(values, name)
    kind = array.dtype.kind
    if kind == "c":
        raise ValueError(f"{name}: holds complex numbers; expected real ones")
    if kind == "b":
        raise ValueError(f"{name}: holds true and false; expected numbers, "
                         "such as .astype(float)")
    if kind in "mM":
        raise ValueError(f"{name}: holds values of the type {array.dtype}; "
                         "expected numbers")
    with np.errstate(over="ignore"):
        found: Array = array.astype(np.float64)
    if kind in "iu":
        # A number that a double rounds to 2**63 or 2**64 is no integer of
        # the type; such ones are beyond 2**53 anyway.
        large = np.abs(found) > 2.0 ** 53
        if large.any():
            raise ValueError(
                f"{name}: sample {int(np.argmax(large))} is "
                f"{array[np.argmax(large)]}; expected whole numbers up to "
                "2**53, which a double holds exactly")
    return found


def seconds(values: Any, name: str) -> Array:
    """Return times in seconds, of numbers or of timedelta64."""
    array = _given(values, name)
    if array.dtype.kind == "M":
        raise ValueError(
            f"{name}: holds dates ({array.dtype}); expected seconds, such as "
            f"({name} - {name}[0]) / numpy.timedelta64(1, 's')")
    if array.dtype.kind != "m":
        return numbers(array, name)
    if np.isnat(array).any():
        raise ValueError(f"{name}: sample {int(np.argmax(np.isnat(array)))} "
                         "is NaT; expected a time")
    unit = np.datetime_data(array.dtype)[0]
    if unit in ("Y", "M", "generic"):
        raise ValueError(f"{name}: holds times of the unit {unit}, whose "
                         "length varies; expected seconds")
    found: Array = array / np.timedelta64(1, "s")
    return found


def status(values: Any) -> Array:
    """Return the bits of the variable `status`."""
    found = numbers(values, "status")
    if np.asarray(values).dtype.kind == "f":
        warn(["status: holds floats: a mean of its bits is another state; "
              "expected integers, such as status.isel(time=slice(None, None, "
              "n)) has beside means of n samples"])
    refused = ~((found >= 0) & (found <= 255) & (found == np.floor(found)))
    if refused.any():
        at = int(np.argmax(refused))
        raise ValueError(f"status: sample {at} is {found[at]:g}; expected a "
                         "whole number from 0 to 255, a bit for each state")
    return found.astype(np.uint8)


def stated_times(values: Any) -> Any:
    """Return the times of an array of xarray or a series of pandas.

    None where it states none.
    """
    if "time" in getattr(values, "coords", ()):
        return values.coords["time"]
    index = getattr(values, "index", None)
    return index if getattr(index, "name", None) == "time" else None


def rate_of(data: Any, rate_Hz: float) -> float:
    """Return the rate of samples, whose times an array may state, too."""
    times = stated_times(data)
    if times is None or data.size < 2:
        return rate_Hz
    steps = np.diff(seconds(times, "time"))
    if not np.allclose(steps * rate_Hz, 1.0, atol=0.5) or abs(
            steps.mean() * rate_Hz - 1.0) > 0.01:
        raise ValueError(
            f"rate_Hz {rate_Hz:g}: the times of the array have steps from "
            f"{steps.min():g} to {steps.max():g} s; expected their rate, or a "
            "dataset, which may have gaps")
    return rate_Hz


def spelled(unit: Optional[str]) -> Optional[str]:
    """Return a unit as the program spells it."""
    return "deg/s" if unit == "degree/s" else unit


def unit_of(data: Any, unit: Optional[str]) -> str:
    """Return the unit of samples, which an array of xarray may state."""
    given = spelled(unit)
    stated = spelled(getattr(data, "attrs", {}).get("units"))
    if None not in (given, stated) and given != stated:
        raise ValueError(f"unit {unit!r}: the array states {stated!r}; "
                         "expected that one, or no unit")
    return str(given or stated or "deg/s")


def require_unit(data: Any, name: str, expected: str) -> None:
    """Refuse an array of xarray that states another unit."""
    stated = getattr(data, "attrs", {}).get("units", expected)
    if spelled(stated) != spelled(expected):
        raise ValueError(f"{name}: units {shown(stated)}; expected "
                         f"{expected!r}")


# Factor and offset to degC, as docs/reference/recording.md has them.
_TEMPERATURES = {"degC": (1.0, 0.0), "Celsius": (1.0, 0.0),
                 "K": (1.0, -273.15), "Kelvin": (1.0, -273.15),
                 "degF": (1 / 1.8, -32 / 1.8)}


def in_degC(values: Array, source: Any, name: str) -> Array:
    """Return temperatures in degC; an array of xarray may state their unit."""
    unit = getattr(source, "attrs", {}).get("units", "degC")
    if unit not in _TEMPERATURES:
        raise ValueError(f"{name}: the array states the unit {unit!r}; "
                         f"expected {', '.join(_TEMPERATURES)}, or none")
    factor, offset = _TEMPERATURES[unit]
    return values if (factor, offset) == (1.0, 0.0) \
        else factor * values + offset


def not_empty(values: Sized, name: str) -> None:
    """Refuse an empty sequence."""
    if len(values) == 0:
        raise ValueError(f"{name}: is empty; expected at least one")
