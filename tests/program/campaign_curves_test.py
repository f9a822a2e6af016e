# SPDX-License-Identifier: MIT
"""`characterise` of a campaign: curves, their figures, and bad input."""

import csv

import h5py
import numpy as np

from program import SCENARIOS, ProgramTest
from rejections import Rejections, row

CAMPAIGN = """\
name = "few"
device = "device.toml"
devices = 5
seed = 4

[tolerances]
"mount.axis_angle_deg" = {{ normal = {{ mean = 0, sigma = 2.5 }} }}
"bond.thickness_m" = {{ normal = {{ mean = 30e-6, sigma = {sigma} }} }}

[[run]]
name = "rest"
scenario = "rest.toml"
"""
REST = """\
name = "rest"
device = "device.toml"
fidelity = "quasistatic"
duration_s = 10
output_rate_Hz = 1
seed = 1
[ambient]
constant_degC = 25
"""
GRID = ("--beam-temperature", "-20:50:0.5")
COLUMNS = ["bias", "in_phase", "quadrature", "drive_frequency", "split",
           "q_drive", "q_sense", "drive_voltage", "scale_factor"]


def files(test, sigma=2e-6):
    test.write("few.toml", CAMPAIGN.format(sigma=sigma))
    test.write("rest.toml", REST)


class Curves(ProgramTest):
    def prepare(self):
        super().prepare()
        files(self)

    def curves(self, name="c.csv", *options):
        """The temperatures and a row each device, and what was printed."""
        text = self.ok("characterise", "few.toml", "-o", name, *options)
        header, *lines = csv.reader(self.text(name).splitlines())
        values = np.array(lines, dtype=float)
        return header, values[:, 0], values[:, 1:].T, text

    def test_a_column_for_each_device_and_a_row_for_each_temperature(self):
        header, T, bias, _ = self.curves("c.csv", *GRID)
        self.assertEqual(header, ["temperature_degC", *(
            f"device_{k}_bias_deg_per_s" for k in range(5))])
        np.testing.assert_array_equal(T, np.arange(-20, 50.5, 0.5))
        self.assertEqual(len(np.unique(bias.round(9), axis=0)), 5)

    def test_a_device_is_the_same_whatever_their_number(self):
        _, _, five, _ = self.curves("c.csv", *GRID)
        _, _, two, _ = self.curves("d.csv", *GRID, "--devices", 2)
        np.testing.assert_array_equal(five[:2], two)

    def test_the_same_bytes_with_any_number_of_threads(self):
        for name in ("csv", "h5"):
            for jobs in (1, 2, 3):
                self.ok("characterise", "few.toml", *GRID, "--jobs", jobs,
                        "-o", f"{jobs}.{name}", "--json", f"{jobs}.json")
            for jobs in (2, 3):
                self.assertSameBytes(f"1.{name}", f"{jobs}.{name}")
                self.assertSameBytes("1.json", f"{jobs}.json")

    def test_a_device_without_tolerances_is_the_device_alone(self):
        self.write("few.toml", CAMPAIGN.format(sigma=1e-30).replace(
            "sigma = 2.5", "sigma = 1e-30").replace(
            "mean = 0,", "mean = 5.0,"))
        _, _, bias, _ = self.curves("c.csv", *GRID)
        self.ok("characterise", "device.toml", *GRID, "-o", "one.csv", "--set",
                "mount.axis_angle_deg=5.0", "--set",
                "bond.thickness_m=[30e-6,30e-6,30e-6,30e-6]")
        one = [float(line["bias_deg_per_s"]) for line in csv.DictReader(
            self.text("one.csv").splitlines())]
        for device in bias:
            np.testing.assert_allclose(device, one, rtol=0, atol=1e-10)

    def test_hdf5_has_all_columns_of_each_device(self):
        _, T, bias, _ = self.curves("c.csv", *GRID)
        self.ok("characterise", "few.toml", *GRID, "-o", "c.h5")
        with h5py.File(self.dir / "c.h5") as file:
            self.assertEqual(file.attrs["filetype"], b"beamgyro-curves")
            self.assertEqual(file.attrs["seed"], 4)
            self.assertEqual({*file}, {
                "device", "temperature", *COLUMNS, "meta"})
            np.testing.assert_array_equal(file["temperature"], T)
            np.testing.assert_array_equal(file["device"], range(5))
            np.testing.assert_allclose(file["bias"], bias, rtol=1e-11)
            for name in COLUMNS:
                self.assertEqual([d[0].name for d in file[name].dims],
                                 ["/device", "/temperature"])
                self.assertIn("long_name", file[name].attrs)
            self.assertEqual(file["meta/campaign"][()].decode(),
                             self.text("few.toml"))
            self.assertEqual(file["meta/device"][()].decode(),
                             self.text("device.toml"))

    def test_figures_are_those_of_another_implementation(self):
        _, T, bias, text = self.curves(
            "c.csv", "--range", "-20:50", "--zero-at", "25.1", "--round",
            "0.0074", "--json", "f.json", "--beam-temperature", "-30:60:0.5")
        bias = bias - [[np.interp(25.1, T, one)] for one in bias]
        kept = (T >= -20) & (T <= 50)
        T, bias = T[kept], np.round(bias[:, kept] / 0.0074) * 0.0074
        found = self.json("f.json")
        self.assertEqual(found["units"], [*range(5)])
        self.assertEqual(found["range_degC"], [-20, 50])
        self.assertEqual(found["temperatures"], 141)

        def values(name):
            return found["figures"][name]["values"]
        peaks = np.ptp(bias, axis=1)
        np.testing.assert_allclose(values("pp_deg_per_s"), peaks, rtol=1e-9)
        for name, degree in [("line", 1), ("cubic", 3), ("quintic", 5)]:
            left = [np.var(one - np.polyval(np.polyfit(T / 50, one, degree),
                                            T / 50)) / np.var(one)
                    for one in bias]
            np.testing.assert_allclose(values(f"left_by_{name}"), left,
                                       rtol=1e-7)
        bends = np.abs(bias[:, 12:] - 2 * bias[:, 6:-6] + bias[:, :-12])
        np.testing.assert_allclose(values("kink"), bends.max(1) / peaks,
                                   rtol=1e-9)
        centred = bias - bias.mean(1, keepdims=True)
        self.assertAlmostEqual(
            found["mean_curve_share"],
            5 * (centred.mean(0) ** 2).sum() / (centred ** 2).sum(), 9)
        sizes = np.linalg.svd(centred - centred.mean(0))[1] ** 2
        np.testing.assert_allclose(found["component_shares"],
                                   (sizes / sizes.sum())[:5], atol=1e-9)
        self.assertAlmostEqual(found["pp_log10_sigma"],
                               np.log10(peaks).std(ddof=1), 9)
        self.assertIn("few: 5 units, -20 to 50 degC, 141 temperatures, zero at "
                      "25.1 degC, rounded to 0.0074 deg/s", text)
        self.assertIn(f"{np.median(peaks):.3g}", text)

    def test_few_temperatures_have_no_figures(self):
        _, T, bias, text = self.curves("c.csv", "--beam-temperature", "25")
        self.assertEqual((text, bias.shape), ("", (5, 1)))
        _, T, _, text = self.curves("c.csv", "--beam-temperature", "50:0:-5")
        self.assertEqual((text, T[0]), ("", 50))

    def test_devices_that_do_not_work_are_left_out_and_named(self):
        files(self, sigma=15e-6)
        answer = self.ended("characterise", "few.toml", "--devices", 40,
                            "--beam-temperature", "0:10:5", "-o", "c.csv")
        self.assertRegex(answer.stderr, r"few: \d+ of 40 devices do not work "
                         r"and are left out; device \d+: .*bond.thickness_m")
        header = self.text("c.csv").splitlines()[0]
        self.assertLess(header.count(","), 40)
        self.ok("characterise", "few.toml", "--devices", 40,
                "--beam-temperature", "0:10:5", "-o", "c.h5")
        with h5py.File(self.dir / "c.h5") as file:
            self.assertEqual(",".join(f"device_{k}_bias_deg_per_s"
                                      for k in file["device"]),
                             header.partition(",")[2])

    def test_no_device_that_works_is_a_failure(self):
        self.write("few.toml", CAMPAIGN.format(sigma=1e-9).replace(
            "30e-6", "-30e-6"))
        answer = self.ended("characterise", "few.toml", *GRID, "-o", "c.csv",
                            allowed=(1, 2))
        self.assertIn("bond.thickness_m", answer.stderr)
        self.assertFalse((self.dir / "c.csv").exists())

    def test_shipped_campaigns_have_curves(self):
        for path in sorted((SCENARIOS / "campaigns").glob("*.toml")):
            self.ok("characterise", path, "--devices", 3, "--json", "f.json",
                    "--beam-temperature", "-20:50:5", "-o", "c.csv")
            self.assertEqual(self.json("f.json")["units"], [0, 1, 2])


class RefusedCurves(Rejections):
    table = [
        row("characterise few.toml -o c.txt", "c.txt", ".csv or .h5"),
        row("characterise few.toml -o few.toml", ".csv or .h5"),
        row("characterise few.toml -o nowhere/c.h5", "nowhere"),
        row("characterise few.toml -o c.csv --set beam.length_m=0.04",
            "--set beam.length_m=0.04", "is a campaign"),
        row("characterise few.toml -o c.csv --devices 0", "--devices 0"),
        row("characterise few.toml -o c.csv --jobs 0", "--jobs 0"),
        row("characterise few.toml -o c.csv --range 20:21", "--range 20:21",
            "temperatures", "expected 8 or more",
            files={"c.csv": "before"}),
        row("characterise few.toml -o c.csv --range 30:20", "--range 30:20",
            "LOW below HIGH"),
        row("characterise few.toml -o c.csv --range 30", "--range 30"),
        row("characterise few.toml -o c.csv --zero-at 70", "--zero-at 70",
            "-40 to 60 degC"),
        row("characterise few.toml -o c.csv --round 0", "--round 0"),
        row("characterise few.toml -o c.csv --json f.csv", "f.csv"),
        row("characterise few.toml -o c.csv --json f.json "
            "--beam-temperature 25", "1 temperatures", "8 or more"),
        row("characterise few.toml -o c.csv --round 0.1 "
            "--beam-temperature 50:0:-1", "temperatures that increase"),
        row("characterise few.toml -o c.csv --devices 100000000 "
            "--beam-temperature 25:26:1", "at most 10000000 in all"),
        row("characterise few.toml -o c.csv --beam-temperature 20:200:10",
            "160 degC"),
        *[row(f"characterise device.toml -o c.csv {option}",
              f"{option.split()[0]}: device.toml is a device file", "campaign")
          for option in ("--devices 3", "--jobs 2", "--range 0:50",
                         "--zero-at 25", "--round 0.1", "--json f.json")],
        row("characterise rest.toml -o c.csv", "is a scenario",
            "a device file or a campaign"),
        row("characterise bad.toml -o c.csv", "bad.toml:6:", "mount.axis",
            files={"bad.toml": CAMPAIGN.format(sigma=1e-6).replace(
                "axis_angle_deg", "axis_angel_deg").replace("\n\n", "\n", 1)}),
    ]

    def prepare(self):
        super().prepare()
        files(self)
