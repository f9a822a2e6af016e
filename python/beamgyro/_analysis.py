# SPDX-License-Identifier: MIT
"""Validation, Allan deviation, plans and sensitivity."""

from __future__ import annotations

import inspect
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

from beamgyro import _arguments, _checks, _core, _shipped, _toml
from beamgyro._compensation import Compensator, compensator_of
from beamgyro._dataset import Path, recording_of
from beamgyro._device import DeviceLike, device_of
from beamgyro._own_metrics import own_metrics
from beamgyro._progress import ProgressArgument, watched
from beamgyro._results import (AllanResult, PlanResult, SensitivityResult,
                               ValidationResult)
from beamgyro._set import Campaign, CampaignLike, Set
from beamgyro._training import Runs, model_of, named_runs
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

Range = tuple[float, float]


# Kinds of files that may be any CSV with a column of samples.
_TABLES = ("a table that characterise wrote", "a profile over time")


class _Files:
    """Files of what is in memory, for the duration of a call."""

    def __init__(self) -> None:
        self._directory: Optional[tempfile.TemporaryDirectory[str]] = None

    def __enter__(self) -> _Files:
        return self

    def __exit__(self, kind: object, error: Optional[BaseException],
                 traceback: object) -> None:
        if self._directory is None:
            return
        self._directory.cleanup()
        if isinstance(error, (ValueError, RuntimeError)):
            error.args = tuple(self._named(one) for one in error.args)
        notes = getattr(error, "__notes__", [])
        notes[:] = [self._named(note) for note in notes]

    def _named(self, message: Any) -> Any:
        """Return a message that calls what was in memory by its name."""
        if self._directory is None or not isinstance(message, str):
            return message
        return message.replace(self._directory.name + os.sep, "")

    def _path(self, name: str) -> str:
        if self._directory is None:
            try:
                self._directory = tempfile.TemporaryDirectory(
                    prefix="beamgyro-")
            except OSError as error:
                raise RuntimeError("cannot make a temporary directory: "
                                   f"{error.strerror}") from None
        return os.path.join(self._directory.name, name)

    def of_run(self, name: str, run: Union[xr.Dataset, Path]) -> str:
        """Return the file of a recording."""
        if isinstance(run, (str, os.PathLike)):
            return _checks.file(run, "runs", "a recording")
        # Never as CSV, which has no place for the text of the device.
        path = self._path(name if name.endswith(".h5") else f"{name}.h5")
        if os.path.exists(path):
            raise ValueError(f"{os.path.basename(path)}: is the name of two "
                             "runs; expected a name of its own for each")
        recording_of(run, name).write(path)
        return path

    def of_text(self, name: str, text: str) -> str:
        """Return a TOML file with a text."""
        path = self._path(name if name.endswith(".toml") else f"{name}.toml")
        try:
            FilePath(path).write_text(text, encoding="utf-8")
        except OSError as error:
            raise RuntimeError(f"{path}: cannot write: {error.strerror}"
                               ) from None
        return path

    def of_table(self, name: str, table: Union[Path, Mapping[str, Any]],
                 kind: str) -> str:
        """Return the file of a nested mapping, or of a kind."""
        if _checks.is_table(table):
            return self.of_text(name, _toml.text(table))
        return _checks.file(table, name, kind, _checks.MAPPING)


def validate(compensator: Any, runs: Optional[Runs] = None, *,
             set: Union[Set, Path, None] = None,
             device: Optional[DeviceLike] = None, jobs: int = 0,
             progress: ProgressArgument = False,
             **options: Any) -> ValidationResult:
    """Judge a compensator by every metric, check and limit.

    Give recordings, or a set, or a device that is simulated. The verdict is
    that of ``beamgyro validate`` with the same inputs. Compensators of Python
    are called by one thread at a time, with measured signals only.

    Args:
        compensator: a `Compensator`, or what makes one; with `device` also a
            model file or a mapping with its contents, which is trained first.
        runs: recordings that training has not seen.
        set: a set, whose test devices are judged.
        device: the device that a qualification is simulated with.
        jobs: threads; 0: one for each core.
        progress: True for a bar on standard error, or a function that is
            called with the share of the work that is done, from 0 to 1.
        options: further options, below. A specification may also be a
            mapping with its contents.

    Returns:
        The result, which prints as a table; ``passed`` tells the verdict.

    Raises:
        ValueError: something is wrong in the input.
        RuntimeError: a simulation or the compensator cannot go on.
    """
    if sum(one is not None for one in (runs, set, device)) != 1:
        raise ValueError("nothing to validate on, or too much; expected one "
                         "of runs, set= and device=")
    if isinstance(runs, Set):
        raise _checks.wrong(runs, "runs", "recordings; a set is given as set=")
    with _Files() as files, watched(progress, "validating") as function:
        given: dict[str, Any] = {"jobs": _arguments.jobs(jobs)}
        for keyword, value in options.items():
            if keyword not in _OPTIONS:
                raise TypeError("validate() got an unexpected keyword "
                                f"argument '{keyword}'")
            option = _OPTIONS[keyword]
            if value is not None:
                given[option.member] = option.read(files, value)
        if runs is not None:
            given["recordings"] = [files.of_run(name, run)
                                   for name, run in named_runs(runs)]
        elif set is not None:
            given["set"] = (set if isinstance(set, Set) else Set(set))._native
        else:
            assert device is not None
            given["device"] = device_of(device)._native
            given.setdefault("qualification", _shipped.file(
                "scenarios/qualification.toml"))
        found = _judged(compensator, given, function)
    text, json_text, warnings, page, junit, trained = found
    warn(warnings)
    return ValidationResult(
        text, json_text, warnings, page, junit,
        Compensator.parse(trained, "trained.json") if trained else None)


class _Option(NamedTuple):
    """An option of `validate`, from the table of the compiled part."""

    keyword: str
    member: str
    type: str
    kind: str
    subjects: list[str]
    words: str

    def read(self, files: _Files, value: Any) -> Any:
        """Return a value of its type."""
        if self.type == "file":
            if self.kind == "a specification":
                return files.of_table(self.keyword, value, self.kind)
            if not self.kind:
                return _checks.path(value, self.keyword)
            return _checks.file(value, self.keyword, self.kind)
        if self.type == "functions":
            return own_metrics(value, self.keyword)
        if self.type == "files":
            return _checks.paths(value, self.keyword)
        if self.type == "number":
            return _arguments.number(value, self.keyword, above=0)
        if self.type == "seed":
            if isinstance(value, str) and value == "random":
                return _core.random_seed()
            if isinstance(value, str):
                raise _checks.wrong(value, self.keyword,
                                    'a whole number, or "random"')
            return _arguments.seed(value, _arguments.LARGEST_JSON_SEED)
        if self.type == "whole":
            return _arguments.count(value, self.keyword)
        if self.type == "flag":
            return _checks.flag(value, self.keyword)
        return (_checks.texts if self.type == "texts"
                else _checks.wholes)(value, self.keyword)

    def parameter(self) -> inspect.Parameter:
        """Return it as a part of a signature."""
        types = {"file": Union[Path, Mapping[str, Any], None]
                 if self.kind == "a specification" else Optional[Path],
                 "number": Optional[float], "whole": Optional[int],
                 "seed": Union[int, str, None], "texts": Iterable[str],
                 "wholes": Iterable[int], "files": Iterable[Path],
                 "flag": bool,
                 "functions": Optional[Mapping[str, Any]]}
        return inspect.Parameter(
            self.keyword, inspect.Parameter.KEYWORD_ONLY,
            default=False if self.type == "flag" else
            () if self.type in ("texts", "wholes", "files") else None,
            annotation=types[self.type])


_OPTIONS = {row[0]: _Option(*row) for row in _core.validation_members()}


def _describe_options() -> None:
    """Show the options of `validate` in its help and its signature."""
    signature = inspect.signature(validate)
    named = [one for one in signature.parameters.values()
             if one.kind is not inspect.Parameter.VAR_KEYWORD]
    setattr(validate, "__signature__", signature.replace(
        parameters=named + [one.parameter() for one in _OPTIONS.values()]))
    lines = [f"        {one.keyword}: {one.words[:1].lower()}{one.words[1:]}; "
             f"with {' or '.join(one.subjects)}." for one in _OPTIONS.values()]
    text = validate.__doc__ or ""
    validate.__doc__ = text.replace(
        "\n    Returns:", "\n    Options:\n" + "\n".join(lines)
        + "\n\n    Returns:", 1)


_describe_options()


def _judged(compensator: Any, options: dict[str, Any],
            function: Any) -> tuple[str, str, list[str], str, str, str]:
    is_model = _checks.is_table(compensator) or (
        isinstance(compensator, (str, os.PathLike))
        and _core.source_kind(os.fsdecode(compensator)) == "model")
    if is_model:
        return _core.validate_model(model_of(compensator), options, function)
    if isinstance(compensator, (str, os.PathLike)):
        compensator = Compensator(
            compensator, plugin_files=options.get("plugin_files", ()),
            require_isolation=options.get("require_isolation", False))
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
    "bias_only": _checks.flag, "soaks": _arguments.count,
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

    Raises:
        ValueError: the compensator is no population, or something is wrong
            in the device or an argument.
    """
    unit = device_of(device)
    options = _checks.given(
        _PLAN_OPTIONS, bias_only=bias_only, soaks=soaks, hold_min=hold_min,
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
    if compensator is not None:
        options["compensator"] = compensator_of(compensator)._trained("file")
    with watched(progress, "studying") as function:
        found = _core.sensitivity(Campaign(campaign)._native, options,
                                  function)
    return SensitivityResult(*found)


