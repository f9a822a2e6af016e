# SPDX-License-Identifier: MIT
"""The verdict of a validation with its limits and main figures."""

from __future__ import annotations

import textwrap
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from . import style

# Colours, dashes and markers of series are those of the page of the report
# (validation/page/page.html).
ROLES = {"before": style.BEFORE, "after": style.AFTER, "fit": style.BLACK,
         "limit": style.BLACK}
MOST_MARKERS = 14  # on one curve
SHOWN = ("population_yield", "bias_over_temperature", "warm_up", "hysteresis",
         "residual_histogram", "scale_factor_over_temperature", "allan")
MOST_SHOWN = 6


def _styles(figure: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Colour, dash, marker and width of each series: by role, where a figure
    has both before and after."""
    roles = {each.get("role") for each in figure["series"]} - {"limit"}
    seen: dict[str, int] = {}
    for each in figure["series"]:
        role = each.get("role", "")
        k = seen[role] = seen.get(role, -1) + 1
        line_only = role in ("fit", "limit")
        by_role = role in ROLES and (len(roles) > 1 or line_only)
        broad = role == "before" and len(roles) > 1
        yield {"color": ROLES[role] if by_role else
               style.COLORS[k % len(style.COLORS)],
               "linestyle": style.DASHES[(k + line_only) % len(style.DASHES)],
               "marker": "" if line_only else style.MARKERS[
                   (k + 3 * (role == "before")) % len(style.MARKERS)],
               "linewidth": 3 if broad else 1.5,
               "markersize": 8 if broad else 5,
               "markerfacecolor": "none" if broad else None,
               "zorder": 2 if broad else 3}


def _numbers(values: Sequence[float | None]) -> list[float]:
    return [np.nan if value is None else value for value in values]


def _series(axes: Axes, kind: str, series: Mapping[str, Any],
            look: dict[str, Any]) -> None:
    x, y = _numbers(series["x"]), _numbers(series["y"])
    label = style.spoken(series["name"])
    if kind == "bars":
        axes.bar(x, y, width=x[1] - x[0] if len(x) > 1 else 1, alpha=0.6,
                 color=look["color"], edgecolor=look["color"], label=label)
        return
    if kind == "points":
        look = {**look, "linestyle": ""}
    else:
        look = {**look, "markevery": max(1, -(-len(x) // MOST_MARKERS))}
    axes.plot(x, y, label=label, **look)
    if "low" in series:
        axes.vlines(x, _numbers(series["low"]), _numbers(series["high"]),
                    color=look["color"], linewidth=1, zorder=look["zorder"])


def draw_figure(axes: Axes, figure: Mapping[str, Any]) -> None:
    """One of the figures of the report."""
    for series, look in zip(figure["series"], _styles(figure)):
        _series(axes, series.get("kind", figure["kind"]), series, look)
    axes.set_title(style.spoken(figure["title"]))
    for name in "xy":
        axis = figure[name]
        axes.set(**{f"{name}label": style.quantity(axis["label"],
                                                   axis["unit"] or "")})
        if axis["scale"] == "log":
            style.log_scale(getattr(axes, f"{name}axis"))


def each(result: Mapping[str, Any]) -> Iterator[tuple[str, Figure]]:
    """Every figure of the report by itself, for slides."""
    for figure in result["figures"]:
        drawn = style.new_figure(4.5)
        axes = drawn.subplots()
        draw_figure(axes, figure)
        if len(figure["series"]) > 1:
            longest = max(len(series["name"]) for series in figure["series"])
            style.legend_below(axes, 2 if longest > 25 else
                               3 if longest > 12 else 5)
        yield figure["id"], drawn


# --- all in one ---

def _shown(result: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The figures that matter most, then others in their order."""
    by_id = {figure["id"]: figure for figure in result.get("figures", [])
             if any(series["x"] for series in figure["series"])}
    first = [by_id[name] for name in SHOWN if name in by_id]
    others = [one for one in by_id.values() if one not in first]
    return (first + others)[:MOST_SHOWN]



def height(result: Mapping[str, Any]) -> float:
    rows = -(-len(_shown(result)) // 2)
    return 1.2 + _limit_height(result) + 2.6 * rows


def _limit_height(result: Mapping[str, Any]) -> float:
    limits = _judged(result)
    return 0.7 + 0.3 * len(limits) if limits else 0.0


def _judged(result: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    return [limit for limit in result.get("limits", [])
            if (limit.get("compared") or {}).get("value") is not None]


def _share(limit: Mapping[str, Any], value: float) -> float:
    """A value as the share of what its limit allows: 1 is the limit."""
    low: float | None = limit["min"]
    high: float | None = limit["max"]
    value = abs(value) if limit["absolute"] else value
    if low is not None and high is not None:
        return abs(value - (low + high) / 2) / ((high - low) / 2)
    if high is not None:
        return value / high if high > 0 else 1 + (value - high)
    assert low is not None
    return low / value if low > 0 and value > 0 else 1 + (low - value)


def _limits(axes: Axes, limits: Sequence[Mapping[str, Any]]) -> None:
    """Bars from nothing to the share of the limit that is used."""
    least = 1e-3
    for k, limit in enumerate(limits):
        compared = limit["compared"]
        if limit.get("relative_to"):  # the limit is that of another rate
            used = max(least, 1.0 if limit["margin"] == 0 else
                       compared["value"] / (compared["value"] +
                                            limit["margin"])
                       if compared["value"] + limit["margin"] > 0 else 1.0)
            ends = [used, used]
        else:
            used = max(least, _share(limit, compared["value"]))
            ends = sorted(max(least, _share(limit, end)) for end in
                          compared.get("interval") or [compared["value"]] * 2)
        color = style.RESULTS.get(limit["result"], style.BLACK)
        axes.barh(k, used - least, left=least, height=0.6, color=color)
        axes.plot(ends, [k, k], color=style.BLACK, lw=1.2)
        axes.annotate(f" {limit['result']}", (max(used, ends[1]), k),
                      xytext=(4, 0), textcoords="offset points", va="center",
                      fontsize=9, color=style.BLACK)
    axes.axvline(1, color=style.BLACK, lw=1.4)
    axes.set_yticks(range(len(limits)), [one["metric"] for one in limits])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    style.log_scale(axes.xaxis)
    axes.set(xlim=(least, max(10, 3 * axes.get_xlim()[1])),
             xlabel="share of the limit (line: the limit; bars end at the "
                    "value, with its 95 % interval)")
    axes.set_title("Limits")


def _words(result: Mapping[str, Any]) -> str:
    words = str(result["words"])
    failed = [check["name"] for check in result.get("checks", [])
              if check["passed"] is False]
    if failed:
        words += f" Checks failed: {', '.join(failed)}."
    population = result.get("population")
    if population and population.get("devices"):
        words += (f" {population['passed']} of {population['devices']} "
                  "devices pass.")
    return textwrap.shorten(words, 240, placeholder=" …")


def _small(axes: Axes, figure: Mapping[str, Any]) -> None:
    """A figure of the report among others: colours tell before from after."""
    draw_figure(axes, figure)
    for line in axes.lines:
        line.set(linewidth=min(line.get_linewidth(), 2.0),
                 markersize=min(line.get_markersize(), 5))
    axes.title.set_fontsize(9)
    axes.xaxis.label.set_fontsize(9)
    axes.yaxis.label.set_fontsize(9)
    axes.tick_params(labelsize=8)
    roles = {series.get("role") for series in figure["series"]}
    if not {"before", "after"} <= roles and 1 < len(figure["series"]) < 5:
        axes.legend(loc="best", fontsize=7, handlelength=1.6)


def draw(figure: Figure, result: Mapping[str, Any]) -> None:
    limits, shown = _judged(result), _shown(result)
    rows = -(-len(shown) // 2)
    style.titled(figure, f"{result['verdict'].upper()}: "
                 f"{result['compensator']['name']}", _words(result))
    parts = [_limit_height(result)] * bool(limits) + [2.6 * rows] * bool(rows)
    if not parts:
        return
    # Each part has a layout of its own.
    below = list(figure.subfigures(len(parts), 1, squeeze=False,
                                   height_ratios=parts)[:, 0])
    if limits:
        _limits(below.pop(0).subplots(), limits)
    if not rows:
        return
    grid = below[0].subplots(rows, 2, squeeze=False)
    for axes, one in zip(grid.flat, shown):
        _small(axes, one)
    for axes in grid.flat[len(shown):]:
        axes.axis("off")
    handles = [Line2D([], [], color=color, label=words, lw=2)
               for words, color in [("before compensation", style.BEFORE),
                                    ("after", style.AFTER)]]
    below[0].legend(handles=handles, loc="upper right", ncols=2)
    below[0].suptitle(" ", fontsize=9)
