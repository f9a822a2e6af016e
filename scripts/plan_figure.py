#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws what chamber hours buy: plan_figure.py PLAN.json PICTURE png|svg

PLAN.json is what `beamgyro plan --json` writes.
"""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402  (the backend comes first)

# Different in grey, too.
BLUE, ORANGE, GREEN, WORDS = "#0072b2", "#d55e00", "#009e73", "#505050"

STYLE = {
    "figure.figsize": (7.2, 4.6),
    "figure.dpi": 150,
    "font.size": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "axes.axisbelow": True,
    "legend.frameon": False,
    "savefig.bbox": "tight",
    "svg.hashsalt": "beamgyro",  # else the ids in an SVG change with every run
}


def curve(axes, plans, color, marker, label):
    hours = [plan["hours"] for plan in plans]
    expected = [plan["expected_rms_deg_per_s"] for plan in plans]
    median = [one["median"] for one in expected]
    axes.plot(hours, median, marker + "-", color=color,
              label=f"{label}: median")
    axes.plot(hours, [one["p95"] for one in expected], marker + ":", ms=4,
              lw=1.2, color=color, label=f"{label}: 95 of 100 devices")
    for x, y, plan in zip(hours, median, plans):
        axes.annotate(len(plan["temperatures_degC"]), (x, y), xytext=(4, 4),
                      textcoords="offset points", fontsize=8, color=WORDS)


def main(result, picture, kind):
    plan = json.loads(pathlib.Path(result).read_text())
    pyplot.rcParams.update(STYLE)
    figure, axes = pyplot.subplots()
    table = plan["trade_off"]
    curve(axes, [row["even"] for row in table], ORANGE, "s", "even spacing")
    curve(axes, [row["planned"] for row in table], BLUE, "o", "planned")
    for number, one in enumerate(plan["candidates"]):
        axes.plot(one["hours"], one["expected_rms_deg_per_s"]["median"], "D",
                  color=GREEN, label="candidates: median" if number == 0
                  else None)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axes.yaxis.set_minor_formatter(ticker.NullFormatter())
    low, high = plan["range_degC"]
    axes.set(xlabel="hours in the chamber (numbers: soaks)",
             ylabel="rms left [°/s]",
             title=f"What soaks buy, {low:g} to {high:g} °C, "
                   f"{' and '.join(plan['observed'])} observed")
    axes.legend(fontsize=9)
    metadata = {"png": {"Software": None}, "svg": {"Date": None}}[kind]
    figure.savefig(picture, format=kind, metadata=metadata)


if __name__ == "__main__":
    main(*sys.argv[1:])
