# SPDX-License-Identifier: MIT
"""Curves of a population: all of them with their quantiles, and the principal
components of what differs between them."""

from __future__ import annotations

import pathlib
import re
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from . import documents, hdf5, style
from .documents import PlotError

Values = npt.NDArray[np.float64]
COLUMN = re.compile(r"device_\d+_bias_deg_per_s")
MOST_CURVES = 400  # that are drawn, evenly over the devices
FEWEST_FOR_QUANTILES = 20  # devices
COMPONENTS, SHAPES = 6, 3
HEIGHT, HEIGHT_OF_ONE = 7.2, 4.5
LARGEST = 1e12  # as in a recording


@dataclass
class Curves:
    name: str
    temperature: Values
    bias: Values  # a row each device


def read(path: pathlib.Path, name: str) -> Curves:
    with open(path, "rb") as file:
        is_hdf5 = file.read(4) == b"\x89HDF"
    curves = _of_hdf5(path, name) if is_hdf5 else _of_csv(path, name)
    if not curves.bias.size:
        raise PlotError(f"{path}: no values; expected one or more devices and "
                        "temperatures")
    for what, values in [("temperature", curves.temperature),
                         ("bias", curves.bias)]:
        wrong = ~(np.abs(values) <= LARGEST)
        if wrong.any():
            raise PlotError(f"{path}: {what}: {values[wrong][0]:g}; expected "
                            f"numbers up to {LARGEST:g}")
    order = np.argsort(curves.temperature, kind="stable")
    return Curves(name, curves.temperature[order], curves.bias[:, order])


def _of_hdf5(path: pathlib.Path, name: str) -> Curves:
    with hdf5.opened(path) as file:
        temperature = file.numbers("temperature").astype(float)
        variable = file.variable("bias", 2)
        if variable.shape[1] != len(temperature):
            raise PlotError(f"{path}: bias: {variable.shape}; expected "
                            f"{len(temperature)} temperatures")
        return Curves(name, temperature, variable[()].astype(float))


def _of_csv(path: pathlib.Path, name: str) -> Curves:
    lines = documents.text_of(path).splitlines()
    names = lines[0].split(",")
    for one in names[1:]:
        if not COLUMN.fullmatch(one):
            raise PlotError(f"{path}:1: {documents.shown(one)}; expected "
                            "device_N_bias_deg_per_s")
    table = documents.table_of(path, lines)
    return Curves(name, table[:, 0], table[:, 1:].T)


# --- drawing ---

def _has_components(curves: Curves) -> bool:
    return min(curves.bias.shape) > 1


def height(curves: Curves) -> float:
    return HEIGHT if _has_components(curves) else HEIGHT_OF_ONE


def components(bias: Values) -> tuple[Values, Values]:
    """The shares of the principal components, and a row each their shapes.

    As docs/reference/curves.md defines them: of curves less their means
    over temperature, and less the mean of these over the devices.
    """
    centred = bias - bias.mean(1, keepdims=True)
    _, sizes, shapes = np.linalg.svd(centred - centred.mean(0),
                                     full_matrices=False)
    total = float((sizes ** 2).sum())
    for shape in shapes:  # the sign of each is any
        shape *= np.sign(shape[np.argmax(np.abs(shape))]) or 1.0
    return sizes ** 2 / total if total else sizes, shapes


def draw(figure: Figure, curves: Curves) -> None:
    if _has_components(curves):
        grid = figure.add_gridspec(2, 2, height_ratios=[1.5, 1],
                                   width_ratios=[1, 2.4])
        _curves(figure.add_subplot(grid[0, :]), curves)
        _components(figure.add_subplot(grid[1, 0]),
                    figure.add_subplot(grid[1, 1]), curves)
    else:
        _curves(figure.add_subplot(), curves)
    count = len(curves.bias)
    words = (f"{count:,} device{'s' if count > 1 else ''} at rest, without "
             "noise")
    if count > MOST_CURVES:
        words += f"; drawn: {len(_drawn(curves)):,}, evenly over them"
    style.titled(figure, style.shortened(curves.name, style.LONGEST_TITLE),
                 words)


def _drawn(curves: Curves) -> Values:
    return curves.bias[::-(-len(curves.bias) // MOST_CURVES)]


def _curves(axes: Axes, curves: Curves) -> None:
    T, bias = curves.temperature, curves.bias
    if len(T) == 1:
        axes.plot(np.repeat(T, len(bias)), bias[:, 0], "o", ms=3,
                  color=style.GREY)
    else:
        axes.add_collection(LineCollection(
            [np.column_stack([T, one]) for one in _drawn(curves)],
            colors=style.GREY, linewidths=0.5,
            alpha=1.0 if len(bias) < FEWEST_FOR_QUANTILES else 0.5,
            label="each device"))
        if len(bias) >= FEWEST_FOR_QUANTILES:
            low, middle, high = np.percentile(bias, [5, 50, 95], axis=0)
            axes.plot(T, middle, color=style.BLUE, label="median")
            axes.plot(T, low, color=style.ORANGE, lw=1.2,
                      label="90 of 100 between")
            axes.plot(T, high, color=style.ORANGE, lw=1.2)
        axes.autoscale_view()
        axes.set_xlim(T[0], T[-1])
        style.legend_above(axes)
    axes.set(xlabel="temperature of the beam [°C]", ylabel="bias [°/s]")


def _components(left: Axes, right: Axes, curves: Curves) -> None:
    shares, shapes = components(curves.bias)
    shares = 100 * shares[:COMPONENTS]
    places = np.arange(1, len(shares) + 1)
    left.bar(places, shares, color=[*style.COLORS[:SHAPES],
                                    *[style.GREY] * COMPONENTS][:len(shares)])
    for place, share in zip(places, shares):
        left.text(place, share, f"{share:.0f}", ha="center", va="bottom",
                  fontsize=9)
    left.set(xlabel="principal component", ylabel="share [%]", xticks=places,
             ylim=(0, 1.15 * max(shares.max(), 1)))
    left.grid(axis="x", visible=False)
    right.axhline(0, color=style.GREY, lw=0.8, zorder=1)
    for k, shape in enumerate(shapes[:SHAPES]):
        right.plot(curves.temperature, shape / (np.abs(shape).max() or 1),
                   color=style.COLORS[k], ls=style.DASHES[k], label=str(k + 1))
    right.set(xlabel="temperature of the beam [°C]", ylabel="shape")
    right.set_xlim(curves.temperature[0], curves.temperature[-1])
    style.legend_above(right)
