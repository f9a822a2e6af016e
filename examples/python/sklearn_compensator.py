#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""An estimator of scikit-learn as a compensator.

sklearn_compensator.py TRAIN.toml TEST.toml: two scenarios.
"""

from __future__ import annotations

import sys

from sklearn.ensemble import GradientBoostingRegressor  # type: ignore[import]

import beamgyro as bg

INPUTS = ["temperature", "temperature_lowpass(300)", "since_power_on(300)"]


def main(train_scenario: str, test_scenario: str) -> None:
    """Fit to one run, and judge on another."""
    train = bg.run(train_scenario)
    test = bg.run(test_scenario)
    rows, labels = bg.training_rows(train, INPUTS, every_s=60)
    estimator = GradientBoostingRegressor(random_state=1)
    estimator.fit(rows, labels)
    compensator = bg.Compensator(estimator, inputs=INPUTS,
                                 name="boosted trees")
    answer = bg.compensate(compensator, test)
    left = (answer.compensated_rate - answer.true_rate).std()
    raw = (answer.rate - answer.true_rate).std()
    print(f"1-sigma: {float(raw):.3f} deg/s before, "
          f"{float(left):.3f} deg/s after")
    result = bg.validate(compensator, test)
    print(f"verdict: {result.verdict}")


if __name__ == "__main__":
    main(*sys.argv[1:3])
