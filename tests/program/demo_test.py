# SPDX-License-Identifier: MIT
"""The demo end to end, and the figures the project promises from it."""

import json
import sys
import unittest

import pytest

from program import PROGRAM, ROOT, class_folder, ended

METHODS = {"cubic", "spline", "bp", "output_and_temperature", "recommended"}
LIFELIKE = METHODS | {"recommended_with_play"}


@pytest.mark.early
class Demo(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.out = class_folder(cls, "a demo ")
        cls.answer = ended(sys.executable, ROOT / "scripts/demo.py", "--program",
                           PROGRAM, "--out", cls.out, cwd=cls.out)
        table = json.loads((cls.out / "table.json").read_text())
        cls.lifelike = {row["method"]: row for row in table["lifelike"]
                        if not row["noise"]}
        cls.lifelike_rows = table["lifelike"]
        cls.modes = table["modes"]
        rows = table["rows"]
        cls.quiet = {row["method"]: row for row in rows if not row["noise"]}
        cls.noisy = {row["method"]: row for row in rows if row["noise"]}

    def test_compensators_table_and_pictures_are_there(self):
        self.assertEqual({path.stem for path in self.out.glob("*.json")},
                         METHODS | {"table"})
        for suffix, start in [("png", b"\x89PNG"), ("svg", b"<?xml")]:
            pictures = list(self.out.glob(f"*.{suffix}"))
            self.assertEqual(len(pictures), 6)
            more = list(self.out.glob(f"more/*.{suffix}"))
            self.assertEqual({picture.stem for picture in more},
                             {"recommended_network", "trap"})
            for picture in pictures + more:
                self.assertTrue(picture.read_bytes().startswith(start))
        for picture in self.out.rglob("*.png"):
            self.assertIn(str(picture), self.answer.stdout)
        self.assertEqual(set(self.quiet), METHODS)
        self.assertEqual(set(self.noisy), METHODS)

    def test_the_network_leaves_two_percent_of_the_cubic(self):
        self.assertLessEqual(self.quiet["bp"]["percent_of_cubic"], 2)

    def test_the_recommended_network_holds_on_ramps_and_warm_ups(self):
        motion = self.quiet["recommended"]["ramps_and_warm_ups"]
        self.assertLessEqual(motion["rms_deg_per_s"], 0.03)
        self.assertLessEqual(motion["max_deg_per_s"], 0.15)
        cubic = self.quiet["cubic"]["ramps_and_warm_ups"]
        self.assertGreaterEqual(cubic["rms_deg_per_s"],
                                10 * motion["rms_deg_per_s"])

    def test_bias_only_compensators_pass_and_keep_the_rate(self):
        for method in METHODS - {"output_and_temperature"}:
            self.assertEqual(self.noisy[method]["verdict"], "pass")
            # Without noise the resolution of the temperature is left.
            self.assertEqual(self.quiet[method]["verdict"], "pass")
            for rows in (self.quiet, self.noisy):
                kept = rows[method]["scale_factor_within_120_deg_per_s"]
                self.assertLess(abs(kept - 1), 1e-3)

    def test_the_network_that_sees_the_output_at_rest_cancels_the_rate(self):
        for rows in (self.quiet, self.noisy):
            row = rows["output_and_temperature"]
            self.assertTrue(row["verdict"].startswith(
                "Not met: jacobian, injection, true_rate"), row["verdict"])
            self.assertLess(row["scale_factor_within_2_deg_per_s"], 0.1)
            self.assertGreater(row["scale_factor_within_120_deg_per_s"], 0.5)

    def test_the_table_has_the_unit_that_remembers(self):
        self.assertEqual({(row["method"], row["noise"])
                          for row in self.lifelike_rows},
                         {(method, noise) for method in LIFELIKE
                          for noise in (False, True)})
        self.assertIn("A unit that remembers", self.answer.stdout)
        for row in self.lifelike_rows:
            for key, value in row.items():
                if key.endswith("_deg_per_s"):
                    self.assertTrue(0 <= value < 2, f"{key}: {value}")

    def test_the_table_has_a_unit_with_spurious_modes(self):
        self.assertIn("A unit with spurious modes", self.answer.stdout)
        cubic, lines, network = (row["rms_deg_per_s"] for row in self.modes)
        self.assertLess(lines, cubic / 2)
        self.assertLess(network, cubic / 2)

    def test_a_store_moves_what_was_calibrated_and_a_zero_brings_it_back(self):
        for method in LIFELIKE - {"output_and_temperature", "cubic"}:
            row = self.lifelike[method]
            # 1,000 h at 40 degC move this unit by 0.25 deg/s.
            self.assertGreater(row["after_store_rms_deg_per_s"], 0.2)
            self.assertLess(row["after_store_rezeroed_rms_deg_per_s"],
                            0.7 * row["after_store_rms_deg_per_s"])

    def test_play_inputs_halve_what_hysteresis_leaves_of_a_day(self):
        left = [self.lifelike[method]["before_store_rms_deg_per_s"] ** 2
                for method in ("recommended_with_play", "recommended")]
        self.assertLess(left[0], left[1] / 2)
