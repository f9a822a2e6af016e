# SPDX-License-Identifier: MIT
"""A recording: rate, what compensation left of its error, temperatures and
the channels of the drive loop over time."""

from __future__ import annotations

import pathlib
from typing import Any, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from . import hdf5, style
from .documents import PlotError
from .envelope import MEANS, bins_of, envelope, lonely, spans
from .logs import csv_columns, device_of
from .units import converted, duration, time_unit, unit_of

Values = npt.NDArray[np.float64]

DRAWN = ("rate", "compensated_rate", "compensated_rate_sigma", "temperature",
         "drive_frequency", "quadrature", "true_rate", "true_bias",
         "true_beam_temperature", "true_board_temperature",
         "true_ambient_temperature")
STATES = [(1, "unpowered", "#c9c9c9", 0.6), (4, "loop not locked", "#e69f00",
                                            0.3), (2, "saturated", "#cc79a7",
                                                   0.35)]
MARKER_ROOM = 0.01  # of the span of time, at both ends of a picture


class Run:
    """The variables of a recording, in the units in which they are drawn."""

    def __init__(self, data: Mapping[Any, Any], name: str = "") -> None:
        # Of a dataset or a mapping.
        attributes: Any = getattr(data, "attrs", None) or data.get("attrs", {})
        self.name = name
        place = name or "recording"
        self.title = hdf5.text_of(attributes.get("title", ""))
        self.device = device_of(data, attributes)
        self.compensator = hdf5.text_of(attributes.get("compensator", ""))
        self.values = {key: _values(data[key], key, place)
                       for key in ("time", *DRAWN) if key in data}
        if "time" not in self.values:
            raise PlotError(f"{place}: no variable time; expected a recording "
                            "with time, rate and temperature")
        self.time = self.values["time"]
        if len(self.time) == 0:
            raise PlotError(f"{place}: no samples; expected one or more")
        if not _panels_of(self):
            raise PlotError(f"{place}: no value of {', '.join(DRAWN[:2])}, "
                            "temperature, drive_frequency or quadrature; "
                            "expected one or more")
        self.status = _status(_values(data["status"], "status", place),
                              place) if "status" in data else \
            np.zeros(len(self.time), np.uint8)
        self._require_sense()
        self.bins = bins_of(self.time)
        self.means = bins_of(self.time, MEANS) if self.bins.merged \
            else self.bins

    def _require_sense(self) -> None:
        where = f"{self.name}: " if self.name else ""
        counts = {key: len(values) for key, values in self.values.items()}
        for key, count in {**counts, "status": len(self.status)}.items():
            if count != len(self.time):
                raise PlotError(f"{where}{key}: {count} values; expected "
                                f"{len(self.time)}, as time has")
        if not (np.isfinite(self.time).all()
                and (np.diff(self.time) >= 0).all()):
            raise PlotError(f"{where}time: does not grow; expected times in "
                            "their order")

    def __contains__(self, key: str) -> bool:
        return key in self.values and bool(
            np.isfinite(self.values[key]).any())

    def error_of(self, key: str) -> Values:
        """A rate less the true rate, or as it is where that is not known."""
        truth = self.values.get("true_rate")
        return self.values[key] if truth is None else self.values[key] - truth

    @property
    def turns(self) -> bool:
        truth = self.values.get("true_rate")
        return truth is not None and bool(np.any(truth != 0))


def _status(values: Values, name: str) -> npt.NDArray[np.uint8]:
    wrong = ~((values >= 0) & (values <= 255) & (values == np.floor(values)))
    if wrong.any():
        raise PlotError(f"{name}: status: {values[np.argmax(wrong)]:g}; "
                        "expected whole numbers from 0 to 255")
    return values.astype(np.uint8)


def _values(variable: Any, key: str, name: str) -> Values:
    attributes = getattr(variable, "attrs", {})
    values = np.asarray(variable)
    if isinstance(variable, np.ma.MaskedArray):
        masked: Any = variable  # NumPy has no types for it
        values = masked.astype(float).filled(np.nan)
    if values.dtype.kind == "m":  # as xarray decodes the time
        return values / np.timedelta64(1, "ns") * 1e-9
    if values.ndim != 1:
        raise PlotError(f"{name}: {key} has {values.ndim} dimensions; "
                        "expected one device, as isel(device=0) gives it")
    if values.dtype.kind not in "biuf":
        raise PlotError(f"{name}: {key}: values of type {values.dtype}; "
                        "expected numbers")
    if key == "status":
        return values
    unit = hdf5.text_of(attributes.get("units", unit_of(key)))
    return converted(key, values.astype(float, copy=False), unit,
                     f"{name}: " if name else "")


def read(path: pathlib.Path, name: str) -> Run:
    with open(path, "rb") as file:
        if file.read(4) != b"\x89HDF":
            return Run(csv_columns(path, ("time", "status", *DRAWN)), name)
    with hdf5.opened(path) as recording:
        return Run(recording.contents, name)


# --- drawing ---

def draw(figure: Figure, runs: Sequence[Run]) -> None:
    """One recording, or several over each other."""
    if len(runs) == 1:
        _draw_one(figure, runs[0])
    else:
        _draw_several(figure, runs)


def draw_panel(axes: Axes, run: Run, panel: str) -> None:
    """One panel of a recording, in axes of the user's."""
    panels = _panels_of(run)
    if panel not in panels:
        raise PlotError(f"panel {panel!r}: is not one of this recording; "
                        f"expected one of {', '.join(panels)}")
    unit, scale = time_unit(float(run.time[-1] - run.time[0]))
    _PANELS[panel](axes, run, scale)
    _shade(axes, run, scale)
    axes.legend(handles=[*axes.get_legend_handles_labels()[0],
                         *_patches(run)])
    _time_axis([axes], [run], unit, scale)


def height(runs: Sequence[Run]) -> float:
    panels = _panels_of(runs[0]) if len(runs) == 1 else _compared(runs)
    return 1.0 + sum(_SHARES[kind] for kind in panels) * 0.9


_SHARES = {"rate": 2.2, "error": 2.0, "left": 2.0, "temperature": 1.6,
           "drive_frequency": 1.2, "quadrature": 1.2}


def _panels_of(run: Run) -> list[str]:
    panels = ["rate"] if "rate" in run or "compensated_rate" in run else []
    if run.turns and "rate" in run:
        panels.append("error")
    if "compensated_rate" in run:
        panels.append("left")
    panels += [key for key in ("temperature", "drive_frequency", "quadrature")
               if key in run]
    return panels


def _draw_one(figure: Figure, run: Run) -> None:
    panels = _panels_of(run)
    rows = _rows(figure, panels)
    unit, scale = time_unit(float(run.time[-1] - run.time[0]))
    for kind, axes in zip(panels, rows):
        _PANELS[kind](axes, run, scale)
        _shade(axes, run, scale)
        style.legend_above(axes, extra=_patches(run) if axes is rows[0] else ())
    _time_axis(rows, [run], unit, scale)
    words = [part for part in (run.title, run.device) if part]
    if run.compensator:
        words.append(f"compensated by {run.compensator}")
    if run.bins.merged:
        words.append(f"bands: lowest to highest of the {len(run.time):,} "
                     f"samples, lines: means of {duration(run.means.width)} "
                     "or less")
    style.titled(figure, run.name or "Recording", "; ".join(words))


def _rows(figure: Figure, panels: Sequence[str]) -> list[Axes]:
    grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False,
                           height_ratios=[_SHARES[kind] for kind in panels])
    figure.align_ylabels(grid)
    return list(grid[:, 0])


def _band(axes: Axes, run: Run, values: Values, scale: float, color: str,
          label: str, noisy: bool = False, alpha: float = 0.3,
          **options: Any) -> None:
    """The envelope of a series and its mean."""
    found = envelope(run.bins, values)
    if run.bins.merged:
        axes.fill_between(found.time / scale, found.low, found.high,
                          color=color, alpha=alpha, lw=0.5)
    if noisy:
        found = envelope(run.means, values)
    # Samples that no line joins to others, or too short a line to be seen.
    alone = lonely(found, run.time[-1] - run.time[0])
    if run.bins.merged and len(alone):
        axes.vlines(found.time[alone] / scale, found.low[alone],
                    found.high[alone], color=color, alpha=alpha)
    axes.plot(found.time / scale, found.mean, color=color, label=label,
              marker="o" if len(alone) else "", ms=3.5,
              markevery=list(alone), **{"lw": 1.3, **options})


def _rate(axes: Axes, run: Run, scale: float) -> None:
    if "rate" in run:
        _band(axes, run, run.values["rate"], scale, style.BEFORE, "measured",
              not run.turns)
    if run.turns:
        if "compensated_rate" in run:
            _band(axes, run, run.values["compensated_rate"], scale,
                  style.AFTER, "compensated")
        _band(axes, run, run.values["true_rate"], scale, style.TRUTH, "true",
              ls=(0, (4, 2)), lw=1.0)
        axes.set_ylabel("rate [°/s]")
    else:
        _true_bias(axes, run, scale)
        axes.set_ylabel("rate at rest [°/s]" if "true_rate" in run
                        else "rate [°/s]")


def _true_bias(axes: Axes, run: Run, scale: float) -> None:
    if "true_bias" in run:
        _band(axes, run, run.values["true_bias"], scale, style.TRUTH,
              "true bias: without noise and turn-on offset", ls=(0, (4, 2)), lw=1.0)


def _error(axes: Axes, run: Run, scale: float) -> None:
    _band(axes, run, run.error_of("rate"), scale, style.BEFORE,
          "measured less true rate", True)
    _true_bias(axes, run, scale)
    axes.set_ylabel("error [°/s]")


def _left(axes: Axes, run: Run, scale: float) -> None:
    known = "true_rate" in run
    error = run.error_of("compensated_rate")
    _band(axes, run, error, scale, style.AFTER,
          "compensated less true rate" if known else "compensated rate",
          True)
    if "compensated_rate_sigma" in run:
        sigma = envelope(run.bins, run.values["compensated_rate_sigma"])
        middle = np.zeros_like(sigma.mean) if known \
            else envelope(run.bins, error).mean
        for sign in (-1, 1):
            axes.plot(sigma.time / scale, middle + sign * sigma.mean,
                      color=style.BLACK, lw=1.1, ls=(0, (1, 1)),
                      label="stated ±1σ of its bias" if sign > 0 else None)
    if known:
        axes.axhline(0, color=style.BLACK, lw=0.8)
    axes.set_ylabel("error left [°/s]" if known else "compensated [°/s]")


def _temperature(axes: Axes, run: Run, scale: float) -> None:
    _band(axes, run, run.values["temperature"], scale, style.GREEN, "sensor")
    for node, color, dash in [("beam", style.PURPLE, (0, (5, 1.5))),
                              ("board", style.YELLOW, (0, (5, 1.5, 1, 1.5))),
                              ("ambient", style.BLACK, (0, (1, 1)))]:
        if f"true_{node}_temperature" in run:
            _band(axes, run, run.values[f"true_{node}_temperature"], scale,
                  color, node, ls=dash, lw=1.2)
    axes.set_ylabel("temp. [°C]")


def _drive_frequency(axes: Axes, run: Run, scale: float) -> None:
    values = run.values["drive_frequency"]
    middle = float(np.round(np.nanmedian(values)))
    _band(axes, run, values - middle, scale, style.GREY,
          f"drive frequency − {middle:.0f} Hz")
    axes.set_ylabel("drive [Hz]")


def _quadrature(axes: Axes, run: Run, scale: float) -> None:
    _band(axes, run, run.values["quadrature"], scale, style.GREY,
          "quadrature")
    axes.set_ylabel("quad. [°/s]")


_PANELS = {"rate": _rate, "error": _error, "left": _left,
           "temperature": _temperature, "drive_frequency": _drive_frequency,
           "quadrature": _quadrature}


def _shade(axes: Axes, run: Run, scale: float) -> None:
    for mask, name, color, alpha in STATES:
        for begin, end in spans(run.bins, run.status & mask != 0):
            axes.axvspan(begin / scale, end / scale, color=color, alpha=alpha,
                         lw=0, zorder=0.5, gid=f"state {name}")


def _patches(run: Run) -> list[Patch]:
    return [Patch(color=color, alpha=alpha, label=name, lw=0)
            for mask, name, color, alpha in STATES
            if np.any(run.status & mask)]


def _time_axis(rows: Sequence[Axes], runs: Sequence[Run], unit: str,
               scale: float) -> None:
    rows[-1].set_xlabel(f"time [{unit}]")
    begin = min(float(run.time[0]) for run in runs)
    end = max(float(run.time[-1]) for run in runs)
    if end > begin:
        markers = any(line.get_marker() == "o" for axes in rows
                      for line in axes.lines)
        reach = MARKER_ROOM * (end - begin) if markers else 0.0
        rows[-1].set_xlim((begin - reach) / scale, (end + reach) / scale)


# --- several ---

def _compared(runs: Sequence[Run]) -> list[str]:
    """The panels that all of them have."""
    def all_have(key: str) -> bool:
        return all(key in run for run in runs)

    panels = []
    if all_have("compensated_rate"):
        panels = ["left"]
    elif all_have("rate"):
        panels = ["rate"] + ["error"] * any(run.turns for run in runs)
    if all_have("temperature"):
        panels.append("temperature")
    if not panels:
        raise PlotError(f"{', '.join(run.name for run in runs)}: have neither "
                        "compensated_rate, rate nor temperature in common; "
                        "expected recordings to compare")
    return panels


def _draw_several(figure: Figure, runs: Sequence[Run]) -> None:
    panels = _compared(runs)
    rows = _rows(figure, panels)
    unit, scale = time_unit(max(float(run.time[-1] - run.time[0])
                                for run in runs))
    names = style.labels([run.name for run in runs])
    key = {"rate": "rate", "temperature": "temperature"}
    for kind, axes in zip(panels, rows):
        for k, (run, name) in enumerate(zip(runs, names)):
            if kind in ("left", "error"):
                values = run.error_of("compensated_rate" if kind == "left"
                                      else "rate")
            else:
                values = run.values[key[kind]]
            _band(axes, run, values, scale,
                  style.COLORS[k % len(style.COLORS)], name,
                  kind != "temperature" and not run.turns, 0.15,
                  ls=style.DASHES[k % len(style.DASHES)])
        axes.set_ylabel({"rate": "rate [°/s]", "error": "error [°/s]",
                         "left": "error left [°/s]",
                         "temperature": "temp. [°C]"}[kind])
    style.legend_above(rows[0], 3)
    _time_axis(rows, runs, unit, scale)
    about = ["error left: compensated less true rate"] \
        if "left" in panels else []
    if any(run.bins.merged for run in runs):
        about.append("bands: lowest to highest sample; lines: means")
    style.titled(figure, f"{len(runs)} recordings", "; ".join(about))
