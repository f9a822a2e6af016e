# SPDX-License-Identifier: MIT
"""What `train` refuses or warns of in recordings that cannot teach a bias."""

import re

from program import ProgramTest, ramp

LOWPASS = 'kind = "polynomial"\ninputs = ["temperature", "{}"]\n' \
    "[polynomial]\ndegree = 1\n"


class TrainDoubts(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("ramp", text=ramp())
        self.run_scenario("other", "--set", "bond.glass_transition_degC=60",
                          text=ramp(low=-20, high=35, seed=3))
        self.run_scenario("again", text=ramp(low=-20, high=35, seed=4))

    def test_a_rate_that_is_the_truth_is_no_channel(self):
        self.ok("run", "ramp.toml", "-o", "ramp.csv")
        head, *lines = self.text("ramp.csv").splitlines()
        at = head.split(",").index("rate")
        cells = [line.split(",") for line in lines]
        for row in cells:
            row[at] = "0"
        self.write("zero.csv", "\n".join([head, *map(",".join, cells)]) + "\n")
        self.rejected("train", "zero.csv", "--model",
                      self.write("m.toml", 'kind = "polynomial"\n'), "-o",
                      "x.json", says=["is the true rate in all",
                                      "is the channel connected?"])

    def test_filters_that_never_move_or_never_filter_are_refused(self):
        for name, says in [
                ("temperature_lowpass(1e9)", "hardly moves within"),
                ("quadrature_lowpass(1e9)", "hardly moves within"),
                ("temperature_rate(1e9)", "hardly moves within"),
                ("temperature_lowpass(0.001)", "filters nothing of samples")]:
            model = self.write("m.toml", LOWPASS.format(name))
            self.rejected("train", "ramp.h5", "--model", model, "-o", "x.json",
                          says=[re.sub(r"\(.*", "(", name), says, "expected a"])
        self.ok("train", "ramp.h5", "--model", self.write(
            "m.toml", LOWPASS.format("temperature_lowpass(100)")), "-o", "x.json")

    def test_recordings_of_several_devices_are_said(self):
        model = self.write("m.toml", 'kind = "polynomial"\n')
        said = self.warned("train", "ramp.h5", "other.h5", "--model", model, "-o",
                           "x.json")
        self.assertIn("recordings are of 2 different devices", said)
        said = self.warned("train", "ramp.h5", "again.h5", "--model", model, "-o",
                           "x.json")
        self.assertNotIn("different devices", said)
