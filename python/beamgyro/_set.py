# SPDX-License-Identifier: MIT
"""Sets of recordings, and how they are generated."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, overload

import numpy as np

from beamgyro import (_adapters, _arguments, _checks, _core, _lazy, _parquet,
                      _windows)
from beamgyro._campaign import Campaign, CampaignLike
from beamgyro._dataset import Path, dataset_of
from beamgyro._native import Native, Wrapper
from beamgyro._progress import ProgressArgument, watched
from beamgyro._warnings import warn

if TYPE_CHECKING:
    import xarray as xr

_MOST_TASKS = 1000000  # that share a directory


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

    def torch(self, inputs: Sequence[str] = _adapters.DEFAULT_INPUTS,
              target: str = _windows.BIAS, window: int = 1, *,
              part: Optional[str] = "train", runs: Iterable[str] = (),
              step: Optional[int] = None) -> _windows.Windows:
        """Return windows of the runs as a map-style dataset of torch.

        >>> windows = set.torch(["temperature", "quadrature"], window=600)
        >>> loader = DataLoader(windows, num_workers=2,
        ...                     batch_sampler=windows.batches(64, workers=2))

        It needs no torch itself: its items are arrays of NumPy, which the
        loader makes tensors of. The status of every run is read at once.

        Args:
            inputs: measured variables, or features as model files name them.
            target: "bias", the measured rate less the true rate, or a
                variable.
            window: samples of an item.
            part: "train", "validation" or "test"; None: all devices.
            runs: runs of the set to use; all without.
            step: samples from one window to the next; without, `window`.

        Raises:
            ValueError: there is no such variable or run, or no window is
                without a sample that is unpowered, saturated or not locked.
        """
        length = _arguments.count(window, "window")
        return _windows.Windows(
            self, self._chosen(part, runs), _windows.Columns(inputs, target),
            length, length if step is None else _arguments.count(step, "step"))

    def to_parquet(self, path: Path,
                   inputs: Sequence[str] = _adapters.DEFAULT_INPUTS,
                   target: str = _windows.BIAS, *,
                   part: Optional[str] = None,
                   runs: Iterable[str] = ()) -> None:
        """Write the samples as a table to FILE.parquet; pyarrow does it.

        Its columns are run, device, part, time, the inputs and the target, as
        of `torch`. Samples without power, without lock or beyond the full
        scale are left out. A row group is a run of a device, so that memory
        does not grow with the set.

        Raises:
            ImportError: pyarrow is missing.
            ValueError: there is no such variable, run or part.
        """
        _parquet.write(self, self._chosen(part, runs),
                       _windows.Columns(inputs, target), path)

    def card(self, *, license: str = "", url: str = "", creator: str = "",
             date: str = "", version: str = "1.0.0",
             progress: ProgressArgument = False) -> None:
        """Write croissant.json and README.md into the directory of the set.

        They are those of ``beamgyro card``. What Croissant requires and is
        not given is a warning.

        Args:
            license: an address, or a name of SPDX such as "CC-BY-4.0".
            url: the page of the set.
            creator: who made it.
            date: of publication, "2026-11-28".
            version: of the set.
            progress: as of `generate`.
        """
        texts = {name: _checks.text(value, name) for name, value in (
            ("license", license), ("url", url), ("creator", creator),
            ("date", date), ("version", version))}
        with watched(progress, "reading the set") as function:
            warn(self._native.write_card(texts, function))

    def _chosen(self, part: Optional[str],
                runs: Iterable[str]) -> list[tuple[str, int]]:
        """The runs of devices that have values, by device."""
        names = _checks.texts(runs, "runs") or self.runs
        for name in names:
            if name not in self.runs:
                raise ValueError(f"runs: {_checks.shown(name)}: expected some "
                                 f"of {', '.join(self.runs)}")
        devices = (range(self.devices) if part is None
                   else self.devices_of(part))
        failed = self._failed()
        return [(run, device) for device in devices for run in names
                if (run, device) not in failed]

    def _recordings_of(self, part: str
                       ) -> Iterator[tuple[str, _core.Recording]]:
        for run, device in self._chosen(part, ()):
            yield (f"{run} of device {device}",
                   self._native.recording(run, device))

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

    def _rows(self) -> list[tuple[str, str]]:
        parts = {part: len(self.devices_of(part))
                 for part in ("train", "validation", "test")}
        return [("directory", str(self.directory)),
                ("runs", ", ".join(self.runs)),
                ("devices", f"{self.devices}: " + ", ".join(
                    f"{count} {part}" for part, count in parts.items())),
                ("without values", f"{len(self.failures)} of "
                 f"{self.devices * len(self.runs)} runs"),
                ("seed", str(self.seed))]

    def __reduce__(self) -> tuple[Any, ...]:
        return Set, (str(self.directory),)


def open_set(directory: Path) -> Set:
    """Open a set; recordings are read when they are asked for."""
    return Set(directory)


@overload
def generate(campaign: CampaignLike, directory: Path, *,
             devices: Optional[int] = ..., jobs: int = ...,
             resume: bool = ..., shard: None = ...,
             progress: ProgressArgument = ...) -> Set: ...


@overload
def generate(campaign: CampaignLike, directory: Path, *,
             devices: Optional[int] = ..., jobs: int = ...,
             resume: bool = ..., shard: tuple[int, int],
             progress: ProgressArgument = ...) -> Optional[Set]: ...


def generate(campaign: CampaignLike, directory: Path, *,
             devices: Optional[int] = None, jobs: int = 0,
             resume: bool = False,
             shard: Optional[tuple[int, int]] = None,
             progress: ProgressArgument = True) -> Optional[Set]:
    """Simulate every device of a campaign into a directory.

    The bytes are those of ``beamgyro generate``. They do not depend on
    `jobs`, nor on interruptions.

    Args:
        campaign: a campaign, or its file.
        directory: where the set is written.
        devices: replaces the number of devices in the file.
        jobs: threads; 0: one for each core.
        resume: continues the set that is in the directory.
        shard: (i, n) makes only the files of task i of n, 1 to n, as
            ``--shard`` does: tasks share the directory, and may run at once
            on any hosts.
        progress: True for a bar on standard error, or a function that is
            called with the share of the work that is done, from 0 to 1.

    Returns:
        The set; with `shard` None, while files of other tasks are missing.

    Raises:
        ValueError: something is wrong in the campaign, or the directory
            holds another set.
        RuntimeError: writing failed, or no device works.
    """
    core = Campaign(campaign, devices)._native
    folder = _checks.path(directory, "directory", "the name of a directory")
    threads = _arguments.jobs(jobs)
    go_on = _checks.flag(resume, "resume")
    task = (0, 0) if shard is None else _task(shard)
    with watched(progress, "generating") as function:
        failures, warnings, is_whole = _core.generate(
            core, folder, threads, go_on, task, function)
    warn(warnings)
    if failures:
        warn([f"{folder}: {failures} runs have no values, since "
              "their devices do not work; see Set.failures"])
    return Set(directory) if is_whole else None


def _task(shard: Any) -> tuple[int, int]:
    """The number of a task and the number of all tasks."""
    pair = _checks.wholes(shard, "shard")
    if len(pair) != 2 or not 1 <= pair[0] <= pair[1] <= _MOST_TASKS:
        raise _checks.wrong(shard, "shard", "(i, n) with i from 1 to n, and n "
                            f"of at most {_MOST_TASKS}")
    return pair[0], pair[1]
