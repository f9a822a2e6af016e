#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Calibration of a new device from three soaks and a population.

few_points.py [--program FILE] [--out DIR] [--campaign FILE] [--devices N]
              [--scored N] [--jobs N]

Generates the campaign (population.toml, its first --devices devices) as
DIR/set, unless a whole set is there. The training devices' sweeps make the
population; the first --scored test devices are new. Scored are soaks at every
kelvin without noise and, where the campaign has them (lifelike_population.toml),
sweeps after a year with noise. Prints rms residuals and writes them to
DIR/table.json; DIR is out/few_points.
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
MODELS = SCENARIOS / "population"
STEADY = "\n[rows]\nsteady_K_per_min = 0.05\n"
CUBIC = 'kind = "polynomial"\n' + STEADY
BIAS_ONLY = 'inputs = ["temperature"]\n'
TRAIN, TEST = 0, 2  # of the variable part
# label, name of the compensator, run it is trained on (none: the population's
# mean). A year later: on which soaks, by whose population.
NEW = [("adapted, 3 soaks", "adapted", "calibration"),
       ("bias_only, 3 soaks", "bias_only", "calibration"),
       ("adapted, 7 soaks", "adapted", "seven"),
       ("cubic, 7 soaks", "cubic", "seven"),
       ("population, 0 soaks", "population", None)]
AFTER_A_YEAR = [
    ("as calibrated when new: adapted, 3 soaks", "adapted", "calibration"),
    ("as calibrated when new: cubic, 7 soaks", "cubic", "seven"),
    ("3 soaks again, population of new devices", "adapted",
     "calibration_after_a_year"),
    ("3 soaks again, population a year old", "adapted_aged",
     "calibration_after_a_year")]


class Study:
    def __init__(self, arguments):
        self.program = arguments.program.resolve()
        self.out = arguments.out.resolve()
        self.devices, self.scored = arguments.devices, arguments.scored
        self.jobs = arguments.jobs
        self.campaign = arguments.campaign
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
        self.beamgyro("generate", self.campaign, *fewer, "-o", self.set,
                      "--resume", "--jobs", self.jobs)

    def devices_of(self, part):
        """Numbers of the devices of a part that could be simulated."""
        with h5py.File(self.set / "sweep.nc") as view:
            ready = ((view["part"][:] == part)
                     & (view["device_status"][:] == 0))
        return [int(device) for device in np.flatnonzero(ready)]

    def population(self, run, name):
        """Trains the mean and what is common of the training devices."""
        self.beamgyro("train", self.set, "--run", run, "--model",
                      MODELS / "population.toml", "-o", self.out / name)

    def populations(self):
        self.population("sweep", "population.json")
        if self.aged:
            self.population("sweep_after_a_year", "population_aged.json")
        adapted = (MODELS / "adapted.toml").read_text()
        for name, text in [
                ("adapted", adapted),
                ("adapted_aged", adapted.replace("population.json",
                                                 "population_aged.json")),
                ("bias_only", BIAS_ONLY + adapted), ("cubic", CUBIC)]:
            (self.out / f"{name}.toml").write_text(text)

    def score(self, device):
        """Rms residual of each method [deg/s], by what is scored."""
        scored = {"check": self.residuals(device, "check", NEW)}
        if self.aged:
            scored["sweep_after_a_year"] = self.residuals(
                device, "sweep_after_a_year", AFTER_A_YEAR)
        return scored

    def residuals(self, device, scored, cases):
        result = {}
        for label, method, run in cases:
            file = self.out / f"{method}_{run}_{device}.json"
            if run is None:
                file = self.out / "population.json"
            else:
                self.beamgyro("train", self.set, "--run", run, "--device",
                              device, "--model", self.out / f"{method}.toml",
                              "-o", file)
            scores = self.out / f"scores_{device}.json"
            self.beamgyro("validate", file, self.set, "--run", scored,
                          "--device", device, "--json", scores, allowed=(0, 3))
            (run_of_device,) = json.loads(scores.read_text())["runs"]
            rms = run_of_device["rms_deg_per_s"]
            result[label], result["raw"] = rms["after"], rms["before"]
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
        self.aged = (self.set / "sweep_after_a_year.nc").exists()
        self.populations()
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            scores = list(pool.map(self.score, new))
        tables = {
            scored: {label: self.spread([score[scored][label]
                                         for score in scores])
                     for label in methods}
            for scored, methods in scores[0].items()}
        (self.out / "table.json").write_text(json.dumps(
            {"devices": new, "training": training, "rms_deg_per_s": tables,
             "of_devices": scores}, indent=1) + "\n")
        lines = [f"{len(new)} new devices, a population of {training}; "
                 "rms [deg/s]"]
        for scored, table in tables.items():
            lines += ["", f"{scored:42}{'best':>10}{'median':>10}"
                      f"{'worst':>10}"]
            lines += [f"{label:42}{row['best']:10.4f}{row['median']:10.4f}"
                      f"{row['worst']:10.4f}" for label, row in table.items()]
        return "\n".join(lines)

    @staticmethod
    def spread(rms):
        return {"best": min(rms), "median": float(np.median(rms)),
                "worst": max(rms)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/few_points")
    parser.add_argument("--campaign", type=pathlib.Path,
                        default=SCENARIOS / "campaigns/population.toml")
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
