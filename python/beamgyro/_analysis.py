# SPDX-License-Identifier: MIT
"""Validation, Allan deviation, plans and sensitivity."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

from beamgyro import _core, _shipped, _toml
from beamgyro._compensation import (Compensator, Runs, compensator_of,
                                    core_recording, model_of, named_runs)
from beamgyro._dataset import Path, recording_of
from beamgyro._device import DeviceLike, device_of
from beamgyro._progress import ProgressArgument, Watched
from beamgyro._results import (AllanResult, PlanResult, SensitivityResult,
                               ValidationResult)
from beamgyro._set import Campaign, CampaignLike, Set
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

Range = tuple[float, float]


def _given(**options: Any) -> dict[str, Any]:
    return {name: value for name, value in options.items()
            if value is not None}


class _Files:
    """Files of what is in memory, for the duration of a call."""

    def __init__(self) -> None:
        self._directory: Optional[tempfile.TemporaryDirectory[str]] = None

    def __enter__(self) -> _Files:
        return self

    def __exit__(self, *error: object) -> None:
        if self._directory is not None:
            self._directory.cleanup()

    def _path(self, name: str) -> str:
        if self._directory is None:
            self._directory = tempfile.TemporaryDirectory(prefix="beamgyro-")
        return os.path.join(self._directory.name, name)

    def of_run(self, name: str, run: Union[xr.Dataset, Path]) -> str:
        """Return the file of a recording."""
        if isinstance(run, (str, os.PathLike)):
            return os.fspath(run)
        path = self._path(name if name.endswith((".h5", ".csv"))
                          else f"{name}.h5")
        recording_of(run).write(path)
        return path

    def of_text(self, name: str, text: str) -> str:
        """Return a TOML file with a text."""
        path = self._path(name if name.endswith(".toml") else f"{name}.toml")
        FilePath(path).write_text(text, encoding="utf-8")
        return path

    def of_table(self, name: str, table: Union[Path, Mapping[str, Any]]
                 ) -> str:
        """Return the file of a nested mapping."""
        if isinstance(table, Mapping):
            return self.of_text(name, _toml.text(table))
        return os.fspath(table)


def validate(compensator: Any, runs: Optional[Runs] = None, *,
             set: Union[Set, Path, None] = None,
             set_runs: Iterable[str] = (), set_devices: Iterable[int] = (),
             device: Optional[DeviceLike] = None,
             qualification: Optional[Path] = None,
             spec: Union[Path, Mapping[str, Any], None] = None,
             workbench: Optional[Path] = None,
             campaign: Optional[Path] = None,
             devices: Optional[int] = None,
             full_scale: Optional[float] = None, jobs: int = 0,
             progress: ProgressArgument = False) -> ValidationResult:
    """Judge a compensator by every metric, check and limit.

    Give recordings, or a set, or a device that is simulated. Compensators of
    Python are called by one thread at a time, with measured signals only.

    Args:
        compensator: a `Compensator`, or what makes one; with `device` also a
            model file (.toml) or a mapping with its contents, which is
            trained first.
        runs: recordings that training has not seen.
        set: a set, whose test devices are judged.
        set_runs: runs of the set; all without.
        set_devices: devices of the set, in place of the test devices.
        device: the device that a qualification is simulated with.
        qualification: the runs that it goes through; the shipped ones
            without.
        spec: a specification with limits, as a file or a mapping; without,
            some drift must be removed.
        workbench: a compensator file to compare the answers with.
        campaign: a campaign whose devices are judged, too.
        devices: how many of them.
        full_scale: of recordings, the largest rate [degree/s].
        jobs: threads; 0: one for each core.
        progress: True for a bar on standard error, or a function that is
            told the share of the work that is done.

    Returns:
        The result, which prints as a table; ``passed`` tells the verdict.

    Raises:
        ValueError: something is wrong in the input.
        RuntimeError: a simulation or the compensator cannot go on.
    """
    if sum(one is not None for one in (runs, set, device)) != 1:
        raise ValueError("nothing to validate on, or too much; expected one "
                         "of runs, set= and device=")
    with _Files() as files, Watched(progress, "validating") as function:
        options = _given(workbench=workbench, campaign=campaign,
                         campaign_devices=devices, full_scale=full_scale,
                         jobs=jobs)
        if runs is not None:
            options["recordings"] = [files.of_run(name, run)
                                     for name, run in named_runs(runs)]
        elif set is not None:
            options["set"] = (set if isinstance(set, Set)
                              else Set(set))._native
            options["runs"] = list(set_runs)
            options["devices"] = list(set_devices)
        else:
            assert device is not None
            options["device"] = device_of(device)._native
            options["qualification"] = (
                _shipped.file("scenarios/qualification.toml")
                if qualification is None else qualification)
        if spec is not None:
            options["specification"] = files.of_table("spec", spec)
        found = _judged(compensator, options, function)
    text, json_text, warnings, page = found
    warn(warnings)
    return ValidationResult(text, json_text, warnings, page)


def _judged(compensator: Any, options: dict[str, Any],
            function: Any) -> tuple[str, str, list[str], str]:
    is_model = isinstance(compensator, Mapping) or (
        isinstance(compensator, (str, os.PathLike))
        and os.fspath(compensator).endswith(".toml"))
    if is_model:
        return _core.validate_model(model_of(compensator), options, function)
    return _core.validate(compensator_of(compensator)._native, options,
                          function)


def allan(data: Union[xr.Dataset, Path, npt.ArrayLike], *,
          column: Optional[str] = None, rate_Hz: Optional[float] = None,
          unit: Optional[str] = None,
          kinds: Sequence[str] = ("adev", "oadev"), taus: str = "octave",
          from_s: float = float("-inf"),
          to_s: float = float("inf")) -> AllanResult:
    """Compute Allan deviations and noise coefficients.

    Args:
        data: a recording, a file as of ``beamgyro allan``, or even samples,
            which need `rate_Hz`.
        column: of a recording; "rate" without.
        rate_Hz: samples in a second, of an array or of a CSV without times.
        unit: of an array or of a CSV; "deg/s" without.
        kinds: of "adev", "oadev", "mdev", "hdev", "ohdev", "totdev".
        taus: "octave", "decade" or "all".
        from_s, to_s: the window of a recording [s].

    Raises:
        ValueError: the column is not there, or the series is too short.
    """
    rest = (list(kinds), taus, from_s, to_s)
    if isinstance(data, (str, os.PathLike)):
        found = _core.allan_file(os.fspath(data), column, rate_Hz, unit,
                                 *rest)
    elif hasattr(data, "data_vars"):
        recording: Any = data
        found = _core.allan_recording(core_recording(recording),
                                      column or "rate", *rest)
    else:
        if rate_Hz is None:
            raise ValueError("rate_Hz: is missing, which an array needs; "
                             "expected the number of samples in a second")
        found = _core.allan_samples(data, rate_Hz, unit or "deg/s", *rest)
    text, json_text, warnings = found
    warn(warnings)
    return AllanResult(text, json_text, warnings)


def plan(population: Union[Compensator, Path], device: DeviceLike, *,
         soaks: Optional[int] = None, hours: Optional[float] = None,
         residual_deg_per_s: Optional[float] = None,
         range_degC: Optional[Range] = None,
         chamber_degC: Optional[Range] = None,
         ramp_K_per_min: Optional[float] = None,
         start_degC: Optional[float] = None,
         hold_min: Optional[int] = None,
         candidates: Optional[Sequence[Sequence[float]]] = None,
         bias_only: bool = False) -> PlanResult:
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
    """
    unit = device_of(device)
    options = _given(
        soaks=soaks, hours=hours, residual_deg_per_s=residual_deg_per_s,
        range_degC=range_degC, chamber_degC=chamber_degC,
        ramp_K_per_min=ramp_K_per_min, start_degC=start_degC,
        hold_min=hold_min, bias_only=bias_only, device_name=unit.name)
    if candidates is not None:
        options["candidates"] = [list(one) for one in candidates]
    text, json_text, warnings, schedule = _core.plan(
        compensator_of(population)._trained("population"), unit._native,
        options)
    warn(warnings)
    return PlanResult(text, json_text, warnings, schedule, unit)


def sensitivity(campaign: CampaignLike, *, figures: Sequence[str] = (),
                compensator: Optional[Any] = None,
                range_degC: Range = (-40.0, 50.0), linear: bool = False,
                limits: Optional[Mapping[str, float]] = None,
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
        samples: each takes a device for every tolerance and three more.
        seed: that of the campaign without.
        jobs: threads; 0: one for each core.
        progress: True for a bar on standard error, or a function that is
            told the share of the work that is done.
    """
    options = _given(figures=list(figures), lowest_degC=range_degC[0],
                     highest_degC=range_degC[1], linear=linear,
                     limits=dict(limits or {}), samples=samples, seed=seed,
                     jobs=jobs)
    if compensator is not None:
        options["compensator"] = compensator_of(compensator)._trained("file")
    with Watched(progress, "studying") as function:
        found = _core.sensitivity(Campaign(campaign)._native, options, function)
    return SensitivityResult(*found)


