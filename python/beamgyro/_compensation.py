# SPDX-License-Identifier: MIT
"""Compensators: trained ones, programs, and those of Python."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from beamgyro import _adapters, _arguments, _checks, _core, _toml
from beamgyro._dataset import (Path, dataset_of, read_recording,
                               recording_of)
from beamgyro._progress import ProgressArgument, Watched
from beamgyro._set import Set
from beamgyro._shipped import program
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

Runs = Union["xr.Dataset", Path, Sequence[Union["xr.Dataset", Path]],
             Mapping[str, "xr.Dataset"]]


class Compensator:
    """What makes a rate without drift of the measured signals of a gyro.

    Args:
        source: one of

            - a compensator file (.json), as `train` writes it;
            - a shared library (.so) with the functions of beamgyro/plugin.h,
              or a command, ``"cmd:PROGRAM ARGS"``;
            - a function that takes the measured signals of a stretch from a
              power-on to the next loss of power (a dataset, or with `arrays`
              a dictionary of arrays) and returns the compensated rate of
              each sample [degree/s], or (rates, sigmas);
            - an estimator of scikit-learn that predicts the bias [degree/s]
              from `inputs`, a column each;
            - a torch module that computes the bias from a tensor of them.
              It answers in eval mode; the mode of each of its modules is then
              as before.

            A function, an estimator or a network owns what it is given and
            may write into it. Validation calls it many times, also with
            changed signals and with parts of a run: it must keep nothing from
            one call to the next.
        inputs: of an estimator or a network: its features, as model files
            name them ("temperature", "temperature_lowpass(100)",
            "since_power_on(300)", ...); by default its attribute
            ``beamgyro_inputs``, the names that it was fitted to, or the
            temperature. Of a function: the measured variables that it is
            given, by default all.
        arrays: whether a function takes arrays in place of a dataset.
        name: for reports.
        stall_s: how long a program may take to answer [s].

    Raises:
        ValueError: `source` is none of these, or cannot be read.
    """

    __slots__ = ("_native", "_source")

    _native: _core.RateCompensator

    def __init__(self, source: Any, *,
                 inputs: Optional[Sequence[str]] = None,
                 arrays: bool = False, name: Optional[str] = None,
                 stall_s: float = 10.0) -> None:
        stall_s = _arguments.number(stall_s, "stall_s", above=0)
        self._source: Optional[tuple[Any, ...]] = (
            source, inputs, arrays, name, stall_s)
        if isinstance(source, Compensator):
            self._native, self._source = source._native, source._source
        elif isinstance(source, (str, os.PathLike)):
            self._native = _opened(source, stall_s)
        else:
            self._native = _of_python(source, inputs, arrays, name)

    @classmethod
    def parse(cls, text: str,
              name: str = "compensator.json") -> Compensator:
        """Read the text of a compensator file, called `name` in messages."""
        return cls._of(_core.Compensator.parse(
            _checks.text(text, "text"), _checks.text(name, "name")))

    @classmethod
    def _of(cls, core: _core.Compensator) -> Compensator:
        compensator = cls.__new__(cls)
        compensator._native = core
        compensator._source = None
        return compensator

    def _trained(self, what: str) -> _core.Compensator:
        if isinstance(self._native, _core.Compensator):
            return self._native
        raise ValueError(
            f"{self.name}: has no {what}; expected a trained compensator")

    @property
    def name(self) -> str:
        """The name that reports give it."""
        return self._native.name

    @property
    def inputs(self) -> list[str]:
        """The measured variables that it reads; none: all there are."""
        return self._native.inputs

    @property
    def text(self) -> str:
        """The text of the file of a trained compensator."""
        return self._trained("text").text

    @property
    def method(self) -> str:
        """How a trained compensator was fitted."""
        return self._trained("method").method

    @property
    def temperature_range(self) -> tuple[float, float]:
        """The temperatures that its training saw [degC]."""
        core = self._trained("range")
        return core.lowest_temperature, core.highest_temperature

    def save(self, path: Path) -> None:
        """Write the file of a trained compensator.

        Raises:
            ValueError: it was not trained, or the name cannot be written.
            RuntimeError: writing failed.
        """
        self._trained("file").write(_checks.path(path, "path"))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Compensator):
            return NotImplemented
        mine, others = self._native, other._native
        if isinstance(mine, _core.Compensator) and isinstance(
                others, _core.Compensator):
            return mine.text == others.text
        return mine is others

    def __hash__(self) -> int:
        core = self._native
        return hash(core.text if isinstance(core, _core.Compensator)
                    else id(core))

    def __repr__(self) -> str:
        method = (f", {self._native.method}"
                  if isinstance(self._native, _core.Compensator) else "")
        return f"<beamgyro.Compensator {self.name}{method}>"

    def __reduce__(self) -> tuple[Any, ...]:
        if isinstance(self._native, _core.Compensator):
            return Compensator.parse, (self._native.text, self.name)
        assert self._source is not None
        return _compensator_of, self._source


def _compensator_of(source: Any, inputs: Optional[Sequence[str]],
                    arrays: bool, name: Optional[str],
                    stall_s: float) -> Compensator:
    return Compensator(source, inputs=inputs, arrays=arrays, name=name,
                       stall_s=stall_s)


def _opened(source: Path, stall_s: float) -> _core.RateCompensator:
    text = os.fspath(source)
    argument = (_checks.command(text, "compensator")
                if isinstance(text, str) and text.startswith("cmd:")
                else _checks.file(source, "compensator", "a compensator"))
    if argument.endswith(".json"):
        return _core.Compensator.read(argument)
    return _core.open_compensator(argument, program(), stall_s)


def _of_python(source: Any, inputs: Optional[Sequence[str]], arrays: bool,
               name: Optional[str]) -> _core.RateCompensator:
    if isinstance(source, type):
        raise ValueError(
            f"compensator {_checks.shown(source)}: is a class; expected an "
            f"instance of it, such as {source.__name__}()")
    called = (_checks.text(name, "name") if name is not None else
              str(getattr(source, "__name__", type(source).__name__)))
    if _adapters.is_torch_module(source) or _adapters.is_estimator(source):
        features = _adapters.inputs_of(source, inputs)
        make = (_adapters.answering_network
                if _adapters.is_torch_module(source)
                else _adapters.answering_estimator)
        return _core.function_compensator(
            called, _adapters.measured_columns(features),
            make(source, features, called))
    if callable(source):
        return _core.function_compensator(
            called, [] if inputs is None else _checks.texts(inputs, "inputs"),
            _adapters.answering_function(source, arrays, called))
    raise ValueError(
        f"compensator {_checks.shown(source)}: is no compensator; expected a "
        "file, a function, an estimator with predict() or a torch module")


def compensator_of(source: Any) -> Compensator:
    """Return anything that compensates as a Compensator."""
    return source if isinstance(source, Compensator) else Compensator(source)


def compensate(compensator: Any, recording: Union[xr.Dataset, Path]
               ) -> xr.Dataset:
    """Add what a compensator answers to a recording.

    Args:
        compensator: a `Compensator`, or what makes one.
        recording: a dataset of `run` or `open_recording`, or a file.

    Returns:
        The recording with ``compensated_rate`` and, where the compensator
        states it, ``compensated_rate_sigma`` (degree/s).

    Raises:
        ValueError: the recording lacks an input, or was compensated already.
        RuntimeError: the compensator did not answer as it should.
    """
    core, warnings = _core.compensate(compensator_of(compensator)._native,
                                      core_recording(recording))
    warn(warnings)
    return dataset_of(core)


def core_recording(run: Union[xr.Dataset, Path],
                   name: str = "recording") -> _core.Recording:
    """Return a recording of a dataset or a file."""
    if isinstance(run, (str, os.PathLike)):
        return read_recording(run, name)
    return recording_of(run, name)


def named_runs(runs: Runs, argument: str = "runs"
               ) -> list[tuple[str, Union[xr.Dataset, Path]]]:
    """Return runs with their names."""
    if isinstance(runs, (str, os.PathLike)):
        return [(FilePath(runs).name, runs)]
    given: Any = [runs] if hasattr(runs, "data_vars") else runs
    if _checks.is_table(given):
        return [(_run_name(name, argument), run)
                for name, run in given.items()]
    if hasattr(given, "shape") or isinstance(given, (bytes, Mapping)) or (
            not isinstance(given, Iterable)):
        raise _checks.wrong(given, argument, "recordings: datasets of run() "
                            "or open_recording(), or files")
    return [(FilePath(run).name if isinstance(run, (str, os.PathLike))
             else f"run {number}", run)
            for number, run in enumerate(given, start=1)]


def _run_name(name: Any, argument: str) -> str:
    right = "the name of a recording, a text without \"/\""
    if "/" in _checks.text(name, argument, right) or "\0" in name or not name:
        raise _checks.wrong(name, argument, right)
    return str(name)


_NamedRuns = list[tuple[str, Union["xr.Dataset", Path]]]


def _recordings(runs: _NamedRuns) -> list[tuple[str, _core.Recording]]:
    return [(name, core_recording(run, name)) for name, run in runs]


def _all_files(runs: _NamedRuns) -> bool:
    return all(isinstance(run, (str, os.PathLike)) for _, run in runs)


def _files(runs: _NamedRuns, argument: str) -> list[str]:
    return [_checks.file(run, argument, "a recording") for _, run in runs]


def model_of(model: Union[Path, Mapping[str, Any]]) -> _core.Model:
    """Return a model file, or a nested mapping with its contents."""
    if _checks.is_table(model):
        return _core.Model.parse(_toml.text(model), "model.toml")
    return _core.Model.read(_checks.file(model, "model", "a model file",
                                          _checks.MAPPING))


def train(model: Union[Path, Mapping[str, Any]],
          runs: Union[Runs, Set], held_out: Runs = (), *,
          set_runs: Iterable[str] = (), devices: Iterable[int] = (),
          seed: int = 0, cross_validation: str = "",
          progress: ProgressArgument = False) -> Compensator:
    """Train a compensator.

    The file of the result has the bytes that ``beamgyro train`` writes for
    the same files.

    Args:
        model: a model file, or its contents as a nested mapping.
        runs: recordings to fit: files, datasets, a mapping of names to
            datasets; or a set, whose training devices are fitted and whose
            validation devices are held out.
        held_out: recordings that a network stops early on.
        set_runs: runs of a set to use; all without.
        devices: devices of a set to fit; then none is held out.
        seed: of the initial weights of a network.
        cross_validation: "run", "cycle" or "leg": groups that are held out
            in turn.
        progress: True for a bar on standard error, or a function that is
            told the share of the epochs that are done, from 0 to 1.

    Raises:
        ValueError: something is wrong in the model or the recordings, or
            these do not suffice.
        RuntimeError: the fit failed.
    """
    core = model_of(model)
    seed = _arguments.seed(seed)
    groups = _checks.text(cross_validation, "cross_validation")
    kept = named_runs(held_out, "held_out")
    with Watched(progress, "training") as function:
        if isinstance(runs, Set):
            if kept or groups:
                raise ValueError(
                    "held_out and cross_validation are for recordings; a set "
                    "holds out its own validation devices")
            found = _core.train_set(
                core, runs._native, _checks.texts(set_runs, "set_runs"),
                _checks.wholes(devices, "devices"), seed, function)
        elif _all_files(fitted := named_runs(runs)) and _all_files(kept):
            found = _core.train_files(
                core, _files(fitted, "runs"), _files(kept, "held_out"), seed,
                groups, function)
        else:
            found = _core.train_recordings(
                core, _recordings(fitted), _recordings(kept), seed, groups,
                function)
    compensator, warnings, _ = found
    warn(warnings)
    return Compensator._of(compensator)


def features(recording: Union[xr.Dataset, Path],
             inputs: Sequence[str] = _adapters.DEFAULT_INPUTS
             ) -> np.ndarray[Any, Any]:
    """Compute the features of a model, a row for each sample.

    Rows without power are NaN. `inputs` are named as in model files.

    Raises:
        ValueError: there is no such input, or the recording lacks one.
    """
    return _core.features(_features(inputs), core_recording(recording))


def _features(inputs: Sequence[str]) -> list[str]:
    found = _checks.texts(inputs, "inputs")
    _arguments.not_empty(found, "inputs")
    return found


def training_rows(runs: Union[Runs, Set],
                  inputs: Sequence[str] = _adapters.DEFAULT_INPUTS, *,
                  part: str = "train", every_s: float = 0.0
                  ) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return features and labels for an estimator or a network.

    The label of a sample is its bias: the measured rate less the true rate,
    which a bench knows [degree/s]. Samples without power or beyond the full
    scale are left out.

    Args:
        runs: recordings as of `train`, or a set.
        inputs: features, as model files name them.
        part: of a set: "train", "validation" or "test".
        every_s: averages over so many seconds; 0: every sample.

    Returns:
        The features (rows, inputs) and the labels (rows).
    """
    recordings: Iterable[_core.Recording]
    every_s = _arguments.number(every_s, "every_s", least=0)
    names = _features(inputs)
    if isinstance(runs, Set):
        recordings = runs._recordings_of(part)
    else:
        recordings = (one for _, one in _recordings(named_runs(runs)))
    found = [_rows_of(one, names, every_s) for one in recordings]
    if not found:
        raise ValueError("no recordings to make rows of; expected at least "
                         "one")
    if not any(labels.size for _, labels in found):
        raise ValueError("runs: have no sample with power and within the full "
                         "scale; expected at least one")
    return (np.concatenate([rows for rows, _ in found]),
            np.concatenate([labels for _, labels in found]))


def _rows_of(recording: _core.Recording, inputs: list[str], every_s: float
             ) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    arrays = recording.arrays()
    if "true_rate" not in arrays:
        raise ValueError("true_rate: the recording has none; expected one "
                         "from a simulation or a bench")
    rows = _core.features(inputs, recording)
    labels = arrays["rate"] - arrays["true_rate"]
    good = (arrays["status"] & 3) == 0
    rows, labels, time = rows[good], labels[good], arrays["time"][good]
    if every_s == 0 or not time.size:
        return rows, labels
    block = np.floor(time / every_s)
    starts = np.flatnonzero(np.diff(block, prepend=-np.inf))
    counts = np.diff(np.append(starts, time.size))
    return (np.add.reduceat(rows, starts, axis=0) / counts[:, None],
            np.add.reduceat(labels, starts) / counts)


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


def _export_options(given: Mapping[str, Any]) -> dict[str, Any]:
    for name in given:
        if name not in _EXPORT_OPTIONS:
            raise ValueError(f"{name}: no option of export; expected one of "
                             f"{', '.join(sorted(_EXPORT_OPTIONS))}")
    return {name: _EXPORT_OPTIONS[name](value, name)
            for name, value in given.items() if value is not None}


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
    several = (compensators if isinstance(compensators, (list, tuple))
               else [compensators])
    folder = None if directory is None else FilePath(_checks.path(
        directory, "directory", "the name of a directory"))
    files, warnings = _core.export_files(
        [compensator_of(one)._trained("formula") for one in several],
        _checks.text(format, "format"), _export_options(options))
    warn(warnings)
    if folder is not None:
        _core.write_texts(folder, files)
    return dict(files)


