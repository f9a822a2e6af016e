# SPDX-License-Identifier: MIT
"""The table of `characterise`: the steady state over temperature."""

from __future__ import annotations

import pathlib
from typing import Any, Mapping, Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from . import documents, style
from .documents import PlotError

Values = npt.NDArray[np.float64]

COLUMNS = ("temperature_degC", "bias_deg_per_s", "in_phase_deg_per_s",
           "quadrature_deg_per_s", "drive_frequency_Hz", "split_Hz", "q_drive",
           "q_sense", "drive_voltage_V", "scale_factor_rel")
# What the dataset of beamgyro.characterise calls them.
VARIABLES = ("temperature", "bias", "in_phase", "quadrature", "drive_frequency",
             "split", "q_drive", "q_sense", "drive_voltage", "scale_factor")
PANELS = [("bias", "°/s", ["bias_deg_per_s"]),
          ("scale factor − 1", "%", ["scale_factor_rel"]),
          ("in-phase error", "°/s", ["in_phase_deg_per_s"]),
          ("quadrature", "°/s", ["quadrature_deg_per_s"]),
          ("drive frequency", "Hz", ["drive_frequency_Hz"]),
          ("sense − drive", "Hz", ["split_Hz"]),
          ("Q", "", ["q_drive", "q_sense"]),
          ("drive voltage", "V", ["drive_voltage_V"])]
HEIGHT = 7.6
LARGEST = 1e12  # as in a recording


def read(path: pathlib.Path, name: str) -> dict[str, Any]:
    lines = documents.text_of(path).splitlines()
    values = documents.table_of(path, lines)
    return {"name": name, **dict(zip(lines[0].split(","), values.T))}


def columns_of(table: Mapping[str, Any]) -> dict[str, Any]:
    """The columns of a table, or of the dataset of characterise."""
    named = dict(zip(VARIABLES, COLUMNS))
    return {named.get(key, key): table[key] for key in [
        *table, *(getattr(table, "coords", ()))]}


def _column(table: Mapping[str, Any], name: str) -> Values:
    if name not in table:
        raise PlotError(f"{table.get('name', 'table')}: no column {name}; "
                        f"expected {', '.join(COLUMNS)}")
    values = np.asarray(table[name])
    if values.dtype.kind not in "biuf" or values.ndim != 1 or \
            len(values) != len(table[COLUMNS[0]]):
        raise PlotError(f"{table.get('name', 'table')}: {name}: "
                        f"{values.shape} of type {values.dtype}; expected a "
                        f"number for each {COLUMNS[0]}")
    if not (np.abs(values) <= LARGEST).all():
        raise PlotError(f"{table.get('name', 'table')}: {name}: "
                        f"{values[~(np.abs(values) <= LARGEST)][0]:g}; "
                        f"expected numbers up to {LARGEST:g}")
    return 100 * (values - 1) if name == "scale_factor_rel" else values


def draw(figure: Figure, tables: Sequence[Mapping[str, Any]]) -> None:
    grid = figure.subplots(4, 2, sharex=True)
    figure.align_ylabels(grid)
    names = style.labels([str(table.get("name", "")) for table in tables])
    for (words, unit, columns), axes in zip(PANELS, grid.flat):
        for k, (table, name) in enumerate(zip(tables, names)):
            T = _column(table, "temperature_degC")
            order = np.argsort(T, kind="stable")
            for j, column in enumerate(columns):
                label = column[2:] if len(columns) > 1 and not k else None
                axes.plot(T[order], _column(table, column)[order],
                          marker="" if len(T) > 1 else "o",
                          color=style.COLORS[k % len(style.COLORS)],
                          ls=style.DASHES[j if len(tables) == 1 else
                                          k % len(style.DASHES)],
                          label=label if len(tables) == 1 else
                          (name if j == 0 else None),
                          lw=1.5 if len(tables) == 1 or not j else 0.8)
        if len(columns) > 1 and len(tables) > 1:
            words += " (thin: sense)"
        axes.set_ylabel(style.quantity(words, unit))
        if words in ("bias", "quadrature", "in-phase error"):
            axes.axhline(0, color=style.GREY, lw=0.8, zorder=1)
    if len(tables) == 1:
        grid[3, 0].legend(loc="best")
    else:
        style.legend_above(grid[0, 0], 3)
    for axes in grid[-1]:
        axes.set_xlabel("temperature of the beam [°C]")
    style.titled(figure, names[0] if len(tables) == 1
                 else f"{len(tables)} devices",
                 "steady state over temperature, without noise; scale factor "
                 "relative to 25 °C")
