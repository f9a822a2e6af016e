#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares what `beamgyro plan` forecasts with what simulated devices show.

planning.py POPULATION.json SET CAMPAIGN.toml [--program FILE] [--out DIR]
            [--devices N] [--hold MIN]... [--device DEVICE.toml]
            [--range LOW:HIGH] [--jobs N]

SET is what CAMPAIGN made: the run "check" of
scenarios/campaigns/population.toml, of devices that the population was not
learned from, soaks at every kelvin without noise. For 2 to 7 soaks, planned and
even, its first N devices go through the soaks with all noise (`generate`) and
are adapted as `train` does it with scenarios/population/adapted.toml; what is
left of the check is scored. A device of each schedule is adapted by `train`
too, and must agree: the first of which `train` takes no row for one of a ramp,
as it does of one device in a hundred. "soaks" leaves out rows that belong to no soak.
DEVICE is the one that the campaign varies, nominal.toml without.
With --hold also for planned soaks that are held for so long. Ends with
DIR/planning.json.
"""

import argparse
import json
import pathlib
import re
import subprocess
import tomllib

import h5py
import numpy as np
from scipy.interpolate import CubicSpline

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"
ADAPTED = SCENARIOS / "population/adapted.toml"
NOMINAL = SCENARIOS / "devices/nominal.toml"
HOLD, RAMP, LAST = 2700, 0.2, 600  # of the check [s, K/min], and rows used [s]
SHARE = 0.01  # PointNoise of population.h
WIDTH, REACH = 2.0, 2  # of a point [K], and of a rate [rows]
ROWS = tomllib.loads(ADAPTED.read_text())["rows"]
SAMPLES, PERIOD = 6, 10.0  # of a row, and seconds between them
CHAMBER = np.arange(-40.0, 51.0)
SOAKS = range(2, 8)
DRAWS = 4000  # of the bootstrap


def values(file, name):
    data = file[name]
    return data[()] * data.attrs.get("scale_factor", 1.0) \
        + data.attrs.get("add_offset", 0.0)


def signals(path):
    with h5py.File(path) as file:
        return file["time"][()], [
            values(file, "temperature"),
            values(file, "rate") - values(file, "true_rate"),
            values(file, "quadrature")]


def truth(folder):
    """Sensor and bias of each device at the end of each soak, a row each."""
    found = []
    for path in sorted(folder.glob("check_*.h5")):
        time, (sensor, bias, _) = signals(path)
        ends = HOLD + np.arange(len(CHAMBER)) * (HOLD + 60 / RAMP)
        parts = [(time > end - LAST) & (time <= end) for end in ends]
        found.append([np.stack([of[:, part].mean(1) for part in parts], 1)
                      for of in (sensor, bias)])
    return tuple(np.concatenate(of) for of in zip(*found))


def rates(minute, T, slope, steady):
    """Of the minutes of a device, between steady ones up to REACH away."""
    found = slope.copy()
    for k in range(len(T)):
        first = last = k
        while first > max(k - REACH, 0) and steady[first - 1]:
            first -= 1
        while last < min(k + REACH, len(T) - 1) and steady[last + 1]:
            last += 1
        if steady[k] and last > first:
            found[k] = (T[last] - T[first]) / (minute[last] - minute[first])
    return found


def rows_of(columns, limits):
    """Means of the minutes of each device, the first of them the temperature
    without the lag, and which are steady."""
    columns = [np.clip(columns[0], *limits), *columns[1:]]
    size = columns[0].shape[1]
    means, slopes, minute = [], [], []
    for first in range(0, size - SAMPLES // 2 + 1, SAMPLES):
        block = [of[:, first:first + SAMPLES] for of in columns]
        weight = np.arange(block[0].shape[1]) * PERIOD
        minute.append((first * PERIOD + weight.mean()) / 60)
        weight -= weight.mean()
        slopes.append(block[0] @ weight / (weight ** 2).sum() * 60)
        means.append([of.mean(1) for of in block])
    means, slopes = np.transpose(means, (2, 0, 1)), np.transpose(slopes)
    steady = abs(slopes) <= ROWS["steady_K_per_min"]
    steady[:, np.floor(minute) < ROWS["after_power_on_min"]] = False
    for own, slope, stays in zip(means, slopes, steady):
        own[:, 0] = np.clip(own[:, 0] - ROWS["lag_min"] *
                            rates(minute, own[:, 0], slope, stays), *limits)
    return means, steady


def points(folder, run, limits):
    """The points of each device that `adapted` makes of the steady rows."""
    for path in sorted(folder.glob(f"{run}_0*.h5")):
        for rows, steady in zip(*rows_of(signals(path)[1], limits)):
            own = rows[steady]
            groups = []
            for row in own[np.argsort(own[:, 0], kind="stable")]:
                if not groups or row[0] - groups[-1][0][0] >= WIDTH:
                    groups.append([])
                groups[-1].append(row)
            yield np.array([np.mean(group, 0) for group in groups])


def own_modes(grid, part):
    """A root of the covariance of what devices have of their own."""
    x = np.sqrt(3) / part["length_K"] * abs(grid[:, None] - grid)
    values, vectors = np.linalg.eigh((1 + x) * np.exp(-x))
    return part["deviation"] * vectors * np.sqrt(values.clip(0))


class Population:
    """The posterior of `adapted`, at the temperatures of the check."""

    def __init__(self, file):
        p = json.loads(file.read_text())["population"]
        self.grid = np.array(p["temperatures_degC"])
        mean, modes = np.array(p["mean"]), np.array(p["modes"]).T
        n = len(self.grid)
        self.noise = [p["point_noise_deg_per_s"],
                      SHARE * np.sqrt((modes[n:] ** 2).sum() / n)]
        for curve, part in enumerate(p["own"]):
            if part["deviation"] > 0:
                added = np.zeros((len(modes), n))
                added[n * curve:n * (curve + 1)] = own_modes(self.grid, part)
                modes = np.hstack([modes, added])
        self.curves = [CubicSpline(self.grid, of, bc_type="not-a-knot")
                       for of in (mean[:n], modes[:n], mean[n:], modes[n:])]

    def inside(self, sensor):
        return np.clip(sensor, self.grid[0], self.grid[-1])

    def adapted(self, T, shown, sensor, channels=True):
        """The curves of devices, a row each, that show bias and quadrature,
        a row each, at points T."""
        at, check = self.inside(T), self.inside(sensor)
        H, y = [], []
        for k in range(1 + channels):
            mean, modes = self.curves[2 * k:2 * k + 2]
            H.append(modes(at) / self.noise[k])
            y.append((shown[k] - mean(at)) / self.noise[k])
        H, y = np.vstack(H), np.hstack(y)
        c = np.linalg.solve(np.eye(H.shape[1]) + H.T @ H, H.T @ y.T)
        mean, modes = self.curves[:2]
        return mean(check) + (modes(check) @ c).T

    def left(self, rows, sensor, bias, channels):
        """rms over the check of a device, adapted at points."""
        curve = self.adapted(rows[:, 0], rows.T[1:, None], sensor, channels)
        return np.sqrt(((bias - curve[0]) ** 2).mean())


def quantiles(rms):
    return dict(zip(["median", "p90", "p95"],
                    map(float, np.percentile(rms, [50, 90, 95]))))


def plans(program, population, out, hold, of):
    """One entry for each number of soaks, schedule and kind of observation."""
    table = []
    for flags in [["--bias-only"], []]:
        file = out / "plan.json"
        words = ["--hold", str(hold)] if hold else []
        subprocess.run([program, "plan", population, "--soaks",
                        str(SOAKS[-1]), f"--range={of.range}", "--device",
                        of.device, "--json", file, *flags, *words], check=True,
                       stdout=subprocess.DEVNULL)
        plan = json.loads(file.read_text())
        assert plan["schedule"]["rows"].items() <= ROWS.items()
        for row in plan["trade_off"]:
            for kind in ["planned"] if hold else ["planned", "even"]:
                if row["soaks"] in SOAKS:
                    table.append({
                        "observed": "bias" if flags else "both", "kind": kind,
                        "soaks": row["soaks"], **row[kind],
                        "ramp_K_per_min": plan["schedule"]["ramp_K_per_min"]})
    return table


def schedule(row, device):
    """A scenario through the soaks as `plan -o` writes it."""
    order = sorted(row["temperatures_degC"])
    if abs(order[-1] - 25) < abs(order[0] - 25):
        order.reverse()
    path, now, before = [[0, 25]], 0, 25
    for soak in order:
        now += abs(soak - before) / row["ramp_K_per_min"] * 60
        path += [[now, soak]] * (now > 0) + [[now + row["hold_s"], soak]]
        now, before = now + row["hold_s"], soak
    return f"""name = "soaks"
description = "a calibration"
device = "{device}"
fidelity = "quasistatic"
duration_s = {int(np.ceil(now))}
output_rate_Hz = {1 / PERIOD}
seed = 0
[ambient]
points = {path}
[chamber]
stirred = true
"""


def generate(program, campaign, table, out, devices, jobs,
             device=NOMINAL):
    text = re.sub(
        r'^device = "(.*)"$',
        lambda found: f'device = "{(campaign.parent / found[1]).resolve()}"',
        campaign.read_text().split("[[run]]")[0], flags=re.M)
    for k, row in enumerate(table):
        scenario = out / f"soaks_{k}.toml"
        scenario.write_text(schedule(row, device))
        text += f'[[run]]\nname = "soaks_{k}"\nscenario = "{scenario}"\n\n'
    text += ('[output]\nvariables = ["rate", "temperature", "quadrature", '
             '"true_rate"]\n')
    (out / "soaks.toml").write_text(text)
    subprocess.run([program, "generate", out / "soaks.toml", "-o", out / "soaks",
                    "--devices", str(devices), "--jobs", str(jobs)],
                   check=True, stdout=subprocess.DEVNULL)


def trained(program, population_file, out, run, device, check, inputs):
    """rms left of a device by `train`; nothing where it leaves rows out."""
    model, file = out / "adapted.toml", out / "adapted.json"
    model.write_text(ADAPTED.read_text().replace(
        '"population.json"',
        f'"{population_file}"\ninputs = {json.dumps(inputs)}'))
    words = subprocess.run(
        [program, "train", out / "soaks", "--run", run, "--device",
         str(device), "--model", model, "-o", file], check=True,
        capture_output=True, text=True).stdout
    if "are left out" in words:
        return None
    p = json.loads(file.read_text())["parameters"]
    curve = CubicSpline(p["knots_degC"], p["values_deg_per_s"])
    sensor, bias = check
    return np.sqrt(np.mean((bias - curve(sensor)) ** 2))


def simulate(program, population_file, folder, table, out, limits):
    sensor, bias = truth(folder)
    inside = (CHAMBER >= limits[0]) & (CHAMBER <= limits[1])
    population = Population(population_file)
    for k, row in enumerate(table):
        both = row["observed"] == "both"
        settled = np.interp(row["temperatures_degC"], CHAMBER, sensor.mean(0))
        left, of_soaks = [], []
        for device, rows in enumerate(points(out / "soaks", f"soaks_{k}",
                                             population.grid[[0, -1]])):
            near = abs(rows[:, :1] - settled).min(1) < WIDTH
            check = sensor[device, inside], bias[device, inside]
            left.append(population.left(rows, *check, both))
            of_soaks.append(population.left(rows[near], *check, both))
        row["rms"], row["simulated"] = left, quantiles(left)
        row["of_soaks"], row["devices"] = quantiles(of_soaks), len(left)
        inputs = ["temperature", "quadrature"][:1 + both]
        for device, own in enumerate(left):
            by_train = trained(program, population_file, out, f"soaks_{k}",
                               device, (population.inside(
                                   sensor[device, inside]),
                                   bias[device, inside]), inputs)
            if by_train is not None:
                np.testing.assert_allclose(by_train, own, rtol=1e-6)
                break


def print_table(table):
    print(f"{'observed':9}{'schedule':9}{'soaks':>6}{'hold':>5}{'hours':>7}"
          f"{'forecast':>20}{'simulated':>22}{'rows of soaks':>22}")
    for row in table:
        cells = [f"{one['median']:8.3f}{one['p90']:7.3f}{one['p95']:7.3f}"
                 for one in (row["expected_rms_deg_per_s"], row["simulated"],
                             row["of_soaks"])]
        print(f"{row['observed']:9}{row['kind']:9}{row['soaks']:6}"
              f"{row['hold_s'] / 60:5.0f}{row['hours']:7.2f}{''.join(cells)}")


def print_ratios(table):
    """Planned over even, with 95 % of a bootstrap over devices."""
    random = np.random.Generator(np.random.Philox(1))
    for observed in ["bias", "both"]:
        for soaks in SOAKS:
            planned, even = (np.array(next(
                row["rms"] for row in table if row["soaks"] == soaks and
                (row["observed"], row["kind"]) == (observed, kind)))
                for kind in ["planned", "even"])
            draw = random.integers(0, len(even), (DRAWS, len(even)))
            text = f"planned / even, {observed}, {soaks} soaks:"
            for p in (50, 95):
                ratio = (np.percentile(planned[draw], p, 1) /
                         np.percentile(even[draw], p, 1))
                low, high = np.percentile(ratio, [2.5, 97.5])
                now = np.percentile(planned, p) / np.percentile(even, p)
                text += f"  {p} % {now:.2f} [{low:.2f}, {high:.2f}]"
            print(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ["population", "set", "campaign"]:
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/planning")
    parser.add_argument("--devices", type=int, default=300)
    parser.add_argument("--hold", type=int, action="append", default=[])
    parser.add_argument("--device", type=pathlib.Path, default=NOMINAL)
    parser.add_argument("--range", default="-40:50")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    program, population = arguments.program, arguments.population.resolve()
    table = [row for hold in [None, *arguments.hold]
             for row in plans(program, population, out, hold, arguments)]
    generate(program, arguments.campaign, table, out, arguments.devices,
             arguments.jobs, arguments.device.resolve())
    simulate(program, population, arguments.set, table, out,
             [float(end) for end in arguments.range.split(":")])
    (out / "planning.json").write_text(json.dumps(table, indent=1))
    print_table(table)
    print_ratios(table)


if __name__ == "__main__":
    main()
