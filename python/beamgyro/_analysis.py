# SPDX-License-Identifier: MIT
"""Allan deviation, plans and sensitivity."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from beamgyro import _arguments, _checks, _core
from beamgyro._campaign import Campaign, CampaignLike
from beamgyro._compensation import Compensator, compensator_of
from beamgyro._dataset import Path, recording_of
from beamgyro._device import DeviceLike, device_of
from beamgyro._progress import ProgressArgument, watched
from beamgyro._results import AllanResult, PlanResult, SensitivityResult
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

Range = tuple[float, float]


# Kinds of files that may be any CSV with a column of samples.
_TABLES = ("a table that characterise wrote", "a profile over time")


def allan(data: Union[xr.Dataset, Path, npt.ArrayLike], *,
          column: Optional[str] = None, rate_Hz: Optional[float] = None,
          unit: Optional[str] = None,
          kinds: Sequence[str] = ("adev", "oadev"), taus: str = "octave",
          from_s: float = float("-inf"),
          to_s: float = float("inf")) -> AllanResult:
    """Compute Allan deviations and noise coefficients.

    Args:
        data: a recording, a file as of ``beamgyro allan``, or even samples
            in one dimension, which need `rate_Hz`. Samples that are NaN are
            left out.
        column: of a recording or a file; "rate" without.
        rate_Hz: samples in a second, of an array or of a CSV without times.
        unit: of an array or of a CSV; without, what an array of xarray
            states, or "deg/s".
        kinds: of "adev", "oadev", "mdev", "hdev", "ohdev", "totdev".
        taus: "octave", "decade" or "all".
        from_s, to_s: the window of a recording [s].

    Raises:
        ValueError: the column is not there, the series is too short, its
            times do not increase or are not even, or an argument is given
            that the data state themselves.
    """
    if rate_Hz is not None:
        rate_Hz = _arguments.number(rate_Hz, "rate_Hz", above=0)
    column = None if column is None else _checks.text(column, "column")
    unit = None if unit is None else _checks.text(unit, "unit")
    options = {
        "kinds": _checks.some_texts(kinds, "kinds"),
        "from_s": _checks.bound(from_s, "from_s"),
        "to_s": _checks.bound(to_s, "to_s"), "taus": _checks.text(
            taus, "taus", "\"octave\", \"decade\" or \"all\"")}
    if isinstance(data, (str, os.PathLike)):
        file = _checks.file(data, "data", "a recording", tables=_TABLES)
        found = _core.allan_file(file, column, rate_Hz, unit, options)
    elif hasattr(data, "data_vars"):
        recording: Any = data
        _checks.refuse("for a CSV or an array; a dataset states its own",
                       rate_Hz=rate_Hz, unit=unit)
        found = _core.allan_recording(
            recording_of(recording, is_sound=False),
            "rate" if column is None else column, options)
    else:
        _checks.refuse("for a recording or a file; an array has none",
                       column=column)
        samples = _arguments.numbers(data, "data")
        if rate_Hz is None:
            raise ValueError("rate_Hz: is missing, which an array needs; "
                             "expected the number of samples in a second")
        found = _core.allan_samples(
            samples, _arguments.rate_of(data, rate_Hz),
            _arguments.unit_of(data, unit), options)
    text, json_text, warnings = found
    warn(warnings)
    return AllanResult(text, json_text, warnings)


def _candidates(value: Any, name: str) -> list[list[float]]:
    return _checks.several(value, name, lambda one, of: list(
        _arguments.numbers(one, of).tolist()))


_PLAN_OPTIONS: dict[str, Callable[[Any, str], Any]] = {
    "bias_only": _checks.flag, "start_row": _checks.flag,
    "soaks": _arguments.count,
    "hold_min": _arguments.count, "hours": _arguments.number,
    "residual_deg_per_s": _arguments.number,
    "ramp_K_per_min": _arguments.number, "start_degC": _arguments.number,
    "range_degC": _arguments.ends, "chamber_degC": _arguments.ends,
    "candidates": _candidates}


def plan(population: Union[Compensator, Path], device: DeviceLike, *,
         soaks: Optional[int] = None, hours: Optional[float] = None,
         residual_deg_per_s: Optional[float] = None,
         range_degC: Optional[Range] = None,
         chamber_degC: Optional[Range] = None,
         ramp_K_per_min: Optional[float] = None,
         start_degC: Optional[float] = None,
         hold_min: Optional[int] = None,
         candidates: Optional[Sequence[Sequence[float]]] = None,
         bias_only: bool = False, start_row: bool = False) -> PlanResult:
    """Plan the soaks that a new device of a population needs.

    Args:
        population: a compensator that was trained as a population.
        device: a device of it, which tells how warm the sensor is and what
            noise a soak shows.
        soaks, hours, residual_deg_per_s: the goal; give one of them.
        range_degC: where the residual counts.
        chamber_degC: where a soak may be.
        ramp_K_per_min: of the chamber.
        start_degC: where it starts.
        hold_min: the length of a soak in whole minutes.
        candidates: soaks of your own to compare.
        bias_only: soaks observe the bias, but no channel.
        start_row: counts on the row that a ramp down from the start shows
            minutes after power-on.

    Raises:
        ValueError: the compensator is no population, or something is wrong
            in the device or an argument.
    """
    unit = device_of(device)
    options = _checks.given(
        _PLAN_OPTIONS, bias_only=bias_only, start_row=start_row,
        soaks=soaks, hold_min=hold_min,
        hours=hours, residual_deg_per_s=residual_deg_per_s,
        ramp_K_per_min=ramp_K_per_min, start_degC=start_degC,
        range_degC=range_degC, chamber_degC=chamber_degC,
        candidates=candidates)
    options["device_name"] = unit.name
    text, json_text, warnings, schedule = _core.plan(
        compensator_of(population)._trained("population"), unit._native,
        options)
    warn(warnings)
    return PlanResult(text, json_text, warnings, schedule, unit)


def _limits(given: Optional[Mapping[str, float]]) -> dict[str, float]:
    if given is None:
        return {}
    if not _checks.is_table(given):
        raise _checks.wrong(given, "limits",
                            "a mapping of figures to their largest values")
    return {_checks.text(name, "limits"):
            _arguments.number(limit, f"limits: {name}", above=0)
            for name, limit in given.items()}


def sensitivity(campaign: CampaignLike, *, figures: Sequence[str] = (),
                compensator: Optional[Any] = None,
                range_degC: Range = (-40.0, 50.0), linear: bool = False,
                limits: Optional[Mapping[str, float]] = None,
                wanted_yield: Optional[float] = None,
                samples: int = 2048, seed: Optional[int] = None,
                jobs: int = 0, progress: ProgressArgument = False
                ) -> SensitivityResult:
    """Compute which tolerance of a campaign causes the spread of its drift.

    Args:
        campaign: a campaign, or its file.
        figures: figures of merit; without: bias_pp_deg_per_s,
            cubic_rms_deg_per_s, scale_factor_drift_rel,
            warm_up_change_deg_per_s.
        compensator: adds what it leaves as a figure.
        range_degC: temperatures of the beam.
        linear: studies every figure as it is, not the logarithm.
        limits: largest good magnitudes by figure; they add yields.
        wanted_yield: share of good devices, above 0 and below 1; adds how
            narrow single tolerances have to be for it.
        samples: each takes a device for every tolerance and three more.
        seed: that of the campaign without.
        jobs: threads; 0: one for each core.
        progress: True for a bar on standard error, or a function that is
            called with the share of the work that is done, from 0 to 1.

    Raises:
        ValueError: something is wrong in the campaign or an argument.
        RuntimeError: no device works.
    """
    low, high = _arguments.ends(range_degC, "range_degC")
    options: dict[str, Any] = {
        "figures": _checks.texts(figures, "figures"), "lowest_degC": low,
        "highest_degC": high, "linear": _checks.flag(linear, "linear"),
        "limits": _limits(limits),
        "samples": _arguments.count(samples, "samples"),
        "jobs": _arguments.jobs(jobs)}
    if seed is not None:
        options["seed"] = _arguments.seed(seed)
    if wanted_yield is not None:
        options["yield"] = _arguments.number(wanted_yield, "wanted_yield")
    if compensator is not None:
        options["compensator"] = compensator_of(compensator)._trained("file")
    with watched(progress, "studying") as function:
        found = _core.sensitivity(Campaign(campaign)._native, options,
                                  function)
    return SensitivityResult(*found)


