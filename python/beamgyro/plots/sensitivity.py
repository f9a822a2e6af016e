# SPDX-License-Identifier: MIT
"""Which tolerance causes the drift: the result of `sensitivity --json`."""

from __future__ import annotations

import re
import textwrap
from typing import Any, Iterator, Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .documents import (NOT_NEGATIVE, NUMBER, PAIR, TEXT, members, record,
                        rows)

BAR = 0.38  # of the distance between tolerances
LONGEST_KEY = 48  # [letters]
MOST_BARS = 20  # tolerances; the others are the least
LETTERS_OF_TITLE = 74
MOST_OF_SEVERAL = 10  # where one picture has several figures of merit
SHAPE = record({
    "campaign": TEXT,
    "devices": NOT_NEGATIVE,
    "figures": members(record({
        "of": TEXT, "meaning": TEXT,
        "indices": rows(record({
            "key": TEXT, "first": NUMBER, "first_interval": PAIR,
            "total": NUMBER, "total_interval": PAIR}), 1)}))})


def _bars(axes: Axes, indices: Sequence[Mapping[str, Any]], kind: str,
          place: float, color: str, label: str) -> None:
    values = [index[kind] for index in indices]
    ends = [index[f"{kind}_interval"] for index in indices]
    # An index of 0 may lie outside its interval by rounding.
    errors = [[max(0, value - low) for value, (low, _) in zip(values, ends)],
              [max(0, high - value) for value, (_, high) in zip(values, ends)]]
    axes.barh([k + place for k in range(len(indices))], values, BAR,
              xerr=errors, color=color, label=label,
              error_kw={"elinewidth": 1, "capsize": 2})


def _panel(axes: Axes, figure: Mapping[str, Any], most: int) -> None:
    indices = figure["indices"][:most]
    _bars(axes, indices, "total", -BAR / 2, style.BLUE, "total")
    _bars(axes, indices, "first", BAR / 2, style.YELLOW, "first order")
    axes.set_yticks(range(len(indices)), style.labels(
        [index["key"] for index in indices], LONGEST_KEY))
    axes.invert_yaxis()
    axes.set_xlim(left=0)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("share of the variance")
    of = re.sub(r"^ln ", "logarithm of ", figure["of"])
    words = f"{of}: {style.spoken(figure['meaning'])}"
    axes.set_title(textwrap.fill(words, LETTERS_OF_TITLE))
    axes.legend(loc="lower right")


def _height(figure: Mapping[str, Any], most: int) -> float:
    return 1.0 + 0.34 * min(most, len(figure["indices"]))


def height(study: Mapping[str, Any]) -> float:
    figures = list(study["figures"].values())
    most = MOST_BARS if len(figures) == 1 else MOST_OF_SEVERAL
    return 0.6 + sum(_height(one, most) for one in figures)


def draw(figure: Figure, study: Mapping[str, Any]) -> None:
    """A panel of bars for each figure of merit."""
    merits = list(study["figures"].values())
    most = MOST_BARS if len(merits) == 1 else MOST_OF_SEVERAL
    panels = figure.subplots(
        len(merits), 1, squeeze=False,
        height_ratios=[_height(one, most) for one in merits])
    for axes, merit in zip(panels[:, 0], merits):
        _panel(axes, merit, most)
    style.titled(figure, f"Sensitivity: {study['campaign']}",
                 f"{study['devices']:,} devices; whiskers: intervals of 95 %")


def each(study: Mapping[str, Any]) -> Iterator[tuple[str, Figure]]:
    """A figure by itself for every figure of merit."""
    for name, merit in study["figures"].items():
        figure = style.new_figure(0.4 + _height(merit, MOST_BARS))
        _panel(figure.subplots(), merit, MOST_BARS)
        yield name, figure
