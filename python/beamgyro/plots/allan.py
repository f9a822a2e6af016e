# SPDX-License-Identifier: MIT
"""Allan deviations and the noise terms fitted to them."""

from __future__ import annotations

import math
from typing import Any, Callable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .documents import (NOT_NEGATIVE, NUMBER, POSITIVE, TEXT, PlotError,
                        WrongValue, both, in_order, maybe, record, rows)
from .units import duration

KINDS = {"oadev": "overlapping Allan", "adev": "Allan",
         "mdev": "modified Allan", "totdev": "total",
         "ohdev": "overlapping Hadamard", "hdev": "Hadamard"}
# Each term as docs/reference/allan_deviation.md has it.
TERMS: dict[str, Callable[[Any, float], Any]] = {
    "Q": lambda t, q: math.sqrt(3) * q / t,
    "N": lambda t, n: n / np.sqrt(t),
    "B": lambda t, b: math.sqrt(2 * math.log(2) / math.pi) * b + 0 * t,
    "K": lambda t, k: k * np.sqrt(t / 3),
    "R": lambda t, r: r * t / math.sqrt(2)}
DRAWN = {"B": "0.664 B"}  # where a line has another height than its letter
# The unit of each term of angular rates, and what it adds to another unit.
UNITS = {"Q": ("deg", " s"), "N": ("deg/sqrt(s)", " sqrt(s)"),
         "B": ("deg/s", ""), "K": ("deg/s/sqrt(s)", "/sqrt(s)"),
         "R": ("deg/s/s", "/s")}
RATE, HOUR = "deg/s", 3600.0
# Of rates: the factor and the unit of data sheets.
PER_HOUR = {"N": (60.0, "°/√h"), "B": (HOUR, "°/h"),
            "K": (60 * HOUR, "°/h/√h"), "R": (HOUR**2, "°/h²")}
HEIGHT = 5.2


def _units_agree(data: Mapping[str, Any], _: str) -> None:
    """The terms are in the unit that follows from that of the series."""
    unit = _unit(data)
    for symbol, (of_rates, factor) in UNITS.items():
        term = _term(data, symbol)
        expected = of_rates if unit == "deg/s" else unit + factor
        if term and term["unit"] != expected:
            raise WrongValue(f"noise.{symbol}.per_second.unit",
                        f'"{term["unit"]}"',
                        f'"{expected}", as the series is in {unit}')


_POINT = record(
    {"tau_s": POSITIVE, "deviation": NOT_NEGATIVE},
    {"interval": maybe(both(rows(maybe(NOT_NEGATIVE), 2, 2), in_order))})
_TERM = record({"per_second": record({"value": POSITIVE, "unit": TEXT})})
SHAPE = both(record({}, {
    **{kind: rows(_POINT) for kind in KINDS},
    "series": record({"dataset": TEXT, "unit": TEXT, "rate_Hz": POSITIVE,
                      "from_s": NUMBER, "to_s": NUMBER,
                      "samples": NOT_NEGATIVE}),
    "noise": maybe(record({}, {symbol: maybe(_TERM) for symbol in TERMS}))}),
    _units_agree)


def _unit(data: Mapping[str, Any]) -> str:
    return str((data.get("series") or {}).get("unit", RATE))


def _term(data: Mapping[str, Any], symbol: str) -> Mapping[str, Any] | None:
    found = (data.get("noise") or {}).get(symbol)
    return found["per_second"] if found else None


def kinds_in(data: Mapping[str, Any]) -> list[str]:
    return [kind for kind in KINDS if data.get(kind)]


def _curve(axes: Axes, points: Sequence[Mapping[str, Any]], k: int,
           label: str, interval: bool = True) -> None:
    tau, deviation = (np.array([point[key] for point in points], dtype=float)
                      for key in ("tau_s", "deviation"))
    # A logarithmic axis has no place for 0.
    deviation[deviation == 0] = np.nan
    ends = np.array([point.get("interval") or (np.nan, np.nan)
                     for point in points], dtype=float).T
    color = style.COLORS[k % len(style.COLORS)]
    axes.plot(tau, deviation, color=color, label=label, ms=4,
              marker=style.MARKERS[k % len(style.MARKERS)],
              ls=style.DASHES[k % len(style.DASHES)])
    if interval:
        axes.fill_between(tau, *ends, color=color, alpha=0.2, lw=0)


# Of the name of a line: the share of the line, the side, the distance [pt].
_PLACES: dict[str, tuple[float, dict[str, Any], tuple[float, float]]] = {
    "falls": (0.88, {"ha": "right", "va": "top"}, (-3, -1)),
    "level": (0.0, {"ha": "left", "va": "bottom"}, (6, 4)),
    "rises": (0.12, {"ha": "left", "va": "top"}, (3, -1))}


def _terms(axes: Axes, data: Mapping[str, Any], kind: str) -> None:
    """The asymptotes of the fitted terms where the picture shows them."""
    tau = np.geomspace(data[kind][0]["tau_s"], data[kind][-1]["tau_s"], 200)
    low, high = axes.get_ylim()
    for symbol, law in TERMS.items():
        term = _term(data, symbol)
        if not term:
            continue
        line = law(tau, term["value"])
        seen = (line > low) & (line < high)
        axes.plot(tau[seen], line[seen], ":", color=style.WORDS, lw=1.2,
                  zorder=1.5)
        if not seen.any():
            continue
        # Named below the line near its low end, where no curve is.
        place, align, offset = _PLACES[
            "falls" if symbol in "QN" else "rises" if symbol in "KR"
            else "level"]
        at = round(place * (np.count_nonzero(seen) - 1))
        axes.annotate(DRAWN.get(symbol, symbol),
                      (tau[seen][at], line[seen][at]), xytext=offset,
                      textcoords="offset points", color=style.WORDS, **align)


def draw(figure: Figure, results: Sequence[Mapping[str, Any]]) -> None:
    """Every deviation of one result, or one deviation of several."""
    axes = figure.subplots()
    names = style.labels([str(one.get("name", "")) for one in results])
    kinds = [kind for kind in KINDS
             if all(kind in kinds_in(one) for one in results)]
    if not kinds:
        raise PlotError(
            f"{names[0]}: no deviation in common with {', '.join(names[1:])}; "
            "expected results of the same --kind" if len(results) > 1 else
            f"{names[0]}: no deviation; expected one of {', '.join(KINDS)}")
    units = [_unit(one) for one in results]
    if len(set(units)) > 1:
        raise PlotError(f"{names[0]}: deviations in {' and '.join(units)} "
                        "cannot be compared; expected one unit")
    if len(results) == 1:
        for k, kind in enumerate(kinds):
            _curve(axes, results[0][kind], k, KINDS[kind] + " deviation",
                   k == 0)
    else:
        for k, (one, name) in enumerate(zip(results, names)):
            _curve(axes, one[kinds[0]], k, name)
    axes.set(xlabel="averaging time τ [s]",
             ylabel=style.quantity("deviation" if len(kinds) > 1 else
                                   KINDS[kinds[0]] + " deviation", units[0]))
    shown = [point["deviation"] for one in results for kind in kinds
             for point in one[kind] if point["deviation"] > 0]
    if not shown:
        raise PlotError(f"{names[0]}: every deviation is 0; expected one "
                        "above 0 for a logarithmic axis")
    style.log_scale(axes.xaxis)
    style.log_scale(axes.yaxis,
                    (1, 2, 5) if max(shown) < 100 * min(shown) else ())
    axes.set_ylim(min(shown) / 3, max(shown) * 3)
    if units[0] == RATE:
        axis_per_hour(axes)
    if len(results) == 1:
        _terms(axes, results[0], kinds[0])
    style.legend_above(axes, 3)
    _title(figure, results, names)


def axis_per_hour(axes: Axes) -> None:
    """As data sheets have it, at the right."""
    right = axes.secondary_yaxis("right", functions=(lambda v: v * HOUR,
                                                     lambda v: v / HOUR))
    right.set_ylabel("[°/h]")
    right.spines["right"].set_visible(True)
    style.log_ticks(right.yaxis)


def _in_words(symbol: str, term: Mapping[str, Any]) -> str:
    """A term in the unit of the series, and in that of data sheets."""
    words = f"{symbol} = {term['value']:.3g} {style.spoken(term['unit'])}"
    if term["unit"] != UNITS[symbol][0] or symbol not in PER_HOUR:
        return words
    factor, unit = PER_HOUR[symbol]
    return f"{words} ({factor * term['value']:.3g} {unit})"


def _title(figure: Figure, results: Sequence[Mapping[str, Any]],
           names: Sequence[str]) -> None:
    if len(results) > 1:
        style.titled(figure, f"{len(results)} Allan deviations",
                     "bands: intervals of 95 %")
        return
    parts = []
    terms = [(symbol, _term(results[0], symbol)) for symbol in TERMS]
    words = [_in_words(symbol, term) for symbol, term in terms if term]
    if words:
        parts.append(f"dotted: fitted noise, {', '.join(words)}")
    series = results[0].get("series")
    if series:
        span = duration(series["to_s"] - series["from_s"])
        parts.append(f"{series['dataset']}, {series['samples']:,} samples at "
                     f"{series['rate_Hz']:g} Hz over {span}")
    style.titled(figure, names[0],
                 "; ".join([*parts, "band: interval of 95 %"]))
