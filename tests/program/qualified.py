# SPDX-License-Identifier: MIT
"""A short qualification, which the tests of `validate --device` share."""

from program import CUBIC, SCENARIO, SCENARIOS, ProgramTest, ramp

NOMINAL = SCENARIOS / "devices/nominal.toml"

# A qualification that takes no time: ramps that train and a ramp that judges.
SHORT = """\
name = "short"

[[run]]
name = "ramp"
purpose = "ramp"
scenario = "ramp.toml"

[[run]]
name = "warm_up"
purpose = "warm_up"
scenario = "warm_up.toml"
[run.overrides]
"ambient.constant_degC" = 12
seed = 12

[[training]]
name = "training_ramp"
scenario = "ramp.toml"
[training.overrides]
"ambient.points" = [[0, 45], [4000, -35]]
seed = 21

[[training]]
name = "held_out_ramp"
scenario = "ramp.toml"
held_out = true
[training.overrides]
seed = 22
"""

CAMPAIGN = """\
name = "three"
device = "device.toml"
devices = 3
seed = 5

[tolerances]
"readout.quadrature_trim_deg_per_s" = { normal = { mean = 0, sigma = 30 } }

[[run]]
name = "ramp"
scenario = "ramp.toml"
"""

SPECIFICATION = """\
name = "a tenth"

[limits]
residual_rms_deg_per_s = { max = 0.1, source = "a test" }
residual_max_deg_per_s = { max = 50, source = "a test" }
"""

DEVICE = ["--device", "device.toml", "--qualification", "q.toml"]


class Qualified(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("ramp.toml", ramp(seed=11))
        self.write("warm_up.toml", SCENARIO)
        self.write("q.toml", SHORT)
        self.write("cubic.toml", CUBIC)
        self.write("campaign.toml", CAMPAIGN)
        self.write("spec.toml", SPECIFICATION)

    def validate(self, *arguments, model="cubic.toml", status=None):
        return self.validated(
            model, *DEVICE, *arguments,
            allowed=(0, 3) if status is None else (status,))

    def trained_file(self, *options):
        """A compensator of the first training run, or of a ramp with other
        options."""
        self.ok("run", "ramp.toml", *options or (
            "--seed", 21, "--set", "ambient.points=[[0, 45], [4000, -35]]"),
            "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        return "c.json"
