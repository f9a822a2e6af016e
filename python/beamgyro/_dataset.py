# SPDX-License-Identifier: MIT
"""Recordings as xarray datasets and as arrays."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from beamgyro import _core, _lazy
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

Path = Union[str, "os.PathLike[str]"]

# Texts of /meta of a file, which are no attributes of its variables. They go
# along in the encoding of a dataset.
_META = {"scenario": "scenario_text", "device": "device_text",
         "overrides": "overrides_text"}


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
        "beamgyro": {name: getattr(recording, member)
                     for name, member in _META.items()}}
    return dataset


def _column_attributes(attributes: Mapping[Any, Any]) -> dict[str, str]:
    return {name: str(attributes[name])
            for name in ("units", "long_name", "role", "comment")
            if name in attributes}


def recording_of(dataset: xr.Dataset) -> _core.Recording:
    """Return a dataset with the dimension `time` as a recording."""
    if "time" not in dataset.variables or set(dataset.sizes) != {"time"}:
        raise ValueError(
            f"a dataset of the dimensions {', '.join(map(str, dataset.dims))};"
            " expected a recording, over time alone")
    size = dataset.sizes["time"]
    time = np.asarray(dataset.variables["time"].values, dtype=float)
    status = (np.asarray(dataset.variables["status"].values, dtype=np.uint8)
              if "status" in dataset.variables
              else np.zeros(size, dtype=np.uint8))
    recording = _core.Recording(time, status)
    for name, variable in dataset.variables.items():
        if name in ("time", "status"):
            continue
        recording.add(str(name), np.asarray(variable.values, dtype=float),
                      _column_attributes(variable.attrs))
    about = dataset.attrs
    recording.seed = int(about.get("seed", 0))
    recording.fidelity = str(about.get("fidelity", "imported"))
    for name in ("title", "history", "compensator", "compensator_sha256",
                 "git_revision"):
        setattr(recording, name, str(about.get(name, "")))
    recording.program_version = str(about.get("beamgyro_version", ""))
    texts = dataset.encoding.get("beamgyro", {})
    for name, member in _META.items():
        setattr(recording, member, texts.get(name, ""))
    return recording


def open_recording(path: Path) -> xr.Dataset:
    """Read a recording (.h5, or .csv) into memory.

    The checksum and the contents are checked, and known variables are
    converted to the units of beamgyro. The texts of the scenario and of the
    device go along in ``encoding["beamgyro"]``.

    Raises:
        ValueError: the file is missing, damaged or no recording.
    """
    recording, warnings = _core.read_recording(os.fspath(path))
    warn(warnings)
    return dataset_of(recording)


def save_recording(dataset: xr.Dataset, path: Path) -> None:
    """Write a recording, as CSV where the name ends in .csv, else as HDF5.

    A dataset of `run` gives the bytes that ``beamgyro run`` writes. The file
    appears under its name when it is complete.

    Raises:
        ValueError: the dataset is no recording, or the name cannot be written.
        RuntimeError: writing failed.
    """
    recording_of(dataset).write(os.fspath(path))
