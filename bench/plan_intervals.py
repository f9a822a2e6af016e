#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Counts how often the intervals that `beamgyro plan` prints hold.

plan_intervals.py SET CAMPAIGN.toml [--program FILE] [--out DIR] [--draws N]
                  [--size N] [--soaks N]... [--first-seed N] [--keep DIR]
                  [--device DEVICE.toml] [--range LOW:HIGH]
                  [--sweep SCENARIO.toml] [--grid K]

SET is as planning.py wants it, of new units of CAMPAIGN, with a seed of its
own. Populations of --size devices of CAMPAIGN, each of another seed, are
learned from sweeps (scenarios/soak_sweep_sparse.toml) on a grid of --grid
kelvins; --keep names a folder of populations that are there already, SEED.json.
Each plans --soaks soaks. The plan and as many even soaks are simulated of all
devices of SET, with all noise and the lag of the beam. What adaptation and
straight lines leave of their checks, in the median and in 95 %, and the
quotient of the medians, is what the printed intervals should hold. Ends with
DIR/intervals.json.

Of units that remember SET has a run "checkdown" as well, the same soaks from 50
down to -40 degC: what is left is scored over both.
"""

import argparse
import json
import pathlib
import shutil
import subprocess

import numpy as np

from planning import (CHAMBER, HOLD, LAST, NOMINAL, RAMP, ROOT, SCENARIOS,
                      Population, generate, points, quantiles, signals)

FINE = 0.05  # [K], of the table that curves are read from


def learned(seed, out, of):
    """A population of the sweeps of a few devices."""
    text = with_seed(of.campaign, seed).split("[[run]]")[0] + f"""
[[run]]
name = "sweep"
scenario = "{of.sweep.resolve()}"
[output]
variables = ["rate", "temperature", "quadrature", "true_rate"]
"""
    campaign, model = out / "sweep.toml", out / "population.toml"
    campaign.write_text(text)
    model.write_text((SCENARIOS / "population/population.toml").read_text()
                     .replace("grid_K = 5", f"grid_K = {of.grid}"))
    folder, file = out / "sweeps" / str(seed), out / f"{seed}.json"
    for words in [["generate", campaign, "-o", folder, "--devices",
                   str(of.size), "--jobs", "1"],
                  ["train", folder, "--run", "sweep", "--model", model, "-o",
                   file]]:
        subprocess.run([of.program, *words, "-q"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return file


def with_seed(campaign, seed):
    """The text of a campaign with another seed, which may lie anywhere."""
    lines = []
    for line in campaign.read_text().splitlines():
        if line.startswith("seed ="):
            line = f"seed = {seed}"
        if line.startswith("device ="):
            device = campaign.parent / line.split('"')[1]
            line = f'device = "{device.resolve()}"'
        lines.append(line)
    return "\n".join(lines) + "\n"


def planned(file, soaks, out, of):
    subprocess.run([of.program, "plan", file, "--soaks", str(soaks),
                    f"--range={of.range}", "--device", of.device, "--json",
                    out / "plan.json"], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return json.loads((out / "plan.json").read_text())


def checks_of(folder):
    """Of the way up and, if there is one, of the way down."""
    return [check_of(folder, run) for run in ("check", "checkdown")
            if any(folder.glob(f"{run}_*.h5"))]


def check_of(folder, run):
    """Sensor and bias of each device at the end of each soak of a check."""
    found = []
    for path in sorted(folder.glob(f"{run}_*.h5")):
        time, (sensor, bias, _) = signals(path)
        ends = HOLD + np.arange(len(CHAMBER)) * (HOLD + 60 / RAMP)
        parts = [(time > end - LAST) & (time <= end) for end in ends]
        found.append([np.stack([values[:, part].mean(1) for part in parts], 1)
                      for values in (sensor, bias)])
    sensor, bias = (np.concatenate(part) for part in zip(*found))
    return (sensor, bias) if run == "check" else (sensor[:, ::-1],
                                                  bias[:, ::-1])


class Units:
    """The new units: their checks, and the soaks that they went through."""

    def __init__(self, out, of):
        self.out, self.of = out, of
        lowest, highest = map(float, of.range.split(":"))
        inside = (CHAMBER >= lowest) & (CHAMBER <= highest)
        self.checks = [(sensor[:, inside], bias[:, inside])
                       for sensor, bias in checks_of(of.set)]
        manifest = (of.set / "manifest.jsonl").read_text().split("\n", 1)[0]
        self.campaign = out / "units.toml"
        self.campaign.write_text(
            with_seed(of.campaign, json.loads(manifest)["seed"]))
        self.known = {}  # the folder of a schedule that is the same for all

    def soaked(self, schedule, limits, again):
        """The points of each unit after the soaks of a schedule."""
        key = json.dumps([schedule["temperatures_degC"], schedule["hold_s"]])
        folder = self.known.get(key)
        if folder is None:
            folder = self.out / "units" / (f"{len(self.known)}" if again
                                           else "planned")
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            generate(self.of.program, self.campaign, [schedule], folder,
                     len(self.checks[0][0]), 1, self.of.device.resolve())
            if again:
                self.known[key] = folder
        return list(points(folder / "soaks", "soaks_0", limits))

    def left_of(self, curves):
        """rms over the checks, of curves at the temperatures of each."""
        return np.sqrt(np.mean([((bias - curve) ** 2).mean(1) for (_, bias),
                                curve in zip(self.checks, curves)], 0))


def coefficients(population, shown):
    """Those of each unit, from its points, by the posterior of `adapted`."""
    found = [None] * len(shown)
    for size in {len(rows) for rows in shown}:
        own = [k for k, rows in enumerate(shown) if len(rows) == size]
        rows = np.array([shown[k] for k in own])
        at = population.inside(rows[:, :, 0])
        H, y = [], []
        for k in range(2):
            mean, modes = population.curves[2 * k:2 * k + 2]
            H.append(modes(at) / population.noise[k])
            y.append((rows[:, :, 1 + k] - mean(at)) / population.noise[k])
        H, y = np.concatenate(H, 1), np.concatenate(y, 1)
        S = H @ H.transpose(0, 2, 1) + np.eye(H.shape[1])
        c = np.einsum("kij,ki->kj", H, np.linalg.solve(S, y[:, :, None])[..., 0])
        for k, one in zip(own, c):
            found[k] = one
    return np.array(found)


def adapted(population, shown, units):
    """What is left of each unit that is adapted from its points."""
    low, high = population.grid[[0, -1]]
    fine = np.arange(low, high + FINE, FINE)
    mean, modes = (of(population.inside(fine)) for of in population.curves[:2])
    curves = mean + coefficients(population, shown) @ modes.T
    return units.left_of([
        [np.interp(T, fine, curve) for T, curve in zip(sensor, curves)]
        for sensor, _ in units.checks])


def lines(shown, units):
    """What straight lines leave between the points of each unit."""
    return units.left_of([
        [np.interp(T, rows[:, 0], rows[:, 1]) for T, rows in zip(sensor, shown)]
        for sensor, _ in units.checks])


def realised(file, plan, units):
    """What plan, even soaks and straight lines leave of each device."""
    population = Population(file)
    limits = [float(end) for end in population.grid[[0, -1]]]
    found = {}
    for name, of in [("planned", plan["schedule"]), ("even", plan["even"])]:
        schedule = {**of, "ramp_K_per_min": plan["schedule"]["ramp_K_per_min"]}
        shown = units.soaked(schedule, limits, name == "even")
        found[name] = adapted(population, shown, units)
        if name == "even":
            found["lines"] = lines(shown, units)
    return found


def held(interval, value):
    return bool(interval[0] <= value <= interval[1])


def draw(seed, soaks, out, units, of):
    kept = of.keep and of.keep / f"{seed}.json"
    file = kept if kept and kept.exists() else learned(seed, out, of)
    plan = planned(file, soaks, out, of)
    left = realised(file, plan, units)
    gain = plan["gain_over_straight_lines"]
    ratio = float(np.median(left["planned"]) / np.median(left["lines"]))
    row = {"seed": seed, "soaks": soaks, "devices": plan["devices"],
           "gain": gain, "ratio": ratio,
           "holds": {"gain": held(gain["interval"], ratio)}}
    for name, forecast in [("planned", plan["expected_rms_deg_per_s"]),
                           ("even", plan["even"]["expected_rms_deg_per_s"]),
                           ("lines", plan["straight_lines"])]:
        found = quantiles(left[name])
        row[name] = {"forecast": forecast, "realised": found}
        for share in ["median", "p95"]:
            row["holds"][f"{name} {share}"] = held(
                forecast[f"{share}_interval"], found[share])
    return row


def print_table(rows):
    for soaks in sorted({row["soaks"] for row in rows}):
        of = [row for row in rows if row["soaks"] == soaks]
        print(f"{soaks} soaks, {len(of)} populations; held:")
        for name in of[0]["holds"]:
            print(f"  {name:16}{sum(row['holds'][name] for row in of):4}")
        ratios = [row["gain"]["ratio"] / row["ratio"] for row in of]
        print(f"  printed over realised gain, median {np.median(ratios):.3f}")
        for name in ["planned", "even", "lines"]:
            for q in ["median", "p95"]:
                each = [row[name]["forecast"][q] / row[name]["realised"][q]
                        for row in of]
                low, middle, high = np.percentile(each, [10, 50, 90])
                print(f"  forecast over realised {name} {q}: {middle:.3f} "
                      f"({low:.2f} to {high:.2f} in 80 %)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ["set", "campaign"]:
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/plan_intervals")
    parser.add_argument("--draws", type=int, default=100)
    parser.add_argument("--size", type=int, default=60)
    parser.add_argument("--soaks", type=int, action="append", default=[])
    parser.add_argument("--first-seed", type=int, default=1001)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--device", type=pathlib.Path, default=NOMINAL)
    parser.add_argument("--range", default="-40:50")
    parser.add_argument("--sweep", type=pathlib.Path,
                        default=SCENARIOS / "soak_sweep_sparse.toml")
    parser.add_argument("--grid", type=float, default=5)
    of = parser.parse_args()
    out = of.out.resolve()
    (out / "sweeps").mkdir(parents=True, exist_ok=True)
    units = Units(out, of)
    rows = [draw(seed, soaks, out, units, of) for soaks in of.soaks or [3]
            for seed in range(of.first_seed, of.first_seed + of.draws)]
    (out / "intervals.json").write_text(json.dumps(rows, indent=1))
    print_table(rows)


if __name__ == "__main__":
    main()
