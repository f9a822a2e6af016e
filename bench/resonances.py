# SPDX-License-Identifier: MIT
"""Seven soaks and the ramps between them, of virtual gyros with spurious
modes: what each method leaves on the steady curve and on unseen ramps.

resonances.py UNITS [--networks] [--campaign FILE] [--first K]

Units are drawn as below, or they are those of a campaign. Training: seven soaks
of an hour from -25 to 45 degC, ramps of 0.5 K/min. Tests: a ramp of 0.03 K/min,
ramps of 1 K/min up and down, and, without noise, ramps of 2 K/min in still air.
BEAMGYRO names the program, BEAMGYRO_SIMULATOR another one for the runs. One
line a unit, then medians and 95 %."""

import argparse
import json
import os
import subprocess
import tempfile
import tomllib
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = os.environ.get("BEAMGYRO", ROOT / "build/release/beamgyro")
SIMULATOR = os.environ.get("BEAMGYRO_SIMULATOR", PROGRAM)
MODELS = ROOT / "scenarios/models"

# Trims as a factory makes them: 1-sigma of each.
TRIMS = {"mount.axis_angle_deg": 0.0075,
         "readout.quadrature_trim_deg_per_s": 0.15,
         "readout.phase_tc_rad_per_K": 6e-6,
         "readout.offset_tc_deg_per_s_per_K": 3.6e-5}
PATCH_OFFSET = 30e-9  # [m]
FIXED = {"readout.offset_trim_deg_per_s": 0,
         "readout.phase_tc2_rad_per_K2": 0,
         "readout.offset_tc2_deg_per_s_per_K2": 0,
         "readout.quadrature_resolution_deg_per_s": 1e-4,
         "readout.drive_voltage_resolution_V": 1e-6}
NOISE = {"noise.angle_random_walk_deg_per_sqrt_s": 0.0015,
         "noise.bias_instability_deg_per_s": 0.0003,
         "noise.rate_random_walk_deg_per_s_per_sqrt_s": 1e-6,
         "noise.turn_on_deg_per_s": 0.001}

SCENARIO = """\
name = "{name}"
device = "{device}"
fidelity = "quasistatic"
duration_s = {duration}
output_rate_Hz = {rate}
seed = {seed}

[ambient]
points = [{points}]

[chamber]
stirred = {stirred}
"""
TESTS = ["steady", "ramp", "still"]


# 100 deg/s from the end of the warm-up on.
TURNING = "rate.steps = [[0, 0], [3500, 100]]\n"


def trims(rng):
    drawn = {key: sigma * rng.normal() for key, sigma in TRIMS.items()}
    offsets = ", ".join(f"{PATCH_OFFSET * rng.normal():.6g}" for _ in range(4))
    return {**FIXED, **drawn, "patches.offset_m": f"[{offsets}]"}


def modes(rng):
    """A Poisson number of about eight, as (13.4) makes bumps of their height."""
    keys = {}
    for k in range(min(rng.poisson(8), 16)):
        loss = 2e-3 * np.exp(0.5 * rng.normal())
        height = np.radians(0.03) * np.exp(0.8 * rng.normal())  # [rad/s]
        product = 2 * loss * 0.977 * height / (2 * np.pi * 9.1e3)
        ratio = np.exp(rng.normal())
        for key, value in {
                "detuning": rng.uniform(-0.03, 0.03),
                "detuning_tc_per_K": rng.choice([-1, 1]) * 2e-4
                * np.exp(0.6 * rng.normal()),
                "loss_factor": loss,
                "coupling_drive": np.sqrt(product * ratio),
                "coupling_sense": rng.choice([-1, 1])
                * np.sqrt(product / ratio)}.items():
            keys[f"spurious_mode.mode_{k + 1}.{key}"] = value
    return keys


def soaks(temperatures, hold, ramp):
    """Points of the ambient: hold [s] at each, ramp [K/min] between."""
    time, points = 0.0, []
    for k, T in enumerate(temperatures):
        if k > 0:
            time += 60 * abs(T - temperatures[k - 1]) / ramp
        points += [(time, T), (time + hold, T)]
        time += hold
    return points


def settings(keys):
    return [x for key, value in keys.items()
            for x in ("--set", f"{key}={value}")]


class Study:
    def __init__(self, folder, campaign=None):
        self.folder = Path(folder)
        self.campaign = campaign.resolve() if campaign else None
        self.base = ROOT / "scenarios/devices/nominal.toml"
        if campaign:
            named = tomllib.loads(campaign.read_text())["device"]
            self.base = (campaign.parent / named).resolve()

    def call(self, program, *arguments):
        answer = subprocess.run([program, *map(str, arguments), "--quiet"],
                                capture_output=True, text=True, check=False,
                                cwd=self.folder)
        if answer.returncode:
            raise SystemExit(answer.stderr)
        return answer.stdout

    def prepare(self, units):
        if self.campaign:
            self.call(SIMULATOR, "generate", self.campaign, "--devices",
                      max(2, units), "-o", "set")

    def device(self, unit):
        """Arguments of the unit."""
        if self.campaign:
            drawn = self.call(PROGRAM, "info", "set", "--device", unit)
            values = drawn.split("\n", 1)[1].split("\n\nrun", 1)[0]
            return [x for line in values.splitlines() if line
                    for x in ("--set", line)]
        rng = np.random.default_rng([13, unit])
        return settings({**trims(rng), **modes(rng), **NOISE})

    def simulate(self, name, points, device, seed, rate=0.1, more="",
                 stirred=True):
        text = more + SCENARIO.format(
            name=name, device=self.base, duration=points[-1][0], rate=rate,
            seed=seed, stirred=str(stirred).lower(),
            points=", ".join(f"[{t:.1f}, {T:.4f}]" for t, T in points))
        (self.folder / f"{name}.toml").write_text(text)
        (self.folder / f"{name}.h5").unlink(missing_ok=True)
        self.call(SIMULATOR, "run", f"{name}.toml", "-o", f"{name}.h5",
                  *device)

    def errors(self, model, name, skip):
        """Bias taken away less the bias of the twin without noise [deg/s]."""
        out = self.folder / "out.h5"
        out.unlink(missing_ok=True)
        self.call(PROGRAM, "compensate", f"{model}.json", f"{name}.h5", "-o",
                  out)
        with h5py.File(out) as f:
            error = f["rate"][:] - f["compensated_rate"][:] - f["true_bias"][:]
            return error[f["time"][:] > skip]

    def train(self, model, text, held_out):
        (self.folder / f"{model}.model.toml").write_text(text)
        (self.folder / f"{model}.json").unlink(missing_ok=True)
        held = ["--held-out", "held_out.h5"] if held_out else []
        self.call(PROGRAM, "train", "train.h5", "--model",
                  f"{model}.model.toml", "-o", f"{model}.json", *held)


def texts(networks):
    shipped = {name: (MODELS / f"{name}.toml").read_text()
               for name in ["straight_lines", "cubic", "spline", "resonances",
                            "resonances_and_ramps"]}
    steady = "\n[rows]\nsteady_K_per_min = 0.05\n"
    blind = "quadrature_noise_deg_per_s = 1e6\n"  # not corrected by it
    shipped["cubic"] += steady
    shipped["resonances, blind"] = \
        shipped["resonances"] + "[resonances]\n" + blind
    shipped["resonances_and_ramps, corrected"] = \
        shipped["resonances_and_ramps"].replace(blind, "")
    if networks:
        for name in ["recommended", "recommended_with_quadrature"]:
            shipped[name] = (MODELS / f"{name}.toml").read_text().replace(
                "restarts = 8", "restarts = 3")
    return shipped


def left_by(study, unit, networks):
    device = study.device(unit)
    silent = [*device, "--set", "noise.enabled=false"]
    up, down = [-24, 44], [-24, 44, -24]
    study.simulate("train", soaks(np.linspace(-25, 45, 7), 3600, 0.5), device,
                   10 * unit + 1)
    study.simulate("held_out", soaks([45, -25], 3600, 0.5), device,
                   10 * unit + 2)
    study.simulate("steady", soaks(up, 3600, 0.03), silent, 10 * unit + 3)
    study.simulate("ramp", soaks(down, 3600, 1.0), device, 10 * unit + 4,
                   rate=1)
    study.simulate("still", soaks(down, 3600, 2.0), silent, 10 * unit + 6,
                   rate=1, stirred=False)
    study.simulate("turning", soaks(up, 3600, 1.0), silent, 10 * unit + 5,
                   more=TURNING)
    study.simulate("at_rest", soaks(up, 3600, 1.0), silent, 10 * unit + 5)
    left = {}
    for name, text in texts(networks).items():
        model = name.replace(", ", "_")
        study.train(model, text, name.startswith("recommended"))
        # A constant is the turn-on offset of training, which re-zeroing takes
        # away; it is the same for all.
        for test in TESTS:
            left[f"{name} {test}"] = float(np.std(
                study.errors(model, test, 3600)))
        left[f"{name} of 100 deg/s"] = float(np.abs(
            study.errors(model, "turning", 3600)
            - study.errors(model, "at_rest", 3600)).max())
    return left


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("units", type=int)
    parser.add_argument("--networks", action="store_true")
    parser.add_argument("--campaign", type=Path)
    parser.add_argument("--first", type=int, default=0)
    arguments = parser.parse_args()
    last = arguments.first + arguments.units
    every = {}
    with tempfile.TemporaryDirectory() as folder:
        study = Study(folder, arguments.campaign)
        study.prepare(last)
        for unit in range(arguments.first, last):
            left = left_by(study, unit, arguments.networks)
            print(unit, json.dumps({k: round(v, 5) for k, v in left.items()}),
                  flush=True)
            for key, value in left.items():
                every.setdefault(key, []).append(value)
    for key, values in every.items():
        print(f"{key:40} {np.median(values):.4f} "
              f"{np.percentile(values, 95):.4f}")


if __name__ == "__main__":
    main()
