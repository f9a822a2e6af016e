# SPDX-License-Identifier: MIT
"""`beamgyro characterise`: the CSV and the figures it must hold."""

import csv
import io

from program import ProgramTest

HEADER = ("temperature_degC,bias_deg_per_s,in_phase_deg_per_s,"
          "quadrature_deg_per_s,drive_frequency_Hz,split_Hz,q_drive,q_sense,"
          "drive_voltage_V,scale_factor_rel")

# Bias [deg/s] over the temperature of the beam [degC] of the nominal unit with
# an angular gain of 1 (docs/model.md, table 3.2).
BIAS = {-40: 3.88, -30: 3.67, -20: 4.33, -10: 3.53, 0: 1.77, 10: 0.77,
        25: 0.50, 40: 0.96, 50: 1.02, 60: -3.1}
# Half a unit of the last digit the table gives.
ROUNDING = {60: 0.05}


class Characterise(ProgramTest):
    def rows(self, *arguments):
        self.ok("characterise", "device.toml", "-o", "out.csv", *arguments)
        text = self.text("out.csv")
        return [{key: float(value) for key, value in row.items()}
                for row in csv.DictReader(io.StringIO(text))]

    def test_header_and_one_row_per_temperature(self):
        rows = self.rows("--beam-temperature", "-40:60:0.25")
        self.assertEqual(self.text("out.csv").splitlines()[0], HEADER)
        self.assertEqual([row["temperature_degC"] for row in rows],
                         [-40 + 0.25 * k for k in range(401)])

    def test_default_is_the_same_range(self):
        self.assertEqual(self.rows(),
                         self.rows("--beam-temperature", "-40:60:0.25"))

    def test_single_temperature(self):
        (row,) = self.rows("--beam-temperature", "25")
        self.assertEqual(row["temperature_degC"], 25)
        self.assertAlmostEqual(row["scale_factor_rel"], 1, delta=1e-9)

    def test_nine_digits(self):
        self.rows("--beam-temperature", "-31.7")
        text = self.text("out.csv").splitlines()[1]
        for value in text.split(",")[1:]:
            digits = value.lower().split("e")[0].replace("-", "") \
                .replace(".", "").lstrip("0")
            self.assertGreaterEqual(len(digits), 9, text)

    def test_bias_of_the_nominal_unit(self):
        rows = {row["temperature_degC"]: row for row in self.rows(
            "--set", "beam.angular_gain=1", "--beam-temperature", "-40:60:5")}
        for temperature, bias in BIAS.items():
            self.assertAlmostEqual(
                rows[temperature]["bias_deg_per_s"], bias,
                delta=0.02 + ROUNDING.get(temperature, 0.005))
        nominal = rows[25]
        self.assertAlmostEqual(nominal["drive_frequency_Hz"], 9081.50,
                               delta=0.02 + 0.005)
        self.assertAlmostEqual(nominal["q_drive"], 763, delta=0.005 * 763)
        self.assertAlmostEqual(nominal["q_sense"], 760, delta=0.005 * 760)
        self.assertAlmostEqual(nominal["split_Hz"], 70.91, delta=0.02)

    def test_trims_hold_after_a_change_of_the_device(self):
        for change in [[], ["--set", "beam.length_m=0.038"],
                       ["--set", "patches.offset_m=[20e-6,1e-6,-4e-6,0.0]"]]:
            (row,) = self.rows("--beam-temperature", "25", *change)
            self.assertAlmostEqual(row["bias_deg_per_s"], 0.5, delta=1e-6)
            self.assertAlmostEqual(row["quadrature_deg_per_s"], 40, delta=1e-6)

    def test_temperatures_where_it_does_not_work_are_told(self):
        self.assertEqual(
            self.warned("characterise", "device.toml", "-o", "a.csv"), "")
        for key, says in [
                ("drive.voltage_limit_V=0.015", "at 401 of 401 temperatures the "
                 "drive needs more than drive.voltage_limit_V = 0.015"),
                ("readout.full_scale_deg_per_s=1", "temperatures the bias is "
                 "beyond readout.full_scale_deg_per_s = 1")]:
            self.assertIn(says, self.warned("characterise", "device.toml",
                                            "--set", key, "-o", "a.csv"))

    def test_same_bytes_again(self):
        self.ok("characterise", "device.toml", "-o", "a.csv")
        self.ok("characterise", "device.toml", "-o", "b.csv")
        self.assertSameBytes("a.csv", "b.csv")

    def test_temperatures_beyond_the_linear_range_of_the_ceramic(self):
        for grid, warns in [("-40:80:20", False), ("-41", True),
                            ("70:90:10", True)]:
            answer = self.ended("characterise", "device.toml", "-o", "c.csv",
                                "--beam-temperature", grid)
            self.assertEqual("beyond -40 to 80 degC the ceramic's coefficients"
                             in answer.stderr, warns, grid)
