#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Counts how often the intervals that `beamgyro plan` prints hold.

plan_intervals.py SET CAMPAIGN.toml [--program FILE] [--out DIR] [--draws N]
                  [--size N] [--soaks N]... [--first-seed N] [--keep DIR]
                  [--device DEVICE.toml]

SET is as planning.py wants it. Populations of --size devices of CAMPAIGN, each
of another seed, are learned from the sweeps of
scenarios/soak_sweep_sparse.toml; --keep names a folder of populations that are
there already, SEED.json. Each plans --soaks soaks. What the plan, as many even
soaks and straight lines between these leave of all devices of SET, in the
median and in 95 %, and the quotient of the medians, is what the printed
intervals should hold. Soaks have the bias and quadrature of the check, with the
slow noise of nominal.toml as `plan` takes it; planning.py simulates them whole,
with the lag of the beam, and agrees. Ends with DIR/intervals.json.

Of units that remember SET has a run "checkdown" as well, the same soaks from 50
down to -40 degC: soaks that are reached from above show that one, and what is
left is scored over both.
"""

import argparse
import json
import pathlib
import subprocess
import tomllib

import numpy as np

from planning import (CHAMBER, HOLD, LAST, NOMINAL, RAMP, ROOT, SCENARIOS,
                      Population, quantiles, signals)

RANGE = "-40:50"
START = 25.0
ROUNDS = 4  # of the noise, for each device
NOISE = tomllib.loads(NOMINAL.read_text())["noise"]


def learned(program, campaign, seed, size, out):
    """A population of the sweeps of a few devices."""
    head = campaign.read_text().split("[[run]]")[0]
    lines = [line for line in head.splitlines()
             if not line.startswith(("seed =", "device ="))]
    device = next(line for line in head.splitlines()
                  if line.startswith("device =")).split('"')[1]
    tables = lines.index(next(line for line in lines if line.startswith("[")))
    lines[tables:tables] = [
        f"seed = {seed}", f'device = "{(campaign.parent / device).resolve()}"']
    (out / "sweep.toml").write_text("\n".join(lines) + f"""
[[run]]
name = "sweep"
scenario = "{SCENARIOS}/soak_sweep_sparse.toml"
[output]
variables = ["rate", "temperature", "quadrature", "true_rate"]
""")
    folder, file = out / "sweeps" / str(seed), out / f"{seed}.json"
    for words in [["generate", out / "sweep.toml", "-o", folder, "--devices",
                   str(size)],
                  ["train", folder, "--run", "sweep", "--model",
                   SCENARIOS / "population/population.toml", "-o", file]]:
        subprocess.run([program, *words, "-q"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return file


def planned(program, file, soaks, device, out):
    subprocess.run([program, "plan", file, "--soaks", str(soaks), "--range",
                    RANGE, "--device", device, "--json", out / "plan.json"],
                   check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return json.loads((out / "plan.json").read_text())


def checks_of(folder):
    """Of the way up and, if there is one, of the way down."""
    up = check_of(folder, "check")
    down = [] if not any(folder.glob("checkdown_*.h5")) else [
        [of[..., ::-1] for of in check_of(folder, "checkdown")]]
    return [up, *down]


def check_of(folder, run):
    """Sensor, bias and quadrature at the end of each soak of the check."""
    found = []
    for path in sorted(folder.glob(f"{run}_*.h5")):
        time, columns = signals(path)
        ends = HOLD + np.arange(len(CHAMBER)) * (HOLD + 60 / RAMP)
        found.append([np.stack([of[:, (time > end - LAST) & (time <= end)]
                                .mean(1) for end in ends], 1)
                      for of in columns])
    sensor, bias, quadrature = (np.concatenate(of) for of in zip(*found))
    return sensor.mean(0), bias, quadrature


def noise_of(soaks, hold, ramp, devices, random):
    """Of each soak and device: turn-on, walk since power-on, flicker, white."""
    order = sorted(soaks, reverse=abs(max(soaks) - START) <
                   abs(min(soaks) - START))
    now, before = 0.0, START
    ends = {}
    for soak in order:
        now += abs(soak - before) / ramp * 60 + hold
        ends[soak], before = now, soak
    steps = np.diff([0.0] + [ends[soak] for soak in order])
    walk = np.cumsum(random.standard_normal((devices, len(order))) *
                     np.sqrt(steps), 1)
    walk = walk[:, [order.index(soak) for soak in soaks]]
    own = np.hypot(np.sqrt(2 * np.log(2) / np.pi) *
                   NOISE["bias_instability_deg_per_s"],
                   NOISE["angle_random_walk_deg_per_sqrt_s"] / np.sqrt(300))
    return (NOISE["turn_on_deg_per_s"] * random.standard_normal((devices, 1))
            + NOISE["rate_random_walk_deg_per_s_per_sqrt_s"] * walk
            + own * random.standard_normal((devices, len(soaks))))


def shown_by(soaks, checks):
    """Bias and quadrature of soaks, of the way on which each is reached."""
    order = sorted(soaks, reverse=abs(max(soaks) - START) <
                   abs(min(soaks) - START))
    before = dict(zip(order, [START, *order]))
    of = {soak: checks[-1] if before[soak] > soak else checks[0]
          for soak in soaks}
    return [np.stack([[np.interp(soak, CHAMBER, one)
                       for one in of[soak][curve]] for soak in soaks], 1)
            for curve in (1, 2)]


def realised(file, plan, checks, random):
    """What plan, even soaks and straight lines leave of each device."""
    sensor = checks[0][0]
    size = len(checks[0][1])

    def left_of(curves):
        return np.sqrt(np.mean([((bias - curves) ** 2).mean(1)
                                for _, bias, _ in checks], 0))

    population = Population(file)
    found = {}
    ramp = plan["schedule"]["ramp_K_per_min"]
    for name, of in [("planned", plan["schedule"]), ("even", plan["even"])]:
        soaks = of["temperatures_degC"]
        T = np.interp(soaks, CHAMBER, sensor)
        left, lines = [], []
        for _ in range(ROUNDS):
            shown = shown_by(soaks, checks)
            shown[0] += noise_of(soaks, of["hold_s"], ramp, size, random)
            left.append(left_of(population.adapted(T, shown, sensor)))
            lines.append(left_of(np.stack([np.interp(sensor, T, one)
                                           for one in shown[0]])))
        found[name] = np.concatenate(left)
        if name == "even":
            found["lines"] = np.concatenate(lines)
    return found


def held(interval, value):
    return bool(interval[0] <= value <= interval[1])


def draw(arguments, seed, soaks, out, check):
    kept = arguments.keep and arguments.keep / f"{seed}.json"
    file = kept if kept and kept.exists() else learned(
        arguments.program, arguments.campaign, seed, arguments.size, out)
    plan = planned(arguments.program, file, soaks, arguments.device, out)
    random = np.random.Generator(np.random.Philox(seed))
    left = realised(file, plan, check, random)
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
        for of in ["median", "p95"]:
            row["holds"][f"{name} {of}"] = held(forecast[f"{of}_interval"],
                                                found[of])
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
    arguments = parser.parse_args()
    arguments.out = out = arguments.out.resolve()
    (out / "sweeps").mkdir(parents=True, exist_ok=True)
    check = checks_of(arguments.set)
    rows = [draw(arguments, seed, soaks, out, check)
            for soaks in arguments.soaks or [3]
            for seed in range(arguments.first_seed,
                              arguments.first_seed + arguments.draws)]
    (out / "intervals.json").write_text(json.dumps(rows, indent=1))
    print_table(rows)


if __name__ == "__main__":
    main()
