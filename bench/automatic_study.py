# SPDX-License-Identifier: MIT
"""The study `automatic` of population.py: what the automatic choice loses.

On good and on deliberately poor data it is compared with the better of a
constant and the cubic, fitted to the same recordings, on runs without noise
that neither has seen: chosen rms / best rms, whose bound is 1.05.
"""

import json
import shutil

import h5py

import demo
from demo import NOISE_OFF, SCENARIOS

BOUND = 1.05
CONSTANT = 'kind = "constant"\n'
COARSE = ["temperature_sensor.resolution_K=1"]


def ramp(name, temperatures, rate, seed):
    """Between soaks of an hour, the first from power-on."""
    way = sum(abs(b - a) for a, b in zip(temperatures, temperatures[1:]))
    return (name, "ramp", seed, [
        f"ambient.soaks.temperatures_degC={temperatures}",
        f"ambient.soaks.ramp_K_per_min={rate}",
        f"duration_s={3600 * len(temperatures) + 60 * way / rate:g}"])


# Ten runs, each kind of the demo's once.
USUAL = [demo.TRAINING[0], *demo.TRAINING[len(demo.SWEEPS):][:3]] + [
    run for run in demo.TRAINING if run[1] == "warm_up_cycles"]
UP = [ramp("up", [-40, 50], 1, 800)]
UP_DOWN = [ramp("up_down", [-40, 50, -40], 1, 801)]
UP_8_K = [ramp("up_8_K", [10, 18], 1, 802)]
UP_DOWN_8_K = [ramp("up_down_8_K", [10, 18, 10], 1, 803)]
TEST = [run for run in demo.TEST if run[0] in demo.SOAKS + demo.MOTION]
TEST_8_K = [ramp("other_8_K", [10, 18, 10], 0.5, 810),
            ramp("soak_8_K", [14], 1, 811)]
# Name: training runs, scored runs, model files, settings of all runs.
CASES = {
    "usual": (USUAL, TEST, ["auto", "auto_recommended"], []),
    "up": (UP, TEST, ["auto", "auto_recommended"], []),
    "up_down": (UP_DOWN, TEST, ["auto", "auto_recommended"], []),
    "coarse": (USUAL, TEST, ["auto"], COARSE),
    "up_8_K": (UP_8_K, TEST_8_K, ["auto"], []),
    "up_down_8_K": (UP_DOWN_8_K, TEST_8_K, ["auto"], []),
}
# Recordings whose true bias is taken away: nothing is left to compensate.
ZEROED = {"usual": (USUAL, ""), "up": (UP, ""), "up_down": (UP_DOWN, "")}


def without_bias(unit, name):
    """The recording NAME with the true bias subtracted from its rate."""
    zeroed = f"zeroed_{name}"
    shutil.copy(unit.recording(name), unit.recording(zeroed))
    with h5py.File(unit.recording(zeroed), "r+") as file:
        file["rate"][...] -= file["true_bias"][()]
    return zeroed


def train(unit, names, model, name):
    """What the compensator's file says of its training."""
    file = unit.out / f"{name}.json"
    unit.beamgyro("train", *map(unit.recording, names), "--model", model,
                  "--seed", 1, "-o", file)
    return json.loads(file.read_text())["training"]


def rms(unit, name, test):
    """Of a compensator over the runs together [deg/s]."""
    judged = unit.judge(unit.out / f"{name}.json", test)
    return judged["after"]["residual_rms_deg_per_s"]


def automatic(unit):
    constant = unit.out / "constant.toml"
    constant.write_text(CONSTANT)
    figures = {}
    for case, (runs, scored, models, settings) in CASES.items():
        runs, scored = unit.few(runs), unit.few(scored)
        suffix = "_coarse" if settings else ""
        unit.simulate(runs, suffix, settings)
        unit.simulate(scored, suffix + "_quiet", [*settings, NOISE_OFF])
        names = [name + suffix for name, *_ in runs]
        test = [f"{name}{suffix}_quiet" for name, *_ in scored]
        for name, model in [("constant", constant),
                            ("cubic", SCENARIOS / "models/cubic.toml")]:
            train(unit, names, model, name)
        best = min(rms(unit, "constant", test), rms(unit, "cubic", test))
        for model in models:
            training = train(unit, names, SCENARIOS / f"models/{model}.toml",
                             model)
            chosen = rms(unit, model, test)
            figures[f"{case}_{model}_of_best"] = chosen / best
            figures[f"{case}_{model}_lost_deg_per_s"] = chosen - best
            figures[f"{case}_{model}_method"] = training["method"]
    for case, (runs, _) in ZEROED.items():
        names = [without_bias(unit, name) for name, *_ in unit.few(runs)]
        training = train(unit, names, SCENARIOS / "models/auto.toml", "zeroed")
        claims = not any("no improvement to claim" in warning
                         for warning in training["warnings"])
        figures[f"zeroed_{case}_method"] = training["method"] + (
            ", claims an improvement" if claims else "")
    return figures
