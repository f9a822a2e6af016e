#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares what `beamgyro plan` forecasts with what devices show.

planning.py POPULATION.json SET [--program FILE] [--out DIR] [--simulate N]
            [--campaign FILE] [--jobs N]

SET has the run "check" of scenarios/campaigns/population.toml, of devices that
the population was not learned from: soaks at every kelvin without noise. For 2
to 7 soaks, planned and even, the truth there at the chamber's temperatures,
with the point noise of `adapted` added, is given to the posterior of the
population; what its mean leaves of the check is scored. With --simulate, the
first N devices of CAMPAIGN, which made SET, are taken through all planned soaks
and three and five even ones for real, by `generate`, `train` with
scenarios/population/adapted.toml and the check. Ends with DIR/planning.json.
"""

import argparse
import json
import pathlib
import subprocess
import sys

import h5py
import numpy as np
from scipy.interpolate import CubicSpline

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"
ADAPTED = SCENARIOS / "population/adapted.toml"
HOLD, RAMP, LAST = 2700, 0.2, 600  # of the check [s, K/min], and rows used [s]
NOISE, SHARE = 0.03, 0.01  # PointNoise of population.h
CHAMBER = np.arange(-40.0, 51.0)
SOAKS = range(2, 8)
NOISE_SEED = 5  # fixed before the first score


def values(file, name):
    data = file[name]
    return data[()] * data.attrs.get("scale_factor", 1.0) \
        + data.attrs.get("add_offset", 0.0)


def truth(folder):
    """Sensor, bias and quadrature of each device at the end of each soak."""
    found = []
    for path in sorted(folder.glob("check_*.h5")):
        with h5py.File(path) as file:
            time = file["time"][()]
            ends = HOLD + np.arange(len(CHAMBER)) * (HOLD + 60 / RAMP)
            parts = [(time > end - LAST) & (time <= end) for end in ends]
            rate = values(file, "rate") - values(file, "true_rate")
            found.append([
                np.stack([of[:, part].mean(1) for part in parts], 1)
                for of in (values(file, "temperature"), rate,
                           values(file, "quadrature"))])
    sensor, bias, quadrature = (np.concatenate(of) for of in zip(*found))
    return sensor.mean(0), bias, quadrature


class Population:
    """The posterior of `adapted`, at the temperatures of the check."""

    def __init__(self, file, sensor):
        p = json.loads(file.read_text())["population"]
        grid = np.array(p["temperatures_degC"])
        self.sensor = np.clip(sensor, grid[0], grid[-1])
        mean, modes = np.array(p["mean"]), np.array(p["modes"]).T
        n = len(grid)
        spline = [CubicSpline(grid, of, bc_type="not-a-knot") for of in
                  (mean[:n], mean[n:], modes[:n], modes[n:])]
        self.curves = spline
        self.bias_mean, self.bias_modes = (spline[0](self.sensor),
                                           spline[2](self.sensor))
        self.channel_noise = SHARE * np.sqrt((modes[n:] ** 2).sum() / n)

    def left(self, chamber, bias, quadrature, with_quadrature, seed):
        """rms over the check of each device, adapted at soaks."""
        random = np.random.Generator(np.random.Philox(seed))
        at = np.interp(chamber, CHAMBER, self.sensor)

        def show(of):
            return CubicSpline(self.sensor, of, axis=1)(at)
        y = show(bias) + NOISE * random.standard_normal(
            (len(bias), len(chamber)))
        mean, channel_mean, modes, channel_modes = self.curves
        H, y = modes(at) / NOISE, (y - mean(at)) / NOISE
        if with_quadrature:
            H = np.vstack([H, channel_modes(at) / self.channel_noise])
            y = np.hstack([y, (show(quadrature) - channel_mean(at))
                           / self.channel_noise])
        c = np.linalg.solve(np.eye(H.shape[1]) + H.T @ H, H.T @ y.T)
        error = bias - (self.bias_mean[:, None] + self.bias_modes @ c).T
        return np.sqrt((error ** 2).mean(1))


def quantiles(rms):
    return dict(zip(["median", "p90", "p95"],
                    map(float, np.percentile(rms, [50, 90, 95]))))


def interpolated(program, population_file, folder, out):
    """One entry for each number of soaks, schedule and kind of observation."""
    sensor, bias, quadrature = truth(folder)
    population = Population(population_file, sensor)
    table = []
    for flags in [["--bias-only"], []]:
        file = out / "plan.json"
        subprocess.run([program, "plan", population_file, "--soaks",
                        str(SOAKS[-1]), "--range", "-40:50", "--json", file,
                        *flags], check=True, stdout=subprocess.DEVNULL)
        plan = json.loads(file.read_text())
        for row in plan["trade_off"]:
            for kind in ["planned", "even"]:
                soaks = row[kind]
                if row["soaks"] not in SOAKS:
                    continue
                real = quantiles(population.left(
                    soaks["temperatures_degC"], bias, quadrature, not flags,
                    NOISE_SEED))
                table.append({"observed": "bias" if flags else "both",
                              "kind": kind, "soaks": row["soaks"],
                              "temperatures_degC": soaks["temperatures_degC"],
                              "hours": soaks["hours"], "realised": real,
                              "hold_s": plan["schedule"]["hold_s"],
                              "ramp_K_per_min":
                                  plan["schedule"]["ramp_K_per_min"],
                              "forecast": soaks["expected_rms_deg_per_s"]})
    return table


def simulate(program, population_file, folder, campaign, table, out, devices,
             jobs):
    """The same for some schedules, run and trained as a user does it."""
    chosen = [row for row in table
              if row["kind"] == "planned" or row["soaks"] in (3, 5)]
    text = campaign.read_text().split("[[run]]")[0]
    for k, row in enumerate(chosen):
        scenario = out / f"soaks_{k}.toml"
        scenario.write_text(schedule(row))
        text += f'[[run]]\nname = "soaks_{k}"\nscenario = "{scenario}"\n\n'
    text += ('[output]\nvariables = ["rate", "temperature", "quadrature", '
             '"true_rate"]\n')
    (out / "soaks.toml").write_text(text)
    subprocess.run([program, "generate", out / "soaks.toml", "-o", out / "soaks",
                    "--devices", str(devices), "--jobs", str(jobs)],
                   check=True, stdout=subprocess.DEVNULL)
    sensor, bias, _ = truth(folder)
    for k, row in enumerate(chosen):
        model = out / "adapted.toml"
        inputs = '["temperature"]' if row["observed"] == "bias" \
            else '["temperature", "quadrature"]'
        model.write_text(ADAPTED.read_text().replace(
            '"population.json"',
            f'"{population_file}"\ninputs = {inputs}'))
        left = []
        for device in range(devices):
            file = out / "adapted.json"
            subprocess.run([program, "train", out / "soaks", "--run",
                            f"soaks_{k}", "--device", str(device), "--model",
                            model, "-o", file], check=True,
                           stdout=subprocess.DEVNULL)
            p = json.loads(file.read_text())["parameters"]
            curve = CubicSpline(p["knots_degC"], p["values_deg_per_s"])
            left.append(np.sqrt(np.mean((bias[device] - curve(sensor)) ** 2)))
        row["simulated"] = quantiles(left)
        row["simulated_devices"] = devices
    return chosen


def schedule(row):
    """A scenario through the soaks as `plan -o` writes it."""
    order = sorted(row["temperatures_degC"])
    if abs(order[-1] - 25) < abs(order[0] - 25):
        order.reverse()
    points, now, before = [[0, 25]], 0, 25
    for soak in order:
        now += abs(soak - before) / row["ramp_K_per_min"] * 60
        points += [[now, soak]] * (now > 0) + [[now + row["hold_s"], soak]]
        now, before = now + row["hold_s"], soak
    return f"""name = "soaks"
description = "a calibration"
device = "{SCENARIOS}/devices/nominal.toml"
fidelity = "quasistatic"
duration_s = {int(np.ceil(now))}
output_rate_Hz = 0.1
seed = 0
[ambient]
points = {points}
[chamber]
stirred = true
"""


def print_table(table):
    print(f"{'observed':9}{'schedule':9}{'soaks':>6}{'hours':>7}"
          f"{'forecast':>22}{'realised':>22}")
    for row in table:
        cells = [f"{one['median']:8.3f}{one['p90']:7.3f}{one['p95']:7.3f}"
                 for one in (row["forecast"], row["realised"])]
        if "simulated" in row:
            one = row["simulated"]
            cells.append(f"  simulated {one['median']:.3f} {one['p90']:.3f} "
                         f"{one['p95']:.3f} of {row['simulated_devices']}")
        print(f"{row['observed']:9}{row['kind']:9}{row['soaks']:6}"
              f"{row['hours']:7.2f}{''.join(cells)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("population", type=pathlib.Path)
    parser.add_argument("set", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/planning")
    parser.add_argument("--simulate", type=int, default=0, metavar="N")
    parser.add_argument("--campaign", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    population = arguments.population.resolve()
    table = interpolated(arguments.program, population, arguments.set,
                         arguments.out)
    if arguments.simulate:
        if arguments.campaign is None:
            sys.exit("--simulate needs --campaign")
        simulate(arguments.program, population, arguments.set,
                 arguments.campaign, table, arguments.out.resolve(),
                 arguments.simulate, arguments.jobs)
    (arguments.out / "planning.json").write_text(json.dumps(table, indent=1))
    print_table(table)


if __name__ == "__main__":
    main()
