# SPDX-License-Identifier: MIT
"""Recordings as xarray datasets and as arrays."""

from __future__ import annotations

import os
import zlib
from collections.abc import Mapping
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy
from beamgyro._checks import Path as Path
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

# Texts of /meta of a file, which are no attributes of its variables. They go
# along in the encoding of a dataset.
_META = {"scenario": "scenario_text", "device": "device_text",
         "overrides": "overrides_text"}


def _checksums(recording: _core.Recording) -> dict[str, int]:
    """Return the checksum of each variable but the answers of compensators."""
    roles = recording.variable_attributes()
    return {name: zlib.crc32(values.data)
            for name, values in recording.arrays().items()
            if roles[name]["role"] != "compensated"}


def _note_changes(recording: _core.Recording,
                  checksums: Optional[Mapping[str, int]]) -> None:
    """Add a line to the history of a recording with other values.

    They are compared with the checksums of what the program returned, which
    the encoding of a dataset keeps until xarray drops it. Variables that are
    left out are no change.
    """
    is_simulated = recording.fidelity not in ("imported", "csv")
    if not is_simulated and not recording.history:
        return  # claims to come from nowhere
    if checksums and _checksums(recording).items() <= checksums.items():
        return
    lines = recording.history.splitlines()
    line = (f"{'' if checksums else 'not known to be un'}changed after "
            f"{'simulation' if is_simulated else 'import'}")
    if lines[-1:] != [line]:
        recording.history = "\n".join([*lines, line])


def dataset_of(recording: _core.Recording) -> xr.Dataset:
    """Return a recording as xarray.open_dataset() returns its file.

    The arrays are those of the recording, not copies.
    """
    xarray = _lazy.xarray()
    arrays = recording.arrays()
    attributes = recording.variable_attributes()
    variables = {}
    for name, values in arrays.items():
        kind = xarray.IndexVariable if name == "time" else xarray.Variable
        variables[name] = kind(
            ("time",), values, attributes[name],
            {"dtype": values.dtype, "original_shape": values.shape},
            fastpath=True)
    dataset: xr.Dataset = xarray.Dataset(
        variables, attrs=recording.file_attributes())
    dataset.encoding = {
        "unlimited_dims": set(),
        "beamgyro": {"checksums": _checksums(recording),
                     **{name: getattr(recording, member)
                        for name, member in _META.items()}}}
    return dataset


def _column_attributes(attributes: Mapping[Any, Any]) -> dict[str, str]:
    found = {name: _checks.text(str(attributes[name]), name)
             for name in ("units", "long_name", "role", "comment")
             if name in attributes}
    if found.get("units") == "deg/s":
        found["units"] = "degree/s"
    return found


def warn_of_lost_units(dataset: xr.Dataset) -> None:
    """Warn of signals without units beside others that state theirs.

    Arithmetic of xarray drops the attributes of what it computes.
    """
    stated = {name for name, variable in dataset.variables.items()
              if "units" in variable.attrs}
    warn(f"{name}: states no units, though others do; taken as "
         f"{_core.unit_of(str(name))}"
         for name in dataset.variables
         if stated and name not in stated and _core.unit_of(str(name)))


def recording_of(dataset: xr.Dataset, argument: str = "recording", *,
                 is_sound: bool = True) -> _core.Recording:
    """Return a dataset with the dimension `time` as a recording.

    It is checked as a file is when it is written, unless `is_sound` is false.
    """
    if not hasattr(dataset, "data_vars"):
        raise _checks.wrong(dataset, argument, "a dataset of run() or "
                            "open_recording(), or the file of a recording")
    if set(dataset.sizes) != {"time"}:
        raise ValueError(
            f"{argument}: a dataset of the dimensions "
            f"{', '.join(map(str, dataset.dims))}; expected a recording, over "
            "time alone")
    if "time" not in dataset.variables:
        raise ValueError(f"{argument}: has no variable time; expected the "
                         "times of its samples [s]")
    warn_of_lost_units(dataset)
    size = dataset.sizes["time"]
    _arguments.require_unit(dataset.variables["time"], "time", "s")
    time = _arguments.seconds(dataset.variables["time"].values, "time")
    status = (_arguments.status(dataset.variables["status"].values)
              if "status" in dataset.variables
              else np.zeros(size, dtype=np.uint8))
    recording = _core.new_recording(time, status)
    for name, variable in dataset.variables.items():
        if name in ("time", "status") or variable.ndim == 0:
            continue  # a coordinate without a dimension, as isel() leaves it
        recording.add(_checks.text(str(name), "variable"),
                      _arguments.numbers(variable.values, str(name)),
                      _column_attributes(variable.attrs))
    about = dataset.attrs
    recording.seed = _arguments.seed(about.get("seed", 0))
    recording.fidelity = _checks.text(
        str(about.get("fidelity", "imported")), "fidelity")
    for name in ("title", "history", "compensator", "compensator_sha256",
                 "git_revision"):
        setattr(recording, name,
                _checks.text(str(about.get(name, "")), name))
    recording.program_version = _checks.text(
        str(about.get("beamgyro_version", "")), "beamgyro_version")
    texts = dataset.encoding.get("beamgyro", {})
    for name, member in _META.items():
        setattr(recording, member, _checks.text(texts.get(name, ""), name))
    _note_changes(recording, texts.get("checksums"))
    if is_sound:
        recording.require_sound()
    return recording


def read_recording(path: Path, name: str) -> _core.Recording:
    """Return the recording in a file."""
    recording, warnings = _core.read_recording(
        _checks.file(path, name, "a recording"))
    warn(warnings)
    return recording


def open_recording(path: Path) -> xr.Dataset:
    """Read a recording (.h5, or .csv) into memory.

    The checksum and the contents are checked, and known variables are
    converted to the units of beamgyro. The texts of the scenario and of the
    device go along in ``encoding["beamgyro"]``.

    Raises:
        ValueError: the file is missing, damaged or no recording.
    """
    return dataset_of(read_recording(path, "path"))


def recording_name(path: Path) -> str:
    """Return the name of a recording that is written: FILE.h5 or FILE.csv."""
    name = _checks.path(path, "path")
    ending = FilePath(name).suffix
    if ending not in (".h5", ".csv"):
        raise ValueError(f"path {_checks.shown(name)}: unknown kind of file "
                         f"{_checks.shown(ending)}; expected a name that ends "
                         "in .h5 or .csv")
    return name


def save_recording(dataset: xr.Dataset, path: Path) -> None:
    """Write a recording, as HDF5 to FILE.h5 or as CSV to FILE.csv.

    A dataset of `run` gives the bytes that ``beamgyro run`` writes. If its
    values were changed, its history says so: "changed after simulation". The
    file appears under its name when it is complete.

    Raises:
        ValueError: the dataset is no recording, or the name cannot be written.
        RuntimeError: writing failed.
    """
    recording_of(dataset, "dataset").write(recording_name(path))


def core_recording(run: Union[xr.Dataset, Path],
                   name: str = "recording") -> _core.Recording:
    """Return a recording of a dataset or a file."""
    if isinstance(run, (str, os.PathLike)):
        return read_recording(run, name)
    return recording_of(run, name)
