# SPDX-License-Identifier: MIT
"""The virtual devices of bench/population.py and its shortened run."""

import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np
import pytest

from program import PROGRAM, ROOT, ended, script

SCRIPT = ROOT / "bench/population.py"
SCALARS = {  # mean and 1-sigma as the page of the benchmarks states them
    "beam.side_difference": (-0.0095, 0.006 / math.sqrt(12)),
    "readout.quadrature_trim_deg_per_s": (0, 50),
    "mount.axis_angle_deg": (0, 2.5),
    "mount.glass_transition_degC": (-48, 4),
    "bond.beta_1Hz_degC": (-60, 4),
    "bond.glass_transition_degC": (38, 4),
    "readout.phase_tc_rad_per_K": (0, 2e-4),
    "readout.feedthrough_F": (0, 0.02e-12),
    "readout.offset_tc_deg_per_s_per_K": (0, 0.012),
    "beam.modulus_tc1_per_K": (0, 4e-6),
}
ARRAYS = {"patches.offset_m": (0, 10e-6),
          "bond.thickness_m": (30e-6, 20e-6 / math.sqrt(12))}


class Draws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.population = script(SCRIPT)
        cls.draws = [cls.population.draw(k) for k in range(2000)]

    def test_a_device_is_the_same_whichever_is_drawn_before_it(self):
        self.assertEqual(self.population.draw(7), self.draws[7])
        self.assertNotEqual(self.draws[7], self.draws[8])

    def test_have_the_stated_means_and_spreads(self):
        # 5 standard errors: of the mean 1 / sqrt(N), of the spread at most
        # 1 / sqrt(2 N), that of a normal distribution.
        def check(values, mean, sigma):
            error = 5 * sigma / math.sqrt(len(values))
            self.assertAlmostEqual(np.mean(values), mean, delta=error)
            self.assertAlmostEqual(np.std(values), sigma, delta=error)
        for key, (mean, sigma) in SCALARS.items():
            check([draw[key] for draw in self.draws], mean, sigma)
        for key, (mean, sigma) in ARRAYS.items():
            check(np.ravel([draw[key] for draw in self.draws]), mean, sigma)
        key = "mount.glassy_stiffness_share"
        check(np.log([draw[key] / 6e-4 for draw in self.draws]), 0, 0.35)
        self.assertEqual(set(self.draws[0]), {*SCALARS, *ARRAYS, key})

    def test_do_not_leave_their_ranges(self):
        for draw in self.draws:
            self.assertTrue(-0.0125 <= draw["beam.side_difference"] <= -0.0065)
            self.assertTrue(all(20e-6 <= t <= 40e-6
                                for t in draw["bond.thickness_m"]))


# What the study runs has tests of its own in test.sh; its script has not.
@pytest.mark.deep
class ShortenedRun(unittest.TestCase):
    def test_leaves_finite_figures_and_no_recording_and_goes_on(self):
        with tempfile.TemporaryDirectory(prefix="a population ") as folder:
            out = pathlib.Path(folder)

            def run():
                answer = ended(sys.executable, SCRIPT, "--program", PROGRAM,
                               "--out", out, "--devices", 1, "--quick", cwd=out)
                return answer.stdout, answer.stderr
            text, _ = run()
            table = json.loads((out / "table_quick.json").read_text())
            (line,) = (out / "devices_quick.jsonl").read_text().splitlines()
            self.assertEqual({path.name for path in out.iterdir()},
                             {"table_quick.json", "table_quick.txt",
                              "devices_quick.jsonl"})
            self.assertEqual(text, (out / "table_quick.txt").read_text())

            studies = json.loads(line)["studies"]
            self.assertEqual(table["devices"], 1)
            self.assertEqual(set(table["studies"]), set(studies))
            for study, figures in studies.items():
                for figure, value in figures.items():
                    row = table["studies"][study][figure]
                    if isinstance(value, str):
                        self.assertEqual(row, {"counts": {value: 1}})
                        continue
                    self.assertTrue(math.isfinite(value))
                    if "_lost_" not in figure:
                        self.assertGreater(value, 0)
                    self.assertEqual(row["median"], value)
            self.assertLess(studies["soak"]["bp_percent_of_cubic"], 7.28)
            automatic = studies["automatic"]
            self.assertLessEqual(automatic["up_down_auto_of_best"], 1.05)
            self.assertEqual(automatic["up_auto_method"], "cubic")
            self.assertEqual(automatic["up_auto_lost_deg_per_s"], 0)
            self.assertIn(automatic["zeroed_up_down_method"],
                          ["none", "constant"])

            # Half a line, as a run broken off leaves it, is no device.
            with (out / "devices_quick.jsonl").open("a") as file:
                file.write('{"device": 1, "stu')
            self.assertEqual(run(), (text, ""))  # nothing is done again
