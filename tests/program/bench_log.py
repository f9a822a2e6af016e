# SPDX-License-Identifier: MIT
"""A log of a gyro on a bench, and its map."""

import math

BENCH = """\
[time]
column = "t"
unit = "ms"

[gyro]
column = "w"
unit = "deg/s"

[temperature]
column = "T"
unit = "degC"

[true_rate]
at_rest = true
"""


def table(names, rows):
    return "\n".join([names, *(",".join(map(str, row)) for row in rows)]) + "\n"


def bench_rows(samples=2400, step_ms=1000):
    """A cubic drift over a slow ramp from -30 to 40 degC."""
    for k in range(samples):
        T = -30 + 70 * k / samples
        yield (k * step_ms, round(0.2 + 0.01 * T - 1e-4 * T**2 + 0.01 *
                                  math.sin(k), 6), round(T, 3))
