#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The drift over temperature of the shipped gyro: drift_curve.py DEVICE."""
import sys

import beamgyro as bg

table = bg.characterise(sys.argv[1], slice(-40, 60, 10))
print("degC   bias deg/s")
for row in zip(table.temperature.values, table.bias.values):
    print("{:4.0f} {:11.4f}".format(*row))
