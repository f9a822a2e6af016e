# SPDX-License-Identifier: MIT
"""What `run`, `generate` and `verify` say about work that is of no use."""

import re
import unittest

import numpy as np

from program import SCENARIO, SCENARIOS, SHIPPED_SCENARIOS, ProgramTest
from sets import CAMPAIGN, Set


class Run(ProgramTest):
    def warnings(self, *arguments, text=SCENARIO):
        """The lines that a run prints besides its recording."""
        scenario = self.write("s.toml", text)
        answer = self.beamgyro("run", scenario, "-o", "s.h5", *arguments)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(answer.stdout, "")
        return answer.stderr.splitlines()

    def warning(self, *arguments, text=SCENARIO):
        lines = self.warnings(*arguments, text=text)
        self.assertEqual(len(lines), 1, lines)
        self.assertTrue(lines[0].startswith("beamgyro: warning: s.toml: "))
        return lines[0]

    def test_a_beam_beyond_the_linear_range_of_the_ceramic(self):
        line = self.warning("--set", "ambient.constant_degC=85",
                            "--set", "drive.voltage_limit_V=50")
        self.assertRegex(line, r"beam is at 85 to 8\d.* degC in all 1200 "
                               r"samples, beyond -40 to 80 degC.*ceramic")
        for celsius in [-40, 70]:
            self.assertEqual(self.warnings(
                "--set", f"ambient.constant_degC={celsius}"), [])

    def test_a_run_without_power(self):
        line = self.warning("--set", "power.on_s=[700]")
        self.assertIn("all 1200 samples are unpowered", line)
        self.assertIn("power.on_s = 700", line)
        self.assertIn("duration_s = 600", line)

    def test_the_true_cause_of_a_run_without_power(self):
        for on, off, cause in [
                ("[0.05]", "[0.15]", "the power is on at power.on_s = 0.05 and "
                 "off again at power.off_s = 0.15, between samples 0.5 s apart"),
                ("[599.75]", "[]", "power.on_s = 599.75 is after the last "
                 "sample, at 599.5 s"),
                ("[-100]", "[-5]", "the power is off since power.off_s = -5"),
                ("[-100, 700]", "[-5]", "the power is off since power.off_s = "
                 "-5, and power.on_s = 700 is not before duration_s = 600")]:
            with self.subTest(on):
                line = self.warning("--set", f"power.on_s={on}", "--set",
                                    f"power.off_s={off}")
                self.assertTrue(line.endswith(
                    f"all 1200 samples are unpowered: {cause}"), line)

    def test_a_run_that_is_saturated(self):
        line = self.warning("--set", "rate.constant_deg_per_s=400")
        self.assertIn("all 1200 powered samples are saturated", line)
        self.assertIn("readout.full_scale_deg_per_s = 150", line)

    def test_a_run_that_is_not_locked(self):
        line = self.warning("--set", "drive.voltage_limit_V=0.5")
        self.assertIn("in all 1200 powered samples the loops are not locked",
                      line)
        self.assertIn("with the beam at 25 to 2", line)
        self.assertIn("drive.voltage_limit_V = 0.5", line)

    def test_a_run_that_loses_its_lock_for_a_while(self):
        text = SCENARIO.replace("quasistatic", "envelope").replace(
            "constant_degC = 25", "points = [[0, 75], [300, 90]]\n"
            "[chamber]\nstirred = true")
        lines = self.warnings("--set", "thermal.electronics_power_W=0",
                              text=text)
        (line,) = [line for line in lines if "not locked" in line]
        self.assertRegex(line, r"in \d{3} of 1200 powered samples the loops are "
                               r"not locked;.* with the beam at 82\S* to 8")
        self.assertIn("drive.voltage_limit_V = 5", line)

    def test_a_sine_faster_than_half_the_output_rate(self):
        sine = "rate.sine={{amplitude_deg_per_s=10, frequency_Hz={}}}"
        line = self.warning("--set", sine.format(900.25),
                            text=SCENARIO.replace("output_rate_Hz = 2",
                                                  "output_rate_Hz = 1"))
        for part in ["rate.sine.frequency_Hz = 900.25", "output_rate_Hz = 1:",
                     "600 samples", "0.25 Hz"]:
            self.assertIn(part, line)
        self.assertEqual(self.warnings("--set", sine.format(0.9)), [])

    def test_a_profile_faster_than_half_the_output_rate(self):
        def square(half):
            steps = [[k * half, 5 * (k % 2)] for k in range(11)]
            return self.warnings("--set", f"rate.steps={steps}")
        (line,) = square(0.25)
        self.assertIn("rate: 10 of 10 swings", line)
        self.assertIn("between samples 0.5 s apart", line)
        self.assertEqual(square(0.5), [])

    def test_a_sine_of_half_the_output_rate(self):
        def sine(frequency, phase):
            return self.warning(
                "--set", "rate.sine={amplitude_deg_per_s=10, frequency_Hz="
                f"{frequency}, phase_rad={phase}}}")
        line = sine(1, 0)
        self.assertIn("rate.sine.frequency_Hz = 1 is half of output_rate_Hz = "
                      "2: the 1200 samples show 0 % of its amplitude", line)
        self.assertIn("show 50 % of its amplitude", sine(1, 0.5235987756))
        # A rounding beside it is the same, and more shows in the number.
        self.assertIn("= 1 is half of", sine(1.0000000000001, 0))
        self.assertIn("= 1.00000001 is above half of output_rate_Hz = 2:",
                      sine(1.00000001, 0))

    def test_a_pulse_between_two_samples(self):
        def pulse(top):
            return self.warnings(
                "--set", "rate.points=[[0,0],[100.1,0],[100.2,50],"
                f"[{top},50],[{top + 0.1},0],[200,0]]")
        (line,) = pulse(100.3)
        self.assertIn("rate: 2 of 2 swings", line)
        self.assertIn("lost", line)
        self.assertEqual(pulse(100.5), [])  # a sample is at its top

    def test_a_flight_of_which_the_samples_show_little(self):
        def flight(rate):
            answer = self.beamgyro("run", SCENARIOS / "flight.toml", "-o",
                                   "f.h5", "--set", f"output_rate_Hz={rate}")
            self.assertEqual(answer.returncode, 0, answer.stderr)
            return answer.stderr
        self.assertRegex(flight(0.003), r"rate: \d+ of \d+ swings of the "
                         r"profile are lost")
        self.assertEqual(flight(1), "")

    def test_sensor_noise_is_no_manoeuvre(self):
        noise = np.random.Generator(np.random.Philox(key=[41, 1]))
        time = np.arange(60000) / 100
        rate = 10 * np.sin(2 * np.pi * 0.01 * time) + 0.02 * noise.normal(
            size=time.size)
        def recorded(values):
            self.write("rate.csv", "time_s,rate_deg_per_s\n" + "".join(
                f"{t:.2f},{w:.6f}\n" for t, w in zip(time, values)))
            return self.warnings("--set", 'rate.file="rate.csv"',
                                 text=SCENARIO.replace("output_rate_Hz = 2",
                                                       "output_rate_Hz = 1"))
        self.assertEqual(recorded(rate), [])
        # A manoeuvre of 0.4 s on it is one.
        rate[20020:20060] += 10
        (line,) = recorded(rate)
        self.assertIn("rate: 2 of 15 swings", line)

    def test_a_random_rate_faster_than_half_the_output_rate(self):
        line = self.warning(
            "--set", "cross_rate.x.random={rms_deg_per_s=1, bandwidth_Hz=20}")
        self.assertIn("cross_rate.x.random.bandwidth_Hz = 20", line)

    def test_soaks_that_the_duration_cuts(self):
        text = SCENARIO.replace(
            "constant_degC = 25",
            "soaks = { temperatures_degC = [20, 30, 40], hold_s = 200, "
            "ramp_K_per_min = 10 }")
        line = self.warning(text=text)  # ends at 200, 460 and 720 s
        self.assertIn("duration_s = 600 cuts 1 of 3 soaks", line)
        self.assertIn("ends at 720 s", line)
        self.assertEqual(self.warnings("--set", "duration_s=720", text=text),
                         [])

    def test_times_a_rounding_apart_are_one(self):
        def ramp(duration):
            return self.beamgyro("run", SCENARIOS / "ramp.toml", "-o", "r.h5",
                                 "--set", f"duration_s={duration}").stderr
        self.assertEqual(ramp("21599.9999999"), "")
        self.assertIn("duration_s = 21599.9 cuts 1 of 3 soaks; the last ends "
                      "at 21600 s", ramp("21599.9"))
        self.assertIn("duration_s = 21599.99997 cuts", ramp("21599.99997"))

    def test_quiet_is_silent(self):
        self.assertEqual(self.warnings("--quiet", "--set", "power.on_s=[700]"),
                         [])

    def test_no_shipped_scenario_is_warned_about(self):
        for path in SHIPPED_SCENARIOS:
            with self.subTest(path.name):
                answer = self.beamgyro("run", path, "-o", "out.h5")
                self.assertEqual(answer.stderr, "")

    def test_temperatures_that_the_materials_do_not_stand(self):
        scenario = self.write("s.toml", SCENARIO)
        for key, value in [
                ("ambient.constant_degC", 151), ("ambient.constant_degC", -101),
                ("thermal.oven", "{ set_point_degC = 200, max_power_W = 3, "
                 "proportional_W_per_K = 1, integral_time_s = 60 }")]:
            with self.subTest(key):
                self.rejected("run", scenario, "-o", "s.h5", "--set",
                              f"{key}={value}", says=[key, "[-100, 150]"])
        self.write("hot.toml", SCENARIO.replace("= 25", "= 170"))
        self.rejected("run", "hot.toml", "-o", "s.h5",
                      says=["hot.toml:10:17: ambient.constant_degC", "170"])
        self.rejected("characterise", "device.toml", "-o", "c.csv",
                      "--beam-temperature", "20:200:10",
                      says=["200 degC", "-100 to 150 degC"])


class Heat(Set):
    def test_generate_names_the_heat_that_no_gyro_stands(self):
        device = (self.dir / "device.toml").read_text()
        hot, replaced = re.subn(r"(?m)^electronics_power_W = .*",
                                "electronics_power_W = 600", device)
        self.assertEqual(replaced, 1)
        self.write("device.toml", hot)
        rest = (self.dir / "rest.toml").read_text()
        self.write("rest.toml", rest.replace("duration_s = 60",
                                             "duration_s = 600"))
        answer = self.beamgyro("generate", "campaign.toml", "-o", "set")
        self.assertEqual(answer.returncode, 1)  # every device fails
        manifest = (self.dir / "set/manifest.jsonl").read_text()
        self.assertEqual(len(re.findall(
            r"board at 1\S+ degC at \S+ s, beyond -100 to 150 degC, "
            r"[^\"]*electronics_power_W = 600", manifest)), 14)


class EveryDeviceFails(Set):
    def setUp(self):
        super().setUp()
        # Beyond the range of the key but for one draw in a thousand.
        self.write("campaign.toml", CAMPAIGN.replace(
            "[tolerances]", '[tolerances]\n"beam.side_difference" = { normal '
            '= { mean = 0, sigma = 600 } }'))

    def test_generate_and_verify_call_such_a_set_a_failure(self):
        answer = self.beamgyro("generate", "campaign.toml", "-o", "set")
        self.assertEqual(answer.returncode, 1, answer.stdout)
        self.assertNotIn("whole", answer.stdout)
        for part in ["set: every one of its 14 device runs failed",
                     "side_difference"]:
            self.assertIn(part, answer.stderr)
        answer = self.beamgyro("verify", "set")
        self.assertEqual(answer.returncode, 1, answer.stdout)
        self.assertNotIn("whole", answer.stdout)
        self.assertIn("every one of its 14 device runs failed", answer.stderr)


if __name__ == "__main__":
    unittest.main()
