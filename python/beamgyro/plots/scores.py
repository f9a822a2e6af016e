# SPDX-License-Identifier: MIT
"""The scores of a compensator on recordings or on the devices of a set."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .documents import (FLAG, NOT_NEGATIVE, TEXT, Shape, maybe, record,
                        rows)

# What is scored: words, colour, marker, dash.
SCORED = {"raw": ("without compensation", style.BEFORE, "D",
                  style.DASHES[3]),
          "cubic": ("cubic of the same training", style.GREY, "s",
                    style.DASHES[1]),
          "residual": ("compensated", style.AFTER, "o", style.DASHES[0])}
PANELS = [("rms_deg_per_s", "rms about zero"),
          ("sigma_deg_per_s", "1σ about the mean")]
MOST_RUNS = 30
_RUN = record({"run": TEXT}, {
    "in_sample": FLAG,
    **{kind: maybe(record({}, {name: maybe(NOT_NEGATIVE)
                               for name, _ in PANELS})) for kind in SCORED}})
_RUNS = record({"verdict": TEXT, "method": TEXT, "words": TEXT,
                "runs": rows(_RUN, 1), "overall": _RUN})
_SET = record(
    {"set": TEXT, "devices": rows(record(
        {"device": TEXT, "passed": FLAG},
        {f"{kind}_rms_deg_per_s": maybe(NOT_NEGATIVE) for kind in SCORED}),
        1)}, {"verdict": TEXT})
SHAPE = Shape("an object", lambda result, key: (
    _SET if "devices" in result else _RUNS).check(result, key))


def _runs(result: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    runs = list(result["runs"])[:MOST_RUNS]
    return [*runs, result["overall"]] if len(result["runs"]) > 1 else runs


def height(result: Mapping[str, Any]) -> float:
    return 4.8 if "devices" in result else 2.1 + 0.34 * len(_runs(result))


def draw(figure: Figure, result: Mapping[str, Any]) -> None:
    if "devices" in result:
        _devices(figure, result)
        return
    shown = [panel for panel in PANELS if _has_values(result, panel[0])] \
        or PANELS[:1]
    panels = figure.subplots(1, len(shown), sharey=True, squeeze=False)[0]
    _each_run(panels, shown, result)
    for axes, (_, words) in zip(panels, shown):
        axes.set_xlabel(style.quantity(words, "deg/s"))
        style.log_scale(axes.xaxis, (1, 3))
        axes.margins(x=0.1)
    # Wider than its panel: the layout sees an empty title in its place.
    panels[0].set_title(" ", pad=10)
    style.legend_above(panels[0], 3)
    panels[0].get_legend().set_in_layout(False)


def _has_values(result: Mapping[str, Any], figure_of_merit: str) -> bool:
    """Whether a value is above 0: there is no other on a logarithmic axis,
    and a single block of 60 s has no spread."""
    return any((one.get(kind) or {}).get(figure_of_merit)
               for one in _runs(result) for kind in SCORED)


def _each_run(panels: Sequence[Axes], shown: Sequence[tuple[str, str]],
              result: Mapping[str, Any]) -> None:
    runs = _runs(result)
    for axes, (figure_of_merit, _) in zip(panels, shown):
        for kind, (words, color, marker, _) in SCORED.items():
            found = [(one[kind][figure_of_merit], k)
                     for k, one in enumerate(runs) if one.get(kind)
                     and one[kind].get(figure_of_merit) is not None]
            if found:
                x, y = zip(*found)
                # What is as good as the cubic shows in its frame.
                axes.plot(x, y, marker, color=color, label=words,
                          **({"ms": 10, "mfc": "none", "mew": 1.8}
                             if kind == "cubic" else {"ms": 7}))
        axes.grid(axis="y", visible=True)
    names = style.labels([one["run"] + (" (in-sample)" if
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
    for kind, (words, color, _, dash) in SCORED.items():
        values = np.sort([row[f"{kind}_rms_deg_per_s"] for row in rows
                          if row.get(f"{kind}_rms_deg_per_s") is not None])
        share = 100 * np.arange(1, len(values) + 1) / max(1, len(values))
        axes.plot(values, share, color=color, label=words,
                  drawstyle="steps-post", ls=dash,
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
