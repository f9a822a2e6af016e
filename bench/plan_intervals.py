#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Counts how often the intervals that `beamgyro plan` prints hold.

plan_intervals.py SET CAMPAIGN.toml [--program FILE] [--out DIR] [--draws N]
                  [--size N] [--soaks N]... [--devices N] [--first-seed N]
                  [--keep DIR]

SET is as planning.py wants it. Populations of --size devices of CAMPAIGN, each
of another seed, are learned from the sweeps of
scenarios/soak_sweep_sparse.toml; --keep names a folder of populations that are
there already, SEED.json. Each plans --soaks soaks. The first --devices devices
of SET go through these and through as many even ones with all noise and are
adapted, or have straight lines. What they leave in the median and in 95 %, and
the quotient of the medians, is what the printed intervals should hold. Ends
with DIR/intervals.json.
"""

import argparse
import json
import pathlib
import subprocess

import numpy as np

from planning import (CHAMBER, RAMP, ROOT, SCENARIOS, Population, generate,
                      points, quantiles, truth)

RANGE = "-40:50"


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


def planned(program, file, soaks, out):
    subprocess.run([program, "plan", file, "--soaks", str(soaks), "--range",
                    RANGE, "--json", out / "plan.json"], check=True,
                   stdout=subprocess.DEVNULL)
    plan = json.loads((out / "plan.json").read_text())
    return plan, [{**row, "ramp_K_per_min": plan["schedule"]["ramp_K_per_min"]}
                  for row in ({"hold_s": plan["schedule"]["hold_s"],
                               **plan["schedule"]}, plan["even"])]


def lines_left(rows, sensor, bias):
    rows = rows[np.argsort(rows[:, 0])]
    return np.sqrt(np.mean((bias - np.interp(sensor, rows[:, 0],
                                             rows[:, 1])) ** 2))


def realised(file, folder, schedules, check):
    """What plan, even soaks and straight lines leave of each device."""
    population = Population(file)
    limits = population.grid[[0, -1]]
    sensor, bias = check
    left = {"planned": [], "even": [], "lines": []}
    for run, name in enumerate(["planned", "even"]):
        for device, rows in enumerate(points(folder, f"soaks_{run}", limits)):
            one = sensor[device], bias[device]
            left[name].append(population.left(rows, *one, True))
            if name == "even":
                left["lines"].append(lines_left(rows, *one))
    return {name: np.array(of) for name, of in left.items()}


def held(interval, value):
    return bool(interval[0] <= value <= interval[1])


def draw(arguments, seed, soaks, out, check):
    kept = arguments.keep and arguments.keep / f"{seed}.json"
    file = kept if kept and kept.exists() else learned(
        arguments.program, arguments.campaign, seed, arguments.size, out)
    plan, schedules = planned(arguments.program, file, soaks, out)
    generate(arguments.program, arguments.campaign, schedules, out,
             arguments.devices, 1)
    left = realised(file, out / "soaks", schedules, check)
    subprocess.run(["rm", "-r", out / "soaks"], check=True)
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
    parser.add_argument("--devices", type=int, default=300)
    parser.add_argument("--first-seed", type=int, default=1001)
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.out = out = arguments.out.resolve()
    (out / "sweeps").mkdir(parents=True, exist_ok=True)
    check = truth(arguments.set)
    rows = [draw(arguments, seed, soaks, out, check)
            for soaks in arguments.soaks or [3]
            for seed in range(arguments.first_seed,
                              arguments.first_seed + arguments.draws)]
    (out / "intervals.json").write_text(json.dumps(rows, indent=1))
    print_table(rows)


if __name__ == "__main__":
    main()
