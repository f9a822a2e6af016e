# SPDX-License-Identifier: MIT
"""Files of another kind than the command takes."""

import shutil
import unittest

from program import CUBIC, SCENARIO, SCENARIOS, ProgramTest, ramp
from sets import CAMPAIGN
from sets import SCENARIO as REST


class Kinds(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scenario.toml", SCENARIO)
        self.write("model.toml", CUBIC)
        self.write("campaign.toml", CAMPAIGN)
        for name in ["rest", "ramp"]:
            self.write(f"{name}.toml", REST.format(
                name=name, ambient="constant_degC = 25"))
        shutil.copy(SCENARIOS / "maps/example.toml", self.dir / "map.toml")
        self.ok("run", "scenario.toml", "-o", "run.csv")
        self.run_scenario("run", text=ramp())
        self.ok("train", "run.h5", "--model", "model.toml", "-o", "c.json")
        self.ok("generate", "campaign.toml", "-o", "set", "--devices", 2)
        self.ok("characterise", "device.toml", "-o", "table.csv",
                "--beam-temperature", "0:1:1")

    def named(self, file, command, *says):
        words = {
            "run": ["run", file, "-o", "o.h5"],
            "characterise": ["characterise", file, "-o", "o.csv"],
            "generate": ["generate", file, "-o", "o"],
            "model": ["train", "run.h5", "--model", file, "-o", "o.json"],
            "train": ["train", file, "--model", "model.toml", "-o", "o.json"],
            "log": ["import", file, "--map", "map.toml", "-o", "o.h5"],
            "map": ["import", "table.csv", "--map", file, "-o", "o.h5"],
            "compensator": ["compensate", file, "run.h5", "-o", "o.h5"],
            "compensate": ["compensate", "c.json", file, "-o", "o.h5"],
            "validate": ["validate", "c.json", file],
            "export": ["export", file, "--format", "c", "-o", "o"],
            "allan": ["allan", file], "info": ["info", file],
            "verify": ["verify", file]}[command]
        with self.subTest(f"{command} {file}"):
            self.rejected(*words, says=[f"{file}: is ", *says])

    def test_every_kind_is_named_with_the_command_that_takes_it(self):
        kinds = {"device.toml": ("a device file", "beamgyro characterise"),
                 "scenario.toml": ("a scenario", "beamgyro run"),
                 "campaign.toml": ("a campaign", "beamgyro generate"),
                 "model.toml": ("a model file", "beamgyro train --model"),
                 "map.toml": ("a log map", "beamgyro import --map"),
                 "run.h5": ("a recording", "beamgyro info"),
                 "run.csv": ("a recording as CSV", "beamgyro info"),
                 "set": ("the directory of a set", "beamgyro info"),
                 "set/rest_00000.h5": ("a file of a set", "beamgyro info"),
                 "c.json": ("a compensator", "beamgyro compensate"),
                 "table.csv": ("a table that characterise wrote", "")}
        takes = {"run": {"scenario.toml"}, "characterise": {"device.toml"},
                 "generate": {"campaign.toml"}, "model": {"model.toml"},
                 "log": {"run.csv", "table.csv"}, "allan": {
                     "run.h5", "run.csv", "table.csv"},
                 "map": {"map.toml"}, "train": {"run.h5", "run.csv", "set"},
                 "compensator": {"c.json"}, "export": {"c.json"},
                 "compensate": {"run.h5", "run.csv"},
                 "validate": {"run.h5", "run.csv", "set"},
                 "info": {"run.h5", "run.csv", "set", "set/rest_00000.h5"},
                 "verify": {"set"}}
        self.assertTrue((self.dir / "set/rest_00000.h5").exists(),
                        sorted(self.files()))
        for command, taken in takes.items():
            for file, says in kinds.items():
                if file not in taken:
                    self.named(file, command, *says)


if __name__ == "__main__":
    unittest.main()
