# SPDX-License-Identifier: MIT
"""Values in another unit than the key names, and a device that is not there."""

import unittest

from program import SCENARIO, ProgramTest


class Units(ProgramTest):
    def refused(self, change, *says):
        self.write("s.toml", SCENARIO)
        key = change.partition("=")[0]
        self.rejected("run", "s.toml", "-o", "a.h5", "--set", change,
                      says=[f"{key}: ", "expected a number in", *says])
        value = change.partition("=")[2]
        text = (self.dir / "device.toml").read_text()
        table, name = key.split(".")
        lines = text.splitlines()
        number = next(k for k, line in enumerate(lines)
                      if line.startswith(f"[{table}]"))
        while not lines[number].startswith(f"{name} ="):
            number += 1
        lines[number] = f"{name} = {value}"
        self.write("other.toml", "\n".join(lines))
        self.rejected("characterise", "other.toml", "-o", "c.csv",
                      says=[f"other.toml:{number + 1}:", f"{key}: ", *says])

    def test_millimetres_are_no_metres(self):
        self.refused("beam.length_m=40", "[0.0001, 0.5]", "40 mm is 0.04 m")
        self.refused("beam.side_m=3.0", "3 mm is 0.003 m")
        self.refused("patches.thickness_m=0.25", "0.25 mm is 0.00025 m")
        self.refused("patches.length_m=12", "12 mm is 0.012 m")

    def test_gigapascals_are_no_pascals(self):
        self.refused("beam.youngs_modulus_Pa=185", "185 GPa is 1.85e+11 Pa")
        self.refused("patches.youngs_modulus_Pa=61", "61 GPa is 6.1e+10 Pa")
        self.refused("bond.shear_modulus_Pa=1.5", "1.5 GPa is 1.5e+09 Pa")
        self.refused("bond.beta_step_Pa=0.45", "0.45 GPa is 4.5e+08 Pa")
        self.refused("bond.alpha_step_Pa=1000", "1000 MPa is 1e+09 Pa")

    def test_a_bond_may_have_no_step(self):
        self.write("s.toml", SCENARIO)
        self.ok("run", "s.toml", "-o", "a.h5", "--set", "bond.beta_step_Pa=0",
                "--set", "bond.alpha_step_Pa=0.0")

    def test_grams_a_cubic_centimetre_are_no_kilograms_a_cubic_metre(self):
        self.refused("beam.density_kg_per_m3=8.05", "8.05 g/cm3 is 8050 kg/m3")
        self.refused("patches.density_kg_per_m3=7.75",
                     "7.75 g/cm3 is 7750 kg/m3")

    def test_other_units(self):
        self.refused("readout.feedback_capacitance_F=100",
                     "100 pF is 1e-10 F")
        self.refused("patches.d31_C_per_N=-171", "-171 pC/N is -1.71e-10 C/N")
        self.refused("bond.beta_activation_J_per_mol=65",
                     "65 kJ/mol is 65000 J/mol")

    def test_a_power_that_no_gyro_has(self):
        self.refused("thermal.electronics_power_W=6e8", "[0, 1000]")


class Device(ProgramTest):
    def test_a_missing_device_is_reported_in_the_line_of_the_scenario(self):
        text = SCENARIO.replace("device.toml", "gone.toml")
        line = text.splitlines().index('device = "gone.toml"') + 1
        self.write("s.toml", text)
        self.rejected("run", "s.toml", "-o", "a.h5",
                      says=[f"s.toml:{line}:10: device: ", "gone.toml",
                            "relative to the scenario"])
        self.write("scenario.toml", SCENARIO)
        self.rejected("run", "scenario.toml", "-o", "a.h5", "--set",
                      'device="gone.toml"', says=["--set device=", "gone.toml"])


if __name__ == "__main__":
    unittest.main()
