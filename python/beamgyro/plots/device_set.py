# SPDX-License-Identifier: MIT
"""A set: how the devices of its runs differ, and how many there are."""

from __future__ import annotations

import pathlib
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import documents, hdf5, style
from .documents import PlotError
from .envelope import means_of
from .units import time_unit

Values = npt.NDArray[np.float64]
MOST_DEVICES = 200  # that are read, evenly over the set
FEWEST_FOR_SHARES = 20  # devices; fewer are drawn one by one
MOST_RUNS = 3
LONGEST_NAME = 60  # of a run [letters]
BINS = 300
MANIFEST = "manifest.jsonl"
FILE = re.compile(r"[a-z][a-z0-9_]{0,199}_\d{5,}\.h5")
PARTS = {0: "train", 1: "validation", 2: "test"}
_HEAD = documents.record({"runs": documents.rows(documents.TEXT, 1),
                          "devices": documents.COUNT})
_LINE = documents.record({}, {"file": documents.TEXT})


@dataclass
class SetRun:
    """Means over short times, one row each device."""

    name: str
    time: Values = field(default_factory=lambda: np.empty(0))
    rate: list[Values] = field(default_factory=list)


@dataclass
class DeviceSet:
    name: str
    runs: list[SetRun]
    devices: int  # in the whole set
    parts: dict[str, int]
    failed: int
    more_runs: list[str]

    @property
    def read(self) -> int:
        return max(len(run.rate) for run in self.runs)


def read(path: pathlib.Path, _: str = "") -> DeviceSet:
    """A set by its directory, or one of its files or views."""
    if path.is_dir():
        lines = _manifest(path)
        names = lines[0]["runs"]
        files = {name: [path / line["file"] for line in lines
                        if FILE.fullmatch(line.get("file", ""))
                        and line["file"].rpartition("_")[0] == name]
                 for name in names}
        for name in names:
            if not files[name]:
                raise PlotError(f"{path / MANIFEST}: no file of the run "
                                f"{name}; expected one or more")
        total = lines[0]["devices"]
    else:
        files, total = {_run_of(path): [path]}, 0
    shown = list(files)[:MOST_RUNS]
    counts: dict[str, int] = {}
    failed = 0
    runs = []
    for number, name in enumerate(shown):
        run = SetRun(name)
        status = _read_run(run, files[name], total)
        runs.append(run)
        if number == 0:
            parts, states = status
            failed = int((states != 0).sum())
            counts = {words: int((parts == part).sum())
                      for part, words in PARTS.items()}
            total = len(parts)
    if not any(run.rate for run in runs):
        raise PlotError(f"{path}: no device has values of rate; expected a "
                        "set with the variable rate")
    return DeviceSet(path.resolve().name, runs, total, counts, failed,
                     list(files)[MOST_RUNS:])


def _manifest(path: pathlib.Path) -> list[dict[str, Any]]:
    manifest = path / MANIFEST
    lines: list[dict[str, Any]] = []
    for number, text in enumerate(documents.text_of(manifest).splitlines(), 1):
        where = f"{manifest}:{number}"
        line = documents.parsed(text, where)
        documents.check(line, _LINE if lines else _HEAD, where)
        lines.append(line)
    if not lines:
        raise PlotError(f"{manifest}: empty; expected the manifest of a "
                        "whole set")
    return lines


def _run_of(path: pathlib.Path) -> str:
    with hdf5.opened(path) as file:
        return hdf5.text_of(file.attributes.get("run", path.stem))


def _decoded(variable: Any, device: int) -> Values:
    counts = variable[device]
    about = variable.attrs
    values = counts * float(about.get("scale_factor", 1.0)) \
        + float(about.get("add_offset", 0.0))
    if "_FillValue" in about:
        values[counts == about["_FillValue"]] = np.nan
    return np.asarray(values, dtype=float)


def _read_run(run: SetRun, files: list[pathlib.Path], total: int
              ) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Reads some devices, and part and status of all."""
    parts, states = [], []
    step = max(1, -(-total // MOST_DEVICES))
    for path in files:
        with hdf5.opened(path) as file:
            numbers, part, state = (file.numbers(name) for name in
                                    ("device", "part", "device_status"))
            if not len(numbers) == len(part) == len(state):
                raise PlotError(f"{path}: {len(numbers)} values of device, "
                                f"{len(part)} of part and {len(state)} of "
                                "device_status; expected as many of each")
            parts.append(part)
            states.append(state)
            if not total:
                step = max(1, -(-len(part) // MOST_DEVICES))
            if "rate" in file:
                _read_devices(run, file, np.flatnonzero(
                    (state == 0) & (numbers % step == 0)), len(numbers))
    return np.concatenate(parts), np.concatenate(states)


def _read_devices(run: SetRun, file: hdf5.File, shown: npt.NDArray[np.int64],
                  devices: int) -> None:
    time = file.numbers("time")
    rates = [file.variable(name, 2) for name in ("rate", "true_rate")
             if name in file]
    for variable in rates:
        if variable.shape != (devices, len(time)) or not len(time):
            raise PlotError(
                f"{file.path}: {variable.name[1:]}: {variable.shape}; "
                f"expected {devices} devices and {len(time)} times, 1 or more")
    edges = np.unique(np.linspace(0, len(time), BINS + 1).astype(int))[:-1]
    if run.rate and len(edges) != len(run.time):
        raise PlotError(f"{file.path}: time: {len(time)} values; expected as "
                        f"many as the first file of run {run.name} has")
    run.time = np.add.reduceat(time, edges) / np.diff([*edges, len(time)])
    for row in shown:
        values = _decoded(rates[0], row)
        for truth in rates[1:]:
            values = values - _decoded(truth, row)
        if np.isfinite(values).any():
            run.rate.append(means_of(edges, values))


# --- drawing ---

def height(devices: DeviceSet) -> float:
    return 1.4 + 2.3 * len(devices.runs)


def draw(figure: Figure, devices: DeviceSet) -> None:
    grid = figure.subplots(len(devices.runs), 2, squeeze=False,
                           width_ratios=[3, 1.25],
                           gridspec_kw={"wspace": 0.06})
    for row, run in zip(grid, devices.runs):
        _spread(row[0], run)
        _histogram(row[1], run)
        row[0].set_title(f"run {style.shortened(run.name, LONGEST_NAME)}")
        if run.rate:
            row[0].legend(loc="upper right", ncols=2, fontsize=8)
    counts = ", ".join(f"{count:,} {words}" for words, count in
                       devices.parts.items() if count)
    words = f"{devices.devices:,} devices ({counts})"
    if devices.failed:
        words += f", {devices.failed:,} failed"
    if devices.read < devices.devices - devices.failed:
        words += f"; drawn: {devices.read}, evenly over the set"
    if any(len(run.rate) >= FEWEST_FOR_SHARES for run in devices.runs):
        words += "; bands and lines at each time, which no device follows"
    if devices.more_runs:
        words += f"; not drawn: runs {', '.join(devices.more_runs)}"
    style.titled(figure, f"Set {devices.name}", words)


def _spread(axes: Axes, run: SetRun) -> None:
    rates = np.array(run.rate)
    if not len(rates):
        return
    unit, scale = time_unit(float(run.time[-1] - run.time[0]))
    time = run.time / scale
    with np.errstate(all="ignore"):
        low, q5, q25, q50, q75, q95, high = np.nanpercentile(
            rates, [0, 5, 25, 50, 75, 95, 100], axis=0)
    if len(rates) < FEWEST_FOR_SHARES:
        for number, rate in enumerate(rates):
            axes.plot(time, rate, color=style.GREY, lw=0.8,
                      label="each device" if number == 0 else None)
    else:
        axes.plot(time, low, color=style.GREY, lw=0.8)
        axes.plot(time, high, color=style.GREY, lw=0.8, label="lowest and highest of all")
        axes.fill_between(time, q5, q95, color=style.AFTER, alpha=0.2, lw=0,
                          label="90 of 100")
        axes.fill_between(time, q25, q75, color=style.AFTER, alpha=0.35,
                          lw=0, label="half")
    if len(rates) > 1:
        axes.plot(time, q50, color=style.AFTER, label="median device")
    axes.set(xlabel=f"time [{unit}]", ylabel="drift [°/s]")
    if time[-1] > time[0]:
        axes.set_xlim(time[0], time[-1])
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top + 0.25 * (top - bottom))  # for the legend


def _histogram(axes: Axes, run: SetRun) -> None:
    if not run.rate:
        return
    with np.errstate(all="ignore"):
        peaks = [float(np.nanmax(rate) - np.nanmin(rate))
                 for rate in run.rate if np.isfinite(rate).any()]
    axes.hist(peaks, min(30, max(8, len(peaks) // 6)), color=style.AFTER)
    axes.set(xlabel="p-p of each device [°/s]", ylabel="devices",
             xlim=(0, None))
    axes.yaxis.get_major_locator().set_params(integer=True)
