# SPDX-License-Identifier: MIT
"""A short qualification, which the tests of `validate --device` share."""

import json

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


class Qualified(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ramp.toml", ramp(seed=11))
        self.write("warm_up.toml", SCENARIO)
        self.write("q.toml", SHORT)
        self.write("cubic.toml", CUBIC)
        self.write("campaign.toml", CAMPAIGN)
        self.write("spec.toml", SPECIFICATION)

    def validate(self, *arguments, model="cubic.toml", status=None):
        answer = self.beamgyro("validate", model, "--device", "device.toml",
                               "--qualification", "q.toml", "--json",
                               "v.json", *arguments)
        self.assertIn(answer.returncode, (0, 3) if status is None
                      else (status,), answer.stderr + answer.stdout)
        return json.loads((self.dir / "v.json").read_text()), answer
