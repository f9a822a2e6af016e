#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Calibration of a new device from three soaks and a population.

few_points.py [--program FILE] [--out DIR] [--training N] [--devices N]
              [--jobs N]

Devices 0, 1, ... of bench/population.py's tolerances are new, the next N make
the population; noise is on in all but the scored runs, which soak every kelvin
from -40 to 50 degC. Prints rms residuals and writes them to DIR/table.json;
DIR is out/few_points.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench"))
from population import draw, overrides, with_arguments  # noqa: E402

SCENARIOS = ROOT / "scenarios"
SWEEP = SCENARIOS / "soak_sweep_train.toml"
MODELS = SCENARIOS / "population"
HOLD = 2700  # [s]
STEADY = "\n[rows]\nsteady_K_per_min = 0.05\n"
CUBIC = 'kind = "polynomial"\n' + STEADY
BIAS_ONLY = 'inputs = ["temperature"]\n'
THREE = [-36, -12, 36]
SEVEN = [-40, -25, -10, 5, 20, 35, 50]
DENSE = list(range(-40, 51))


def soaks(temperatures):
    """Settings of a sweep over these temperatures."""
    ramps = sum(abs(b - a) for a, b in zip(temperatures, temperatures[1:]))
    return [f"ambient.soaks.temperatures_degC={temperatures}",
            f"duration_s={HOLD * len(temperatures) + 300 * ramps}"]


class Study:
    def __init__(self, arguments):
        self.program = arguments.program.resolve()
        self.out = arguments.out.resolve()
        self.new, self.training = arguments.devices, arguments.training
        self.jobs = arguments.jobs
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir(parents=True)

    def beamgyro(self, *arguments, allowed=(0,)):
        answer = subprocess.run([str(self.program), *map(str, arguments)],
                                capture_output=True, text=True, check=False)
        if answer.returncode not in allowed:
            raise RuntimeError(f"{' '.join(map(str, arguments))}: "
                               f"{answer.stderr}")

    def simulate(self, name, device, seed, settings):
        file = self.out / f"{name}_{device}.h5"
        self.beamgyro("run", SWEEP, "--seed", seed + 10 * device,
                      *with_arguments([*overrides(draw(device)), *settings,
                                       "output_rate_Hz=0.2"]), "-o", file)
        return file

    def all(self, work, items):
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(work, items))

    def population(self):
        """Trains the mean and what is common of the training devices."""
        runs = self.all(lambda k: self.simulate("sweep", k, 1, []),
                        range(self.new, self.new + self.training))
        self.beamgyro("train", *runs, "--model", MODELS / "population.toml",
                      "-o", self.out / "population.json")
        for run in runs:
            run.unlink()
        adapted = (MODELS / "adapted.toml").read_text()
        (self.out / "adapted.toml").write_text(adapted)
        (self.out / "bias_only.toml").write_text(BIAS_ONLY + adapted)
        (self.out / "cubic.toml").write_text(CUBIC)

    def score(self, device):
        """Rms residual of each method over the dense soaks [deg/s]."""
        runs = {"3": self.simulate("three", device, 2, soaks(THREE)),
                "7": self.simulate("seven", device, 3, soaks(SEVEN))}
        test = self.simulate("dense", device, 4,
                             [*soaks(DENSE), "noise.enabled=false"])
        result = {}
        for method, points in [("adapted", "3"), ("bias_only", "3"),
                               ("adapted", "7"), ("cubic", "7"),
                               ("population", "0")]:
            file = self.out / f"{method}_{points}_{device}.json"
            if method == "population":
                file = self.out / "population.json"
            else:
                self.beamgyro("train", runs[points], "--model",
                              self.out / f"{method}.toml", "-o", file)
            scores = self.out / f"scores_{device}.json"
            self.beamgyro("validate", file, test, "--json", scores,
                          allowed=(0, 3))
            overall = json.loads(scores.read_text())["overall"]
            result[f"{method}, {points} soaks"] = \
                overall["residual"]["rms_deg_per_s"]
        for run in [*runs.values(), test]:
            run.unlink()
        return result

    def run(self):
        self.population()
        scores = self.all(self.score, range(self.new))
        table = {}
        for method in scores[0]:
            rms = np.array([score[method] for score in scores])
            table[method] = {"best": rms.min(), "median": np.median(rms),
                             "worst": rms.max()}
        (self.out / "table.json").write_text(json.dumps(
            {"devices": self.new, "training": self.training,
             "rms_deg_per_s": table, "of_devices": scores}, indent=1) + "\n")
        lines = [f"{self.new} new devices, a population of {self.training}; "
                 "rms [deg/s]",
                 f"{'':24}{'best':>10}{'median':>10}{'worst':>10}"]
        lines += [f"{method:24}{row['best']:10.4f}{row['median']:10.4f}"
                  f"{row['worst']:10.4f}" for method, row in table.items()]
        return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/few_points")
    parser.add_argument("--training", type=int, default=200)
    parser.add_argument("--devices", type=int, default=40)
    parser.add_argument("--jobs", type=int,
                        default=len(os.sched_getaffinity(0)))
    print(Study(parser.parse_args()).run())


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError) as error:
        sys.exit(f"few_points: {error}")
