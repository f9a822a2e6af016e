#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A platform that holds its heading by a gyro, on a vehicle that warms up.

stabilised_platform.py DEVICE.toml SWEEP.toml MODEL.toml [PICTURE]

The controller sees the integral of the measured rate alone, so the bias of
the gyro turns the platform away. Both platforms have been on for an hour at
-10 °C, rest for ten seconds, and take off what the gyro shows then; then the
air warms by 1 K a minute, and the vehicle sways. The second platform has the
same gyro, and also takes off the bias of a compensator: of MODEL.toml, trained
on the run SWEEP.toml. Prints the largest error of both.
"""
import sys
import warnings

import numpy as np
import numpy.typing as npt
import xarray as xr

import beamgyro as bg

STEP_S, MINUTES, REST_S = 0.02, 40, 10
COLD_DEGC, WARMER_K_PER_S = -10.0, 1 / 60
Values = npt.NDArray[np.float64]


def bias_over_temperature(compensator: bg.Compensator,
                          degC: Values) -> Values:
    """What the compensator takes from a rate at these temperatures."""
    resting = xr.Dataset(
        {"rate": ("time", np.zeros(degC.size)),
         "temperature": ("time", degC),
         "status": ("time", np.zeros(degC.size, np.uint8))},
        {"time": np.arange(degC.size, dtype=float)})
    answer = bg.compensate(compensator, resting).compensated_rate
    return np.asarray(-answer.values, np.float64)


def heading_errors(gyro: bg.Gyro, degC: Values,
                   bias: Values) -> Values:
    """The true heading of the platform [degree] after every step."""
    gyro.step(dt=3600.0)
    resting = []
    for _ in range(int(REST_S / STEP_S)):
        shown = gyro.step(dt=STEP_S)
        resting.append(shown.rate - np.interp(shown.temperature, degC, bias))
    zero = np.mean(resting)
    errors = np.empty(int(MINUTES * 60 / STEP_S))
    heading = estimate = before = 0.0
    for k in range(errors.size):
        sway = 5 * np.sin(2 * np.pi * 0.2 * STEP_S * k)  # of the vehicle
        rate = sway - 20 * estimate  # the motor turns against what it sees
        heading += STEP_S * (before + rate) / 2
        air, later = (COLD_DEGC + WARMER_K_PER_S * STEP_S * step
                      for step in (k, k + 1))
        shown = gyro.step(dt=STEP_S, rate=(before, rate), ambient=(air, later))
        estimate += STEP_S * (
            shown.rate - np.interp(shown.temperature, degC, bias) - zero)
        errors[k] = heading
        before = rate
    return errors


def main() -> None:
    """Run both platforms; draw them where a picture is asked for."""
    device, sweep, model = sys.argv[1:4]
    with warnings.catch_warnings(action="ignore"):  # its scores are not used
        compensator = bg.train(model, [bg.run(sweep, device=device)])
    degC = np.linspace(*compensator.temperature_range, 1000)
    first, second = (bg.Device(device).start(seed=1, noise_rate_Hz=1 / STEP_S,
                                             ambient=COLD_DEGC)
                     for _ in range(2))
    raw = heading_errors(first, degC, 0 * degC)
    compensated = heading_errors(second, degC,
                                 bias_over_temperature(compensator, degC))
    print(f"raw: {abs(raw).max():.1f} degrees, compensated: "
          f"{abs(compensated).max():.1f} degrees, after {MINUTES} minutes")
    if len(sys.argv) > 4:
        draw(raw, compensated, sys.argv[4])


def draw(raw: Values, compensated: Values, picture: str) -> None:
    """Draw the headings of both platforms over time."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    minutes = STEP_S / 60 * np.arange(raw.size)
    figure, axes = pyplot.subplots(figsize=(7, 4), layout="constrained")
    axes.plot(minutes, raw, label="raw rate")
    axes.plot(minutes, compensated, label="compensated rate")
    axes.set(xlabel="time [min]",
             ylabel="true heading, should be 0 [degree]",
             title="A platform that a gyro holds, from -10 °C up by 1 K/min")
    axes.legend()
    axes.grid(alpha=0.3)
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    main()
