# SPDX-License-Identifier: MIT
"""Populations of gyros, and the sets that are generated from them."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy, _toml
from beamgyro._dataset import Path, dataset_of
from beamgyro._device import Device, Keys
from beamgyro._native import Native, Wrapper
from beamgyro._progress import ProgressArgument, watched
from beamgyro._scenario import Scenario
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

CampaignLike = Union["Campaign", Path, Keys]


class Campaign(Wrapper):
    """A population of devices and the runs of each of them.

    It does not change. Campaigns are equal when their files are; a campaign
    pickles as the texts of these.

    Args:
        source: a campaign file, or its contents as a nested mapping. There
            files are named from the current directory; ``device`` and the
            ``scenario`` of a run may also be mappings or objects.
        devices: replaces the number of devices in the file.

    Raises:
        ValueError: with file, line and key, what is wrong.
    """

    __slots__ = ()

    _native: _core.Campaign

    def __init__(self, source: CampaignLike,
                 devices: Optional[int] = None) -> None:
        count = (None if devices is None else
                 _arguments.count(devices, "devices"))
        if isinstance(source, Campaign):
            self._native = (source._native if count is None else
                            _core.Campaign.parse(source._native.files, count))
        elif _checks.is_table(source):
            self._native = _campaign_of_keys(source, count)
        else:
            self._native = _core.Campaign.read(
                _checks.file(source, "campaign", "a campaign",
                             _checks.MAPPING), count)

    name = Native(str, "The name in the file.")
    text = Native(str, "The text of the campaign file.")
    devices = Native(int, "The number of devices.")
    seed = Native(int, "The seed of everything random.")
    runs = Native(list[str], "The names of the runs of each device.")

    def device(self, number: int) -> Device:
        """Return a device of the population; numbers start at 0.

        Raises:
            ValueError: there is no such device.
        """
        return Device._of(self._native.device(
            _arguments.whole(number, "device")))

    def _identity(self) -> Any:
        return tuple(self._native.files), self.devices

    def __repr__(self) -> str:
        return (f"<beamgyro.Campaign {self.name}: {self.devices} devices, "
                f"runs {', '.join(self.runs)}>")

    def __reduce__(self) -> tuple[Any, ...]:
        return Campaign._parsed, (self._native.files, self.devices)


def _campaign_of_keys(keys: Keys, count: Optional[int]) -> _core.Campaign:
    """The campaign of a mapping, whose parts are written as files to be read
    as those of any campaign; what it keeps of them are texts."""
    with tempfile.TemporaryDirectory() as folder:
        table = dict(keys)
        if "device" in table:
            table["device"] = _part(table["device"], folder, "device")
        if not _is_sequence_of_tables(table.get("run", [])):
            raise ValueError("campaign: run: expected a sequence of mappings "
                             "with name and scenario")
        table["run"] = [
            {**run, "scenario": _part(run["scenario"], folder,
                                      f"scenario_{number}")}
            if "scenario" in run else dict(run)
            for number, run in enumerate(table.get("run", []))]
        path = FilePath(folder) / "campaign.toml"
        path.write_text(_toml.text(table), encoding="utf-8")
        try:
            files = _core.Campaign.read(path, count).files
        except ValueError as error:
            raise ValueError(str(error).replace(f"{folder}/", "")) from None
    return _core.Campaign.parse(
        [(_without(place, folder), text) for place, text in files], count)


def _is_sequence_of_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and all(
        isinstance(one, Mapping) for one in value)


def _part(source: Any, folder: str, name: str) -> str:
    """The path of a file, or of one that is written of keys or an object."""
    if isinstance(source, (str, os.PathLike)):
        return os.path.abspath(os.fspath(source))
    path = FilePath(folder) / f"{name}.toml"
    if isinstance(source, (Device, Scenario)):
        if source.overrides:
            raise ValueError(f"campaign: {name}: {source!r}: has replaced keys;"
                             " expected a mapping with them, or the file")
        path.write_text(source.text, encoding="utf-8")
    elif _checks.is_table(source):
        table = {key: _part(part, folder, f"{name}_device")
                 if key == "device" else part for key, part in source.items()}
        path.write_text(_toml.text(table), encoding="utf-8")
    else:
        raise _checks.wrong(source, f"campaign: {name}",
                            "a file, a mapping or an object of beamgyro")
    return path.name  # as seen from the file that names it


def _without(place: Any, folder: str) -> FilePath:
    """A place in the folder, as seen from there; another one as it is."""
    path = FilePath(os.fspath(place))
    return path.relative_to(folder) if path.is_relative_to(folder) else path


class Set(Wrapper, Mapping[tuple[str, int], "xr.Dataset"]):
    """The recordings of many devices in one directory.

    A mapping of (run, device) to recordings, which are read when they are
    asked for. Devices that failed are left out. As of every mapping, any
    other key raises KeyError in ``set[key]`` and is not ``in`` the set; the
    methods raise ValueError.

    Args:
        directory: what `generate` or ``beamgyro generate`` wrote.

    Raises:
        ValueError: there is no finished set.
    """

    __slots__ = ()

    _native: _core.Set

    def __init__(self, directory: Path) -> None:
        # Absolute: it is read later, when another directory may be current.
        self._native = _core.Set.open(os.path.abspath(
            _checks.file(directory, "set", "the directory of a set")))

    directory = Native(FilePath, "Where the set is.")
    devices = Native(int, "The number of devices, which are counted from 0.")
    runs = Native(list[str], "The names of the runs of each device.")
    seed = Native(int, "The seed of everything random.")
    failures = Native(list[tuple[str, int, str]],
                   "Run, device and reason of each run that has no values.")

    def part(self, device: int) -> str:
        """Return what a device is for: "train", "validation" or "test"."""
        return self._native.part(_arguments.whole(device, "device"))

    def devices_of(self, part: str) -> list[int]:
        """Return the devices of a part, in their order."""
        if part not in ("train", "validation", "test"):
            raise _checks.wrong(part, "part",
                                "\"train\", \"validation\" or \"test\"")
        return [device for device in range(self.devices)
                if self.part(device) == part]

    def recording(self, run: str, device: int) -> xr.Dataset:
        """Return a run of a device, in the units of recordings.

        Raises:
            ValueError: there is no such run or device, the device failed, or
                its file has other bytes than the manifest says.
        """
        return dataset_of(self._native.recording(
            _checks.text(run, "run"), _arguments.whole(device, "device")))

    def slow_recording(self, run: str, device: int) -> xr.Dataset:
        """Return the truths that are stored at a lower rate."""
        return dataset_of(self._native.slow_recording(
            _checks.text(run, "run"), _arguments.whole(device, "device")))

    def parameters(self, run: Optional[str] = None) -> xr.Dataset:
        """Return the numbers that were drawn, over ``device``.

        `run` is by default the first one; numbers of the devices are the
        same in all runs. Those of a device that failed are NaN.
        """
        name = self.runs[0] if run is None else _checks.text(run, "run")
        drawn: dict[str, tuple[Any, dict[str, str]]] = {}
        failed = {device for one, device, _ in self.failures if one == name}
        for device in range(self.devices):
            if device in failed:
                continue
            for key, value, units, words in self._native.parameters(name,
                                                                  device):
                values, _ = drawn.setdefault(
                    key, (np.full(self.devices, np.nan),
                          {"units": units, "long_name": words}))
                values[device] = value
        xarray = _lazy.xarray()
        table: xr.Dataset = xarray.Dataset(
            {key: ("device", values, about)
             for key, (values, about) in drawn.items()},
            {"device": np.arange(self.devices)})
        return table

    def view(self, run: str) -> xr.Dataset:
        """Open all devices of a run as one dataset, without reading it.

        The data are those of the file RUN.nc; close the dataset after use.
        """
        if run not in self.runs:
            raise ValueError(
                f"{self.directory}: has no run {_checks.shown(run)}; expected "
                f"one of {', '.join(self.runs)}")
        file = self.directory / f"{run}.nc"
        if not file.is_file():
            raise ValueError(f"{file}: no such file; expected the whole set")
        dataset: xr.Dataset = _lazy.xarray().open_dataset(file,
                                                          engine="h5netcdf")
        return dataset

    def verify(self, progress: ProgressArgument = False
               ) -> list[tuple[str, str]]:
        """Compare every byte with the manifest.

        Returns:
            The damaged files with what is wrong; none for a whole set.
        """
        with watched(progress, "verifying") as function:
            return self._native.verify(function)

    def _failed(self) -> set[tuple[str, int]]:
        return {(run, device) for run, device, _ in self.failures}

    def _recordings_of(self, part: str) -> Iterator[_core.Recording]:
        failed = self._failed()
        for device in self.devices_of(part):
            for run in self.runs:
                if (run, device) not in failed:
                    yield self._native.recording(run, device)

    def __getitem__(self, key: tuple[str, int]) -> xr.Dataset:
        if key not in self:
            raise KeyError(
                f"{_checks.shown(key)}: expected (run, device) with a run of "
                f"{', '.join(self.runs)} and a device from 0 to "
                f"{self.devices - 1} that did not fail")
        run, device = key
        return self.recording(run, device)

    def __contains__(self, key: object) -> bool:
        if not isinstance(key, tuple) or len(key) != 2:
            return False
        run, device = key
        return (isinstance(run, str) and run in self.runs
                and not isinstance(device, bool)
                and hasattr(device, "__index__")
                and 0 <= device < self.devices and key not in self._failed())

    def __iter__(self) -> Iterator[tuple[str, int]]:
        failed = self._failed()
        for run in self.runs:
            for device in range(self.devices):
                if (run, device) not in failed:
                    yield run, device

    def __len__(self) -> int:
        return len(self.runs) * self.devices - len(self._failed())

    def _identity(self) -> Any:
        return self.directory

    def __repr__(self) -> str:
        return (f"<beamgyro.Set {self.directory}: {self.devices} devices, "
                f"runs {', '.join(self.runs)}>")

    def __reduce__(self) -> tuple[Any, ...]:
        return Set, (str(self.directory),)


def open_set(directory: Path) -> Set:
    """Open a set; recordings are read when they are asked for."""
    return Set(directory)


def generate(campaign: CampaignLike, directory: Path, *,
             devices: Optional[int] = None, jobs: int = 0,
             resume: bool = False, progress: ProgressArgument = True) -> Set:
    """Simulate every device of a campaign into a directory.

    The bytes are those of ``beamgyro generate``. They do not depend on
    `jobs`, nor on interruptions.

    Args:
        campaign: a campaign, or its file.
        directory: where the set is written.
        devices: replaces the number of devices in the file.
        jobs: threads; 0: one for each core.
        resume: continues the set that is in the directory.
        progress: True for a bar on standard error, or a function that is
            called with the share of the work that is done, from 0 to 1.

    Raises:
        ValueError: something is wrong in the campaign, or the directory
            holds another set.
        RuntimeError: writing failed, or no device works.
    """
    core = Campaign(campaign, devices)._native
    folder = _checks.path(directory, "directory", "the name of a directory")
    threads = _arguments.jobs(jobs)
    go_on = _checks.flag(resume, "resume")
    with watched(progress, "generating") as function:
        failures, warnings = _core.generate(core, folder, threads, go_on,
                                            function)
    warn(warnings)
    if failures:
        warn([f"{folder}: {failures} runs have no values, since "
              "their devices do not work; see Set.failures"])
    return Set(directory)
