# SPDX-License-Identifier: MIT
"""A compensator: its bias over temperature, its sigma, what it leaves; or a
population: the mean of its devices and how they differ."""

from __future__ import annotations

import json
import pathlib
from typing import Any, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import documents, style
from .documents import PlotError
from .units import unit_of

SCORES = [("constant", "constant", style.GREY),
          ("cubic", "baseline", style.YELLOW),
          ("straight lines", "straight_lines", style.GREEN),
          ("compensator", "", style.AFTER)]
SAMPLES = [("in-sample", "in_sample_rms_deg_per_s"),
           ("held out", "held_out_rms_deg_per_s")]
Document = Mapping[str, Any]

# Those of files, where the program that draws them has computed them.
CURVES: dict[object, Document | None] = {}


def with_curve(one: Document, where: object) -> Document:
    """A compensator and its curve over temperature. The compiled part of the
    package computes it, and checks all that is drawn."""
    curve = CURVES.get(where)
    if curve is None:
        from beamgyro import _core
        try:
            text = documents.text_of(where) if isinstance(
                where, pathlib.Path) else json.dumps(
                    {key: one[key] for key in one if key != "name"})
            curve = json.loads(
                _core.Compensator.parse(text, str(where)).curve)
        except TypeError as error:
            raise PlotError(f"{where}: {error}; expected what a file of JSON "
                            "holds") from None
        except ValueError as error:
            raise PlotError(str(error)) from None
    return {**one, "curve": curve}


def height(compensators: Sequence[Document]) -> float:
    if len(compensators) == 1 and "population" in compensators[0]:
        return 6.6
    return 7.2 if any("sigma" in one for one in compensators) else 6.0


def draw(figure: Figure, compensators: Sequence[Document]) -> None:
    if len(compensators) == 1 and "population" in compensators[0]:
        _population(figure, compensators[0])
    elif len(compensators) == 1:
        _one(figure, compensators[0])
    else:
        _several(figure, compensators)


def _curve(axes: Axes, one: Document, color: str, label: str,
           band: bool = True, **options: Any) -> bool:
    """Bias over temperature, where that is all the compensator sees."""
    curve = one["curve"]
    if curve["bias_deg_per_s"] is None:
        return False
    T, values = curve["temperature_degC"], np.array(curve["bias_deg_per_s"])
    axes.plot(T, values, color=color, label=label, **options)
    if band and "sigma" in one:
        s = np.array(curve["sigma_deg_per_s"])
        axes.fill_between(T, values - s, values + s, color=color, alpha=0.25,
                          lw=0, label="±1σ stated")
    return True


def _range(axes: Axes, low: float, high: float) -> None:
    """Shades what lies beyond the temperatures of the training."""
    ends = axes.get_xlim()
    for begin, end in [(ends[0], low), (high, ends[1])]:
        if end > begin:
            axes.axvspan(begin, end, color="#ececec", lw=0, zorder=0.5)
    axes.set_xlim(ends)


def _one(figure: Figure, one: Document) -> None:
    stated = "sigma" in one
    rows = figure.subplots(2 + stated, 1,
                           height_ratios=[3, 1.6, 1.3] if stated else [3, 1.3])
    low, high = one["temperature_range_degC"]
    curve = one["curve"]
    T = np.array(curve["temperature_degC"])
    drawn = _curve(rows[0], one, style.AFTER, "bias taken away", zorder=3)
    rows[0].plot(T, curve["cubic_deg_per_s"], color=style.YELLOW,
                 ls=(0, (4, 2)), label="cubic of its training", lw=2.2,
                 zorder=2.5)
    if curve.get("straight_lines_deg_per_s") is not None:
        rows[0].plot(T, curve["straight_lines_deg_per_s"], color=style.GREEN,
                     ls=(0, (1, 1)), label="lines between its soaks",
                     lw=1.8, zorder=2.6)
    rows[0].set(ylabel="bias [°/s]", xlim=(T[0], T[-1]))
    words = "shaded: beyond the training, where the temperature is clamped"
    if not drawn:
        words = (f"its bias follows {' and '.join(curve['other_inputs'])}, not "
                 "the temperature alone: no curve")
    _range(rows[0], low, high)
    style.legend_above(rows[0])
    if stated:
        s = np.array(curve["sigma_deg_per_s"])
        rows[1].plot(T, s, color=style.AFTER)
        inside = s[(T >= low) & (T <= high)]
        rows[1].set(ylabel="stated σ [°/s]", ylim=(0, 2 * inside.max()),
                    xlim=(T[0], T[-1]))
        _range(rows[1], low, high)
    rows[int(stated)].set_xlabel("measured temperature [°C]")
    _scores(rows[-1], one)
    figure.align_ylabels(rows)
    training = one["training"]
    style.titled(figure, f"{one.get('name', 'Compensator')}: "
                 f"{training['method']}",
                 f"at steady temperatures, long after power-on; {words}"
                 if drawn else words)


def _scores(axes: Axes, one: Document) -> None:
    """The residuals that training found, beside those of the baselines."""
    training = one["training"]
    shown = [(words, key) for words, key in SAMPLES
             if training.get(key) is not None]
    validated = training.get("cross_validation")
    scores = [score for score in SCORES if score[1] != "straight_lines" or
              training.get("straight_lines_in_sample_rms_deg_per_s")
              is not None]
    height = 0.78 / len(scores)
    for k, (words, prefix, color) in enumerate(scores):
        values = [training.get(f"{prefix}_{key}" if prefix else key)
                  for _, key in shown]
        if validated:
            values.append({"constant": validated.get("constant_rms_deg_per_s"),
                           "": validated.get("rms_deg_per_s")}.get(prefix))
        places = [j + height * (k - (len(scores) - 1) / 2)
                  for j in range(len(values))]
        drawn = [(p, v) for p, v in zip(places, values) if v is not None]
        for number, (place, value) in enumerate(drawn):
            axes.barh(place, value, 0.92 * height, color=color,
                      label=None if number else words)
            axes.annotate(f"{value:.3g}", (value, place), xytext=(4, 0),
                          textcoords="offset points", va="center", fontsize=8)
    labels = [words for words, _ in shown]
    if validated:
        labels.append("cross-validation")
    axes.set_yticks(range(len(labels)), labels)
    axes.set_ylim(max(1, len(labels)) - 0.5, -0.5)
    axes.set_xlabel("rms left [°/s]")
    axes.set_xlim(0, 1.15 * axes.dataLim.x1 or 1.0)
    axes.grid(axis="y", visible=False)
    style.legend_above(axes)


def _several(figure: Figure, compensators: Sequence[Document]) -> None:
    stated = any("sigma" in one for one in compensators)
    rows = figure.subplots(2 if stated else 1, 1, squeeze=False, sharex=True,
                           height_ratios=[3, 1.6] if stated else [1])[:, 0]
    names = style.labels([str(one.get("name", "")) for one in compensators])
    without = []
    for k, (one, name) in enumerate(zip(compensators, names)):
        look: dict[str, Any] = {"ls": style.DASHES[k % len(style.DASHES)]}
        color = style.COLORS[k % len(style.COLORS)]
        if not _curve(rows[0], one, color, name, band=False, **look):
            without.append(name)
        if "sigma" in one:
            curve = one["curve"]
            rows[1].plot(curve["temperature_degC"], curve["sigma_deg_per_s"],
                         color=color,
                         label=name if curve["other_inputs"] else None, **look)
    rows[0].set_ylabel("bias [°/s]")
    if stated:
        rows[1].set_ylabel("stated σ [°/s]")
        rows[1].set_ylim(bottom=0)
    rows[-1].set_xlabel("measured temperature [°C]")
    style.legend_above(rows[0], 3)
    figure.align_ylabels(rows)
    about = "bias taken away at steady temperatures, long after power-on"
    if without:
        about += f"; no curve over temperature alone: {', '.join(without)}"
    style.titled(figure, f"{len(compensators)} compensators", about)


def _population(figure: Figure, one: Document) -> None:
    """Mean and spread of the bias over devices, and of each channel."""
    population = one["population"]
    T = np.asarray(population["temperatures_degC"])
    mean = np.asarray(population["mean"]).reshape(-1, len(T))
    modes = np.asarray(population["modes"])
    modes = modes.reshape(len(modes), *mean.shape)
    spread = np.sqrt((modes**2).sum(axis=0))
    # Each channel counts by its own spread.
    strongest = np.argsort(-(modes**2 / (spread**2).mean(
        axis=1, keepdims=True)).sum(axis=(1, 2)))[:4]
    names = ["bias", *population["channels"]]
    grid = figure.subplots(len(names), 2, sharex=True, squeeze=False)
    figure.align_ylabels(grid)
    for row, name, middle, sd, parts in zip(grid, names, mean, spread,
                                            modes.swapaxes(0, 1)):
        row[0].fill_between(T, middle - 2 * sd, middle + 2 * sd, lw=0,
                            color=style.AFTER, alpha=0.2, label="±2σ")
        row[0].fill_between(T, middle - sd, middle + sd, lw=0,
                            color=style.AFTER, alpha=0.35, label="±1σ")
        for end in (-2, 2):  # seen in grey, too
            row[0].plot(T, middle + end * sd, color=style.AFTER, lw=0.6)
        row[0].plot(T, middle, color=style.AFTER, label="mean of the devices")
        for k, mode in enumerate(strongest):
            row[1].plot(T, parts[mode], color=style.COLORS[k],
                        ls=style.DASHES[k],
                        label=("1st", "2nd", "3rd", "4th")[k])
        row[1].axhline(0, color=style.GREY, lw=0.8)
        words = style.quantity(name.replace("_", " "), unit_of(name))
        row[0].set_ylabel(words)
        row[1].set_ylabel(f"change of {words}")
    style.legend_above(grid[0, 0])
    style.legend_above(grid[0, 1])
    for axes in grid[-1]:
        axes.set_xlabel("measured temperature [°C]")
    style.titled(figure, f"{one.get('name', 'Population')}: population of "
                 f"{population['devices']:,} devices",
                 "left: mean and spread over devices; right: the strongest of "
                 f"{len(modes)} ways in which a device differs, 1σ each")
