# SPDX-License-Identifier: MIT
"""The scores of a compensator on recordings or on the devices of a set."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np
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
    return 4.8 if "devices" in result else 2.1 + 0.34 * len(_runs(result))


def draw(figure: Figure, result: Mapping[str, Any]) -> None:
    if "devices" in result:
        _devices(figure, result)
        return
    panels = figure.subplots(1, 2, sharey=True)
    _each_run(panels, result)
    for axes, (_, words) in zip(panels, PANELS):
        axes.set_xlabel(style.quantity(words, "deg/s"))
        style.log_scale(axes.xaxis, (1, 3))
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


def _devices(figure: Figure, result: Mapping[str, Any]) -> None:
    """The share of the scored runs of all devices that keep to each value."""
    axes = figure.subplots()
    rows = result["devices"]
    for kind, (words, color, _) in SCORED.items():
        values = np.sort([row[f"{kind}_rms_deg_per_s"] for row in rows
                          if row.get(f"{kind}_rms_deg_per_s") is not None])
        share = 100 * np.arange(1, len(values) + 1) / max(1, len(values))
        axes.plot(values, share, color=color, label=words,
                  drawstyle="steps-post",
                  marker="o" if len(values) < 10 else "")
    axes.set(xlabel=style.quantity(PANELS[0][1], "deg/s"), ylim=(0, 103),
             ylabel="runs at or below [%]")
    style.log_scale(axes.xaxis, (1, 3))
    style.legend_above(axes, 3)
    devices = len({row["device"] for row in rows})
    kept = sum(bool(row["passed"]) for row in rows)
    style.titled(figure, f"{result.get('verdict', 'scores').upper()}: set "
                 f"{result['set']}",
                 f"{devices} devices, {len(rows)} runs, of which {kept} pass; "
                 "residual in blocks of 60 s")


def figure_of(panels: Sequence[Axes]) -> Figure:
    return panels[0].figure
