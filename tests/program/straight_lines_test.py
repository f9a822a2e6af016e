# SPDX-License-Identifier: MIT
"""Straight lines between soaks, a baseline wherever a cubic is one."""

from program import SCENARIO, ProgramTest, by_name, ramp
from qualified import DEVICE, SHORT

SOAKS = [-25, -5, 15, 35]
HOLD, STEP = 2700, 600  # [s]
SPECIFICATION = """\
name = "half of what straight lines leave"
[limits_relative_to.straight_lines]
residual_rms_deg_per_s = { max = 0.5, source = "a test" }
"""


def soaks(temperatures, seed):
    points = []
    for k, soak in enumerate(temperatures):
        begin = k * (HOLD + STEP)
        points += [[begin, soak], [begin + HOLD, soak]]
    return SCENARIO.replace("duration_s = 600", f"duration_s = {points[-1][0]}") \
        .replace("output_rate_Hz = 2", "output_rate_Hz = 0.2") \
        .replace("seed = 7", f"seed = {seed}") \
        .replace("constant_degC = 25", f"points = {points}")


class StraightLines(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("soaks", text=soaks(SOAKS, 3))
        self.run_scenario("test", text=ramp(low=-20, high=30, seed=5))
        self.run_scenario("ramp", text=ramp(seed=7))
        self.write("spec.toml", SPECIFICATION)

    def validated_with(self, *arguments):
        return self.validated("c.json", "test.h5", *arguments)

    def test_a_file_that_was_trained_on_soaks_has_them(self):
        of_soaks = self.train_on("soaks.h5")
        lines = of_soaks["straight_lines"]
        self.assertEqual(len(lines["temperatures_degC"]), len(SOAKS))
        self.assertIsNotNone(
            of_soaks["training"]["straight_lines_in_sample_rms_deg_per_s"])
        said, answer = self.validated_with()
        residual = by_name(said["metrics"])["residual_rms_deg_per_s"]
        self.assertGreater(
            residual["baselines"]["straight_lines"]["value"], 0)
        self.assertIn("straight_lines",
                      [one["with"] for one in said["compared_with"]])
        self.assertIn("  straight_lines\n", answer.stdout)
        said, _ = self.validated_with("--spec", "spec.toml")
        self.assertIsNotNone(said["limits"][0]["compared"]["value"])

    def test_they_are_those_of_the_model_of_that_name(self):
        """The table of bins, of bins that hold a soak each."""
        self.train_on("soaks.h5")
        said, _ = self.validated_with()
        self.train_on("soaks.h5", model='kind = "table"\n'
                      'inputs = ["temperature"]\n[rows]\n'
                      'steady_K_per_min = 0.05\n[table]\nentries = "soaks"\n')
        table, _ = self.validated_with()
        of = [by_name(one["metrics"])["residual_rms_deg_per_s"]
              for one in (said, table)]
        self.assertAlmostEqual(of[0]["baselines"]["straight_lines"]["value"],
                               of[1]["after"]["value"], delta=0.02 *
                               of[1]["before"]["value"])

    def test_a_ramp_has_none_and_says_so(self):
        said = self.ok("train", "ramp.h5", "--model",
                       self.write("model.toml", 'kind = "constant"\n'
                                  'inputs = ["temperature"]\n'),
                       "-o", "c.json")
        self.assertIn("straight lines between soaks: none, the rows hold no "
                      "two soaks\n", said)
        self.assertNotIn("straight_lines", self.json("c.json"))
        said, answer = self.validated_with()
        self.assertNotIn("straight_lines", answer.stdout)
        self.assertNotIn("straight_lines",
                         said["metrics"][0]["baselines"])
        self.rejected("validate", "c.json", "test.h5", "--spec", "spec.toml",
                      says=["spec.toml:3:26: the limit of "
                            "residual_rms_deg_per_s is relative to the "
                            "straight_lines"])

    def test_a_qualification_trains_them_on_its_soaks(self):
        self.write("ramp.toml", ramp(seed=11))
        self.write("warm_up.toml", SCENARIO)
        self.write("soaks.toml", soaks(SOAKS, 13))
        self.write("q.toml", SHORT + '[[training]]\nname = "soaks"\n'
                   'scenario = "soaks.toml"\n')
        for text, expected in [(None, True), (SHORT, False)]:
            if text:
                self.write("q.toml", text)
            self.train_on("soaks.h5")
            said, _ = self.validated("c.json", *DEVICE)
            names = [one["with"] for one in said["compared_with"]]
            self.assertEqual("straight_lines" in names, expected)
            self.assertEqual("straight_lines" in
                             said["metrics"][0]["baselines"], expected)
