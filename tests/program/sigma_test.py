# SPDX-License-Identifier: MIT
"""The 1-sigma of the compensated rate: train, compensate, export."""

import json
import pathlib
import re
import types

import h5py
import numpy as np

from exported import WARNINGS
from program import PROGRAM, ROOT, SCENARIOS, ProgramTest, ended, said, script
from train_set_test import CAMPAIGN, SCENARIO

SPLINE = 'kind = "spline"\n[rows]\nsteady_K_per_min = 0.05\n'
SOAKS = f"""\
name = "soaks"
description = "seven soaks"
device = "device.toml"
fidelity = "quasistatic"
duration_s = 16000
output_rate_Hz = 0.1
seed = 3

[ambient.soaks]
temperatures_degC = [-35, -20, -5, 10, 25, 40]
hold_s = 1800
ramp_K_per_min = 1
"""


class OfOneGyro(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("soaks.toml", SOAKS)
        self.write("spline.toml", SPLINE)
        self.ok("run", "soaks.toml", "-o", "soaks.h5")
        self.ok("train", "soaks.h5", "--model", "spline.toml", "-o", "c.json")

    def setUp(self):
        super().setUp()
        self.compensator = self.json("c.json")

    def sigma_in(self, file):
        with h5py.File(self.dir / file) as recording:
            variable = recording["compensated_rate_sigma"]
            self.assertEqual(variable.attrs["units"], b"degree/s")
            self.assertEqual(variable.attrs["role"], b"compensated")
            return variable[:]

    def test_compensate_writes_what_the_page_of_the_file_says(self):
        self.ok("compensate", "c.json", "soaks.h5", "-o", "out.h5")
        found = self.sigma_in("out.h5")
        run = self.signals("soaks.h5")
        # It computes sigma from the page alone.
        expected = script(ROOT / "bench/uncertainty.py").sigma_of(
            self.compensator["sigma"], run["time"], run["temperature"])
        # The same arithmetic in another order.
        np.testing.assert_allclose(found, expected, rtol=1e-9)
        self.assertEqual(self.compensator["sigma"]["source"], "covariance")
        self.assertIn("power_on", self.compensator["sigma"])
        self.assertIn("temperature_rate", self.compensator["sigma"])

    def test_what_all_soaks_of_one_run_share_is_warned_of(self):
        self.ok("run", "soaks.toml", "-o", "more.h5", "--seed", 4)
        for runs, is_warned in [(["soaks.h5"], True),
                                (["soaks.h5", "more.h5"], False)]:
            self.assertEqual("the stated sigma leaves out the turn-on offset and "
                             "the slow noise that all soaks" in self.warned(
                                 "train", *runs, "--model", "spline.toml", "-o",
                                 "again.json"), is_warned)

    def test_outside_the_temperatures_of_training_it_grows(self):
        self.ok("run", "soaks.toml", "-o", "cold.h5", "--set",
                "ambient.soaks.temperatures_degC=[-35,-60]")
        self.ok("compensate", "c.json", "cold.h5", "-o", "out.h5")
        sigma = self.sigma_in("out.h5")
        lowest = self.compensator["sigma"]["sigma_deg_per_s"][0]
        self.assertGreater(sigma[-1],
                           2 * lowest * self.compensator["sigma"]["factor"])

    def test_training_says_why_there_is_none(self):
        self.run_scenario("two", text=SOAKS.replace(
            "[-35, -20, -5, 10, 25, 40]", "[10, 14]").replace(
            "= 16000", "= 5000"))
        self.write("line.toml", SPLINE.replace("spline", "polynomial")
                   + "[polynomial]\ndegree = 1\n")
        text = self.ok("train", "two.h5", "--model", "line.toml", "-o",
                       "none.json")
        self.assertIn("\nno sigma: the rows have 2 soaks; expected 3 or more",
                      text)
        self.assertNotIn("sigma", self.json("none.json"))

    def test_a_file_without_one_gives_the_same_rate_and_no_sigma(self):
        self.ok("compensate", "c.json", "soaks.h5", "-o", "with.h5")
        del self.compensator["sigma"]
        self.write("plain.json", json.dumps(self.compensator))
        self.ok("compensate", "plain.json", "soaks.h5", "-o", "without.h5")
        other = self.signals("without.h5")
        self.assertNotIn("compensated_rate_sigma", other)
        np.testing.assert_array_equal(self.signals("with.h5")["compensated_rate"],
                                      other["compensated_rate"])

    def test_broken_members_are_refused_by_name(self):
        sigma = self.compensator["sigma"]
        values = sigma["sigma_deg_per_s"]
        cases = [
            ("sigma_deg_per_s", [-v for v in values], "above 0"),
            ("sigma_deg_per_s", values[1:], "as many"),
            ("sigma_deg_per_s", [None] * len(values), "finite number"),
            ("temperature_degC", [], "at least one"),
            ("temperature_degC", sigma["temperature_degC"][::-1],
             "must increase"),
            ("temperature_degC", [10 * T for T in sigma["temperature_degC"]],
             "must lie within"),
            ("growth_deg_per_s_per_K", [0, 0], "above 0"),
            ("factor", -1, "above 0"),
            ("source", "hope", "must be"),
            ("power_on", {}, "is missing"),
            ("small", True, "not known"),
        ]
        for key, value, words in cases:
            self.write("bad.json", json.dumps(
                self.compensator | {"sigma": sigma | {key: value}}))
            self.rejected("compensate", "bad.json", "soaks.h5", "-o",
                          "bad.h5", says=words)

    def test_exported_code_tells_it_and_its_self_test_sees_damage(self):
        self.ok("export", "c.json", "--format", "c", "-o", "code", "--name",
                "gyro")
        code = self.dir / "code"
        self.assertIn("float gyro_sigma(const gyro_state *state);",
                      (code / "gyro.h").read_text())
        source = (code / "gyro.c").read_text()

        def self_test():
            said("cc", *WARNINGS, "-O2", "gyro.c", "gyro_selftest.c", "-o",
                 "selftest", cwd=code)
            return ended(code / "selftest", allowed=(0, 1)).returncode
        self.assertEqual(self_test(), 0)
        damaged = source.replace("sigma_terms[0] * exp_minus",
                                 "-sigma_terms[0] + exp_minus")
        self.assertNotEqual(damaged, source)
        (code / "gyro.c").write_text(damaged)
        self.assertEqual(self_test(), 1)

    def test_without_one_the_exported_code_has_nothing_of_it(self):
        del self.compensator["sigma"]
        self.compensator["training"]["warnings"] = []  # that of sigma
        self.write("plain.json", json.dumps(self.compensator))
        self.ok("export", "plain.json", "--format", "c", "-o", "code",
                "--name", "gyro")
        for file in (self.dir / "code").iterdir():
            self.assertNotIn("sigma", file.read_text(), file.name)


class OfAPopulation(ProgramTest):
    def test_adapted_devices_take_the_calibration_of_the_population(self):
        sweep = SCENARIO.format(
            name="sweep", duration=38400,
            temperatures=[-35, -20, -5, 10, 25, 40, 50])
        self.write("sweep.toml", sweep)
        self.write("check.toml", SCENARIO.format(
            name="check", duration=12000, temperatures=[-20, 40]))
        self.write("campaign.toml", CAMPAIGN.replace(
            "validation = 0.2", "validation = 0.4").replace(
            "train = 0.6", "train = 0.4"))
        self.ok("generate", "campaign.toml", "-o", "set")
        models = SCENARIOS / "population"
        for name in ["population", "adapted"]:
            self.write(f"{name}.toml", (models / f"{name}.toml").read_text()
                       .replace("grid_K = 5", "grid_K = 15"))
        self.ok("train", "set", "--run", "sweep", "--model",
                "population.toml", "-o", "population.json")
        population = self.json("population.json")
        parts = self.signals("set/sweep.nc")["part"]
        validation = int(np.count_nonzero(parts == 1))
        sigma = population["sigma"]
        self.assertEqual(sigma["source"], "posterior")
        self.assertEqual(sigma["calibration"]["by"], "device")
        self.assertEqual(sigma["calibration"]["groups"], validation)
        learned = population["population"]["sigma"]
        self.assertEqual(learned["devices"], validation)
        words = self.ok(
            "train", "set", "--run", "check", "--device",
            int(np.flatnonzero(parts == 2)[0]), "--model", "adapted.toml",
            "-o", "adapted.json")
        adapted = self.json("adapted.json")["sigma"]
        self.assertEqual(adapted["factor"], learned["factor"])
        self.assertEqual(adapted["temperature_rate"],
                         learned["temperature_rate"])
        # The sigma that is told is that of the file.
        told = float(re.search(r"1-sigma left open by the rows: rms ([\d.]+)",
                               words).group(1))
        self.assertAlmostEqual(
            told, adapted["factor"] * np.sqrt(np.mean(np.square(
                adapted["sigma_deg_per_s"]))), delta=1e-4)
        # Known from two soaks, a device is surer than the population.
        self.assertLess(np.mean(adapted["sigma_deg_per_s"]),
                        np.mean(sigma["sigma_deg_per_s"]))
        # Of a set it is judged over all test devices, as of other runs.
        self.beamgyro("validate", "population.json", "set", "--run", "sweep",
                      "--json", "found.json")
        found = self.json("found.json")["sigma"]
        self.assertEqual(found["soaks"]["clusters"],
                         np.count_nonzero(parts == 2))
        self.assertEqual([c["level"] for c in found["soaks"]["coverage"]],
                         [0.5, 0.9, 0.95])
        self.assertAlmostEqual(sum(found["soaks"]["pit"]["histogram"]), 1)
        self.assertGreater(found["bias_filter"]["nis"]["value"], 0)


class OfAUnitThatAges(ProgramTest):
    def test_after_a_year_its_sigma_is_said_not_to_hold(self):
        lifelike = SOAKS.replace(
            "device.toml", str(SCENARIOS / "devices/lifelike.toml"))
        self.write("spline.toml", SPLINE)
        self.write("lifelike.toml", lifelike)
        self.ok("run", "lifelike.toml", "-o", "new.h5")
        for days, is_told in [(6, False), (365, True)]:
            self.ok("run", "lifelike.toml", "-o", f"{days}.h5", "--seed", 9,
                    "--set", f"age.hours={24 * days}")
            self.ok("train", "new.h5", "--model", "spline.toml", "-o",
                    "c.json")
            self.assertEqual(self.json("c.json")["sigma"]["holds_for"],
                             {"temperature_way": "rising", "age_hours": 0})
            words = f"sigma does not hold: the unit is {24 * days} h old"
            compensated = self.ended("compensate", "c.json", f"{days}.h5", "-o",
                                     f"out_{days}.h5").stderr
            self.assertEqual(words in compensated, is_told)
            self.beamgyro("validate", "c.json", f"{days}.h5", "--json",
                          "found.json")
            self.assertEqual(any(words in warning for warning in
                                 self.json("found.json")["warnings"]), is_told)


class OfLegs(ProgramTest):
    """Three legs of a log at 3 K/min, two of which train (three_legs.py)."""
    UNITS = 8

    def setUp(self):
        super().setUp()
        self.study = self.study_in_dir()

    def prepare(self):
        super().prepare()
        study = self.study_in_dir()
        study.draw()
        for unit in range(self.UNITS):
            study.simulate(unit)

    def study_in_dir(self):
        return script(ROOT / "bench/three_legs.py").Study(
            types.SimpleNamespace(
                program=pathlib.Path(PROGRAM), out=self.dir / "legs",
                units=self.UNITS, seed=3100, trims=[1 / 300, 0.1], jobs=2,
                models=[]))

    def scored(self, unit, leg):
        """Share within the interval of 90 %, and what is said."""
        legs = [self.study.leg(unit, k) for k in range(3)]
        scored = legs.pop(leg)
        warnings = self.ended("train", *legs, "--model",
                              SCENARIOS / "models/cubic.toml", "-o",
                              "leg.json").stderr
        answer = self.ended("compensate", "leg.json", scored, "-o", "leg.h5")
        lowest, highest = self.json("leg.json")["temperature_range_degC"]
        with h5py.File(self.dir / "leg.h5") as run:
            error = run["compensated_rate"][()] - run["true_rate"][()]
            sigma = run["compensated_rate_sigma"][()]
            T = run["temperature"][()]
        own = np.isfinite(error) & (T >= lowest) & (T <= highest)
        count = own.sum() // 60 * 60
        means = error[own][:count].reshape(-1, 60).mean(1)
        sigmas = sigma[own][:count].reshape(-1, 60).mean(1)
        (self.dir / "leg.h5").unlink()
        return (np.mean(np.abs(means) <= 1.645 * sigmas), warnings,
                answer.stderr)

    def test_sigma_holds_or_is_said_not_to(self):
        shares = []
        for unit in range(self.UNITS):
            for leg in (0, 2):  # the others go both ways
                share, warned, said_of_it = self.scored(unit, leg)
                shares.append(share)
                self.assertNotIn("temperatures alone", warned)
                self.assertNotIn("does not hold", said_of_it)
            _, warned, said_of_it = self.scored(unit, 1)
            self.assertRegex(warned,
                             "sigma is of (rising|falling) temperatures alone")
            self.assertRegex(said_of_it, "sigma does not hold of "
                             "(rising|falling) temperatures")
        # The mean over 16 legs is known to 6 %.
        self.assertGreater(np.mean(shares), 0.80)

    def test_one_held_out_run_is_no_evidence_of_a_network(self):
        legs = [self.study.leg(0, k) for k in range(3)]
        self.write("bp.toml", 'kind = "bp"\ninputs = ["temperature"]\n[bp]\n'
                   "hidden = [3]\n"
                   "max_epochs = 20\nrestarts = 1\n")
        text = self.ok("train", legs[0], legs[1], "--model", "bp.toml",
                       "--held-out", legs[2], "-o", "bp.json")
        self.assertIn("\nno sigma: one held-out run does not tell", text)
        stored = self.json("bp.json")
        self.assertNotIn("sigma", stored)
        self.assertIn("one held-out run", stored["sigma_not_known"])
        self.ok("export", "bp.json", "--format", "c", "-o", "code", "--name",
                "gyro")
        self.assertIn("States no sigma", self.text("code/gyro.h"))
        self.rejected("export", "bp.json", "--format", "ekf", "--rest",
                      legs[2], "-o", "filters", says="one held-out run")
        self.ok("train", *legs, "--model", "bp.toml", "--cv", "run", "-o",
                "bp.json")
        calibration = self.json("bp.json")["sigma"]["calibration"]
        self.assertEqual((calibration["by"], calibration["groups"]), ("run", 3))
