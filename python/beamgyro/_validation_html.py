# SPDX-License-Identifier: MIT
"""A validation in a notebook: verdict, reasons, limits, checks, metrics."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

# What a reader looks for first, and the colours of the page of a report.
ORDER = ["fail", "undecided", "not tested", "pass"]
COLORS = {"pass": "#0072b2", "fail": "#d55e00"}
GREY = "#6a6a6a"
BASELINES = {"before": "no compensator", "constant": "a constant",
             "cubic": "a cubic", "table": "a table of straight lines",
             "straight_lines": "straight lines between soaks",
             "constant_of_runs": "a constant of each run"}


def number(value: Any) -> str:
    """Return a number as the table of the command prints it, or nothing."""
    return "" if value is None else f"{value:.4g}"


def figure(estimate: Any) -> str:
    """Return a figure with its interval, as text."""
    if not isinstance(estimate, Mapping) or estimate.get("value") is None:
        return ""
    interval = estimate.get("interval")
    value = number(estimate["value"])
    if not interval or interval[0] is None or interval[1] is None:
        return value
    return f"{value} ({number(interval[0])} to {number(interval[1])})"


def page(result: Mapping[str, Any]) -> str:
    """Return the HTML of what ``--json`` writes."""
    verdict = str(result["verdict"])
    parts = [f'<p style="font-size:1.3em">{_marked(verdict, verdict.upper())} '
             f'{_text(_about(result))}</p>', f"<p>{_text(result['words'])}</p>"]
    if result.get("next"):
        parts.append(f"<p>next: {_text(result['next'])}</p>")
    parts += [f"<p><b>warning:</b> {_text(words)}</p>"
              for words in result["warnings"]]
    population = result.get("population")
    if population and population.get("devices"):
        parts.append(f"<p>{population['passed']} of {population['devices']} "
                     "devices pass.</p>")
    parts += [_limits(result), _compared(result), _checks(result),
              _metrics(result)]
    return "".join(parts)


def _about(result: Mapping[str, Any]) -> str:
    count = len(result.get("runs") or [])
    runs = f"{count} run{'s' * (count != 1)}"
    return f"{result['compensator']['name']} on {runs}" if count \
        else str(result["compensator"]["name"])


def _limits(result: Mapping[str, Any]) -> str:
    before = {one["name"]: one.get("before") for one in
              [*result["metrics"], *result.get("own_metrics", [])]}
    rows = [(str(one["result"] or "undecided"), one["metric"],
             figure(before.get(one["metric"])), figure(one.get("compared")),
             _allowed(one), number(one.get("margin")),
             str(one.get("words") or ""))
            for one in result["limits"]]
    return _table("Limits", ("result", "metric", "before", "value", "limit",
                             "margin", "reason"), rows)


def _allowed(limit: Mapping[str, Any]) -> str:
    bounds = [f"{word} {number(limit[end])}" for end, word in
              (("min", "at least"), ("max", "at most"))
              if limit[end] is not None]
    size = "size " if limit["absolute"] else ""
    whose = f" of {limit['relative_to']}" if limit.get("relative_to") else ""
    return size + " and ".join(bounds) + whose


def _compared(result: Mapping[str, Any]) -> str:
    words = {True: "better", False: "not better"}
    rows = [(words[one["better"]],
             BASELINES.get(one["with"], one["with"].replace("_", " ")),
             number(one["rms_deg_per_s"]),
             number(one["compensated_rms_deg_per_s"]))
            for one in result.get("compared_with") or []]
    return _table("What is left [deg/s rms]",
                  ("", "compared with", "it leaves", "this leaves"), rows)


def _checks(result: Mapping[str, Any]) -> str:
    words = {True: "pass", False: "fail", None: "not tested"}
    rows = [(words[one["passed"]], one["name"], str(one.get("words") or ""))
            for one in result["checks"]]
    return _table("Checks", ("result", "check", "reason"), rows)


def _metrics(result: Mapping[str, Any]) -> str:
    rows = [(str(one.get("result") or ""), one["name"],
             figure(one.get("before")), figure(one.get("after")), one["unit"])
            for one in [*result["metrics"], *result.get("own_metrics", [])]
            if figure(one.get("before")) or figure(one.get("after"))]
    if not rows:
        return ""
    table = _table("", ("result", "metric", "before", "after", "unit"), rows)
    return (f"<details><summary>{len(rows)} metrics</summary>{table}"
            "</details>")


def _table(title: str, header: Sequence[str],
           rows: Iterable[Sequence[str]]) -> str:
    """An HTML table whose first column is a result, the worst at the top."""
    ranks = {word: rank for rank, word in enumerate(ORDER)}
    ordered = sorted(rows, key=lambda row: ranks.get(row[0], len(ORDER)))
    if not ordered:
        return ""
    left = ' style="text-align:left"'
    head = "".join(f"<th{left}>{_text(cell)}</th>" for cell in header)
    body = "".join(
        f"<tr><td{left}>{_marked(row[0], row[0])}</td>"
        + "".join(f"<td{left}>{_text(cell)}</td>" for cell in row[1:])
        + "</tr>" for row in ordered)
    caption = f"<p><b>{_text(title)}</b></p>" if title else ""
    return (f"{caption}<table><thead><tr>{head}</tr></thead>"
            f"<tbody>{body}</tbody></table>")


def _marked(result: str, words: str) -> str:
    color = COLORS.get(result, GREY)
    return f'<b style="color:{color}">{_text(words)}</b>'


def _text(words: Any) -> str:
    return html.escape(str(words))
