# SPDX-License-Identifier: MIT
"""What the tests of sets share: a campaign of seven devices in two runs."""

import hashlib
import json
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


def write_campaign(test, devices=7, seconds=60, rate_Hz=2, **ambients):
    """The campaign and its scenarios in the folder of a test."""
    for name, ambient in ({"rest": "constant_degC = 25",
                           "ramp": "points = [[0, 0], [60, 10]]"}
                          | ambients).items():
        test.write(f"{name}.toml", SCENARIO.format(name=name, ambient=ambient)
                   .replace("= 60\n", f"= {seconds}\n")
                   .replace("= 2\n", f"= {rate_Hz}\n"))
    test.write("campaign.toml",
               CAMPAIGN.replace("devices = 7", f"devices = {devices}"))


def manifest_line(record):
    """One of a manifest, with its checksum."""
    record.pop("check", None)
    body = json.dumps(record, separators=(",", ":"),
                      ensure_ascii=False).encode()[:-1]
    check = hashlib.sha256(body).hexdigest()[:16]
    return body + b',"check":"' + check.encode() + b'"}\n'


class Set(ProgramTest):
    def prepare(self):
        super().prepare()
        write_campaign(self)

    def contents(self, name):
        return set_faults.contents(self.dir / name)

    def manifest(self, name):
        """Its lines."""
        return [json.loads(line) for line in
                self.text(f"{name}/manifest.jsonl").splitlines()]

    def generate(self, name, *arguments):
        return self.ok("generate", "campaign.toml", "-o", name, *arguments)
