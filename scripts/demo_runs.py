# SPDX-License-Identifier: MIT
"""The runs of the demo: name, scenario, seed, overrides.

The seeds were fixed before anything was scored; no run serves two of the three
purposes. Sweeps and ramps are repeated because the gyro's own slow noise, a
rate random walk of 0.05 deg/s over a day, is in the labels of each: only other
days average it out.
"""

import pathlib

SCENARIOS = pathlib.Path(__file__).resolve().parent.parent / "scenarios"
TRAINING_SEED = 1


def ramp(name, rate, seed):
    return (name, "ramp", seed, [f"ambient.soaks.ramp_K_per_min={rate}",
                                 f"duration_s={10800 + 10800 / rate:g}"])


def at(name, scenario, temperature, seed):
    return (name, scenario, seed, [f"ambient.constant_degC={temperature}"])


def sweep(name, seed, falling):
    soaks = list(range(-40, 51, 5))[::-1 if falling else 1]
    return (name, "soak_sweep_train", seed,
            [f"ambient.soaks.temperatures_degC={soaks}"])


SWEEPS = [("soak_sweep_train", "soak_sweep_train", 101, [])] + [
    sweep(f"soak_sweep_train_{k}", 101 + k, falling=k % 2 == 1)
    for k in range(1, 5)]
TRAINING = SWEEPS + [
    ramp(f"ramp_{rate}_{k}", rate, 110 + 10 * k + i)
    for k in range(5) for i, rate in enumerate([0.5, 1, 2])] + [
    at(f"warm_up_cycles_{t}", "warm_up_cycles", t, 160 + k)
    for k, t in enumerate([-40, -30, -10, 10, 30, 50])]
SOAKS_HELD_OUT = [(f"soak_sweep_validation_{k}", "soak_sweep_validation",
                   201 + k, []) for k in range(3)]
VALIDATION = SOAKS_HELD_OUT + [
    ramp(f"ramp_1.2_{k}", 1.2, 210 + k) for k in range(3)] + [
    at(f"warm_up_cycles_20_{k}", "warm_up_cycles", 20, 220 + k)
    for k in range(3)]
TEST = [("soak_sweep_test", "soak_sweep_test", 301, [])] + [
    ramp(f"ramp_{rate}", rate, 310 + k) for k, rate in enumerate([0.75, 1.5])
] + [at(f"warm_up_{t}", "warm_up", t, 320 + k)
     for k, t in enumerate([0, 25, 40])] + [
    at(f"rate_table_{t}", "rate_table", t, 330 + k)
    for k, t in enumerate([-33, -12, 3, 22, 41])] + [
    at(f"small_rates_{t}", "small_rates", t, 340 + k)
    for k, t in enumerate([-28, 12, 37])]
REST = [("rest", "rest", 401, [])]

NOISE_OFF = "noise.enabled=false"
SOAKS = ["soak_sweep_test"]
MOTION = [name for name, *_ in TEST if name.startswith(("ramp", "warm_up"))]


def lifelike(name, scenario, seed, overrides):
    """The same run of the unit that remembers, a sample in ten seconds."""
    return (f"lifelike_{name}", scenario, seed, [
        *overrides, 'device="devices/lifelike.toml"', "output_rate_Hz=0.1"])


def turning(name, seed, soaks):
    return (name, "turning_soaks", seed,
            [f"ambient.soaks.temperatures_degC={soaks}"])


# The first of each kind: a sweep up and one down, three ramps, six ambients; and
# soaks that turn back, without which no network learns the hysteresis.
LIFELIKE_TRAINING = [lifelike(*run) for run in [
    *SWEEPS[:2], *TRAINING[5:8], *TRAINING[20:],
    ("turning_0", "turning_soaks", 181, []),
    turning("turning_1", 182,
            [-40, 0, -20, 20, -10, 40, 10, 50, 30, 45, -30, -15])]]
LIFELIKE_SWEEPS = LIFELIKE_TRAINING[:2]
LIFELIKE_VALIDATION = [lifelike(*run) for run in [
    *VALIDATION[::3],
    turning("turning_validation", 281,
            [48, 18, 32, -12, 22, -35, -5, -18, 8, 38, 28])]]
LIFELIKE_TEST = [lifelike(*run) for run in TEST
                 if run[0] in SOAKS or run[0] in MOTION]


def with_modes(name, scenario, seed, overrides):
    """The same run of a unit with spurious modes, a sample in 20 seconds."""
    return (f"modes_{name}", scenario, seed, [
        *overrides, 'device="devices/lifelike_with_modes.toml"',
        "output_rate_Hz=0.05"])


# Two sweeps to train on, up and down, one to hold out, and one without noise.
MODES_SWEEPS = [with_modes(*run) for run in [*SWEEPS[:2], SOAKS_HELD_OUT[0]]]
MODES_TEST = with_modes("test", "soak_every_kelvin", 361, [])

# Ten cycles within the temperatures of training. What is scored of one are the
# rise with its holds and the fall to 25 degC, which all ten have.
CYCLES = ("lifelike_cycles", "thermal_cycles", 351, [
    "duration_s=147600",
    f"ambient.soaks.temperatures_degC={[25] + 10 * [-40, 50] + [25]}"])
CYCLE_S = {k: (5700 + 14400 * (k - 1), 16200 + 14400 * (k - 1))
           for k in (1, 10)}
# A day of calibration, 1,000 h at 40 degC, a day of use.
STORE = ("lifelike_store", "calibrate_store_use", 352, [])
BEFORE_S, AFTER_S = (0, 25000), (3625000, 3650000)
