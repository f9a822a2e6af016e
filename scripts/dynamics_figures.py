#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws what the gyro does within seconds, and what each fidelity leaves out.

dynamics_figures.py [--program FILE] [--out DIR] [--jobs N]; DIR is
out/dynamics. Beside the pictures, PNG and SVG, numbers.json holds the
differences they show.
"""

import csv
import json
import subprocess
import sys
import tomllib

import h5py
import numpy as np

from demo import NOISE_OFF, SCENARIOS, Demo, options
from figures import BLUE, GREY, ORANGE, pyplot, save, style

DEVICES = {"nominal": BLUE, "rebalance": ORANGE, "matched": GREY}
LABELS = {"nominal": "nominal, open loop", "rebalance": "force rebalance",
          "matched": "matched modes, open loop"}
# [Hz], whole numbers: the last second of a run holds whole cycles of each.
FREQUENCIES = [2, 3, 5, 8, 12, 20, 30, 40, 50, 60, 70, 85, 110, 150, 200]
HIGHEST = 220  # [Hz], where curves end
STEP = 1.00025  # [s], of scenarios/start_up.toml, between two samples
LOCKED = 1.0  # [s], when a start-up is over
NOT_LOCKED = 4  # bit of status
# The steps of the real one, 0.005 deg/s, would hide what is compared here.
FINE_ADC = "readout.adc_bits=32"


class Dynamics(Demo):
    """The demo's way to call the program, with runs of its own."""

    def __init__(self, program, out, jobs):
        self.program, self.out, self.jobs = program, out, jobs
        self.runs = out / "runs"
        self.runs.mkdir(parents=True, exist_ok=True)

    def simulate(self):
        runs = [(f"{scenario}_{fidelity}", scenario, fidelity, [])
                for scenario, fidelity in [
                    ("start_up", "carrier"), ("start_up", "envelope"),
                    ("ramp", "envelope"), ("ramp", "quasistatic"),
                    ("warm_up", "envelope"), ("warm_up", "quasistatic")]]
        for device in DEVICES:
            chosen = [f'device="devices/{device}.toml"']
            runs.append((f"bandwidth_{device}", "bandwidth", "envelope",
                         chosen))
            runs += [(f"sine_{device}_{hertz}", "sine_rate", "envelope",
                      chosen + [f"rate.sine.frequency_Hz={hertz}"])
                     for hertz in FREQUENCIES]

        def run(item):
            name, scenario, fidelity, overrides = item
            sets = [part for text in [*overrides, NOISE_OFF, FINE_ADC]
                    for part in ("--set", text)]
            self.beamgyro("run", SCENARIOS / f"{scenario}.toml", "--fidelity",
                          fidelity, *sets, "-o", self.recording(name))
        self.all(run, runs)
        return len(runs)

    def read(self, name, *variables):
        with h5py.File(self.recording(name)) as file:
            return [file[variable][()] for variable in variables]

    def modes(self, device):
        """Split D [rad/s] and decay time tau [s] of the sense mode at 25 degC,
        where the runs are."""
        table = self.runs / f"{device}.csv"
        self.beamgyro("characterise", SCENARIOS / f"devices/{device}.toml",
                      "--beam-temperature", 25, "-o", table)
        (at_25,) = csv.DictReader(table.read_text().splitlines())
        carrier = 2 * np.pi * float(at_25["drive_frequency_Hz"])
        # Q is that of the drive frequency, the one the sense mode moves at.
        return (2 * np.pi * float(at_25["split_Hz"]),
                2 * float(at_25["q_sense"]) / carrier)

    def closed_form(self, device, hertz):
        """|output / rate| of the linear model, 1 at frequency 0."""
        text = (SCENARIOS / f"devices/{device}.toml").read_text()
        keys = tomllib.loads(text)
        readout, s = keys["readout"], 2j * np.pi * hertz

        def two_poles(corner):
            return (1 + s / (2 * np.pi * corner)) ** -2
        demodulator = two_poles(keys["drive"]["demodulator_corner_Hz"])
        if readout["mode"] == "force_rebalance":
            # The controller's zero lies on the sense mode's pole, which leaves
            # an integrator; 20 Hz is what the program takes, too.
            gain = 2 * np.pi * readout.get("rebalance_bandwidth_Hz", 20)
            mode = gain / (s + gain * demodulator)
        else:
            split, tau = self.modes(device)
            mode = ((s / tau + split**2 + tau**-2)
                    / ((s + 1 / tau) ** 2 + split**2))
        return np.abs(mode * demodulator * two_poles(readout["bandwidth_Hz"]))

    def sine_gain(self, device, hertz):
        time, rate, rest, true = self.read(
            f"sine_{device}_{hertz}", "time", "rate", "true_bias", "true_rate")
        last = slice(-round(1 / (time[1] - time[0])), None)
        answer, cause = (np.fft.rfft(values[last])[hertz]
                         for values in (rate - rest, true))
        return abs(answer / cause)

    def binary_gain(self, device):
        """Frequencies [Hz] and gains from one pseudo-random binary rate."""
        time, rate, rest, true = self.read(
            f"bandwidth_{device}", "time", "rate", "true_bias", "true_rate")
        step = time[1] - time[0]
        hertz = np.fft.rfftfreq(len(time), step)
        shown = (hertz >= FREQUENCIES[0]) & (hertz <= HIGHEST)
        moving = time >= LOCKED - step / 2  # the start-up is no answer to a rate
        answer, cause = (np.fft.rfft(np.where(moving, values, 0))[shown]
                         for values in (rate - rest, true))
        hertz = hertz[shown]
        # The rate stands still between its samples.
        return hertz, np.abs(answer / cause) / np.sinc(hertz * step)


def start_up(work):
    time, voltage, frequency, rate, status = work.read(
        "start_up_envelope", "time", "drive_voltage", "drive_frequency",
        "rate", "status")
    locked = 1e3 * time[np.flatnonzero(status & NOT_LOCKED)[-1] + 1]
    final = rate[time < LOCKED][-1]
    milliseconds = 1e3 * time
    figure, panels = pyplot.subplots(4, 1, sharex=True, figsize=(7.2, 8))
    for panel, values, colour in zip(
            panels, [voltage, frequency, rate, np.abs(rate - final)],
            [BLUE, BLUE, ORANGE, ORANGE]):
        panel.plot(milliseconds, values, color=colour)
        panel.axvline(locked, color=GREY, lw=1, ls="--")
    panels[0].annotate(f"locked after {locked:.0f} ms", (locked, 0.9),
                       xycoords=("data", "axes fraction"), xytext=(6, 0),
                       textcoords="offset points", fontsize=9, color="#555555")
    panels[0].set(title="Virtual gyro: the first 0.4 s after power-on, 25 °C",
                  ylabel="drive voltage [V]")
    panels[1].set(ylabel="drive frequency\n[Hz]")
    panels[2].set(ylabel="rate shown\n[°/s]")
    style.log_scale(panels[3].yaxis)
    panels[3].set(xlabel="time since power-on [ms]",
                  ylabel=f"|rate − {final:.3f} °/s|\n[°/s]", xlim=(0, 400),
                  ylim=(1e-4, 200))
    figure.align_ylabels()
    save(figure, work.out, "start_up")
    return {"locked_after_s": round(locked / 1e3, 6)}


def rate_step(work):
    (time, envelope), (carrier,) = (
        work.read("start_up_envelope", "time", "rate"),
        work.read("start_up_carrier", "rate"))
    after = 1e3 * (time - STEP)
    shown = (after > -10) & (after < 150)
    difference = carrier - envelope
    figure, (top, bottom) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 5.8), height_ratios=[3, 2])
    # Drawn wide: the envelope's curve lies on it.
    top.plot(after[shown], carrier[shown], color=GREY, lw=5, alpha=0.6,
             label="carrier, every vibration")
    top.plot(after[shown], envelope[shown], color=BLUE, label="envelope")
    top.set(title="Virtual gyro: answer to a step of 10 °/s",
            ylabel="rate shown [°/s]")
    top.legend(loc="lower right")
    bottom.plot(after[shown], 1e3 * difference[shown], ".-", ms=3, lw=1,
                color=ORANGE)
    bottom.set(xlabel="time since the step [ms]", xlim=(-10, 150),
               ylabel="carrier − envelope\n[0.001 °/s]")
    figure.align_ylabels()
    save(figure, work.out, "rate_step")
    return {"carrier_minus_envelope_deg_per_s": {
        "max": np.abs(difference[after > 0]).max(),
        "end": abs(difference[-1])}}


def frequency_response(work):
    figure, (top, bottom) = pyplot.subplots(
        2, 1, sharex=True, figsize=(7.2, 7), height_ratios=[3, 2])
    points = np.array(FREQUENCIES)
    worst = {}
    for device, colour in DEVICES.items():
        sines = np.array([work.sine_gain(device, f) for f in FREQUENCIES])
        hertz, binary = work.binary_gain(device)
        closed = work.closed_form(device, hertz)
        top.plot(hertz, binary, color=colour, lw=5, alpha=0.3)
        top.plot(hertz, closed, color=colour, lw=1.2)
        top.plot(points, sines, "o", ms=4.5, color=colour,
                 label=LABELS[device])
        of_sines = np.abs(sines / work.closed_form(device, points) - 1)
        of_binary = np.abs(binary / closed - 1)
        bottom.plot(hertz, 100 * of_binary, color=colour, lw=1, alpha=0.4)
        bottom.plot(points, 100 * of_sines, "o", ms=4.5, color=colour)
        worst[device] = {"sines": of_sines.max(), "binary": of_binary.max()}
    for look, label in [({"marker": "o", "ls": "", "ms": 4.5}, "sine rates"),
                        ({"lw": 5, "alpha": 0.3}, "pseudo-random rate"),
                        ({"lw": 1.2}, "closed form")]:
        top.plot([], [], color="#555555", label=label, **look)
    for axis in (top.xaxis, top.yaxis, bottom.yaxis):
        style.log_scale(axis)
    top.set(xlim=(1.8, 230),
            title="Virtual gyro: gain over the frequency of the rate, 25 °C",
            ylabel="output rate / true rate")
    top.legend(loc="lower left")
    bottom.set(ylim=(3e-5, 5), xlabel="frequency [Hz]",
               ylabel="|simulated / closed form − 1|\n[%]")
    bottom.set_xticks([2, 5, 10, 20, 50, 100, 200],
                      ["2", "5", "10", "20", "50", "100", "200"])
    for axes in (top, bottom):
        axes.grid(which="minor", color="#f1f1f1")
    figure.align_ylabels()
    save(figure, work.out, "frequency_response")
    return {"deviation_from_closed_form": worst}


def fidelities(work):
    """What each fidelity's zero-rate output lacks of the next one's."""
    figure, panels = pyplot.subplots(1, 3, sharey=True, figsize=(9.6, 4.6))
    largest = {}
    for panel, scenario, pair, title, unit, label in zip(
            panels, ["warm_up", "ramp", "start_up"],
            [("quasistatic", "envelope")] * 2 + [("envelope", "carrier")],
            ["warm-up at 25 °C", "ramps of 1 K/min, stirred",
             "first 1.5 s at 25 °C"],
            [1, 3600, 1],
            ["time since power-on [s]", "time since power-on [h]",
             "time since power-on [s]"]):
        (time, less), (more,) = (
            work.read(f"{scenario}_{pair[0]}", "time", "true_bias"),
            work.read(f"{scenario}_{pair[1]}", "true_bias"))
        difference = np.abs(more - less)
        largest[scenario] = difference[time >= LOCKED].max()
        panel.plot(time[1:] / unit, difference[1:], lw=1,
                   color=ORANGE if "carrier" in pair else BLUE)
        panel.set(title=f"{pair[0]} vs {pair[1]}:\n{title}", xlabel=label)
        panel.annotate(f"{largest[scenario]:.1e} °/s at most\nafter 1 s",
                       (0.97, 0.97), xycoords="axes fraction", ha="right",
                       va="top", fontsize=9, color="#555555")
    style.log_scale(panels[0].xaxis)
    style.log_scale(panels[0].yaxis)
    panels[0].set(xlim=(0.1, 3600), ylim=(1e-9, 1),
                  ylabel="|difference of the zero-rate output| [°/s]")
    save(figure, work.out, "fidelities")
    return {"zero_rate_difference_deg_per_s": largest}


def main():
    arguments = options("dynamics").parse_args()
    work = Dynamics(arguments.program.resolve(), arguments.out.resolve(),
                    arguments.jobs)
    print(f"{work.simulate()} runs simulated; drawing ...", file=sys.stderr)
    numbers = {}
    with style.look():
        for draw in (start_up, rate_step, frequency_response, fidelities):
            numbers |= draw(work)
    (work.out / "numbers.json").write_text(json.dumps(numbers, indent=2) + "\n")
    print("Pictures (and the same as .svg):")
    for picture in sorted(work.out.glob("*.png")):
        print(f"  {picture}")


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"dynamics_figures: {error}")
