# SPDX-License-Identifier: MIT
"""What the tests of `export` share: one small model of every kind, trained and
exported by the program, and the C compiler."""

import json

from program import CUBIC, ProgramTest, ended, ramp, said

# Rounding of a * b + c once instead of twice would change last bits.
WARNINGS = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow",
            "-Wconversion", "-Wdouble-promotion", "-Wfloat-conversion",
            "-Werror", "-ffp-contract=off"]

INPUTS = """\
inputs = ["temperature", "temperature_lowpass(100)", "temperature_rate(60)",
          "temperature_play(2)", "since_power_on(300)", "drive_frequency",
          "drive_voltage", "quadrature"]
"""

TRAINING = "restarts = 1\nmax_epochs = 30\nweight_decay = 1e-6\n"

MODELS = {
    "none": 'kind = "none"\n',
    "constant": 'kind = "constant"\n',
    "cubic": CUBIC,
    "slopes": 'kind = "polynomial"\n'
              'inputs = ["temperature", "temperature_rate(60)"]\n',
    "play": 'kind = "polynomial"\n'
            'inputs = ["temperature", "temperature_play(1)"]\n',
    "scaled": CUBIC,
    "table": 'kind = "table"\n',
    "spline": 'kind = "spline"\n',
    "px4": 'kind = "px4"\n',
    "ardupilot": 'kind = "ardupilot"\n[ardupilot]\nleast_samples = 10\n',
    "thermistor": 'kind = "thermistor"\n',
    "fuzzy": 'kind = "fuzzy"\ninputs = ["temperature", "drive_voltage"]\n'
             "[fuzzy]\nrules = 3\n",
    "radial_basis": 'kind = "radial_basis"\n'
                    'inputs = ["temperature", "drive_voltage"]\n'
                    "[radial_basis]\ncentres = 4\n",
    "resonances": 'kind = "resonances"\ninputs = ["temperature",'
                  ' "temperature_lowpass(100)", "quadrature_lowpass(10)"]\n'
                  "rows = { steady_K_per_min = 0.1 }\n",
    "network": f'kind = "bp"\n{INPUTS}[bp]\nhidden = [5, 3]\n{TRAINING}',
    "wide": 'kind = "bp"\ninputs = ["temperature"]\n'
            f"[bp]\nhidden = [12, 2]\n{TRAINING}",
    "3_8_1": 'kind = "bp"\ninputs = ["temperature", "temperature_lowpass(100)",'
             f' "temperature_lowpass(400)"]\n[bp]\nhidden = [8]\n{TRAINING}',
}

# Of the kind "scaled": a ramp never holds a temperature long enough to train it.
SCALE_FACTOR = {"temperatures_degC": [-20.0, 0.0, 30.0],
                "values": [0.98, 1.01, 1.03]}

# A ramp under a changing rate, with the power off for a while.
EVENTFUL = ramp(seed=3) + """
[power]
on_s = [0, 2100]
off_s = [1900]

[rate]
sine.amplitude_deg_per_s = 50
sine.frequency_Hz = 0.002
"""


# Three soaks and the ramps between them.
SOAKS = ramp(seconds=12000, seed=5).replace(
    "points = [[0, -30], [12000, 40]]",
    "points = [[0, -30], [3000, -30], [4500, 5], [7500, 5], [9000, 40]]")


def run_of(kind):
    """The run that a compensator of the kind is trained on."""
    return "soaks.h5" if kind == "resonances" else "train.h5"


class ExportTest(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("soaks", text=SOAKS)
        self.run_scenario("train", text=EVENTFUL)
        self.run_scenario("held_out", "--seed", 4, text=EVENTFUL)

    def train(self, kind):
        """File of a compensator of the kind."""
        model = self.write(f"{kind}.toml", MODELS[kind])
        self.ok("train", run_of(kind), "--held-out", "held_out.h5", "--model", model,
                "-o", f"{kind}.json", "--quiet")
        if kind == "scaled":
            stored = self.json("scaled.json")
            self.write("scaled.json", json.dumps(
                stored | {"scale_factor": SCALE_FACTOR}))
        return f"{kind}.json"

    def export(self, kind, *arguments, form="c"):
        """Directory of the exported files, called net."""
        self.ok("export", self.train(kind), "--format", form, "-o", kind,
                "--name", "net", "--quiet", *arguments)
        return self.dir / kind

    def compile(self, folder, *arguments, compiler="cc"):
        answer = ended(compiler, *arguments, cwd=folder)
        self.assertEqual(answer.stderr, "")

    def run_binary(self, *command, given="", status=0):
        return said(*command, input=given, allowed=(status,))
