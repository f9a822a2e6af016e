#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the figures of the demo, PNG and SVG: figures.py DIR

DIR is what scripts/demo.py filled; its runs/ and allan/ are read.
"""

import json
import pathlib
import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend comes first)

BLUE, ORANGE, GREEN, GREY = "#2868a8", "#cc6a1a", "#3f8f4f", "#8c8c8c"
BLOCK = 60.0  # [s], what scores are averaged over, too

STYLE = {
    "figure.figsize": (7.2, 4.6),
    "figure.dpi": 150,
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.8,
    "axes.axisbelow": True,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "savefig.bbox": "tight",
    "svg.hashsalt": "beamgyro",  # else the ids in an SVG change with every run
}


def block_means(file, *names):
    """Means over blocks counted from power-on, of powered samples; a block
    that was not powered all along is left out."""
    time = file["time"][()]
    powered = (file["status"][()] & 1) == 0
    block = np.floor(time / BLOCK).astype(int)
    size = np.bincount(block)
    whole = np.bincount(block, powered) == size.max()
    return [(np.bincount(block, np.where(powered, file[name][()], 0)) / size)
            [whole] for name in names]


def save(figure, folder, name):
    for suffix, metadata in [("png", {"Software": None}), ("svg", {"Date": None})]:
        figure.savefig(folder / f"{name}.{suffix}", metadata=metadata)
    pyplot.close(figure)


def rest_output(folder):
    """The paper's figure 2: the output at rest over temperature."""
    with h5py.File(folder / "runs/soak_sweep_train.h5") as file:
        chamber, output = block_means(file, "true_ambient_temperature",
                                      "output")
    # The end of each soak: the chamber has not moved for half an hour.
    held = np.abs(chamber[30:] - chamber[:-30]) < 1e-6
    chamber, output = chamber[30:][held], output[30:][held]
    soaks = np.unique(chamber.round(6))
    output = [output[chamber.round(6) == soak].mean() for soak in soaks]
    figure, axes = pyplot.subplots()
    axes.plot(soaks, 1e3 * (np.array(output) - 2.5), ".-", ms=9, lw=1,
              color=BLUE)
    axes.set(title="Virtual gyro at rest: output at the end of each soak",
             xlabel="chamber temperature [°C]",
             ylabel="output − 2.5 V [mV]", xlim=(-42, 52))
    second = axes.secondary_yaxis("right", functions=(lambda v: v / 12.5,
                                                      lambda r: r * 12.5))
    second.set_ylabel("as rate [°/s]")
    second.spines["right"].set_visible(True)
    save(figure, folder, "figure_2_rest_output")


def warm_up(folder):
    """The paper's figure 3: the output after power-on at 25 degC."""
    with h5py.File(folder / "runs/warm_up_25_noise.h5") as file:
        minutes = file["time"][()] / 60
        rate = file["rate"][()]
        bias = file["true_bias"][()]
        warmth = {node: file[f"true_{node}_temperature"][()]
                  for node in ["board", "sensor", "beam"]}
        mean_time, mean_rate = block_means(file, "time", "rate")
    figure, (top, bottom) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 5.8), height_ratios=[3, 2])
    offset = mean_rate[-10:].mean() - bias[-600:].mean()
    final = bias[-1]
    outside = np.abs(bias - final) > 0.05 * abs(bias[0] - final)
    settled = minutes[np.flatnonzero(outside)[-1]]
    top.plot(minutes, rate, ",", color="#b9cde3", rasterized=True)
    top.plot([], [], ".", color="#b9cde3", label="10 Hz samples")
    top.plot(mean_time / 60, mean_rate, ".", color=BLUE, label="60 s means")
    top.plot(minutes, bias + offset, color=ORANGE,
             label="true drift, shifted by the turn-on offset")
    low, high = np.percentile(rate, [0.02, 99.98])
    top.set(title="Virtual gyro after power-on, still air at 25 °C",
            ylabel="rate shown at rest [°/s]",
            ylim=(low, high + 0.35 * (high - low)))
    top.legend(loc="upper right")
    bottom.axvline(settled, color=GREY, lw=1, ls="--")
    bottom.annotate(f"drift within 5 % of its change after {settled:.1f} min",
                    (settled, 0.04), xytext=(6, 0), textcoords="offset points",
                    fontsize=9, xycoords=("data", "axes fraction"), color="#555555")
    for (node, values), colour in zip(warmth.items(), [GREEN, GREY, ORANGE]):
        bottom.plot(minutes, values, color=colour)
        bottom.annotate(node, (minutes[-1], values[-1]), xytext=(4, 0),
                        textcoords="offset points", va="center", color=colour)
    bottom.set(xlabel="time since power-on [min]", ylabel="temperature [°C]",
               xlim=(0, 60))
    save(figure, folder, "figure_3_warm_up")


def held_out_sweep(folder, method):
    path = folder / f"runs/soak_sweep_test_{method}.h5"
    with h5py.File(path) as file:
        temperature, rate, compensated = block_means(
            file, "temperature", "rate", "compensated_rate")
    order = np.argsort(temperature, kind="stable")
    return temperature[order], rate[order], compensated[order]


def fit(folder, method, short, title, name, beside=None):
    """The paper's figures 6 and 7: a fit to the drift and what it leaves."""
    temperature, rate, residual = held_out_sweep(folder, method)
    figure, (top, bottom) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 5.8), height_ratios=[3, 2])
    top.plot(temperature, rate, ".", ms=4, color=GREY,
             label="held-out soaks, 60 s means")
    top.plot(temperature, rate - residual, color=ORANGE, label=title)
    top.set(title=f"Virtual gyro at rest: {title}", ylabel="rate at rest [°/s]")
    top.legend(loc="best")
    bottom.axhline(0, color="#555555", lw=0.8)
    if beside:
        other, _, left = held_out_sweep(folder, beside)
        bottom.plot(other, left, color="#c4c4c4",
                    label=f"cubic: variance {left.var():.2g} (°/s)²")
    bottom.plot(temperature, residual, color=BLUE,
                label=f"{short}: variance {residual.var():.2g} (°/s)²")
    low, high = bottom.get_ylim()
    bottom.set(xlabel="temperature the sensor shows [°C]",
               ylabel="residual [°/s]",
               ylim=(low, high + (0.32 if beside else 0.2) * (high - low)))
    bottom.legend(loc="upper right", ncols=2)
    save(figure, folder, name)


def allan(folder):
    """Overlapping Allan deviation at rest, before and after compensation."""
    figure, axes = pyplot.subplots()
    for name, label, colour, style in [
            # Drawn wide: the recommended network's curve lies on it.
            ("raw", "no compensation", GREY, "-"),
            ("recommended", "recommended network", BLUE, "-"),
            ("output_and_temperature",
             "network on (output, T): cancels the rate, noise included",
             ORANGE, "--")]:
        points = json.loads((folder / f"allan/{name}.json").read_text())["oadev"]
        points = [point for point in points if point["clusters"] >= 4]
        tau = np.array([point["tau_s"] for point in points])
        deviation = np.array([point["deviation"] for point in points])
        wide = {"lw": 5, "alpha": 0.6} if name == "raw" else {}
        axes.plot(tau, deviation, style, color=colour, label=label, **wide)
        if name == "recommended":
            spread = 1 / np.sqrt(2 * np.array(
                [point["clusters"] - 1 for point in points]))
            axes.fill_between(tau, deviation * (1 - spread),
                              deviation * (1 + spread), color=colour,
                              alpha=0.15, lw=0)
    axes.set(xscale="log", yscale="log",
             title="Virtual gyro at rest, 25 °C, six hours after the warm-up",
             xlabel="averaging time τ [s]",
             ylabel="overlapping Allan deviation [°/s]")
    axes.grid(which="minor", color="#f1f1f1")
    axes.legend(loc="best")
    save(figure, folder, "allan_deviation")


def main(folder):
    with pyplot.rc_context(STYLE):
        rest_output(folder)
        warm_up(folder)
        fit(folder, "cubic", "cubic", "least-squares cubic", "figure_6_cubic")
        fit(folder, "bp", "BP network", "BP network on the temperature",
            "figure_7_bp", beside="cubic")
        allan(folder)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
