#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the figures of a validation for slides.

validation_figures.py RESULT.json [--out DIR]; RESULT.json is what
`beamgyro validate --json` writes, DIR is where it stands. A figure ID becomes
DIR/ID.png. Colours, dashes and markers are those of the page of the report
(validation/page/page.html).
"""

import argparse
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend comes first)

# Of Okabe and Ito.
ROLES = {"before": "#d55e00", "after": "#0072b2", "fit": "#1b1f23",
         "limit": "#1b1f23"}
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
          "#000000"]
DASHES = ["-", (0, (4, 2)), (0, (1, 1.5)), (0, (5, 1.5, 1, 1.5)), (0, (7, 2)),
          (0, (2, 1, 0.5, 1, 0.5, 1)), (0, (0.5, 2.5))]
MARKERS = ["o", "^", "s", "D", "x", "*", "+"]
MOST_MARKERS = 14  # on one curve

STYLE = {
    "figure.figsize": (8, 4.5),  # 1600 x 900 pixels
    "figure.dpi": 200,
    "figure.constrained_layout.use": True,
    "font.size": 11,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "axes.axisbelow": True,
    "legend.frameon": False,
    "legend.fontsize": 9,
}


def spoken(text):
    """Text with its units as they are printed."""
    return text.replace("degC", "°C").replace("deg", "°")


def styles(figure):
    """Colour, dash, marker and width of each series: by role, where a figure
    has both before and after."""
    roles = {each.get("role") for each in figure["series"]} - {"limit"}
    seen = {}
    for each in figure["series"]:
        role = each.get("role", "")
        k = seen[role] = seen.get(role, -1) + 1
        line_only = role in ("fit", "limit")
        by_role = role in ROLES and (len(roles) > 1 or line_only)
        broad = role == "before" and len(roles) > 1
        yield {"color": ROLES[role] if by_role else COLORS[k % len(COLORS)],
               "linestyle": DASHES[(k + line_only) % len(DASHES)],
               "marker": "" if line_only else
                         MARKERS[(k + 3 * (role == "before")) % len(MARKERS)],
               "linewidth": 3 if broad else 1.5, "markersize": 8 if broad else 5,
               "markerfacecolor": "none" if broad else None,
               "zorder": 2 if broad else 3}


def draw_series(axes, kind, series, style):
    x, y = series["x"], series["y"]
    if kind == "bars":
        axes.bar(x, y, width=x[1] - x[0] if len(x) > 1 else 1, alpha=0.6,
                 color=style["color"], edgecolor=style["color"],
                 label=spoken(series["name"]))
        return
    if kind == "points":
        style = {**style, "linestyle": ""}
    else:
        style = {**style, "markevery": -(-len(x) // MOST_MARKERS)}
    axes.plot(x, y, label=spoken(series["name"]), **style)
    if "low" in series:
        axes.vlines(x, series["low"], series["high"], color=style["color"],
                    linewidth=1, zorder=style["zorder"])


def draw(figure, file):
    drawn, axes = pyplot.subplots()
    for series, style in zip(figure["series"], styles(figure)):
        draw_series(axes, series.get("kind", figure["kind"]), series, style)
    axes.set_title(spoken(figure["title"]))
    for name in "xy":
        axis = figure[name]
        unit = f" [{spoken(axis['unit'])}]" if axis["unit"] else ""
        axes.set(**{f"{name}label": axis["label"] + unit,
                    f"{name}scale": axis["scale"]})
    if len(figure["series"]) > 1:
        longest = max(len(series["name"]) for series in figure["series"])
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14),
                    ncols=2 if longest > 25 else 3 if longest > 12 else 5)
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
        for figure in figures:
            draw(figure, out / f"{figure['id']}.png")
    print(f"{len(figures)} figures in {out}")


if __name__ == "__main__":
    sys.exit(main())
