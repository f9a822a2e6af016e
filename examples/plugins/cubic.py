# SPDX-License-Identifier: MIT
"""A cubic of the temperature as a command: CSV in, one rate a line out."""

import sys

BIAS = [0.68417, -0.048258, 2.0124e-3, 3.1422e-5]  # deg/s over T - 25 degC

names = sys.stdin.readline().strip().split(",")
rate, temperature = names.index("rate"), names.index("temperature")
for line in sys.stdin:
    values = line.split(",")
    x = float(values[temperature]) - 25
    bias = BIAS[0] + x * (BIAS[1] + x * (BIAS[2] + x * BIAS[3]))
    print(float(values[rate]) - bias)
