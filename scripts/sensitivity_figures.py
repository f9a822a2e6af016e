#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws a bar chart for each figure of merit of a sensitivity study.

sensitivity_figures.py RESULT.json [--out DIR]; RESULT.json is what
`beamgyro sensitivity --json` writes, DIR is where it stands. The figure NAME
becomes DIR/NAME.png: total and first-order index of each tolerance with their
intervals of 95 %. Style and colours are those of validation_figures.py.
"""

import argparse
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend comes first)

from validation_figures import COLORS, STYLE, spoken  # noqa: E402

BAR = 0.38  # of the distance between tolerances
MOST_BARS = 20  # tolerances; the others are the least


def draw_bars(axes, indices, kind, place, color, label):
    values = [index[kind] for index in indices]
    ends = [index[f"{kind}_interval"] for index in indices]
    # An index of 0 may lie outside its interval by rounding.
    errors = [[max(0, value - low) for value, (low, _) in zip(values, ends)],
              [max(0, high - value) for value, (_, high) in zip(values, ends)]]
    axes.barh([k + place for k in range(len(indices))], values, BAR,
              xerr=errors, color=color, label=label,
              error_kw={"elinewidth": 1, "capsize": 2})


def draw(figure, file):
    indices = figure["indices"][:MOST_BARS]
    drawn, axes = pyplot.subplots(figsize=(8, 1.4 + 0.34 * len(indices)))
    draw_bars(axes, indices, "total", -BAR / 2, COLORS[0], "total")
    draw_bars(axes, indices, "first", BAR / 2, COLORS[4], "first order")
    axes.set_yticks(range(len(indices)), [index["key"] for index in indices])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("share of the variance")
    axes.set_title(f"{figure['of']}: {spoken(figure['meaning'])}", fontsize=10)
    axes.legend(loc="lower right")
    drawn.savefig(file, metadata={"Software": None})
    pyplot.close(drawn)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("result", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    arguments = parser.parse_args()
    figures = json.loads(arguments.result.read_text())["figures"]
    out = arguments.out or arguments.result.parent
    out.mkdir(parents=True, exist_ok=True)
    with pyplot.rc_context(STYLE):
        for name, figure in figures.items():
            draw(figure, out / f"{name}.png")
    print(f"{len(figures)} figures in {out}")


if __name__ == "__main__":
    sys.exit(main())
