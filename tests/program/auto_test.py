# SPDX-License-Identifier: MIT
"""The automatic choice of a model, and cross-validation, by the program."""

import re
import shutil

import h5py
import numpy as np

from program import CUBIC, NETWORK, ProgramTest, SCENARIO, SCENARIOS, ramp

AUTO = SCENARIOS / "models/auto.toml"
FIVE_INPUTS = SCENARIOS / "models/auto_recommended.toml"

CURVES = """\
kind = "auto"
inputs = ["temperature"]

[auto]
candidates = ["constant", "linear", "cubic", "spline"]
"""


def points(seed, *temperatures, seconds=6000):
    """Scenario text of straight lines between temperatures [degC]."""
    times = np.linspace(0, seconds, len(temperatures))
    way = [[float(t), T] for t, T in zip(times, temperatures)]
    return ramp(seconds, seed=seed).replace(
        f"points = [[0, -30], [{seconds}, 40]]", f"points = {way}")


def power_cycles(ambient, seed):
    """Scenario text of two power-ons in still air."""
    return SCENARIO.replace("duration_s = 600", "duration_s = 6000") \
        .replace("output_rate_Hz = 2", "output_rate_Hz = 1") \
        .replace("seed = 7", f"seed = {seed}") \
        .replace("constant_degC = 25", f"constant_degC = {ambient}") \
        + "\n[power]\non_s = [0, 3600]\noff_s = [2400]\n"


class Auto(ProgramTest):
    def recordings(self, **scenarios):
        for name, text in scenarios.items():
            self.run_scenario(name, text=text)
        return [f"{name}.h5" for name in scenarios]

    def add_to_rate(self, name, change):
        """Adds change(file) to the rate, and as much to the output."""
        with h5py.File(self.dir / name, "r+") as file:
            rate = file["rate"][()]
            scale, offset = np.polyfit(rate, file["output"][()], 1)
            rate += change(file)
            file["rate"][...] = rate
            file["output"][...] = scale * rate + offset

    def zero(self, name):
        """Takes the true bias from a recording: nothing is left to learn."""
        self.add_to_rate(name, lambda file: -file["true_bias"][()])

    def trained(self, runs, model, *arguments, name="c.json"):
        """Printed report, warnings on stderr, and what the file says."""
        answer = self.ended("train", *runs, "--model", model, "-o", name,
                            *arguments)
        stored = self.json(name)["training"]
        for warning in stored["warnings"]:
            self.assertIn(warning, answer.stderr)
        return answer.stdout, answer.stderr, stored

    def both(self, runs):
        """A constant and a cubic of these runs."""
        for name, model in [("constant", 'kind = "constant"\n'),
                            ("cubic", CUBIC)]:
            self.train_on(*runs, model=model, to=f"{name}.json")
        return ["constant.json", "cubic.json"]

    def rms(self, compensator, run):
        said, _ = self.validated(compensator, run)
        (judged,) = said["runs"]
        return judged["rms_deg_per_s"]["after"]


class OneLeg(Auto):
    def test_is_a_cubic_and_says_why_it_is_no_more(self):
        runs = self.recordings(up=points(3, -40, 50))
        for model in [AUTO, FIVE_INPUTS]:
            report, errors, stored = self.trained(runs, model)
            self.assertEqual(stored["method"], "cubic")
            self.assertRegex(report, r"choice: spline: passed over, the "
                                     r"recordings are one leg of temperature")
            self.assertIn("they say nothing about new data", errors)
        # What it keeps is the cubic, bit for bit.
        self.assertEqual(self.json("c.json")["parameters"],
                         self.train_on(*runs, to="cubic.json")["parameters"])

    def test_without_a_temperature_effect_is_no_more_than_a_constant(self):
        for name, temperatures in [("up", [-40, 50]), ("both", [-40, 50, -40])]:
            runs = self.recordings(**{name: points(5, *temperatures)})
            self.zero(runs[0])
            report, errors, stored = self.trained(runs, AUTO)
            self.assertIn(stored["method"], ["none", "constant"])
            self.assertIn("no improvement to claim", errors)
            self.assertRegex(report, r"choice: cubic: passed over, the bias|"
                                     r"choice: kept (none|constant)")

    def test_over_8_K_loses_nothing_against_constant_and_cubic(self):
        runs = self.recordings(train=points(6, 10, 18, 10))
        (test,) = self.recordings(test=points(7, 18, 10, 18, seconds=9000) +
                                  "\n[noise]\nenabled = false\n")
        self.trained(runs, AUTO)
        automatic, constant, cubic = (
            self.rms(name, test) for name in ["c.json", *self.both(runs)])
        # The two differ, so that the choice matters.
        self.assertGreater(constant, 1.2 * cubic)
        self.assertLessEqual(automatic, 1.05 * cubic)


class LegsThatDisagree(Auto):
    SLOPES = [1.0, 0.3, 0.15]  # [deg/s] over half the span of temperatures

    runs = ["a_1.h5", "b_0.3.h5", "c_0.15.h5"]

    def prepare(self):
        super().prepare()
        self.recordings(a=points(31, -40, 50), b=points(32, -40, 50),
                        c=points(33, -40, 50), down=points(34, 50, -40))
        for run, slope in zip("abc", self.SLOPES):
            self.with_slope(run, slope)

    def with_slope(self, run, slope):
        """Copies a run, with a line over the temperature for its bias."""
        name = f"{run}_{slope:g}.h5"
        shutil.copy(self.dir / f"{run}.h5", self.dir / name)
        self.add_to_rate(name, lambda file: slope
                         * (file["temperature"][()] - 5) / 45
                         - file["true_bias"][()])
        return name

    def check_third(self, two, thirds):
        """Trains on two legs and scores others beside constant and cubic."""
        _, errors, _ = self.trained(two, AUTO)
        self.assertIn("no improvement to claim", errors)
        others = self.both(two)
        for third in thirds:
            left = self.rms("c.json", third)
            for name in others:
                self.assertLessEqual(left, 1.6 * self.rms(name, third), two)

    def test_leave_at_most_1_6_times_the_better_of_constant_and_cubic(self):
        for third in range(3):
            self.check_third(
                [run for k, run in enumerate(self.runs) if k != third],
                [self.runs[third]])

    # Thirds between the flatter leg and half of its slope; why not all of them
    # can be served is in tests/compensation/selection_test.cpp.
    def test_leave_that_over_a_grid_of_slopes(self):
        for slope in [0.2, 0.4, 0.6, 0.8, 1.0]:
            self.check_third(
                [self.runs[0], self.with_slope("b", slope)],
                [self.with_slope("c", share * slope) for share in [0.5, 1]])

    def test_are_two_though_self_heating_adds_a_third(self):
        for slopes in [(1, 0.3), (0.3, 1), (1, 0.6)]:
            two = [self.with_slope(run, slope)
                   for run, slope in zip(["a", "down"], slopes)]
            _, errors, stored = self.trained(two, AUTO)
            self.assertEqual(stored["cross_validation"]["groups"], 2)
            self.assertIn("fewer than 3 groups are no evidence", errors)

    def test_a_network_alone_is_no_average_and_is_read(self):
        two = [self.with_slope(run, slope)
               for run, slope in zip("ab", [0.45, -0.45])]
        self.write("network.toml", NETWORK.replace(
            "restarts = 1", "restarts = 1\nweight_decays = [0, 1e-8, 1e-6]"))
        _, errors, stored = self.trained(two, "network.toml", "--cv", "run")
        self.assertEqual(stored["method"], "BP network 2")
        self.assertIn("no improvement to claim", errors)
        self.ok("compensate", "c.json", two[0], "-o", "c.h5")

    def test_that_contradict_each_other_leave_a_constant(self):
        two = [self.with_slope(run, slope)
               for run, slope in zip("ab", [0.45, -0.45])]
        _, errors, stored = self.trained(two, AUTO, "--cv", "run")
        self.assertIn(stored["method"], ["none", "constant"])
        self.assertIn("no improvement to claim", errors)
        self.ok("compensate", "c.json", two[0], "-o", "c.h5")

    def test_an_average_is_exported_in_every_format(self):
        report, _, stored = self.trained(self.runs[:2], AUTO, "--cv", "leg")
        self.assertIn("beside a constant", stored["method"])
        self.assertRegex(report, r"leg 2: rms [\d.]+ deg/s unseen, of a constant")
        self.assertEqual(len(stored["cross_validation"]["group_rms_deg_per_s"]),
                         2)
        self.ok("export", "c.json", "--format", "c", "-o", "firmware")
        for name in ["px4", "ardupilot"]:
            self.ok("export", "c.json", "--format", name, "--fit-cubic", "-o",
                    "firmware")
        for name in ["once.h5", "again.h5"]:
            self.ok("compensate", "c.json", self.runs[2], "-o", name)
        self.assertSameBytes("once.h5", "again.h5")


class ManyLegs(Auto):
    runs = ["a.h5", "b.h5", "c.h5"]

    def prepare(self):
        super().prepare()
        self.recordings(a=points(11, -40, 50, -40), b=points(12, 50, -40, 50),
                        c=points(13, -40, 50, -40, seconds=9000))

    def test_takes_more_than_a_cubic_and_claims_it(self):
        report, errors, stored = self.trained(self.runs, AUTO)
        self.assertRegex(stored["method"], "cubic spline|BP network")
        self.assertNotIn("no improvement to claim", errors)
        judged = dict(re.findall(r"choice: (.*): ([\d.]+) deg/s rms over 3 "
                                 r"unseen runs", report))
        self.assertLess(float(judged["spline"]), float(judged["cubic"]))
        self.assertEqual(stored["cross_validation"]["by"], "run")
        self.assertEqual(stored["cross_validation"]["groups"], 3)

    def test_gives_the_same_file_again(self):
        for name in ["first.json", "again.json"]:
            self.trained(self.runs, FIVE_INPUTS, name=name)
        self.assertSameBytes("first.json", "again.json")

    def test_without_warm_ups_drops_the_time_since_power_on_alone(self):
        report, _, stored = self.trained(self.runs, FIVE_INPUTS)
        self.assertRegex(report, r"choice: bp\(2,8\): without "
                                 r"since_power_on\(100\), since_power_on\(700\): "
                                 r"time since power-on is told from")
        judged = dict(re.findall(r"choice: (.*): ([\d.]+) deg/s rms over 3 "
                                 r"unseen runs", report))
        networks = [float(rms) for name, rms in judged.items()
                    if name.startswith("bp(2,8)")]
        self.assertLess(min(networks), 0.5 * float(judged["spline"]))
        self.assertRegex(stored["method"], "BP network 2-")
        self.assertEqual(self.json("c.json")["inputs"], [
            "temperature", "temperature_lowpass(100)",
            "temperature_lowpass(400)"])

    def test_a_network_of_several_inputs_needs_three_of_them(self):
        self.write("network.toml", NETWORK.replace(
            '"temperature"', '"temperature", "temperature_lowpass(100)"'))
        self.rejected("train", *self.runs[:2], "--model", "network.toml", "-o",
                      "c.json", "--cv", "run",
                      says=["3 runs or more judge a network of several inputs",
                            "temperature_lowpass(100)", "have 2"])

    def test_without_a_temperature_effect_claims_nothing(self):
        for run in self.runs:
            self.zero(run)
        _, errors, stored = self.trained(self.runs, AUTO)
        self.assertIn(stored["method"], ["none", "constant"])
        self.assertIn("no improvement to claim", errors)

    def test_is_judged_by_held_out_runs_where_there_are_any(self):
        self.write("curves.toml", CURVES)
        report, _, stored = self.trained(self.runs[:1], "curves.toml",
                                         "--held-out", *self.runs[1:])
        self.assertEqual(stored["method"], "cubic spline")
        self.assertIn("unseen legs", report)
        self.assertIsNone(stored["cross_validation"])


class CrossValidation(Auto):
    def test_holds_out_runs_cycles_or_legs(self):
        self.write("network.toml", NETWORK)
        cycles = self.recordings(cold=power_cycles(-20, 21),
                                 warm=power_cycles(20, 22))
        way = self.recordings(way=points(23, -40, 50, -40, 50))
        for by, runs, count in [("run", cycles, 2), ("cycle", cycles, 4),
                                ("leg", way, 3)]:
            report, _, stored = self.trained(runs, "network.toml", "--cv", by)
            validated = stored["cross_validation"]
            self.assertEqual((validated["by"], validated["groups"]),
                             (by, count))
            if by == "leg":  # elsewhere a constant is all there is to learn
                self.assertLess(validated["rms_deg_per_s"],
                                validated["constant_rms_deg_per_s"])
            self.assertRegex(report, f"rms cross-validated over {count} {by}s")
