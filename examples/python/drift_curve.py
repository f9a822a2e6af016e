#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Drift over temperature, without noise: drift_curve.py DEVICE [PICTURE]"""
import sys

import beamgyro as bg

table = bg.characterise(sys.argv[1], slice(-40, 60, 10))
print("degC   bias deg/s")
for row in zip(table.temperature.values, table.bias.values):
    print("{:4.0f} {:11.4f}".format(*row))
if len(sys.argv) > 2:
    fine = bg.characterise(sys.argv[1], slice(-40, 60, 1))
    bg.plots.plot_table(fine, names=sys.argv[1:2]).savefig(sys.argv[2])
