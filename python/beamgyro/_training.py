# SPDX-License-Identifier: MIT
"""Training of compensators, and rows for estimators and networks."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from beamgyro import _adapters, _arguments, _checks, _core, _toml
from beamgyro._compensation import Compensator
from beamgyro._dataset import Path, core_recording
from beamgyro._progress import ProgressArgument, watched
from beamgyro._set import Set
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

Runs = Union["xr.Dataset", Path, Sequence[Union["xr.Dataset", Path]],
             Mapping[str, "xr.Dataset"]]


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
        devices: devices of a set to fit; then none is held out. One device
            alone can be cross-validated.
        seed: of the initial weights of a network.
        cross_validation: "run", "cycle" or "leg": groups that are held out
            in turn.
        progress: True for a bar on standard error, or a function that is
            called with the share of the epochs that are done, from 0 to 1.

    Raises:
        ValueError: something is wrong in the model or the recordings, or
            these do not suffice.
        RuntimeError: the fit failed.
    """
    core = model_of(model)
    seed = _arguments.seed(seed)
    groups = _checks.text(cross_validation, "cross_validation")
    kept = named_runs(held_out, "held_out")
    named = _checks.texts(set_runs, "set_runs")
    numbered = _checks.wholes(devices, "devices")
    if not isinstance(runs, Set):
        _checks.refuse("for a set", set_runs=named or None,
                       devices=numbered or None)
    with watched(progress, "training") as function:
        if isinstance(runs, Set):
            if kept or (groups and len(numbered) != 1):
                raise ValueError(
                    "held_out is for recordings, and cross_validation for "
                    "these and for one device of a set; a set holds out its "
                    "own validation devices")
            found = _core.train_set(
                core, runs._native, named, numbered, seed, groups, function)
        elif _all_files(fitted := named_runs(runs)) and _all_files(kept):
            found = _core.train_files(
                core, _files(fitted, "runs"), _files(kept, "held_out"), seed,
                groups, function)
        else:
            found = _core.train_recordings(
                core, _recordings(fitted), _recordings(kept), seed, groups,
                function)
    compensator, warnings = found
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
    return _core.features(_checks.some_texts(inputs, "inputs"),
                          core_recording(recording))


def training_rows(runs: Union[Runs, Set],
                  inputs: Sequence[str] = _adapters.DEFAULT_INPUTS, *,
                  part: Optional[str] = None, every_s: float = 0.0
                  ) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Return features and labels for an estimator or a network.

    The label of a sample is its bias: the measured rate less the true rate,
    which a bench knows [degree/s]. Samples without power, without lock or
    beyond the full scale are left out, as `train` does.

    Args:
        runs: recordings as of `train`, or a set.
        inputs: features, as model files name them.
        part: of a set: "train", "validation" or "test"; "train" without.
        every_s: averages over blocks of so many seconds, which are counted
            from each power-on; a block that is less than half as full as the
            fullest is left out, as `train` does. 0: every sample.

    Returns:
        The features (rows, inputs) and the labels (rows), as `train` makes
        them.

    Raises:
        ValueError: a run has no true rate, an input, or no usable sample; as
            in `train`.
    """
    every_s = _arguments.number(every_s, "every_s", least=0)
    names = _checks.some_texts(inputs, "inputs")
    recordings: Iterable[tuple[str, _core.Recording]]
    if isinstance(runs, Set):
        recordings = runs._recordings_of("train" if part is None else part)
    else:
        _checks.refuse("for a set", part=part)
        recordings = _recordings(named_runs(runs))
    found = [_core.training_rows(names, name, one, every_s)[:2]
             for name, one in recordings]
    if not found:
        raise ValueError("no recordings to make rows of; expected at least "
                         "one")
    return (np.concatenate([rows for rows, _ in found]),
            np.concatenate([labels for _, labels in found]))
