#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A platform that holds its heading by a gyro, on a swaying vehicle.

stabilised_platform.py DEVICE.toml SWEEP.toml MODEL.toml [PICTURE]

The controller sees the integral of the measured rate alone, so the bias of
the gyro turns the platform away. The second platform has the same gyro, and
takes the bias of a compensator from the rate: one of MODEL.toml that is
trained on the run SWEEP.toml. Prints the largest error of both.
"""
import sys

import numpy as np
import xarray as xr

import beamgyro as bg

STEP_S, MINUTES = 0.02, 25


def bias_over_temperature(compensator: bg.Compensator,
                          degC: np.ndarray) -> np.ndarray:
    """What the compensator takes from a rate, at temperatures of the sensor."""
    resting = xr.Dataset(
        {"rate": ("time", np.zeros(degC.size)),
         "temperature": ("time", degC),
         "status": ("time", np.zeros(degC.size, np.uint8))},
        {"time": np.arange(degC.size, dtype=float)})
    return -bg.compensate(compensator, resting).compensated_rate.values


def heading_errors(gyro: bg.Gyro, degC: np.ndarray,
                   bias: np.ndarray) -> np.ndarray:
    """The true heading of the platform [degree] after every step."""
    errors = np.empty(int(MINUTES * 60 / STEP_S))
    heading = estimate = before = 0.0
    for k in range(errors.size):
        sway = 5 * np.sin(2 * np.pi * 0.2 * STEP_S * k)  # of the vehicle
        rate = sway - 20 * estimate  # the motor turns against what it sees
        heading += STEP_S * (before + rate) / 2
        shown = gyro.step(dt=STEP_S, rate=(before, rate))
        estimate += STEP_S * (shown.rate
                              - np.interp(shown.temperature, degC, bias))
        errors[k] = heading
        before = rate
    return errors


def main() -> None:
    """Run both platforms; draw them where a picture is asked for."""
    device, sweep, model = sys.argv[1:4]
    compensator = bg.train(model, [bg.run(sweep, device=device)])
    degC = np.linspace(*compensator.temperature_range, 1000)
    first, second = (bg.Device(device).start(seed=1, ambient=5.0)
                     for _ in range(2))
    raw = heading_errors(first, degC, 0 * degC)
    compensated = heading_errors(second, degC,
                                 bias_over_temperature(compensator, degC))
    print(f"raw: {abs(raw).max():.1f} degrees, compensated: "
          f"{abs(compensated).max():.1f} degrees, after {MINUTES} minutes")
    if len(sys.argv) > 4:
        draw(raw, compensated, sys.argv[4])


def draw(raw: np.ndarray, compensated: np.ndarray, picture: str) -> None:
    """Draw the headings of both platforms over time."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    minutes = STEP_S / 60 * np.arange(raw.size)
    figure, axes = pyplot.subplots(figsize=(7, 4), layout="constrained")
    axes.plot(minutes, raw, label="raw rate")
    axes.plot(minutes, compensated, label="compensated rate")
    axes.set(xlabel="time after power-on [min]",
             ylabel="true heading, should be 0 [degree]",
             title="A platform that a gyro holds, powered on at 5 °C")
    axes.legend()
    axes.grid(alpha=0.3)
    figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    main()
