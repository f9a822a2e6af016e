# SPDX-License-Identifier: MIT
"""Steady curves over temperature, and what describes those of many units."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy
from beamgyro._campaign import Campaign
from beamgyro._device import Device, DeviceLike, Keys
from beamgyro._progress import ProgressArgument, watched
from beamgyro._results import CurveFiguresResult
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

Temperatures = Union[slice, float, Iterable[float]]

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
    found = _arguments.in_degC(_arguments.numbers(one_or_more, name), given,
                               name)
    _arguments.not_empty(found, name)
    return list(found.tolist())


def characterise(
        device: Union[DeviceLike, Campaign],
        beam_temperature: Temperatures = slice(-40.0, 60.0, 0.25),
        *, set: Optional[Keys] = None, devices: Optional[int] = None,
        jobs: Optional[int] = None,
        progress: ProgressArgument = False) -> xr.Dataset:
    """Tabulate the steady state over the temperature of the beam.

    Args:
        device: a device, its file, or a mapping; or a campaign or its file.
        beam_temperature: temperatures in degC: one, several, or
            ``slice(start, stop, step)`` with both ends included, of at most
            1,000,000.
        set: keys of the device to replace; not of a campaign.
        devices: the number of devices of a campaign.
        jobs: threads for a campaign; 0 and None: one for each core.
        progress: of a campaign: True shows a bar on a terminal; a function is
            called with the share of the work that is done, from 0 to 1.

    Returns:
        A dataset over ``temperature``, of a campaign over ``device`` and
        ``temperature``: ``bias``, its parts ``in_phase`` and ``quadrature``
        (degree/s), ``drive_frequency`` and ``split`` (Hz), ``q_drive``,
        ``q_sense``, ``drive_voltage`` (V), ``scale_factor``. The table of
        ``beamgyro characterise`` is ``encoding["csv"]``. Of a device
        ``encoding["crossings"]`` lists where spurious modes meet the drive
        frequency: ``mode``, its name, ``temperature`` (degC), and ``height``
        (degree/s, signed) and ``width`` (K) of the bump of the bias. A device
        of a campaign that does not work is left out, with a warning.

    Raises:
        ValueError: something is wrong in the device or campaign, or a
            temperature is beyond -100 to 150 degC.
        RuntimeError: no device of the campaign works.
    """
    if _is_campaign(device, devices):
        _checks.refuse("for a device", set=set)
        return _curves_of(Campaign(device, devices),  # type: ignore[arg-type]
                          _temperatures(beam_temperature), jobs or 0, progress)
    _checks.refuse("for a campaign", devices=devices, jobs=jobs)
    found = _core.characterise(
        Device(device, set)._native,  # type: ignore[arg-type]
        _temperatures(beam_temperature))
    warn(found["warnings"])
    table = _dataset(found, {"temperature": found["temperature"]},
                     "beamgyro-characteristic")
    table.encoding["crossings"] = found["crossings"]
    return table


def _is_campaign(source: Any, devices: Optional[int]) -> bool:
    if isinstance(source, (Campaign, Device)):
        return isinstance(source, Campaign)
    if _checks.is_table(source):
        return False
    kinds = _core.kinds_of(_checks.path(source, "device"))
    return "a campaign" in kinds or (devices is not None and not kinds)


def _curves_of(campaign: Campaign, temperatures: list[float], jobs: int,
               progress: ProgressArgument) -> xr.Dataset:
    with watched(progress, "characterising") as function:
        found = _core.characterise_campaign(
            campaign._native, temperatures, _arguments.jobs(jobs), function)
    warn(found["warnings"])
    return _dataset(found, {"device": found["device"],
                            "temperature": temperatures}, "beamgyro-curves")


_ABOUT = {"temperature": {"units": "degC",
                          "long_name": "temperature of the beam"},
          "device": {"long_name": "number of the device"}}


def _dataset(found: dict[str, Any], axes: Mapping[str, Any],
             filetype: str) -> xr.Dataset:
    xarray = _lazy.xarray()
    table: xr.Dataset = xarray.Dataset(
        {name: xarray.Variable(tuple(axes), values, {"units": units})
         for name, (values, units) in found["columns"].items()},
        {name: xarray.Variable(name, values, _ABOUT[name])
         for name, values in axes.items()},
        {"filetype": filetype, "beamgyro_version": _core.version})
    table.encoding["csv"] = found["csv"]
    return table


def _treatment(range_degC: Optional[tuple[float, float]],
               zero_at_degC: Optional[float],
               round_deg_per_s: Optional[float]) -> dict[str, Any]:
    treatment: dict[str, Any] = {}
    if range_degC is not None:
        treatment["lowest_degC"], treatment["highest_degC"] = _arguments.ends(
            range_degC, "range_degC")
    numbers: dict[str, Callable[[Any, str], Any]] = {
        "zero_at_degC": _arguments.number,
        "round_deg_per_s": _arguments.number}
    return {**treatment, **_checks.given(numbers, zero_at_degC=zero_at_degC,
                                         round_deg_per_s=round_deg_per_s)}


def curve_figures(curves: Union[xr.Dataset, xr.DataArray], *,
                  range_degC: Optional[tuple[float, float]] = None,
                  zero_at_degC: Optional[float] = None,
                  round_deg_per_s: Optional[float] = None,
                  name: str = "curves") -> CurveFiguresResult:
    """Describe the curves of many units as data sheets describe gyros.

    Args:
        curves: what `characterise` returns of a campaign, or an array over
            ``device`` and ``temperature`` in deg/s, with the temperatures as
            its coordinate, in degC unless they state another unit.
        range_degC: the temperatures that count; all without.
        zero_at_degC: each curve counts less its value there.
        round_deg_per_s: values count at the nearest multiple of it, as read
            from a drawing.
        name: what the text calls the curves.

    Raises:
        ValueError: the temperatures do not increase, fewer than 8 are in the
            range, or an argument is wrong.
    """
    array: Any = curves["bias"] if hasattr(curves, "data_vars") else curves
    if {*getattr(array, "dims", ())} != {"device", "temperature"}:
        raise ValueError("curves: no array over device and temperature; "
                         "expected one, such as characterise() of a campaign")
    array = array.transpose("device", "temperature")
    units = (array["device"].values if "device" in array.coords
             else np.arange(array.sizes["device"]))
    _arguments.require_unit(array, "curves", "degree/s")
    temperature = array["temperature"]
    return CurveFiguresResult(*_core.curve_figures(
        _arguments.in_degC(_arguments.numbers(temperature, "temperature"),
                           temperature, "temperature"),
        _arguments.numbers(array.values.ravel(), "curves"),
        [_arguments.whole(one, "device") for one in units.tolist()],
        _treatment(range_degC, zero_at_degC, round_deg_per_s),
        _checks.text(name, "name")))


def area_metric(sample: npt.ArrayLike, other: npt.ArrayLike, *,
                shares: Optional[Sequence[float]] = None) -> float:
    """Return how far two distributions of a figure are apart, in its unit.

    Args:
        sample: values of the figure, one of each unit.
        other: those of other units; with `shares` their quantiles.
        shares: of the quantiles, increasing within 0 to 1.

    Returns:
        The area between the distribution functions; with `shares` the mean
        distance of the quantiles between the first and the last of them.
    """
    values = _arguments.numbers(sample, "sample")
    others = _arguments.numbers(other, "other")
    stated = getattr(sample, "attrs", {}).get("units")
    if stated is not None:
        _arguments.require_unit(other, "other", stated)
    if shares is None:
        return _core.area_metric(values, others)
    return _core.area_metric_of_table(
        values, _arguments.numbers(shares, "shares"), others)


class HalfSplit(NamedTuple):
    """The area metric between random halves of a sample, over many splits."""

    median: float
    p95: float


def half_split(sample: npt.ArrayLike, draws: int = 1000,
               seed: int = 1) -> HalfSplit:
    """Return by how much two samples differ when nothing is different.

    Args:
        sample: two values or more.
        draws: the number of splits.
        seed: of the splits.
    """
    return HalfSplit(*_core.half_split(
        _arguments.numbers(sample, "sample"),
        _arguments.whole(draws, "draws", 1, 1000000), _arguments.seed(seed)))
