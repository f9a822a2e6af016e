#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Coverage of the sigma of devices adapted from a population.

uncertainty.py [--program FILE] [--out DIR] [--campaign FILE] [--set DIR]
               [--ramps DIR] [--devices N] [--scored N] [--jobs N]
               [--runs NAME...]

SET is the campaign (population.toml) as generated, its first --devices,
RAMPS the same devices on scenarios/ramp.toml; both are made where they are not
there. A population is learned from the sweeps of the training devices and
calibrated on those of the validation devices. Each of the first --scored test
devices is adapted from --runs in turn. Its residuals on soaks at every kelvin
without noise, and on ramps with noise, are compared with sigma, as
docs/reference/compensator_file.md defines it. Prints the share of residuals
within 50, 90 and 95 % intervals and the mean square of residual over sigma,
devices of equal weight, and writes them to DIR/table.json; DIR is
out/uncertainty.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import sys
import threading

import numpy as np
import xarray as xr
from scipy.interpolate import PPoly

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench"))
import few_points  # noqa: E402  (its study makes set and population)

LEVELS = {"50": 0.6745, "90": 1.6449, "95": 1.9600}  # half-widths in sigmas
RAMP = 0.1 / 60  # [K/s], from here on a sample is on a ramp
WARM_UP = 900.0  # [s]


def spline_of(parameters):
    """Piecewise cubic of knots, values and second derivatives."""
    x = np.array(parameters["knots_degC"])
    y = np.array(parameters["values_deg_per_s"])
    m = np.array(parameters["second_derivatives_deg_per_s_per_K2"])
    h = np.diff(x)
    return PPoly([np.diff(m) / (6 * h), m[:-1] / 2,
                  np.diff(y) / h - h * (2 * m[:-1] + m[1:]) / 6, y[:-1]], x)


def temperature_rate(time, T, tau):
    """(T - low-pass of T) / tau, exact for straight lines between samples."""
    lag, result = 0.0, np.zeros(len(T))
    for k in range(1, len(T)):
        h = (time[k] - time[k - 1]) / tau
        lag = np.exp(-h) * lag + (T[k] - T[k - 1]) * -np.expm1(-h) / h
        result[k] = lag / tau
    return result


def sigma_of(sigma, time, T):
    """Sigma of samples powered from the first one on."""
    table = np.array(sigma["temperature_degC"])
    square = np.interp(T, table, sigma["sigma_deg_per_s"]) ** 2
    below, above = sigma["growth_deg_per_s_per_K"]
    square += (below * np.maximum(table[0] - T, 0)) ** 2
    square += (above * np.maximum(T - table[-1], 0)) ** 2
    if on := sigma.get("power_on"):
        decay = np.exp(-(time - time[0]) / on["time_constant_s"])
        square += (on["sigma_deg_per_s"] * decay) ** 2
    if term := sigma.get("temperature_rate"):
        rate = temperature_rate(time, T, term["time_constant_s"])
        square += (term["sigma_deg_per_s_per_K_per_s"] * rate) ** 2
    return sigma["factor"] * np.sqrt(square)


class Coverage(few_points.Study):
    def __init__(self, arguments):
        super().__init__(arguments)
        self.set = (arguments.set or self.out / "set").resolve()
        self.ramps = (arguments.ramps or self.out / "ramps").resolve()
        self.runs = arguments.runs
        self.reading = threading.Lock()

    def generate(self):
        if not (self.set / "manifest.jsonl").exists():
            super().generate()
        if (self.ramps / "manifest.jsonl").exists():
            return
        text = self.campaign.read_text()
        ramp = (few_points.SCENARIOS / "ramp.toml").read_text()
        nominal = few_points.SCENARIOS / "devices/nominal.toml"
        (self.out / "ramp.toml").write_text(
            ramp.replace("devices/nominal.toml", str(nominal))
            .replace("output_rate_Hz = 1\n", "output_rate_Hz = 0.1\n"))
        head, tail = text.split("[[run]]", 1)[0], text[text.index("[output]"):]
        campaign = self.out / "ramps.toml"
        campaign.write_text(
            head.replace("../devices/nominal.toml", str(nominal))
            + '[[run]]\nname = "ramp"\nscenario = "ramp.toml"\n\n' + tail)
        fewer = ["--devices", self.devices] if self.devices else []
        self.beamgyro("generate", campaign, *fewer, "-o", self.ramps,
                      "--jobs", self.jobs)

    def adapted(self, device, run):
        file = self.out / f"{run}_{device}.json"
        self.beamgyro("train", self.set, "--run", run, "--device", device,
                      "--model", self.out / "adapted.toml", "-o", file)
        compensator = json.loads(file.read_text())
        file.unlink()
        return compensator

    def score(self, item):
        """Shares within each interval: {where: {level: share}}."""
        device, run = item
        compensator = self.adapted(device, run)
        result = {}
        for name, source in [("check", self.set), ("ramp", self.ramps)]:
            # The netCDF libraries take one thread at a time.
            with self.reading, xr.open_dataset(source / f"{name}.nc",
                                               engine="h5netcdf") as view:
                one = view.isel(device=device)
                time = one["time"].values.astype(float)
                T = one["temperature"].values.astype(float)
                rate = one["rate"].values - one["true_rate"].values
            lowest, highest = compensator["temperature_range_degC"]
            bias = spline_of(compensator["parameters"])(
                np.clip(T, lowest, highest))
            share = abs(rate - bias) / sigma_of(compensator["sigma"], time, T)
            moving = abs(temperature_rate(time, T, 300)) >= RAMP
            late = time - time[0] >= WARM_UP
            inside = (T >= lowest) & (T <= highest)
            places = {"soaks": ~moving & late & inside,
                      "ramps": moving & late & inside,
                      "warm-up": ~late, "beyond": ~inside & late}
            for place in (["soaks"] if name == "check"
                          else ["ramps", "warm-up", "beyond"]):
                own = share[places[place]]
                if len(own):
                    result[place] = {level: float(np.mean(own <= width))
                                     for level, width in LEVELS.items()}
                    result[place]["square"] = float(np.mean(own ** 2))
        return result

    def run(self):
        self.generate()
        new = self.devices_of(few_points.TEST)[:self.scored]
        self.aged = False
        self.populations()
        table, lines = {}, []
        for run in self.runs:
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                scores = list(pool.map(self.score,
                                       [(device, run) for device in new]))
            table[run] = {}
            lines.append(f"adapted from {run}, {len(new)} new devices: share "
                         "within the intervals of 50, 90, 95 %; mean square")
            for place in ["soaks", "ramps", "warm-up", "beyond"]:
                found = [score[place] for score in scores if place in score]
                if not found:
                    continue
                table[run][place] = {
                    level: np.mean([score[level] for score in found])
                    for level in [*LEVELS, "square"]}
                means = table[run][place]
                lines.append(f"  {place:10}" + "".join(
                    f"{100 * means[level]:8.1f} %" for level in LEVELS)
                    + f"{means['square']:8.2f}")
        (self.out / "table.json").write_text(json.dumps(
            {"devices": new, "coverage": table}, indent=1) + "\n")
        return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/uncertainty")
    parser.add_argument("--campaign", type=pathlib.Path,
                        default=few_points.SCENARIOS /
                        "campaigns/population.toml")
    parser.add_argument("--set", type=pathlib.Path)
    parser.add_argument("--ramps", type=pathlib.Path)
    parser.add_argument("--devices", type=int, default=0)
    parser.add_argument("--scored", type=int, default=133)
    parser.add_argument("--runs", nargs="+",
                        default=["calibration", "seven"])
    parser.add_argument("--jobs", type=int,
                        default=len(os.sched_getaffinity(0)))
    print(Coverage(parser.parse_args()).run())


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError) as error:
        sys.exit(f"uncertainty: {error}")
