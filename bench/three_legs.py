#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Three legs of a chamber at 3 K/min: two train, the third is scored.

three_legs.py [--program FILE] [--out DIR] [--units N] [--trims LOW HIGH]
              [--seed N] [--jobs N] [MODEL.toml ...]

Draws units of lifelike_with_modes.toml and makes them as small as a MEMS: heat
capacities are a quarter to a fiftieth of the nominal ones, and what makes the
drift (mount angle, offsets of patches, electronics, heights of modes) is a
share of what was drawn, from LOW to HIGH. Memory and noise stay, so that legs
of a unit differ by about as much as the drift. Each unit goes up and down and
up again (or down first) over 30 to 90 K in one recording. A leg of it is a
recording as one cuts it out of a log.

Every model file (auto.toml and auto_recommended.toml without) is trained on two
of the legs and scored on the third, for each of the three. Printed is what it
leaves over what the better of a constant and the cubic of the same two legs
leaves, known only in hindsight: geometric mean, 95 % and the worst of all. Of
models that state a sigma it is also the share of means of a minute within the
interval of 90 % and the mean square of residual over sigma, within the
temperatures of the two legs: apart where these go both ways, and where they go
one way and the third goes the other.
DIR/table.json has every figure; DIR is out/three_legs, whose recordings are
made once.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tomllib

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"
CAMPAIGN = SCENARIOS / "campaigns/lifelike_with_modes.toml"
UNPOWERED = 1  # of `status`
LEGS = 3
RAMP = 3.0  # [K/min]
BLOCK = 60  # samples at 1 Hz, of a scored mean
NORMAL_90 = 1.645  # half-width of the interval of 90 % [sigma]
CAPACITIES = ["beam", "pzt", "mount", "housing", "board", "sensor"]
BASE = {"beam": 1.46, "pzt": 0.08, "mount": 1.8, "housing": 42, "board": 6,
        "sensor": 0.25}  # [J/K], of lifelike.toml
TRIMMED = [("mount", "axis_angle_deg"), ("patches", "offset_m"),
           ("readout", "quadrature_trim_deg_per_s"),
           ("readout", "phase_tc_rad_per_K"), ("readout", "feedthrough_F"),
           ("readout", "offset_tc_deg_per_s_per_K")]
YARDSTICKS = {"constant": 'kind = "constant"\n',
              "cubic": 'kind = "polynomial"\n'}

SCENARIO = """\
name = "legs"
device = "{device}"
fidelity = "quasistatic"
duration_s = {duration:.0f}
output_rate_Hz = 1
seed = {seed}

[ambient]
points = [{points}]

[chamber]
stirred = true
"""


def course(random):
    """Turning points (time [s], temperature [degC]) of a chamber's ramps."""
    span = np.exp(random.uniform(np.log(30), np.log(90)))  # [K]
    low = random.uniform(-40, 50 - span)
    way = [low, low + span] * 2 if random.random() < 0.5 else [
        low + span, low] * 2
    return [(60 * k * span / RAMP, T) for k, T in enumerate(way)]


class Study:
    def __init__(self, arguments):
        self.program = arguments.program.resolve()
        self.out = arguments.out.resolve()
        self.units, self.seed = arguments.units, arguments.seed
        self.trims = np.log(arguments.trims)
        self.jobs = arguments.jobs
        self.models = {
            path.stem: path.read_text() for path in
            arguments.models or [SCENARIOS / "models/auto.toml",
                                 SCENARIOS / "models/auto_recommended.toml"]}
        self.models = {**YARDSTICKS, **self.models}
        self.out.mkdir(parents=True, exist_ok=True)
        for name, text in self.models.items():
            (self.out / f"{name}.toml").write_text(text)

    def beamgyro(self, *arguments):
        answer = subprocess.run([str(self.program), *map(str, arguments)],
                                capture_output=True, text=True, check=False)
        if answer.returncode:
            raise RuntimeError(f"{' '.join(map(str, arguments))}: "
                               f"{answer.stderr}")
        return answer.stdout

    def draw(self):
        """The keys of every unit, as a set of the campaign has them."""
        if not (self.out / "set").exists():
            text = CAMPAIGN.read_text().split("[[run]]")[0]
            device = SCENARIOS / "devices/lifelike.toml"
            text = text.replace("../devices/lifelike.toml", str(device))
            (self.out / "campaign.toml").write_text(
                text + '[[run]]\nname = "moment"\nscenario = "moment.toml"\n')
            (self.out / "moment.toml").write_text(SCENARIO.format(
                device=device, duration=2, seed=1, points="[0, 25]"))
            self.beamgyro("generate", self.out / "campaign.toml", "--devices",
                          self.units, "-o", self.out / "set", "--jobs",
                          self.jobs)

    def simulate(self, unit):
        """Makes the recordings unit_K_leg_L.h5, which hold one leg each."""
        whole = self.out / f"unit_{unit}.h5"
        if whole.exists():
            return
        random = np.random.Generator(np.random.Philox(key=[self.seed, unit]))
        points = course(random)
        smaller = np.exp(-random.uniform(np.log(4), np.log(50)))
        share = np.exp(random.uniform(*self.trims))
        size = [part for name in CAPACITIES for part in (
            "--set", f"thermal.{name}_heat_capacity_J_per_K="
            f"{BASE[name] * smaller:.6g}")]
        scenario = self.out / f"unit_{unit}.toml"
        scenario.write_text(SCENARIO.format(
            device=SCENARIOS / "devices/lifelike.toml", seed=self.seed + unit,
            duration=points[-1][0],
            points=", ".join(f"[{t:.0f}, {T:.4f}]" for t, T in points)))
        drawn = self.beamgyro("info", self.out / "set", "--device", unit)
        part = whole.with_suffix(".part.h5")
        self.beamgyro("run", scenario, "-o", part, *settings_in(drawn, share),
                      *size)
        ends = [points[-1][0] * k / LEGS for k in range(LEGS + 1)]
        for leg, (begin, end) in enumerate(zip(ends, ends[1:])):
            file = self.leg(unit, leg)
            shutil.copy(part, file)
            with h5py.File(file, "r+") as recording:
                time = recording["time"][()]
                status = recording["status"][()]
                status[(time < begin) | (time >= end)] |= UNPOWERED
                recording["status"][...] = status
        part.rename(whole)

    def leg(self, unit, leg):
        return self.out / f"unit_{unit}_leg_{leg}.h5"

    def left(self, unit, leg, model):
        """Rms left of a leg by a model of the others [deg/s]; its method."""
        file = self.out / f"{model}_{unit}_{leg}.json"
        answer = self.out / f"{model}_{unit}_{leg}.h5"
        answer.unlink(missing_ok=True)
        others = [self.leg(unit, k) for k in range(LEGS) if k != leg]
        self.beamgyro("train", *others, "--model", self.out / f"{model}.toml",
                      "-o", file)
        self.beamgyro("compensate", file, self.leg(unit, leg), "-o", answer)
        with h5py.File(answer) as run:
            error = run["compensated_rate"][()] - run["true_rate"][()]
            powered = np.isfinite(error)
            error = means(error[powered])
            T = means(run["temperature"][()][powered])
            sigma = (means(run["compensated_rate_sigma"][()][powered])
                     if "compensated_rate_sigma" in run else None)
        stored = json.loads(file.read_text())
        answer.unlink()
        return (float(np.sqrt(np.mean(error**2))),
                stored["training"]["method"],
                normalised(error, sigma, T, stored["temperature_range_degC"]))

    def score(self, unit):
        self.simulate(unit)
        return [{"unit": unit, "leg": leg,
                 **{model: self.left(unit, leg, model)
                    for model in self.models}} for leg in range(LEGS)]

    def run(self):
        self.draw()
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            cases = [case for cases in pool.map(self.score, range(self.units))
                     for case in cases]
        (self.out / "table.json").write_text(json.dumps(cases, indent=1) + "\n")
        return table(cases, self.models)


def means(samples):
    """Of blocks of a minute."""
    return samples[:len(samples) // BLOCK * BLOCK].reshape(
        -1, BLOCK).mean(axis=1)


def normalised(error, sigma, T, temperatures):
    """Share within the interval of 90 %, mean square of residual over sigma."""
    if sigma is None:
        return None
    own = (T >= temperatures[0]) & (T <= temperatures[1])
    z = error[own] / sigma[own]
    return [float(np.mean(abs(z) <= NORMAL_90)), float(np.mean(z**2))]


def settings_in(text, share):
    """The values that `info SET --device K` prints, with trims of a share."""
    drawn = tomllib.loads("\n".join(
        line for line in text.splitlines() if "=" in line))
    for table, key in TRIMMED:
        value = drawn[table][key]
        drawn[table][key] = ([share * x for x in value]
                             if isinstance(value, list) else share * value)
    for mode in drawn.get("spurious_mode", {}).values():
        for key in ["coupling_drive", "coupling_sense"]:
            mode[key] *= share**0.5
    return settings(drawn)


def settings(values, prefix=""):
    """Nested tables as arguments --set KEY=VALUE."""
    result = []
    for key, value in values.items():
        if isinstance(value, dict):
            result += settings(value, f"{prefix}{key}.")
        else:
            result += ["--set", f"{prefix}{key}={value}"]
    return result


def table(cases, models):
    best = np.array([min(case[name][0] for name in YARDSTICKS)
                     for case in cases])
    lines = [f"{len(cases)} third legs; over the better of constant and cubic "
             f"({np.median(best):.3f} deg/s, median)",
             f"{'model':20}{'mean':>8}{'95 %':>8}{'worst':>8}  chosen"]
    for model in models:
        ratio = np.array([case[model][0] for case in cases]) / best
        chosen = collections.Counter(
            case[model][1].split(" of weight")[0] + (
                " averaged" if " of weight" in case[model][1] else "")
            for case in cases)
        lines.append(
            f"{model:20}{np.exp(np.mean(np.log(ratio))):8.3f}"
            f"{np.percentile(ratio, 95):8.2f}{ratio.max():8.2f}  "
            + ", ".join(f"{name} {n}" for name, n in chosen.most_common()))
    for model in models:
        for ways, legs in [("both ways", (0, 2)), ("one way", (1,))]:
            found = np.array([case[model][2] for case in cases
                              if case["leg"] in legs and case[model][2]])
            if len(found):
                lines.append(
                    f"{model:20}sigma of legs that go {ways}: 90 % holds "
                    f"{100 * found[:, 0].mean():.1f} % of {len(found)}, z^2 "
                    f"{found[:, 1].mean():.2f}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/three_legs")
    parser.add_argument("--units", type=int, default=60)
    parser.add_argument("--trims", type=float, nargs=2, default=[1 / 300, 0.1],
                        metavar=("LOW", "HIGH"))
    parser.add_argument("--seed", type=int, default=3000)
    parser.add_argument("--jobs", type=int,
                        default=len(os.sched_getaffinity(0)))
    parser.add_argument("models", nargs="*", type=pathlib.Path)
    print(Study(parser.parse_args()).run())


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError) as error:
        sys.exit(f"three_legs: {error}")
