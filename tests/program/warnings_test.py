# SPDX-License-Identifier: MIT
"""What `run` warns of, and what `generate` and `verify` say of a set that failed."""

import re

import numpy as np

from program import SCENARIO, SCENARIOS, ProgramTest
from sets import Set

ENVELOPE = SCENARIO.replace("quasistatic", "envelope").replace(
    "constant_degC = 25", "points = [[0, 75], [300, 90]]\n[chamber]\nstirred = true")
ONE_HERTZ = SCENARIO.replace("output_rate_Hz = 2", "output_rate_Hz = 1")
SOAKS = SCENARIO.replace(
    "constant_degC = 25", "soaks = { temperatures_degC = [20, 30, 40], hold_s = 200, "
    "ramp_K_per_min = 10 }")  # ends at 200, 460 and 720 s
UNPOWERED = "all 1200 samples are unpowered: "


def sine(frequency, phase=0):
    return (f"rate.sine={{amplitude_deg_per_s=10, frequency_Hz={frequency}, "
            f"phase_rad={phase}}}")


def square(half):
    return f"rate.steps={[[k * half, 5 * (k % 2)] for k in range(11)]}"


def pulse(top):
    return ("rate.points=[[0,0],[100.1,0],[100.2,50],"
            f"[{top},50],[{top + 0.1},0],[200,0]]")


# A scenario, values that are set, and what the one warning says.
WARNED = [
    # A beam beyond the linear range of the ceramic
    (SCENARIO, ["ambient.constant_degC=85", "drive.voltage_limit_V=50"],
     re.compile(r"beam is at 85 to 8\d.* degC in all 1200 samples, beyond -40 to 80 degC"
                ".*ceramic")),
    # Without power, with the true cause
    (SCENARIO, ["power.on_s=[700]"], "all 1200 samples are unpowered",
     "power.on_s = 700", "duration_s = 600"),
    *[(SCENARIO, [f"power.on_s={on}", f"power.off_s={off}"],
       re.compile(f"{UNPOWERED}{re.escape(cause)}$")) for on, off, cause in [
        ("[0.05]", "[0.15]", "the power is on at power.on_s = 0.05 and off again at "
         "power.off_s = 0.15, between samples 0.5 s apart"),
        ("[599.75]", "[]", "power.on_s = 599.75 is after the last sample, at 599.5 s"),
        ("[-100]", "[-5]", "the power is off since power.off_s = -5"),
        ("[-100, 700]", "[-5]", "the power is off since power.off_s = -5, and "
         "power.on_s = 700 is not before duration_s = 600")]],
    # A history that ends elsewhere than the run begins
    (SCENARIO, ["memory.relaxation={}", "history.points=[[0, 60], [3600, 60]]"],
     "history.points ends at 60 degC and the run begins at 25 degC", "1 K/min"),
    # A history of a unit that forgets
    (SCENARIO, ["history.points=[[0, 25], [3600, 25]]"],
     "history.points changes nothing: the device has no [memory]"),
    # An oven in a place that is hotter
    (SCENARIO, ["thermal.oven={set_point_degC=10, max_power_W=3, "
                "proportional_W_per_K=1, integral_time_s=60}"],
     "thermal.oven.set_point_degC = 10 is below the surroundings in all 1200",
     "up to 25 degC", "cannot cool"),
    # Channels that tell nothing
    (SCENARIO, ["readout.adc_bits=1"], "readout.adc_bits = 1 makes steps of 150 deg/s",
     "all 1200 powered samples show the rate 0 deg/s"),
    (SCENARIO, ["temperature_sensor.resolution_K=100"],
     "temperature_sensor.resolution_K = 100: all 1200 powered samples show 0 degC",
     "the sensor moves by"),
    # A run of weeks without an age
    (SCENARIO, ["duration_s=720000", "output_rate_Hz=0.01"],
     "random walk of a run without age.hours has no bound: 0.17 deg/s",
     "after 200 h", "noise.random_walk_correlation_h = 100", "0.085 deg/s"),
    (SCENARIO, ["rate.constant_deg_per_s=400"], "all 1200 powered samples are saturated",
     "readout.full_scale_deg_per_s = 150"),
    (SCENARIO, ["drive.voltage_limit_V=0.5"],
     "in all 1200 powered samples the loops are not locked", "with the beam at 25 to 2",
     "drive.voltage_limit_V = 0.5"),
    # Rates faster than half the output rate
    (ONE_HERTZ, [sine(900.25)], "rate.sine.frequency_Hz = 900.25", "output_rate_Hz = 1:",
     "600 samples", "0.25 Hz"),
    (SCENARIO, [square(0.25)], "rate: 10 of 10 swings", "between samples 0.5 s apart"),
    (SCENARIO, [pulse(100.3)], "rate: 2 of 2 swings", "lost"),
    (SCENARIO, ["cross_rate.x.random={rms_deg_per_s=1, bandwidth_Hz=20}"],
     "cross_rate.x.random.bandwidth_Hz = 20"),
    # A sine of half the output rate, to a rounding
    (SCENARIO, [sine(1)], "rate.sine.frequency_Hz = 1 is half of output_rate_Hz = 2: the 1200 "
     "samples show 0 % of its amplitude"),
    (SCENARIO, [sine(1, 0.5235987756)], "show 50 % of its amplitude"),
    (SCENARIO, [sine(1.0000000000001)], "= 1 is half of"),
    (SCENARIO, [sine(1.00000001)], "= 1.00000001 is above half of output_rate_Hz = 2:"),
    # Soaks that the duration cuts
    (SOAKS, [], "duration_s = 600 cuts 1 of 3 soaks", "ends at 720 s"),
]

SILENT = [
    (SCENARIO, "ambient.constant_degC=-40"), (SCENARIO, "ambient.constant_degC=70"),
    (SCENARIO, sine(0.9)), (SCENARIO, square(0.5)),
    (SCENARIO, pulse(100.5)),  # a sample is at its top
    (SOAKS, "duration_s=720"),
]


class Run(ProgramTest):
    def warnings(self, *changes, text=SCENARIO, options=()):
        """The lines that a run prints besides its recording."""
        self.write("s.toml", text)
        answer = self.ended("run", "s.toml", "-o", "s.h5", *options, *[
            word for change in changes for word in ("--set", change)])
        self.assertEqual(answer.stdout, "")
        return answer.stderr.splitlines()

    def shipped(self, name, change):
        return self.warned("run", SCENARIOS / name, "-o", "s.h5", "--set",
                           change)

    def test_one_line_names_what_is_of_no_use(self):
        for text, changes, *says in WARNED:
            (line,) = self.warnings(*changes, text=text)
            self.assertTrue(line.startswith("beamgyro: warning: s.toml: "))
            self.assertSays(line, says)

    def test_nothing_is_said_of_what_is_of_use(self):
        for text, change in SILENT:
            self.assertEqual(self.warnings(change, text=text), [])

    def test_a_run_that_loses_its_lock_for_a_while(self):
        lines = self.warnings("thermal.electronics_power_W=0", text=ENVELOPE)
        (line,) = [line for line in lines if "not locked" in line]
        self.assertRegex(line, r"in \d{3} of 1200 powered samples the loops are "
                               r"not locked;.* with the beam at 82\S* to 8")
        self.assertIn("drive.voltage_limit_V = 5", line)

    def test_a_flight_of_which_the_samples_show_little(self):
        self.assertRegex(self.shipped("flight.toml", "output_rate_Hz=0.003"),
                         r"rate: \d+ of \d+ swings of the profile are lost")
        self.assertEqual(self.shipped("flight.toml", "output_rate_Hz=1"), "")

    def test_sensor_noise_is_no_manoeuvre(self):
        noise = np.random.Generator(np.random.Philox(key=[41, 1]))
        time = np.arange(60000) / 100
        rate = 10 * np.sin(2 * np.pi * 0.01 * time) + 0.02 * noise.normal(
            size=time.size)
        def recorded(values):
            self.write("rate.csv", "time_s,rate_deg_per_s\n" + "".join(
                f"{t:.2f},{w:.6f}\n" for t, w in zip(time, values)))
            return self.warnings('rate.file="rate.csv"', text=ONE_HERTZ)
        self.assertEqual(recorded(rate), [])
        # A manoeuvre of 0.4 s on it is one.
        rate[20020:20060] += 10
        (line,) = recorded(rate)
        self.assertIn("rate: 2 of 15 swings", line)

    def test_times_a_rounding_apart_are_one(self):
        def ramp(duration):
            return self.shipped("ramp.toml", f"duration_s={duration}")
        self.assertEqual(ramp("21599.9999999"), "")
        self.assertIn("duration_s = 21599.9 cuts 1 of 3 soaks; the last ends "
                      "at 21600 s", ramp("21599.9"))
        self.assertIn("duration_s = 21599.99997 cuts", ramp("21599.99997"))

    def test_quiet_is_silent(self):
        self.assertEqual(self.warnings("power.on_s=[700]", options=["--quiet"]), [])


class Failures(Set):
    def test_generate_names_the_heat_that_no_gyro_stands(self):
        self.change("device.toml", "^electronics_power_W = .*",
                    "electronics_power_W = 600")
        self.change("rest.toml", "duration_s = 60", "duration_s = 600")
        self.ended("generate", "campaign.toml", "-o", "set", allowed=(1,))
        manifest = self.text("set/manifest.jsonl")
        self.assertEqual(len(re.findall(
            r"board at 1\S+ degC at \S+ s, beyond -100 to 150 degC, "
            r"[^\"]*electronics_power_W = 600", manifest)), 14)

    def test_generate_and_verify_call_a_set_without_a_device_a_failure(self):
        # Beyond the range of the key but for one draw in a thousand.
        self.change("campaign.toml", r"\[tolerances\]", '[tolerances]\n"beam.'
                    'side_difference" = { normal = { mean = 0, sigma = 600 } }')
        for words, says in [
                (["generate", "campaign.toml", "-o", "set"], "set: every one"),
                (["verify", "set"], "manifest says, but every one")]:
            answer = self.ended(*words, allowed=(1,))
            self.assertNotIn("whole", answer.stdout)
            self.assertSays(answer.stderr, [
                f"{says} of its 14 device runs failed", "side_difference"])
