# SPDX-License-Identifier: MIT
"""`device` of the shipped program: device files from figures of data sheets."""

import re
import tomllib

import numpy as np

from program import ROOT, SCENARIOS, ProgramTest
from rejections import Rejections, row

NOMINAL = tomllib.loads((SCENARIOS / "devices/nominal.toml").read_text())


class DeviceFromSheet(ProgramTest):
    def made(self, *words, name="made.toml", **options):
        """The device as TOML, and what the command said of its figures."""
        answer = self.ended("device", *words, "-o", name, **options)
        self.said, self.warnings = answer.stdout, answer.stderr
        return tomllib.loads(self.text(name))

    def steady(self, name="made.toml", temperatures="25"):
        self.ok("characterise", name, "--beam-temperature", temperatures, "-o",
                "steady.csv")
        return np.atleast_1d(np.genfromtxt(self.dir / "steady.csv",
                                           delimiter=",", names=True))

    def works(self, name="made.toml"):
        """`run`, `characterise` and `generate` take the file, without a word."""
        self.assertEqual(self.warned("characterise", name, "-o", "c.csv"), "")
        scenario = f"device = \"{name}\"\n" + \
            (SCENARIOS / "ten_minutes.toml").read_text().replace("device =", "# ")
        self.write("ten.toml", scenario)
        self.assertEqual(self.warned("run", "ten.toml", "-o", "ten.h5"), "")
        self.write("campaign.toml", f"""\
name = "made"
description = "a null within its limits"
device = "{name}"
seed = 1
devices = 2
devices_per_file = 2

[tolerances]
"readout.offset_trim_deg_per_s" = {{ normal = {{ mean = 0, sigma = 0.3 }} }}

[[run]]
name = "ten"
scenario = "ten.toml"
""")
        self.ok("generate", "campaign.toml", "-o", "set")

    def test_a_small_gyro_of_a_uav(self):
        """9 mm, Q 400, held by epoxy, 8 bits of temperature."""
        made = self.made("--length", "9e-3", "--quality", 400, "--mount", "epoxy",
                         "--bits", 8, "--temperature-degC=-20:60")
        self.assertEqual(self.warnings, "")
        steady, = self.steady()
        self.assertAlmostEqual(steady["q_drive"], 400, delta=4)
        # f ~ a/L^2: both by k, so 1/k.
        self.assertAlmostEqual(steady["drive_frequency_Hz"], 9083 / 0.225,
                               delta=0.003 * 40000)
        self.assertEqual(made["temperature_sensor"]["resolution_K"], 0.5)
        for key in ["offset_m", "thickness_m"]:
            table = "patches" if key == "offset_m" else "bond"
            np.testing.assert_allclose(made[table][key],
                                       0.225 * np.array(NOMINAL[table][key]))
        self.assertAlmostEqual(made["drive"]["amplitude_m"], 0.225e-6, delta=1e-12)
        # The bias drifts with the frequency: some 4 times that of the nominal
        # one, and not the 200 deg/s of a beam whose patches did not shrink.
        bias = self.steady(temperatures="-20:60:5")["bias_deg_per_s"]
        self.assertLess(np.ptp(bias), 40)
        self.works()

    def test_a_trimmed_gyro_of_a_published_sheet(self):
        sheet = tomllib.loads(
            (ROOT / "docs/hardware/xv7081bb.toml").read_text())["data_sheet"]
        made = self.made(
            "--like", SCENARIOS / "devices/trimmed.toml",
            "--frequency-Hz", 50e3, "--split-Hz", sheet["split_Hz"]["typical"],
            "--range-deg-per-s", sheet["full_scale_deg_per_s"],
            "--noise-deg-per-s-per-sqrt-Hz",
            sheet["noise_density_deg_per_s_per_sqrt_Hz"],
            "--walk-deg-per-sqrt-h", sheet["angle_random_walk_deg_per_sqrt_h"],
            "--null-deg-per-s", sheet["bias_at_25_degC_deg_per_s"],
            "--scale-tolerance-percent", sheet["scale_factor_tolerance_percent"],
            "--supply-V", sheet["supply_V"], "--current-A", sheet["supply_A"],
            "--resolution-K", 1 / sheet["temperature_output_LSB_per_K"],
            "--sensor-tolerance-K", sheet["temperature_output_degC"],
            "--bandwidth-Hz", 38, "--temperature-degC=-20:80")
        self.assertEqual(self.warnings, "")
        steady, = self.steady()
        self.assertAlmostEqual(steady["drive_frequency_Hz"], 50e3, delta=50)
        self.assertAlmostEqual(steady["split_Hz"], 900, delta=9)
        self.assertEqual(made["readout"]["full_scale_deg_per_s"], 400)
        self.assertEqual(made["readout"]["scale_factor_error"], 0.00666667)
        self.assertAlmostEqual(made["thermal"]["electronics_power_W"], 2.7e-3)
        self.assertEqual(self.said.count(" met"), 4)
        # The noise, once more, by `allan`.
        self.write("rest.toml", 'device = "made.toml"\n' + re.sub(
            "(?m)^device = .*", "", (SCENARIOS / "rest.toml").read_text()))
        self.ok("run", "rest.toml", "-o", "rest.h5", "--set", "seed=5")
        self.ok("allan", "rest.h5", "--from", 3600, "--json", "allan.json")
        deviation = self.json("allan.json")["oadev"]
        short = next(one for one in deviation if one["tau_s"] == 0.1)
        self.assertAlmostEqual(short["deviation"] * 0.1 ** 0.5,
                               0.0015 / 2 ** 0.5, delta=0.1 * 0.0015)
        self.works()

    def test_figures_of_the_nominal_unit_give_it_back(self):
        self.made(name="plain.toml")
        steady = self.steady(SCENARIOS / "devices/nominal.toml", "-40:60:10")
        self.assertEqual(self.steady("plain.toml", "-40:60:10").tolist(),
                         steady.tolist())
        nominal, = self.steady(SCENARIOS / "devices/nominal.toml")
        made = self.made(
            "--frequency-Hz", nominal["drive_frequency_Hz"], "--split-Hz",
            nominal["split_Hz"], "--quality", nominal["q_drive"],
            "--range-deg-per-s", 150, "--walk-deg-per-sqrt-h", 0.6, "--adc-bits",
            16, "--resolution-K", 0.05, "--supply-V", 5, "--power-W", 0.6,
            "--self-heating-K", 7.88)
        self.assertEqual(self.warnings, "")
        for table, keys in NOMINAL.items():
            for key, value in keys.items():
                if isinstance(value, str) or "noise" in table:
                    continue
                np.testing.assert_allclose(
                    made[table][key], value, rtol=0.02, atol=1e-12,
                    err_msg=f"{table}.{key}")

    def test_every_key_says_where_it_comes_from(self):
        self.made("--length", "9e-3", "--supply-V", 3.3)
        for line in self.text("made.toml").splitlines():
            if line and line[0] not in "[#":
                self.assertRegex(line, r" = .*   # \w+")
        self.assertIn("#   length = 0.009\n", self.text("made.toml"))

    def test_a_sheet_that_no_gyro_meets_says_by_how_much(self):
        """The sense mode of the nominal beam answers at 71 Hz."""
        self.made("--bandwidth-Hz", 38.6)
        self.assertIn("bandwidth", self.said)
        self.assertIn("NOT met", self.said)
        self.assertRegex(self.warnings, r"bandwidth: 38.6 Hz asked for, the device"
                                        r" has \d+\.\d+: \+\d+")
        self.assertIn("near the split of the modes", self.warnings)

    def test_warm_up_and_self_heating_are_those_of_the_sheet(self):
        self.made("--length", "9e-3", "--power-W", 0.05, "--self-heating-K", 5,
                  "--warm-up-s", 300)
        self.assertEqual(self.warnings, "")
        self.write("warm.toml", 'device = "made.toml"\n' + re.sub(
            "(?m)^device = .*", "", (SCENARIOS / "warm_up.toml").read_text()))
        self.ok("run", "warm.toml", "-o", "warm.h5")
        out = self.signals("warm.h5")
        T = out["true_sensor_temperature"]
        self.assertAlmostEqual(T[-1] - 25, 5, delta=0.05)
        late = out["time"][T < T[0] + 0.95 * (T[-1] - T[0])][-1]
        self.assertAlmostEqual(late, 300, delta=6)

    def test_same_bytes_again(self):
        words = ["--length", "9e-3", "--quality", 400, "--bandwidth-Hz", 50]
        self.made(*words, name="a.toml")
        self.made(*words, name="b.toml")
        self.assertSameBytes("a.toml", "b.toml")

    def test_a_high_quality_takes_the_loss_from_the_ceramic(self):
        made = self.made("--quality", 2000)
        self.assertLess(made["patches"]["mechanical_loss_factor"], 0.0133)
        steady, = self.steady()
        self.assertAlmostEqual(steady["q_drive"], 2000, delta=20)


class BadSheets(Rejections):
    table = [row(f"device {words} -o out.toml", *says) for words, *says in [
        ("--length 9", "--length", "0.0001"),
        ("--length 9e-3 --side 3e-3", "--side 0.003", "no beam"),
        ("--length 9e-3 --side 0.7e-3 --frequency-Hz 9e3", "--frequency-Hz 9000",
         "vibrates at"),
        ("--length 9e-3 --side 3e-5", "--side 3e-05", "no beam", "200 times"),
        ("--length 9e-3 --frequency-Hz 1e3", "--frequency-Hz 1000",
         "a length of 0.009 m", "more than 200 times", "a higher frequency"),
        ("--side 3e-4 --frequency-Hz 9e5", "--frequency-Hz 900000",
         "a side of 0.0003 m", "less than 5 times", "a lower frequency"),
        ("--frequency-Hz 3", "--frequency-Hz"),
        ("--frequency-Hz 9e3 --split-Hz 5e3", "--split-Hz", "a fifth"),
        ("--quality 400 --air-quality 300", "--quality 400", "--air-quality 300",
         "the gas alone"),
        ("--quality 1e5", "--quality 100000", "alone leave"),
        ("--quality 20 --air-quality 1e6", "--quality 20", "loss factor"),
        ("--quality 1", "--quality"),
        ("--mount glue", "--mount glue", "elastomer"),
        ("--range-deg-per-s 300 --full-scale-deg-per-s 200",
         "--range-deg-per-s 300", "--full-scale-deg-per-s 200"),
        ("--full-scale-deg-per-s 300 --scale-factor-V-per-deg-per-s 0.02 "
         "--supply-V 5", "--scale-factor-V-per-deg-per-s", "6 V", "--supply-V 5"),
        ("--null-deg-per-s 200 --range-deg-per-s 150", "--null-deg-per-s 200"),
        ("--noise-deg-per-s-per-sqrt-Hz 0.01 --walk-deg-per-sqrt-h 1",
         "0.4243 deg/sqrt(h)", "--walk-deg-per-sqrt-h 1"),
        ("--noise-deg-per-s-per-sqrt-Hz -1", "--noise-deg-per-s-per-sqrt-Hz"),
        ("--bandwidth-Hz 5000", "--bandwidth-Hz"),
        ("--bandwidth-Hz 60 --split-Hz 100", "--bandwidth-Hz 60", "half of the"),
        ("--bits 8 --resolution-K 0.1", "--bits 8", "0.5 K",
         "--resolution-K 0.1"),
        ("--bits 1", "--bits", "2 to 32"),
        ("--adc-bits 40", "--adc-bits"),
        ("--bits 8 --sensor-range-degC 0:50 --temperature-degC=-20:60",
         "--sensor-range-degC 0:50", "-20 to 60 degC"),
        ("--sensor-range-degC 0:50", "--bits"),
        ("--current-A 0.01", "--current-A 0.01", "--supply-V"),
        ("--current-A 0.01 --supply-V 5 --power-W 1", "0.05 W", "--power-W 1"),
        ("--temperature-degC 60:-20", "--temperature-degC"),
        ("--scale-tolerance-percent 80", "--scale-tolerance-percent"),
        ("--like gone.toml", "gone.toml"),
        ("--like lines.toml", "lines.toml:", "several lines"),
        ("--like off.toml --self-heating-K 5", "--self-heating-K 5", "--power-W"),
        ("--like off.toml --warm-up-s 500", "--warm-up-s 500", "--power-W"),
        ("--bits eight", "--bits"),
    ]] + [row("device --length 9e-3", "--output"),
          row("device --length 9e-3 -o out.txt", "out.txt", ".toml"),
          row("device --like device.toml -o device.toml", "device.toml",
              "is read by this command")]

    def prepare(self):
        super().prepare()
        text = self.text("device.toml")
        self.write("lines.toml", text.replace("14e-6, -5e-6", "14e-6,\n  -5e-6"))
        self.write("off.toml", re.sub("(?m)^electronics_power_W = .*",
                                      "electronics_power_W = 0", text))
