#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Who belongs to a population, and how well sigma covers bumps between soaks.

foreign_units.py [--program FILE] [--out DIR] [--units N] [--jobs N]

Two classes: the tolerances of campaigns/population.toml with the spurious modes
of campaigns/lifelike_with_modes.toml, and campaigns/trimmed.toml. Of each, sets
of 60 and 1,220 devices without modes make populations from their sweeps. N
further units without and N with modes are calibrated on a ramp of 0.5 K/min, on
seven soaks and on three. Printed: how many are named foreign, also of those with
a spurious bias of 0.02 deg/s or more, peak to peak.

Then, for populations with and without modes: N further units of the same kind
on seven and three soaks; the share of a soak at every kelvin, without noise,
within 90 % intervals, of all and of those 3 K and more from a soak; the mean
square of residual over sigma; medians of what is left and of sigma."""

import argparse
import concurrent.futures
import json
import pathlib
import re
import subprocess

import h5py
import numpy as np
from scipy.interpolate import CubicSpline

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"
HOLD, STEP, LAST = 2700, 3000, 600  # of the check [s], and what is used [s]
SOAKS = {"seven": np.linspace(-40, 50, 7), "calibration": [-36, -12, 36]}
SHOWN = 0.02  # [deg/s]
RAMP = """name = "slow_ramp"
device = "{device}"
fidelity = "quasistatic"
duration_s = {duration}
output_rate_Hz = 0.1
seed = 777
[ambient.soaks]
temperatures_degC = [{low}, 50]
hold_s = 3600
ramp_K_per_min = 0.5
[chamber]
stirred = true
"""
MODEL = """kind = "adapted"
population = "{population}"
[rows]
seconds = 60
"""
# A steady ramp has another lag than soaks.
ROWS = {"slow_ramp": "lag_min = 2.5\n",
        "seven": "lag_min = 8.1\nsteady_K_per_min = 0.2\n",
        "calibration": "lag_min = 8.1\nsteady_K_per_min = 0.2\n"}


def values(file, name):
    data = file[name]
    return data[()] * data.attrs.get("scale_factor", 1.0) \
        + data.attrs.get("add_offset", 0.0)


class Study:
    def __init__(self, arguments):
        self.program = arguments.program.resolve()
        self.out = arguments.out.resolve()
        self.units, self.jobs = arguments.units, arguments.jobs
        self.out.mkdir(parents=True, exist_ok=True)

    def call(self, *words):
        answer = subprocess.run([self.program, *map(str, words)],
                                capture_output=True, text=True, check=False)
        if answer.returncode:
            raise SystemExit(answer.stderr)

    def scenario(self, kind, run):
        if run != "slow_ramp":
            names = {"sweep": "soak_sweep_sparse", "seven": "seven_soaks",
                     "calibration": "three_soaks",
                     "check": "soak_every_kelvin"}
            return SCENARIOS / f"{names[run]}.toml"
        low = -20 if kind == "trimmed" else -40
        file = self.out / f"slow_ramp_{kind}.toml"
        file.write_text(RAMP.format(
            device=SCENARIOS / "devices/nominal.toml", low=low,
            duration=7200 + (50 - low) * 120))
        return file

    def campaign(self, kind, with_modes, runs, seed):
        text = (SCENARIOS / f"campaigns/{kind}.toml").read_text()
        modes = (text if kind == "trimmed" else
                 (SCENARIOS / "campaigns/lifelike_with_modes.toml").read_text())
        modes = re.search(r"\[spurious_modes\].*?\n\n", modes, re.S).group(0)
        head = re.sub(r"\[spurious_modes\].*", "", text.split("[[run]]")[0],
                      flags=re.S)
        head = re.sub(r"\nseed = \d+", f"\nseed = {seed}", head).replace(
            '"../', f'"{SCENARIOS}/')
        for run in runs:
            modes += (f'[[run]]\nname = "{run}"\nscenario = '
                      f'"{self.scenario(kind, run)}"\n\n')
        if not with_modes:
            modes = modes[modes.index("[[run]]"):]
        variables = ["rate", "temperature", "quadrature", "true_rate"]
        variables += ["true_spurious_bias"] * with_modes
        return f"{head}{modes}[output]\nvariables = {json.dumps(variables)}\n"

    def set(self, name, kind, with_modes, runs, seed, devices):
        folder = self.out / name
        if not (folder / "manifest.jsonl").exists():
            file = self.out / f"{name}.toml"
            file.write_text(self.campaign(kind, with_modes, runs, seed))
            self.call("generate", file, "-o", folder, "--devices", devices,
                      "--jobs", self.jobs)
        return folder

    def population(self, kind, with_modes, devices):
        name = f"{kind}{'_modes' * with_modes}_{devices}"
        folder = self.set(f"set_{name}", kind, with_modes, ["sweep"],
                          30 + with_modes, devices)
        file = self.out / f"{name}.json"
        if not file.exists():
            self.call("train", folder, "--run", "sweep", "--model",
                      SCENARIOS / "population/population.toml", "-o", file)
        return file

    def further(self, kind, with_modes):
        runs = ["seven", "slow_ramp", "calibration", "check"]
        return self.set(f"units_{kind}{'_modes' * with_modes}", kind,
                        with_modes, runs, 9001 + with_modes, self.units)

    def adapted(self, folder, run, population):
        """The compensator of each unit."""
        model = self.out / f"adapted_{population.stem}_{run}.toml"
        model.write_text(MODEL.format(population=population) + ROWS[run])

        def one(device):
            file = self.out / f"{folder.name}_{run}_{device}.json"
            self.call("train", folder, "--run", run, "--device", device,
                      "--model", model, "-o", file)
            text = file.read_text()
            file.unlink()
            return json.loads(text)
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(one, range(self.units)))


def checks(folder):
    """Temperature, bias and spurious bias of each unit at every kelvin."""
    found = []
    for path in sorted(folder.glob("check_*.h5")):
        with h5py.File(path) as file:
            time = file["time"][()]
            of = [values(file, "temperature"),
                  values(file, "rate") - values(file, "true_rate"),
                  values(file, "true_spurious_bias" if "true_spurious_bias"
                         in file else "true_rate")]
        ends = HOLD + np.arange(91) * STEP
        parts = [(time > end - LAST) & (time <= end) for end in ends]
        of = [np.stack([one[:, part].mean(1) for part in parts], 1)
              for one in of]
        found += list(zip(*of))
    return found


def is_foreign(compensator):
    return any("foreign to its population" in warning
               for warning in compensator["training"]["warnings"])


def print_foreign(study, kind):
    low = -15 if kind == "trimmed" else -35
    modes = np.array([np.ptp(spurious[T >= low]) for T, _, spurious in
                      checks(study.further(kind, True))])
    for devices in [60, 1220]:
        population = study.population(kind, False, devices)
        for run in ROWS:
            own, foreign = (np.array([is_foreign(c) for c in study.adapted(
                study.further(kind, with_modes), run, population)])
                for with_modes in [False, True])
            print(f"{kind:11}{devices:5} devices, {run:12} named foreign: "
                  f"{100 * own.mean():5.1f} % of its own, "
                  f"{100 * foreign.mean():5.1f} % with modes, "
                  f"{100 * foreign[modes > SHOWN].mean():5.1f} % of those "
                  f"above {SHOWN} deg/s", flush=True)


def print_coverage(study, kind, with_modes):
    low = -15 if kind == "trimmed" else -35
    folder = study.further(kind, with_modes)
    truth = checks(folder)
    for devices in [60, 1220]:
        population = study.population(kind, with_modes, devices)
        for run, soaks in SOAKS.items():
            rows = []
            for c, (T, bias, _) in zip(study.adapted(folder, run, population),
                                       truth):
                first, last = c["temperature_range_degC"]
                own = (T >= max(low, first)) & (T <= last)
                curve = CubicSpline(c["parameters"]["knots_degC"],
                                    c["parameters"]["values_deg_per_s"])
                sigma = c["sigma"]["factor"] * np.interp(
                    T, c["sigma"]["temperature_degC"],
                    c["sigma"]["sigma_deg_per_s"])
                error = bias - curve(T)
                z = abs(error / sigma)
                # The electronics heat the sensor by 5 K.
                far = own & (abs(T[:, None] - np.array(soaks) - 5).min(1) > 3)
                rows.append([np.mean(z[own] < 1.645), np.mean(z[far] < 1.645),
                             np.mean(z[own] ** 2), np.mean(z[far] ** 2),
                             np.sqrt(np.mean(error[own] ** 2)),
                             np.sqrt(np.mean(sigma[own] ** 2))])
            rows = np.array(rows)
            within, squares = 100 * rows[:, :2].mean(0), rows[:, 2:4].mean(0)
            left = np.median(rows[:, 4:], axis=0)
            print(f"{kind:11}{'with modes ' * with_modes}{devices:5} devices, "
                  f"{run:12} within 90 %: {within[0]:5.1f} all, "
                  f"{within[1]:5.1f} between; z^2 {squares[0]:.2f}, "
                  f"{squares[1]:.2f}; left {left[0]:.4f}, sigma "
                  f"{left[1]:.4f} deg/s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", type=pathlib.Path,
                        default=ROOT / "build/release/beamgyro")
    parser.add_argument("--out", type=pathlib.Path,
                        default=ROOT / "out/foreign_units")
    parser.add_argument("--units", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=2)
    study = Study(parser.parse_args())
    for kind in ["population", "trimmed"]:
        print_foreign(study, kind)
    for kind in ["population", "trimmed"]:
        for with_modes in [False, True]:
            print_coverage(study, kind, with_modes)


if __name__ == "__main__":
    main()
