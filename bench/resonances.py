# SPDX-License-Identifier: MIT
"""Seven soaks and the ramps between them, of virtual gyros with spurious
modes: what each method leaves on the steady curve and on unseen ramps.

    /usr/bin/python3 bench/resonances.py 60 [--networks]

BEAMGYRO names the program. One line a unit, then medians and 95 %."""

import json
import os
import subprocess
import sys
import tempfile
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
stirred = true
"""


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


class Study:
    def __init__(self, folder):
        self.folder = Path(folder)

    def call(self, program, *arguments):
        answer = subprocess.run([program, *map(str, arguments), "--quiet"],
                                capture_output=True, text=True,
                                cwd=self.folder)
        if answer.returncode:
            raise SystemExit(answer.stderr)

    def simulate(self, name, points, keys, seed, rate=0.1, more=""):
        text = more + SCENARIO.format(
            name=name, device=ROOT / "scenarios/devices/nominal.toml",
            duration=points[-1][0], rate=rate, seed=seed,
            points=", ".join(f"[{t:.1f}, {T:.4f}]" for t, T in points))
        (self.folder / f"{name}.toml").write_text(text)
        (self.folder / f"{name}.h5").unlink(missing_ok=True)
        sets = [x for key, value in keys.items()
                for x in ("--set", f"{key}={value}")]
        self.call(SIMULATOR, "run", f"{name}.toml", "-o", f"{name}.h5", *sets)

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
               for name in ["straight_lines", "cubic", "spline", "resonances"]}
    steady = "\n[rows]\nsteady_K_per_min = 0.05\n"
    shipped["cubic"] += steady
    shipped["blind"] = (shipped["resonances"]
                        + "[resonances]\nquadrature_noise_deg_per_s = 1e6\n")
    if networks:
        for name in ["recommended", "recommended_with_quadrature"]:
            shipped[name] = (MODELS / f"{name}.toml").read_text().replace(
                "restarts = 8", "restarts = 3")
    return shipped


def main():
    units = int(sys.argv[1])
    first = int(os.environ.get("FIRST", 0))
    networks = "--networks" in sys.argv
    every = {}
    with tempfile.TemporaryDirectory() as folder:
        study = Study(folder)
        for unit in range(first, first + units):
            rng = np.random.default_rng([13, unit])
            device = {**trims(rng), **modes(rng), **NOISE}
            silent = {**device, "noise.enabled": "false"}
            study.simulate("train", soaks(np.linspace(-25, 45, 7), 3600, 0.5),
                           device, 10 * unit + 1)
            study.simulate("held_out", soaks([45, -25], 3600, 0.5), device,
                           10 * unit + 2)
            study.simulate("steady", soaks([-24, 44], 3600, 0.03), silent,
                           10 * unit + 3)
            study.simulate("ramp", soaks([-24, 44, -24], 3600, 1.0), device,
                           10 * unit + 4, rate=1)
            study.simulate("turning", soaks([-24, 44], 3600, 1.0), silent,
                           10 * unit + 5, more=TURNING)
            study.simulate("at_rest", soaks([-24, 44], 3600, 1.0), silent,
                           10 * unit + 5)
            line = {}
            for name, text in texts(networks).items():
                study.train(name, text, name.startswith("recommended"))
                for test in ["steady", "ramp"]:
                    error = study.errors(name, test, 3600)
                    # A constant is the turn-on offset of training, which
                    # re-zeroing takes away; it is the same for all.
                    line[f"{name} {test}"] = float(
                        np.sqrt(np.mean((error - error.mean())**2)))
                line[f"{name} of 100 deg/s"] = float(np.abs(
                    study.errors(name, "turning", 3600)
                    - study.errors(name, "at_rest", 3600)).max())
            print(unit, json.dumps({k: round(v, 5) for k, v in line.items()}),
                  flush=True)
            for key, value in line.items():
                every.setdefault(key, []).append(value)
    for key, values in every.items():
        print(f"{key:40} {np.median(values):.4f} "
              f"{np.percentile(values, 95):.4f}")


if __name__ == "__main__":
    main()
