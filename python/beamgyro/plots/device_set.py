# SPDX-License-Identifier: MIT
"""A set: how the devices of its runs differ, and how many there are."""

from __future__ import annotations

import json
import pathlib
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .errors import PlotError

Values = npt.NDArray[np.float64]
MOST_DEVICES = 200  # that are read, evenly over the set
MOST_RUNS = 3
BINS = 300
FILE = re.compile(r"[a-z][a-z0-9_]{0,199}_\d{5,}\.h5")
PARTS = {0: "train", 1: "validation", 2: "test"}


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


def read(path: pathlib.Path) -> DeviceSet:
    """A set by its directory, or one of its files or views."""
    if path.is_dir():
        lines = _manifest(path)
        names = lines[0]["runs"]
        files = {name: [path / line["file"] for line in lines
                        if FILE.fullmatch(str(line.get("file", "")))
                        and line["file"].rpartition("_")[0] == name]
                 for name in names}
        total = int(lines[0]["devices"])
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
    manifest = path / "manifest.jsonl"
    lines = []
    for number, line in enumerate(manifest.read_text().splitlines(), 1):
        try:
            lines.append(json.loads(line))
        except ValueError:
            raise PlotError(f"{manifest}:{number}: no JSON; `beamgyro verify` "
                            "says what is damaged") from None
    if not lines or "runs" not in lines[0]:
        raise PlotError(f"{manifest}:1: no runs; expected the manifest of a "
                        "whole set")
    return lines


def _run_of(path: pathlib.Path) -> str:
    import h5py
    with h5py.File(path) as file:
        return str(file.attrs["run"].decode())


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
    import h5py
    parts, states = [], []
    step = max(1, -(-total // MOST_DEVICES))
    for path in files:
        with h5py.File(path) as file:
            parts.append(file["part"][()])
            states.append(file["device_status"][()])
            if not total:
                step = max(1, -(-len(parts[0]) // MOST_DEVICES))
            if "rate" in file:
                _read_devices(run, file, states[-1], step)
    return np.concatenate(parts), np.concatenate(states)


def _read_devices(run: SetRun, file: Any, states: Any, step: int) -> None:
    time = file["time"][()]
    edges = np.unique(np.linspace(0, len(time), BINS + 1).astype(int))[:-1]
    run.time = np.add.reduceat(time, edges) / np.diff([*edges, len(time)])
    for row, number in enumerate(file["device"][()]):
        if number % step or states[row] != 0:
            continue
        values = _decoded(file["rate"], row)
        if "true_rate" in file and file["true_rate"].shape[-1] == len(time):
            values = values - _decoded(file["true_rate"], row)
        run.rate.append(_means(values, edges))


def _means(values: Values, edges: npt.NDArray[np.int64]) -> Values:
    finite = np.isfinite(values)
    count = np.add.reduceat(finite, edges, dtype=float)
    count[count == 0] = np.nan
    means: Values = np.add.reduceat(np.where(finite, values, 0), edges) / count
    return means


# --- drawing ---

def height(devices: DeviceSet) -> float:
    return 1.4 + 2.3 * len(devices.runs)


def draw(figure: Figure, devices: DeviceSet) -> None:
    grid = figure.subplots(len(devices.runs), 2, squeeze=False,
                           width_ratios=[3, 1.25])
    for row, run in zip(grid, devices.runs):
        _spread(row[0], run)
        _histogram(row[1], run)
        row[0].set_title(f"run {run.name}")
        row[0].legend(loc="upper right", ncols=4)
    counts = ", ".join(f"{count:,} {words}" for words, count in
                       devices.parts.items() if count)
    words = f"{devices.devices:,} devices ({counts})"
    if devices.failed:
        words += f", {devices.failed:,} failed"
    if devices.read < devices.devices - devices.failed:
        words += f"; drawn: {devices.read}, evenly over the set"
    if devices.more_runs:
        words += f"; not drawn: runs {', '.join(devices.more_runs)}"
    style.titled(figure, f"Set {devices.name}", words)


def _spread(axes: Axes, run: SetRun) -> None:
    rates = np.array(run.rate)
    if not len(rates):
        return
    longest = run.time[-1] - run.time[0]
    unit, scale = ("h", 3600.0) if longest > 3 * 3600 else ("min", 60.0)
    time = run.time / scale
    with np.errstate(all="ignore"):
        low, q5, q25, q50, q75, q95, high = np.nanpercentile(
            rates, [0, 5, 25, 50, 75, 95, 100], axis=0)
    axes.plot(time, low, color=style.GREY, lw=0.8)
    axes.plot(time, high, color=style.GREY, lw=0.8, label="all")
    axes.fill_between(time, q5, q95, color=style.AFTER, alpha=0.2, lw=0,
                      label="90 of 100")
    axes.fill_between(time, q25, q75, color=style.AFTER, alpha=0.35, lw=0,
                      label="half")
    axes.plot(time, q50, color=style.AFTER, label="median device")
    axes.set(xlabel=f"time [{unit}]", ylabel="drift [°/s]",
             xlim=(time[0], time[-1]))
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
