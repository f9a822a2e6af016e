# SPDX-License-Identifier: MIT
"""What the tests of sets share: a campaign of seven devices in two runs."""

import sys

from program import ROOT, ProgramTest

sys.path.insert(0, str(ROOT / "bench"))
import set_faults  # noqa: E402

CAMPAIGN = """\
name = "tiny"
device = "device.toml"
devices = 7
devices_per_file = 2
seed = 5

[tolerances]
"patches.offset_m" = { normal = { mean = 0, sigma = 10e-6 } }
"readout.quadrature_trim_deg_per_s" = { normal = { mean = 0, sigma = 50 } }

[[run]]
name = "rest"
scenario = "rest.toml"

[[run]]
name = "ramp"
scenario = "ramp.toml"
ambient_offset_K = { uniform = { low = -5, high = 5 } }
"""

SCENARIO = """\
name = "{name}"
device = "device.toml"
fidelity = "quasistatic"
duration_s = 60
output_rate_Hz = 2
seed = 1

[ambient]
{ambient}
"""


class Set(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("rest.toml", SCENARIO.format(name="rest",
                                                ambient="constant_degC = 25"))
        self.write("ramp.toml", SCENARIO.format(
            name="ramp", ambient="points = [[0, 0], [60, 10]]"))
        self.write("campaign.toml", CAMPAIGN)

    def contents(self, name):
        return set_faults.contents(self.dir / name)

    def generate(self, name, *arguments):
        return self.ok("generate", "campaign.toml", "-o", name, *arguments)
