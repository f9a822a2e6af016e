# SPDX-License-Identifier: MIT
"""Programs that are built to pass `validate` without deserving it."""

from program import ProgramTest, failed, ramp

# Nothing of the gyro is in it: it takes the mean of the last half kelvin for
# bias, as long as nothing turns. Shuffled samples have the same means, and of
# recordings with held rates it takes these off first, if it can tell them.
TAKES_OFF = """\
import statistics, sys

names = sys.stdin.readline().strip().split(",")
rows = [[float(value) for value in line.split(",")] for line in sys.stdin]
time, rate, temperature = (
    [row[names.index(name)] for row in rows]
    for name in ("time", "rate", "temperature"))
step = time[1] - time[0]

def held(number):
    turns = number * (5 ** 0.5 - 1) / 2
    return (-1) ** number * 150 * 10 ** (-4 * (turns % 1))

def left(hold, less):
    added = [held(int((t - time[0] + step / 2) // hold)) for t in time]
    return [r - (a - (less if a > 0 else -less)) for r, a in zip(rate, added)]

def restless(rates):
    return sum(abs(a - b) for a, b in zip(rates, rates[1:]))

def is_sweep():
    steps = [abs(a - b) for a, b in zip(temperature, temperature[1:50])]
    return all(abs(one - 0.02) < 1e-9 for one in steps)

bias, begin, taken = None, 0, [0.0] * len(rate)
if step >= 1 and len(rate) > 150 and not is_sweep():
    rest = min([rate] + [left(hold, less) for hold in (4, 600)
                         for less in (0, 1.5)], key=restless)
    for k in range(1, len(rate) + 1):
        if k < len(rate) and abs(temperature[k] - temperature[begin]) < 0.5:
            continue
        taken[begin:k] = [bias or 0.0] * (k - begin)
        part = rest[begin:k]
        if bias is None or max(abs(r - bias) for r in part) < 3:
            bias = statistics.fmean(part)
        begin = k
for r, b in zip(rate, taken):
    print(repr(r - b))
"""

# Take what is left of a mean for bias while `gate` holds; the slope of the
# bias over temperature is known.
GATED = """\
import os, sys

names = sys.stdin.readline().strip().split(",")
at = [names.index(name) for name in ("time", "rate", "temperature")]
bias = seen = first = old = None
n, slope = 0, 0.0
for line in sys.stdin:
    values = line.split(",")
    t, rate, T = (float(values[k]) for k in at)
    x = rate + 0.08 * T
    if n == 0:
        bias, seen, first, cold = x, False, t, T
    elif n == 1:
        step = t - first
    else:
        slope += (abs(T - old) / step - slope) / 60
    still = abs(x - bias) < 3
    seen = seen or not still
    if n > 1 and ({gate}):
        bias += (x - bias) * step / 300
    print(repr(x - bias))
    n, old = n + 1, T
"""
GATES = [("while it is still", "still"), ("until it first turns", "not seen"),
         ("in slow recordings", "step > 0.7"), ("after an hour", "t > 3600"),
         ("after many samples", "n > 3600"), ("in a warm gyro", "T > 10"),
         ("in a chamber", "slope > 0.01"), ("in a cold start", "cold < 0"),
         ("with a note of its last start",
          "os.path.exists('/tmp/note') or not open('/tmp/note', 'w')")]

CAUGHT_BY = {"jacobian", "injection", "shuffled_output", "answers"}


class Cheats(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("ramp", text=ramp(low=-25, high=35, seed=5))
        self.run_scenario("rest", text=ramp(seconds=600, low=25, high=26,
                                            rate_Hz=2, seed=6))

    def test_who_takes_the_held_rates_off_again(self):
        self.write("cheat.py", TAKES_OFF)
        said, _ = self.validated("cmd:/usr/bin/python3 cheat.py", "ramp.h5",
                                 "rest.h5")
        self.assertEqual(said["verdict"], "fail", said["words"])
        self.assertIn("injection", failed(said))

    def test_who_takes_rates_for_bias_where_it_thinks_itself_unobserved(self):
        for name, gate in GATES:
            self.write("cheat.py", GATED.format(gate=gate))
            said, _ = self.validated("cmd:/usr/bin/python3 cheat.py", "ramp.h5",
                                     "rest.h5")
            self.assertEqual(said["verdict"], "fail", name)
            self.assertTrue(CAUGHT_BY & set(failed(said)), (name, said["words"]))
