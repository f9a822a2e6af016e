# SPDX-License-Identifier: MIT
"""Training that cannot work names its cause."""

import shutil
import unittest

import h5py

from program import CUBIC, NETWORK, ProgramTest, ramp


class Training(ProgramTest):
    def setUp(self):
        super().setUp()
        self.run_scenario("run", text=ramp())
        self.run_scenario("held_out", text=ramp(seed=9))

    def test_rows_that_are_too_long(self):
        for model in [CUBIC, NETWORK]:
            with self.subTest(model):
                self.write("m.toml", model + "[rows]\nseconds = 100000\n")
                self.rejected("train", "run.h5", "--model", "m.toml",
                              "--held-out", "held_out.h5", "-o", "c.json",
                              says=["1 rows", "100000 s", "rows.seconds"])

    def test_a_network_larger_than_its_data(self):
        self.write("m.toml", NETWORK.replace("[2]", "[1000]")
                   + "[rows]\nseconds = 16\n")
        self.rejected("train", "run.h5", "--model", "m.toml", "--held-out",
                      "held_out.h5", "-o", "c.json",
                      says=["hidden = [1000]", "3001 weights",
                            "250 training rows"])

    def test_a_number_that_overflows(self):
        self.write("m.toml", CUBIC)
        self.ok("train", "run.h5", "--model", "m.toml", "-o", "c.json")
        for name in ["rate", "temperature", "output"]:
            shutil.copy(self.dir / "run.h5", self.dir / "big.h5")
            with h5py.File(self.dir / "big.h5", "a") as file:
                file[name][50] = 1e300
            for command in [
                    ["train", "big.h5", "--model", "m.toml", "-o", "d.json"],
                    ["compensate", "c.json", "big.h5", "-o", "o.h5"],
                    ["validate", "c.json", "big.h5"],
                    ["allan", "big.h5"], ["info", "big.h5"]]:
                with self.subTest(f"{command[0]} {name}"):
                    self.rejected(*command, says=[
                        "big.h5", f"{name}: sample 50 is 1e+300"])


if __name__ == "__main__":
    unittest.main()
