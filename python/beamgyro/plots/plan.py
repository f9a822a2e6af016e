# SPDX-License-Identifier: MIT
"""What soaks in a chamber buy: the result of `plan --json`."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .documents import NUMBER, POSITIVE, RANGE, TEXT, maybe, record, rows

HEIGHT = 4.8
_FORECAST = record({"median": POSITIVE, "p95": POSITIVE})
_CANDIDATE = record({"hours": NUMBER, "expected_rms_deg_per_s": _FORECAST})
_SOAKS = record({"hours": NUMBER, "expected_rms_deg_per_s": _FORECAST,
                 "temperatures_degC": rows(NUMBER)})
SHAPE = record({
    "trade_off": rows(record({"even": _SOAKS, "planned": _SOAKS},
                             {"straight_lines": maybe(_FORECAST)}), 1),
    "candidates": rows(_CANDIDATE),
    "schedule": record({"hours": NUMBER, "temperatures_degC": rows(NUMBER)}),
    "expected_rms_deg_per_s": _FORECAST,
    "range_degC": RANGE,
    "observed": rows(TEXT)})


def _curve(axes: Axes, plans: Sequence[Mapping[str, Any]], color: str,
           marker: str, label: str) -> None:
    hours = [plan["hours"] for plan in plans]
    expected = [plan["expected_rms_deg_per_s"] for plan in plans]
    median = [one["median"] for one in expected]
    axes.plot(hours, median, marker + "-", color=color,
              label=f"{label}: median")
    axes.plot(hours, [one["p95"] for one in expected], marker + ":", ms=4,
              lw=1.2, color=color, label=f"{label}: 95 of 100 devices")
    for x, y, plan in zip(hours, median, plans):
        axes.annotate(str(len(plan["temperatures_degC"])), (x, y),
                      xytext=(4, 4), textcoords="offset points", fontsize=9,
                      color=style.WORDS)


def _lines(table: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """What straight lines between the even soaks leave, as plans."""
    return [{**row["even"], "expected_rms_deg_per_s": row["straight_lines"]}
            for row in table if row.get("straight_lines")]


def draw(figure: Figure, plan: Mapping[str, Any]) -> None:
    axes = figure.subplots()
    table = plan["trade_off"]
    if lines := _lines(table):
        _curve(axes, lines, style.GREY, "^", "straight lines, even")
    _curve(axes, [row["even"] for row in table], style.ORANGE, "s",
           "even spacing")
    _curve(axes, [row["planned"] for row in table], style.BLUE, "o", "planned")
    for number, one in enumerate(plan["candidates"]):
        axes.plot(one["hours"], one["expected_rms_deg_per_s"]["median"], "D",
                  color=style.GREEN, ls="",
                  label=None if number else "candidates: median")
    chosen = plan["schedule"]
    axes.plot(chosen["hours"], plan["expected_rms_deg_per_s"]["median"], "o",
              ms=14, mfc="none", mew=1.6, color=style.BLACK, ls="",
              label="this schedule")
    style.log_scale(axes.yaxis, (1, 2, 5))
    axes.set(xlabel="time in the chamber [h] (numbers: soaks)",
             ylabel="rms left [°/s]")
    axes.legend(loc="best")
    low, high = plan["range_degC"]
    soaks = ", ".join(f"{T:g}" for T in chosen["temperatures_degC"])
    style.titled(figure, f"What soaks buy, {low:g} to {high:g} °C",
                 f"this schedule: {soaks} °C in {chosen['hours']:.2f} h; "
                 f"{' and '.join(plan['observed'])} observed")
