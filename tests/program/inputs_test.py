# SPDX-License-Identifier: MIT
"""No command writes over a file that it reads, under whatever name."""

import os
import shutil
import unittest

from program import CUBIC, SCENARIO, ramp
from sets import CAMPAIGN, SCENARIO as SHORT, Set

POPULATION = """\
kind = "population"
inputs = ["temperature", "quadrature"]

[population]
grid_K = 5
"""

ADAPTED = """\
kind = "adapted"
population = "population.json"
"""

MAP = """\
[time]
column = "t"
unit = "s"
[gyro]
column = "w"
unit = "deg/s"
[temperature]
column = "T"
unit = "degC"
[true_rate]
at_rest = true
"""


class Inputs(Set):
    def protects(self, command, *inputs, suffix=".h5"):
        """`command` has OUT where its output goes."""
        for given in inputs:
            for make in [os.symlink, os.link]:
                with self.subTest(command=command[0], given=given,
                                  make=make.__name__):
                    out = self.dir / f"out{suffix}"
                    make(self.dir / given, out)
                    self.refuses(command, out.name)
                    out.unlink()
            if given.endswith(suffix):
                with self.subTest(command=command[0], given=given):
                    self.refuses(command, given)

    def refuses(self, command, out):
        self.rejected(*[out if word == "OUT" else word for word in command],
                      says="is read by this command")

    def test_run(self):
        self.write("profile.csv", "time_s,rate_deg_per_s\n0,0\n600,1\n")
        self.write("ambient.csv", "time_s,temperature_degC\n0,20\n600,30\n")
        self.write("s.toml", SCENARIO.replace(
            "constant_degC = 25", 'file = "ambient.csv"') +
            '\n[rate]\nfile = "profile.csv"\n')
        self.protects(["run", "s.toml", "-o", "OUT"], "s.toml", "device.toml",
                      "profile.csv", "ambient.csv", suffix=".csv")

    def test_a_profile_named_on_the_command_line(self):
        self.write("other.csv", "time_s,rate_deg_per_s\n0,0\n600,1\n")
        self.write("s.toml", SCENARIO)
        self.protects(["run", "s.toml", "--set", 'rate.file="other.csv"', "-o",
                       "OUT"], "other.csv", suffix=".csv")

    def test_characterise(self):
        self.protects(["characterise", "device.toml", "-o", "OUT"],
                      "device.toml", suffix=".toml")

    def test_import(self):
        self.write("map.toml", MAP)
        self.write("log.csv", "t,w,T\n" + "".join(
            f"{k},0.1,{20 + k % 3}\n" for k in range(100)))
        self.protects(["import", "log.csv", "--map", "map.toml", "-o", "OUT"],
                      "map.toml", "log.csv", suffix=".csv")

    def test_recordings_and_compensators(self):
        for seed, name in enumerate(["a", "b"]):
            self.run_scenario(name, text=ramp(seed=seed))
        self.write("model.toml", CUBIC)
        train = ["train", "a.h5", "--held-out", "b.h5", "--model",
                 "model.toml", "-o", "OUT"]
        self.protects(train, "a.h5", "b.h5", "model.toml")
        self.ok(*[word.replace("OUT", "c.json") for word in train])
        self.protects(["compensate", "c.json", "a.h5", "-o", "OUT"], "c.json",
                      "a.h5")
        self.protects(["validate", "c.json", "a.h5", "b.h5", "--json", "OUT"],
                      "c.json", "a.h5", "b.h5")
        self.protects(["allan", "a.h5", "--json", "OUT"], "a.h5")

    def test_exported_files(self):
        self.run_scenario("a", text=ramp())
        self.write("model.toml", CUBIC)
        self.ok("train", "a.h5", "--model", "model.toml", "-o", "c.json")
        for name in ["c.h", "c.c", "c_selftest.c", "c_plugin.c"]:
            (self.dir / "c").mkdir()
            os.link(self.dir / "c.json", self.dir / "c" / name)
            self.rejected("export", "c.json", "--format", "c", "-o", "c",
                          says=[name, "is read by this command"])
            shutil.rmtree(self.dir / "c")

    def test_sets_and_the_population_of_a_model(self):
        self.write("campaign.toml", CAMPAIGN.replace(
            "devices = 7", "devices = 12") +
            '[split]\ntrain = 0.7\nvalidation = 0.15\ntest = 0.15\n')
        for name in ["rest", "ramp"]:
            self.write(f"{name}.toml", SHORT.format(
                name=name, ambient="points = [[0, -30], [3000, 40]]").replace(
                    "duration_s = 60", "duration_s = 3000").replace(
                        "output_rate_Hz = 2", "output_rate_Hz = 0.1"))
        self.generate("set")
        files = [str(path.relative_to(self.dir))
                 for path in sorted((self.dir / "set").rglob("*"))
                 if path.is_file()]
        self.assertIn("set/manifest.jsonl", files)
        self.assertIn("set/source/device.toml", files)
        self.write("model.toml", CUBIC)
        self.protects(["train", "set", "--model", "model.toml", "-o", "OUT"],
                      *files)
        self.ok("train", "set", "--model", "model.toml", "-o", "c.json")
        self.protects(["validate", "c.json", "set", "--json", "OUT"],
                      "set/manifest.jsonl", "set/rest_00000.h5",
                      "set/source/head.jsonl", "c.json", suffix=".jsonl")
        self.write("population.toml", POPULATION)
        self.ok("train", "set", "--model", "population.toml", "-o",
                "population.json")
        self.write("adapted.toml", ADAPTED)
        self.protects(["train", "set", "--device", 3, "--model",
                       "adapted.toml", "-o", "OUT"], "population.json",
                      "adapted.toml", suffix=".json")

    def test_generate(self):
        """A campaign that lies in the directory of its own set."""
        (self.dir / "set").mkdir()
        for name in ["set/rest.nc", "set/rest_00000.h5", "set/manifest.jsonl",
                     "set/set.lock"]:
            with self.subTest(name):
                os.link(self.dir / "device.toml", self.dir / name)
                self.rejected("generate", "campaign.toml", "-o", "set",
                              "--resume", says="is read by this command")
                (self.dir / name).unlink()
        for name in ["campaign.toml", "rest.toml", "ramp.toml", "device.toml"]:
            shutil.copy(self.dir / name, self.dir / "set" / name)
        self.ok("generate", "set/campaign.toml", "-o", "set")
        self.ok("generate", "set/source/campaign.toml", "-o", "set",
                "--resume")


if __name__ == "__main__":
    unittest.main()
