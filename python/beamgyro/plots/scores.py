# SPDX-License-Identifier: MIT
"""The scores of a compensator on recordings or on the devices of a set."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np
from matplotlib import ticker
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style

# What is scored: words, colour, marker.
SCORED = {"raw": ("without compensation", style.BEFORE, "D"),
          "cubic": ("cubic of the same training", style.GREY, "s"),
          "residual": ("compensated", style.AFTER, "o")}
PANELS = [("rms_deg_per_s", "rms about zero"),
          ("sigma_deg_per_s", "1σ about the mean")]
MOST_RUNS = 30


def _runs(result: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    runs = list(result["runs"])[:MOST_RUNS]
    return [*runs, result["overall"]] if len(result["runs"]) > 1 else runs


def height(result: Mapping[str, Any]) -> float:
    if "devices" in result:
        return 4.8
    return 2.1 + 0.34 * len(_runs(result))


def draw(figure: Figure, result: Mapping[str, Any]) -> None:
    panels = figure.subplots(1, 2, sharey=True)
    if "devices" in result:
        _devices(panels, result)
    else:
        _each_run(panels, result)
    for axes, (_, words) in zip(panels, PANELS):
        axes.set_xlabel(style.quantity(words, "deg/s"))
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(ticker.LogLocator(subs=[1, 3]))
        axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
        axes.xaxis.set_minor_formatter(ticker.NullFormatter())
        axes.margins(x=0.1)
    # Wider than its panel: the layout sees an empty title in its place.
    panels[0].set_title(" ", pad=10)
    style.legend_above(panels[0], 3)
    panels[0].get_legend().set_in_layout(False)


def _each_run(panels: Sequence[Axes], result: Mapping[str, Any]) -> None:
    runs = _runs(result)
    for axes, (figure_of_merit, _) in zip(panels, PANELS):
        for kind, (words, color, marker) in SCORED.items():
            found = [(one[kind][figure_of_merit], k)
                     for k, one in enumerate(runs) if one.get(kind)
                     and one[kind].get(figure_of_merit) is not None]
            if found:
                x, y = zip(*found)
                axes.plot(x, y, marker, color=color, label=words, ms=7)
        axes.grid(axis="y", visible=True)
    names = style.shortened([one["run"] + (" (in-sample)" if
                                           one.get("in_sample") else "")
                             for one in runs], 34)
    panels[0].set_yticks(range(len(runs)), names)
    panels[0].set_ylim(len(runs) - 0.5, -0.5)
    rest = len(result["runs"]) - MOST_RUNS
    style.titled(figure_of(panels),
                 f"{result['verdict'].upper()}: {result['method']}",
                 f"{result['words']}; residual in blocks of 60 s" +
                 (f"; {rest} more runs in the file" if rest > 0 else ""))


def _devices(panels: Sequence[Axes], result: Mapping[str, Any]) -> None:
    """The share of the devices that keep to each value."""
    scored = [one.get("overall", one) for one in result["devices"]]
    for axes, (figure_of_merit, _) in zip(panels, PANELS):
        for kind, (words, color, _) in SCORED.items():
            values = np.sort([
                one[kind][figure_of_merit] for one in scored if one.get(kind)
                and one[kind].get(figure_of_merit) is not None])
            if len(values):
                share = 100 * np.arange(1, len(values) + 1) / len(values)
                axes.step(values, share, where="post", color=color,
                          label=words)
    panels[0].set_ylabel("devices at or below [%]")
    panels[0].set_ylim(0, 102)
    style.titled(figure_of(panels),
                 f"{result['verdict'].upper()}: {len(scored)} devices of "
                 f"{result['set']}", "residual in blocks of 60 s")


def figure_of(panels: Sequence[Axes]) -> Figure:
    return panels[0].figure
