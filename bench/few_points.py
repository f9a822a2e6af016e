#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Calibration of a new device from three soaks and a population.

few_points.py [--program FILE] [--out DIR] [--devices N] [--scored N]
              [--jobs N]

Generates scenarios/campaigns/population.toml (its first --devices devices) as
DIR/set, unless a whole set is there. The training devices' sweeps make the
population; the first --scored test devices are new. Scored are soaks at every
kelvin without noise. Prints rms residuals and writes them to DIR/table.json;
DIR is out/few_points.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"
CAMPAIGN = SCENARIOS / "campaigns/population.toml"
MODELS = SCENARIOS / "population"
STEADY = "\n[rows]\nsteady_K_per_min = 0.05\n"
CUBIC = 'kind = "polynomial"\n' + STEADY
BIAS_ONLY = 'inputs = ["temperature"]\n'
TRAIN, TEST = 0, 2  # of the variable part


class Study:
    def __init__(self, arguments):
        self.program = arguments.program.resolve()
        self.out = arguments.out.resolve()
        self.devices, self.scored = arguments.devices, arguments.scored
        self.jobs = arguments.jobs
        self.set = self.out / "set"
        self.out.mkdir(parents=True, exist_ok=True)

    def beamgyro(self, *arguments, allowed=(0,)):
        answer = subprocess.run([str(self.program), *map(str, arguments)],
                                capture_output=True, text=True, check=False)
        if answer.returncode not in allowed:
            raise RuntimeError(f"{' '.join(map(str, arguments))}: "
                               f"{answer.stderr}")

    def generate(self):
        fewer = ["--devices", self.devices] if self.devices else []
        self.beamgyro("generate", CAMPAIGN, *fewer, "-o", self.set, "--resume",
                      "--jobs", self.jobs)

    def devices_of(self, part):
        """Numbers of the devices of a part that could be simulated."""
        with h5py.File(self.set / "sweep.nc") as view:
            ready = ((view["part"][:] == part)
                     & (view["device_status"][:] == 0))
        return [int(device) for device in np.flatnonzero(ready)]

    def population(self):
        """Trains the mean and what is common of the training devices."""
        self.beamgyro("train", self.set, "--run", "sweep", "--model",
                      MODELS / "population.toml", "-o",
                      self.out / "population.json")
        adapted = (MODELS / "adapted.toml").read_text()
        (self.out / "adapted.toml").write_text(adapted)
        (self.out / "bias_only.toml").write_text(BIAS_ONLY + adapted)
        (self.out / "cubic.toml").write_text(CUBIC)

    def score(self, device):
        """Rms residual of each method over the check [deg/s]."""
        result = {}
        for method, points, run in [("adapted", 3, "calibration"),
                                    ("bias_only", 3, "calibration"),
                                    ("adapted", 7, "seven"),
                                    ("cubic", 7, "seven"),
                                    ("population", 0, None)]:
            file = self.out / f"{method}_{points}_{device}.json"
            if run is None:
                file = self.out / "population.json"
            else:
                self.beamgyro("train", self.set, "--run", run, "--device",
                              device, "--model", self.out / f"{method}.toml",
                              "-o", file)
            scores = self.out / f"scores_{device}.json"
            self.beamgyro("validate", file, self.set, "--run", "check",
                          "--device", device, "--json", scores, allowed=(0, 3))
            (own,) = json.loads(scores.read_text())["devices"]
            result[f"{method}, {points} soaks"] = own["residual_rms_deg_per_s"]
            result["raw"] = own["raw_rms_deg_per_s"]
            if run is not None:
                file.unlink()
        scores.unlink()
        return result

    def run(self):
        self.generate()
        training = len(self.devices_of(TRAIN))
        new = self.devices_of(TEST)[:self.scored]
        if not new:
            raise RuntimeError("no test device in the set; more --devices?")
        self.population()
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            scores = list(pool.map(self.score, new))
        table = {}
        for method in scores[0]:
            rms = np.array([score[method] for score in scores])
            table[method] = {"best": rms.min(), "median": np.median(rms),
                             "worst": rms.max()}
        (self.out / "table.json").write_text(json.dumps(
            {"devices": new, "training": training, "rms_deg_per_s": table,
             "of_devices": scores}, indent=1) + "\n")
        lines = [f"{len(new)} new devices, a population of {training}; "
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
    parser.add_argument("--devices", type=int)
    parser.add_argument("--scored", type=int, default=40)
    parser.add_argument("--jobs", type=int,
                        default=len(os.sched_getaffinity(0)))
    print(Study(parser.parse_args()).run())


if __name__ == "__main__":
    try:
        main()
    except (RuntimeError, OSError) as error:
        sys.exit(f"few_points: {error}")
