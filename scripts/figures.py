#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the figures of the demo, PNG and SVG: figures.py DIR

DIR is what scripts/demo.py filled; its runs/ and allan/ are read. The paper's
figures and the Allan plot go to DIR, what goes beyond the paper to DIR/more.
"""

import json
import pathlib
import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend comes first)

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python/beamgyro"))
from plots import style  # noqa: E402  (where it is comes first)
from plots.style import BLUE, GREY, ORANGE, WORDS  # noqa: E402

PALE = "#b3d4e8"
DPI = 150  # small enough for a README
BLOCK = 60.0  # [s], what scores are averaged over, too
FLOOR = np.sqrt(2 * np.log(2) / np.pi)  # of the Allan deviation, over B


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


def titled(axes, title, about):
    """A title, and in smaller letters what was run and whether with noise."""
    axes.set_title(title, pad=19 + 12 * about.count("\n"))
    axes.text(0, 1.02, about, transform=axes.transAxes, fontsize=8.5,
              color=WORDS, va="bottom")


def signed(value):
    """A number with the minus sign that axes have."""
    return f"{value:+.3f}".replace("-", "−")


def save(figure, folder, name):
    for suffix in style.FORMATS:
        style.save(figure, folder / f"{name}.{suffix}", dpi=DPI)
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
    titled(axes, "Virtual gyro at rest: output at the end of each soak",
           "soaks from −40 to 50 °C, run with noise; means of 60 s")
    axes.set(xlabel="chamber temperature [°C]",
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
        mean_time, mean_rate, mean_bias = block_means(file, "time", "rate",
                                                      "true_bias")
    figure, (top, bottom) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 6.0), height_ratios=[3, 2])
    offset = mean_rate[-10:].mean() - bias[-600:].mean()
    final = bias[-1]
    outside = np.abs(bias - final) > 0.05 * abs(bias[0] - final)
    settled = minutes[np.flatnonzero(outside)[-1]]
    top.plot(minutes, rate, ".", ms=1, color=PALE, rasterized=True)
    top.plot([], [], ".", color=PALE, label="10 Hz samples")
    top.plot(mean_time / 60, mean_rate, ".", color=BLUE, label="60 s means")
    top.plot(minutes, bias + offset, color=ORANGE, lw=2,
             label=f"true drift, moved by {signed(offset)} °/s to the means at "
                   "the end")
    low, high = np.percentile(rate, [0.02, 99.98])
    titled(top, "Virtual gyro after power-on, still air at 25 °C",
           "run with noise; the true drift is what the same gyro shows "
           "without noise")
    top.set(ylabel="rate shown at rest [°/s]",
            ylim=(low - 0.2 * (high - low), high + 0.45 * (high - low)))
    left = mean_rate - mean_bias - offset
    far = np.argmax(np.abs(left))
    top.annotate("the means leave the true drift by the slow noise of this "
                 f"run:\nflicker and random walk, up to "
                 f"{abs(left[far]):.3f} °/s here; no temperature tells it",
                 (mean_time[far] / 60, mean_rate[far]), xytext=(13, low
                 - 0.12 * (high - low)), fontsize=8.5, color=WORDS,
                 arrowprops={"arrowstyle": "-", "color": WORDS, "lw": 0.8,
                             "relpos": (0, 0.9)})
    top.legend(loc="upper right", fontsize=9)
    bottom.axvline(settled, color=GREY, lw=1, ls="--")
    bottom.annotate(f"drift within 5 % of its change after {settled:.1f} min",
                    (settled, 0.04), xytext=(6, 0), textcoords="offset points",
                    fontsize=9, xycoords=("data", "axes fraction"), color=WORDS)
    for (node, values), (colour, dash) in zip(
            warmth.items(), [(BLUE, "-"), (GREY, "--"), (ORANGE, "-.")]):
        bottom.plot(minutes, values, dash, color=colour)
        bottom.annotate(node, (minutes[-1], values[-1]), xytext=(4, 0),
                        textcoords="offset points", va="center", color=WORDS)
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


def fit(folder, method, title, name):
    """The paper's figures 6 and 7: a fit to the drift and what it leaves."""
    temperature, rate, residual = held_out_sweep(folder, method)
    figure, ((top, corner), (bottom, side)) = pyplot.subplots(
        2, 2, figsize=(7.2, 5.8), height_ratios=[3, 2], width_ratios=[4, 1])
    corner.axis("off")
    top.plot(temperature, rate, ".", ms=5, color=GREY,
             label="held-out soaks, 60 s means")
    top.plot(temperature, rate - residual, color=BLUE, lw=1.3, label=title)
    titled(top, f"Virtual gyro at rest: {title}",
           "held-out day of soaks, run without noise; the fit knows other days, "
           "with noise.\nSpikes of what is left: after a step of the chamber the "
           "beam lags behind the sensor")
    top.set(ylabel="rate at rest [°/s]", xticklabels=[])
    top.legend(loc="best")
    mean, sigma = residual.mean(), residual.std()
    bottom.axhspan(mean - sigma, mean + sigma, color=PALE, lw=0,
                   label=f"mean {signed(mean)} ± 1σ {sigma:.3f} °/s")
    bottom.axhline(mean, color=WORDS, lw=0.8, ls="--")
    bottom.plot(temperature, residual, ".", ms=3, color=BLUE)
    low, high = bottom.get_ylim()
    bottom.set(xlabel="temperature the sensor shows [°C]",
               ylabel="residual [°/s]", xlim=top.get_xlim(),
               ylim=(low, high + 0.22 * (high - low)))
    bottom.legend(loc="upper right", fontsize=9)
    side.axhspan(mean - sigma, mean + sigma, color=PALE, lw=0)
    side.hist(residual, 30, orientation="horizontal", color=BLUE)
    side.set(ylim=bottom.get_ylim(), yticklabels=[], xlabel="blocks")
    save(figure, folder, name)


def deviations(folder, name):
    found = json.loads((folder / f"allan/{name}.json").read_text())
    points = [point for point in found["oadev"] if point["clusters"] >= 4]
    tau, deviation, interval = (
        np.array([point[key] for point in points])
        for key in ["tau_s", "deviation", "interval"])
    noise = found["noise"] or {}
    return tau, deviation, interval.T, {
        symbol: noise[symbol]["per_second"]["value"] for symbol in "NBK"
        if noise.get(symbol) and noise[symbol].get("per_second")}


def mark_terms(axes, tau, terms):
    """The asymptotes of the noise terms that the curve shows."""
    about = {  # law, words, where the words stand
        "N": (lambda t, n: n / np.sqrt(t), "slope −½: N = {:.3g} °/√s", 8.0),
        "B": (lambda t, b: FLOOR * b + 0 * t,
              "slope 0: 0.664 B\nB = {:.3g} °/s", 0.1),
        "K": (lambda t, k: k * np.sqrt(t / 3),
              "slope +½: K = {:.3g} °/s/√s", 300.0)}
    low, high = axes.get_ylim()
    for symbol, (law, words, place) in about.items():
        if symbol not in terms:
            axes.text(0.02, 0.04, f"{symbol}: not seen within six hours",
                      transform=axes.transAxes, fontsize=8.5, color=WORDS)
            continue
        line = law(tau, terms[symbol])
        seen = (line > low) & (line < high)
        axes.plot(tau[seen], line[seen], ":", color=WORDS, lw=1.4)
        at = min(max(place, tau[seen][0]), tau[seen][-1])
        # Under a line that falls or is level, and beyond its slope.
        axes.annotate(words.format(terms[symbol]), (at, law(at, terms[symbol])),
                      xytext=(8 if symbol == "N" else 2, -3),
                      textcoords="offset points", fontsize=8.5, color=WORDS,
                      va="bottom" if symbol == "N" else "top")


def allan(folder):
    """Overlapping Allan deviation at rest, before and after compensation."""
    figure, (axes, cheat) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 6.4), height_ratios=[3, 1])
    tau, raw, _, terms = deviations(folder, "raw")
    _, kept, (low, high), _ = deviations(folder, "recommended")
    axes.plot(tau, raw, color=GREY, lw=5, label="no compensation")
    axes.plot(tau, kept, "o-", ms=3.5, lw=1.2, color=BLUE,
              label="recommended network, 95 %")
    axes.fill_between(tau, low, high, color=PALE, lw=0)
    axes.set(yscale="log", ylim=(raw.min() / 4, raw.max() * 1.4),
             ylabel="overlapping Allan deviation [°/s]")
    style.log_scale(axes.xaxis)
    style.log_scale(axes.yaxis, (1, 2, 5))
    mark_terms(axes, tau, terms)
    titled(axes, "Virtual gyro at rest, 25 °C, over six hours, after the warm-up",
           "run with noise; dotted: the terms that are fitted to the curve "
           "without compensation")
    axes.legend(loc="upper right")
    tau, cancelled, _, _ = deviations(folder, "output_and_temperature")
    cheat.plot(tau, cancelled, "--", color=ORANGE, lw=2,
               label="network on (output, T): it cancels the rate, and the "
                     "noise with it")
    style.log_scale(cheat.yaxis)
    cheat.set(xlabel="averaging time τ [s]", ylabel="[°/s]",
              ylim=(cancelled.min() / 3, cancelled.max() * 30))
    cheat.legend(loc="upper right", fontsize=9)
    for each in (axes, cheat):
        each.grid(which="minor", color="#f1f1f1")
    save(figure, folder, "allan_deviation")


def with_modes(folder):
    """Units with spurious modes, and what tables over temperature leave."""
    curves = np.genfromtxt(folder / "modes/curves.csv", delimiter=",",
                           comments="#", names=True)
    temperature, *units = (curves[name] for name in curves.dtype.names)
    rows = json.loads((folder / "table.json").read_text())["modes"]
    figure, (top, bottom) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 6.0), height_ratios=[1, 1])
    at_25 = np.argmin(np.abs(temperature - 25))
    for unit in units:
        top.plot(temperature, unit - unit[at_25], color=BLUE, lw=1, alpha=0.7)
    titled(top, f"{len(units)} virtual gyros with spurious modes",
           "steady zero-rate output, less its value at 25 °C, without noise")
    top.set(ylabel="drift [°/s]", xlim=(-41, 51))
    for row, (colour, dash, words) in zip(rows, [
            (GREY, "--", "least-squares cubic"),
            (ORANGE, "-.", "straight lines"),
            (BLUE, "-", "BP network on the temperature")]):
        bottom.plot(row["temperatures_degC"], row["residual_deg_per_s"], dash,
                    color=colour, lw=1.4,
                    label=f"{words}, rms {row['rms_deg_per_s']:.3f} °/s")
    titled(bottom, "What is left of one more unit, at every kelvin",
           "trained with noise on soaks every 5 K, up and down; scored without")
    low, high = bottom.get_ylim()
    bottom.set(xlabel="chamber temperature [°C]", ylabel="residual [°/s]",
               ylim=(low, high + 0.35 * (high - low)))
    bottom.legend(loc="upper right", fontsize=9, ncols=1)
    save(figure, folder, "spurious_modes")


def recommended(folder):
    """What the recommended network makes of motions that it never saw."""
    figure, panels = pyplot.subplots(2, 2, figsize=(9.2, 5.8), sharex="col")
    reaches = []
    for (top, bottom), name, title, scale, unit in zip(
            panels.T, ["ramp_0.75", "warm_up_25"],
            ["chamber ramp, 0.75 K/min", "warm-up in still air at 25 °C"],
            [3600, 60], ["h", "min"]):
        residuals = []
        for suffix, look in [("_noise", {"marker": ".", "ls": "", "ms": 4,
                                          "color": GREY,
                                          "label": "with noise, 60 s means"}),
                              ("", {"color": BLUE, "label": "without noise"})]:
            path = folder / f"runs/{name}{suffix}_recommended.h5"
            with h5py.File(path) as file:
                time, rate, after = block_means(file, "time", "rate",
                                                "compensated_rate")
            top.plot(time / scale, rate, **look)
            bottom.plot(time / scale, after, **look)
            residuals.append(after)
        mean, sigma = residuals[1].mean(), residuals[1].std()
        bottom.axhline(0, color=WORDS, lw=0.8)
        titled(top, f"Before: {title}", "held-out run at rest")
        titled(bottom, "After the recommended network",
               f"1σ {sigma:.4f} °/s (band); with noise "
               f"{residuals[0].std():.4f}, mean {signed(residuals[0].mean())} °/s")
        reaches.append(1.5 * max(np.abs(part).max() for part in residuals))
        bottom.set(xlabel=f"time [{unit}]")
        bottom.axhspan(mean - sigma, mean + sigma, color=PALE, lw=0)
    for axes in panels[1]:  # one scale, so that the two can be compared
        axes.set_ylim(-max(reaches), max(reaches))
    panels[0, 0].set_ylabel("rate at rest [°/s]")
    panels[1, 0].set_ylabel("compensated [°/s]")
    figure.suptitle("Virtual gyro at rest. With noise each run has a turn-on "
                    "offset of its own, which no temperature tells: the mean of "
                    "the grey points", fontsize=9.5, color=WORDS)
    panels[1, 0].legend(loc="upper left", fontsize=8.5, ncols=2)
    save(figure, folder / "more", "recommended_network")


def trap(folder):
    """A network that sees the output cancels the rate."""
    figure, panels = pyplot.subplots(1, 2, figsize=(9.2, 4.4))
    for axes, run, limit, title in zip(
            panels, ["rate_table_22", "small_rates_12"], [128, 2.2],
            ["rate table at 22 °C", "small rates at 12 °C"]):
        axes.plot([-limit, limit], [-limit, limit], color=GREY, lw=1,
                  label="a rate that is kept")
        for method, look in [
                ("recommended", {"marker": "o", "ms": 5, "color": BLUE,
                                 "label": "recommended network"}),
                ("output_and_temperature",
                 {"marker": "x", "ms": 5, "color": ORANGE, "mew": 1.6,
                  "label": "network on (output, T)"})]:
            with h5py.File(folder / f"runs/{run}_{method}.h5") as file:
                truth, answer = file["true_rate"][()], file["compensated_rate"][()]
                ready = (file["status"][()] & 3) == 0
            rates = np.unique(truth[ready].round(6))
            means = [answer[ready & (truth.round(6) == rate)].mean()
                     for rate in rates]
            axes.plot(rates, means, ls="", **look)
        titled(axes, title, "held-out run without noise, mean of each rate")
        axes.set(xlabel="true rate [°/s]", xlim=(-limit, limit),
                 ylim=(-limit, limit))
    figure.suptitle("The trap: a network that sees the output takes the rate for "
                    "drift, and cancels it", fontsize=11)
    panels[0].set_ylabel("compensated rate [°/s]")
    panels[1].legend(loc="upper left", fontsize=9)
    save(figure, folder / "more", "trap")


def main(folder):
    (folder / "more").mkdir(exist_ok=True)
    with style.look():
        rest_output(folder)
        warm_up(folder)
        fit(folder, "cubic", "least-squares cubic", "figure_6_cubic")
        fit(folder, "bp", "BP network on the temperature", "figure_7_bp")
        allan(folder)
        with_modes(folder)
        recommended(folder)
        trap(folder)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
