# SPDX-License-Identifier: MIT
"""The verdict of a validation with its limits and main figures."""

from __future__ import annotations

import re
import textwrap
from typing import Any, Iterator, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from . import style
from .allan import axis_per_hour
from .documents import (FLAG, NAME, NOT_NEGATIVE, NUMBER, TEXT, both, either,
                        maybe, record, rows, WrongValue)

# Colours, dashes and markers of series are those of the page of the report
# (validation/page/page.html).
ROLES = {"before": style.BEFORE, "after": style.AFTER, "fit": style.BLACK,
         "limit": style.BLACK}
MOST_MARKERS = 14  # on one curve
SHOWN = ("population_yield", "bias_over_temperature", "warm_up", "hysteresis",
         "residual_histogram", "scale_factor_over_temperature", "allan")
MOST_SHOWN = 6
LONGEST_METRIC = 40  # [letters]
ROW, LEGEND = 2.6, 0.3  # height of a row of figures, of what is above [inch]
LETTERS_OF_LEGEND = 52  # in a line of a panel's legend
LEAST_LIMIT = 1e-30  # a share of a smaller one tells nothing

_KIND = either("line", "points", "bars")
_ENDS = rows(maybe(NUMBER))  # of intervals that may be open
_AXIS = record({"label": TEXT, "unit": TEXT,
                "scale": either("linear", "log")})
_SERIES = record(
    {"name": TEXT, "x": rows(NUMBER), "y": rows(NUMBER)},
    {"role": TEXT, "kind": _KIND, "low": _ENDS, "high": _ENDS},
    alike=("x", "y", "low", "high"))
_FIGURE = record({"id": NAME, "title": TEXT, "kind": _KIND, "x": _AXIS,
                  "y": _AXIS, "series": rows(_SERIES)})


def _has_an_end(limit: Mapping[str, Any], key: str) -> None:
    if limit["min"] is None and limit["max"] is None:
        raise WrongValue(key, "neither min nor max is a number", "one or both")


_LIMIT = both(record({
    "metric": TEXT, "min": maybe(NUMBER), "max": maybe(NUMBER),
    "absolute": FLAG, "relative_to": maybe(TEXT), "margin": maybe(NUMBER),
    "compared": maybe(record({"value": maybe(NUMBER)},
                             {"interval": maybe(rows(maybe(NUMBER), 2, 2))})),
    "result": maybe(either("pass", "fail", "undecided"))}), _has_an_end)
SHAPE = record({
    "verdict": TEXT, "words": TEXT, "compensator": record({"name": TEXT}),
    "limits": rows(_LIMIT), "figures": rows(_FIGURE),
    "checks": rows(record({"name": TEXT, "passed": maybe(FLAG)}))},
    {"population": maybe(record({"devices": NOT_NEGATIVE,
                                 "passed": NOT_NEGATIVE})),
     # These are not drawn, but a result without them is not whole.
     "metrics": rows(record({})), "runs": rows(record({"name": TEXT})),
     "provenance": record({}, {"device": TEXT, "qualification": TEXT}),
     "sigma": record({}), "warnings": rows(TEXT)})


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
    if figure["id"] == "allan":
        axis_per_hour(axes)


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
    by_id = {figure["id"]: figure for figure in result["figures"]
             if any(series["x"] for series in figure["series"])}
    first = [by_id[name] for name in SHOWN if name in by_id]
    others = [one for one in by_id.values() if one not in first]
    return (first + others)[:MOST_SHOWN]


def height(result: Mapping[str, Any]) -> float:
    rows = -(-len(_shown(result)) // 2)
    return 1.2 + _limit_height(result) + (LEGEND + ROW * rows) * bool(rows)


def _limit_height(result: Mapping[str, Any]) -> float:
    limits = _judged(result)
    return 0.7 + 0.3 * len(limits) if limits else 0.0


def _judged(result: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The limits; one that no run shows is undecided, and not left out."""
    return list(result["limits"])


def _has_value(limit: Mapping[str, Any]) -> bool:
    return (limit.get("compared") or {}).get("value") is not None


def _share(limit: Mapping[str, Any], value: float) -> float:
    """A value as the share of what its limit allows: 1 is the limit."""
    low: float | None = limit["min"]
    high: float | None = limit["max"]
    value = abs(value) if limit["absolute"] else value
    if low is not None and high is not None:
        return abs(value - (low + high) / 2) / max((high - low) / 2,
                                                   LEAST_LIMIT)
    if high is not None:
        return value / high if high > LEAST_LIMIT else 1 + (value - high)
    assert low is not None
    return low / value if low > 0 and value > LEAST_LIMIT \
        else 1 + (low - value)


def _limits(axes: Axes, limits: Sequence[Mapping[str, Any]]) -> None:
    """Bars from nothing to the share of the limit that is used."""
    least = 1e-3
    for k, limit in enumerate(limits):
        if not _has_value(limit):
            axes.barh(k, 1 - least, left=least, height=0.6, color="none",
                      edgecolor=style.GREY, hatch="///", lw=0)
            _result_words(axes, "undecided: no run shows it", least, k)
            continue
        compared = limit["compared"]
        if limit.get("relative_to"):  # the limit is that of another rate
            allowed = compared["value"] + (limit.get("margin") or 0)
            used = max(least, compared["value"] / allowed if allowed > 0
                       else 1.0)
            ends = [used, used]
        else:
            used = max(least, _share(limit, compared["value"]))
            ends = sorted(max(least, _share(limit, compared["value"] if end is
                                            None else end)) for end in
                          compared.get("interval") or [None, None])
        color = style.RESULTS.get(limit["result"], style.BLACK)
        axes.barh(k, used - least, left=least, height=0.6, color=color)
        axes.plot(ends, [k, k], color=style.BLACK, lw=1.2)
        _result_words(axes, str(limit["result"]), max(used, ends[1]), k)
    axes.axvline(1, color=style.BLACK, lw=1.4)
    axes.set_yticks(range(len(limits)), style.labels(
        [one["metric"] for one in limits], LONGEST_METRIC))
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    style.log_scale(axes.xaxis)
    axes.set(xlim=(least, max(10, 3 * axes.get_xlim()[1])),
             xlabel="share of the limit (line: the limit; bars end at the "
                    "value, with its 95 % interval)")
    axes.set_title("Limits")


def _result_words(axes: Axes, words: str, x: float, y: float) -> None:
    """Beside a bar; the line of the limit does not run through them."""
    axes.annotate(words, (x, y), xytext=(6, 0), textcoords="offset points",
                  va="center", fontsize=9, color=style.BLACK,
                  bbox={"fc": "white", "ec": "none", "pad": 1})


def _title(result: Mapping[str, Any]) -> str:
    """Verdict, compensator, and what it was judged on."""
    title = f"{result['verdict'].upper()}: {result['compensator']['name']}"
    device = (result.get("provenance") or {}).get("device")
    runs = [run["name"] for run in result.get("runs") or []]
    if device:
        return f"{title} on {device}"
    if not runs:
        return title
    others = f" and {len(runs) - 1} more runs" if len(runs) > 2 else ""
    return f"{title} on {' and '.join(runs[:1 if others else 2])}{others}"


def _words(result: Mapping[str, Any]) -> str:
    words = str(result["words"])
    failed = [check["name"] for check in result["checks"]
              if check["passed"] is False]
    if failed:
        words += f" Checks failed: {', '.join(failed)}."
    population = result.get("population")
    if population and population.get("devices"):
        words += (f" {population['passed']} of {population['devices']} "
                  "devices pass.")
    words = textwrap.shorten(words, 240, placeholder=" …")
    provenance = result.get("provenance") or {}
    if provenance.get("device") and provenance.get("qualification"):
        words += (f" The runs of {provenance['qualification']} with the "
                  f"virtual gyro {provenance['device']}.")
    return words


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
    for side in axes.child_axes:
        side.yaxis.label.set_fontsize(9)
        side.tick_params(labelsize=8)
    handles = _handles(axes, figure)
    if handles:
        _legend_within(axes, handles)


def _handles(axes: Axes, figure: Mapping[str, Any]) -> list[Any]:
    """What the legend above all panels does not say: where colours tell before
    from after, dashes tell the runs; both have the same dash."""
    drawn, names = axes.get_legend_handles_labels()
    dashes = {style.spoken(series["name"]): look["linestyle"] for series, look
              in zip(figure["series"], _styles(figure))}
    roles = {series.get("role") for series in figure["series"]}
    if not {"before", "after"} <= roles:
        return list(drawn) if len(drawn) > 1 else []
    found = []
    for handle, name in zip(drawn, names):
        of_both = re.match("after, (.*)", name)
        if of_both and isinstance(handle, Line2D):
            found.append(Line2D([], [], color=style.WORDS, lw=1.5,
                                ls=dashes[name], label=of_both[1]))
        elif not of_both and not re.match("before|after$", name):
            found.append(handle)
    return found


def _legend_within(axes: Axes, handles: Sequence[Any]) -> None:
    """A legend above what is drawn, for which the axis becomes longer."""
    texts = [str(handle.get_label()) for handle in handles]
    longest = max(map(len, texts))
    columns = min(len(texts), max(1, LETTERS_OF_LEGEND // (longest + 6)))
    low, high = axes.get_ylim()
    lines = -(-len(texts) // columns)
    share = 0.06 + 0.09 * lines
    if axes.get_yscale() == "linear":
        axes.set_ylim(low, high + share * (high - low))
    elif low > 0:
        axes.set_ylim(low, high * (high / low) ** share)
    axes.legend(handles=handles, loc="upper right", ncols=columns, fontsize=7,
                handlelength=2.4, columnspacing=1.0, labelspacing=0.3)


def draw(figure: Figure, result: Mapping[str, Any]) -> None:
    limits, shown = _judged(result), _shown(result)
    rows = -(-len(shown) // 2)
    style.titled(figure, _title(result), _words(result))
    parts = [_limit_height(result)] * bool(limits) + \
        [LEGEND, ROW * rows] * bool(rows)
    if not parts:
        return
    # Each part has a layout of its own.
    below = list(figure.subfigures(len(parts), 1, squeeze=False,
                                   height_ratios=parts)[:, 0])
    for part in below:
        part.set_facecolor("none")  # else it hides the end of the title's words
    if limits:
        _limits(below.pop(0).subplots(), limits)
    if not rows:
        return
    _legend(below.pop(0))
    grid = below[0].subplots(rows, 2, squeeze=False)
    for axes, one in zip(grid.flat, shown):
        _small(axes, one)
    for axes in grid.flat[len(shown):]:
        axes.axis("off")


def _legend(strip: SubFigure) -> None:
    """What the colours of the figures below say."""
    looks = [("before compensation", style.BEFORE, "none"),
             ("after", style.AFTER, style.AFTER)]
    strip.legend(handles=[Line2D([], [], color=color, label=words, lw=2,
                                 marker="D", mfc=inside, ms=5)
                          for words, color, inside in looks],
                 loc="center left", ncols=2)
