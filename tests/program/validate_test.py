# SPDX-License-Identifier: MIT
"""`validate` against compensators that only look good, written by hand."""

import json
import resource
import shutil
import unittest

import h5py
import numpy as np

from program import CUBIC, NETWORK, ROOT, ProgramTest, ramp

UNIT = {"centre": 0.0, "half_width": 1.0}


class Validate(ProgramTest):
    def setUp(self):
        super().setUp()
        self.run_scenario("train", text=ramp(seed=3))
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        self.write("cubic.toml", CUBIC)
        self.ok("train", "train.h5", "--model", "cubic.toml", "-o",
                "cubic.json")
        self.cubic = json.loads((self.dir / "cubic.json").read_text())
        with h5py.File(self.dir / "test.h5") as file:
            self.offset = float(file["rate"][:].mean())

    def compensator(self, **changes):
        """The file of a cubic with other keys, in c.json."""
        self.write("c.json", json.dumps({**self.cubic, **changes}))

    def cheat(self, inputs, kind, parameters, **changes):
        self.compensator(inputs=inputs, kind=kind, parameters=parameters,
                         input_scales=[UNIT] * len(inputs), bias_scale=UNIT,
                         **changes)

    def judged(self, *runs, status=3):
        answer = self.beamgyro("validate", "c.json", *(runs or ["test.h5"]),
                               "--json", "v.json")
        self.assertEqual(answer.returncode, status, answer.stdout
                         + answer.stderr)
        said = json.loads((self.dir / "v.json").read_text())
        self.assertIn(f"verdict: {said['words']}\n", answer.stdout)
        return said, answer


class Cheats(Validate):
    def named(self, verdict):
        """The cheat at rest: a good residual, and this verdict."""
        said, answer = self.judged()
        self.assertEqual(said["words"], verdict)
        checks = {check["name"]: check for check in said["checks"]}
        self.assertTrue(checks["residual"]["passed"], checks)
        return said, answer

    def constant(self, **changes):
        self.cheat(["temperature"], "constant",
                   {"value_deg_per_s": self.offset}, **changes)

    def test_a_constant_is_sound(self):
        self.constant()
        said, _ = self.judged(status=0)
        scale = said["overall"]["scale_factor"]
        self.assertAlmostEqual(scale["replayed_at_rest"], 1, delta=1e-9)
        self.assertEqual(scale["replayed"]["largest_rate_deg_per_s"], 150)
        self.assertEqual(scale["not_tested"], [])

    def test_a_constant_divided_by_a_huge_scale_factor(self):
        self.constant(scale_factor={"temperatures_degC": [0],
                                    "values": [1e9]})
        said, _ = self.named("cancels the rate")
        self.assertLess(said["overall"]["residual"]["rms_deg_per_s"], 1e-6)

    def test_a_scale_factor_no_recorded_rate_tells_of(self):
        self.constant(scale_factor={"temperatures_degC": [0],
                                    "values": [1.02]})
        said, _ = self.named("scale factor not tested")
        self.assertEqual(said["overall"]["scale_factor"]["not_tested"],
                         ["scale_factor"])

    def test_a_staircase_that_eats_92_percent_of_large_rates(self):
        rates = np.arange(-200, 201, 5)
        stairs = np.sign(rates) * np.maximum(np.abs(rates) - 15, 0)
        self.cheat(["rate"], "table", {
            "temperatures_degC": rates.tolist(),
            "values_deg_per_s": (self.offset + 0.92 * stairs).tolist()})
        said, answer = self.named("cancels the rate")
        worst = said["overall"]["scale_factor"]["replayed"]["beyond"]
        self.assertLess(worst["retained"], 0.2)
        self.assertGreater(abs(worst["rate_deg_per_s"]), 75)
        self.assertRegex(answer.stdout, r"FAILED scale factor: 0\.\d+ "
                         r"replayed in run test.h5 .-?\d+")

    def test_a_window_of_a_tenth_of_a_kelvin_that_eats_everything(self):
        self.cheat(["temperature", "rate"], "fuzzy", {
            "centres": [4.9, 5.0, 5.1], "width": 0.01,
            "consequents": [[self.offset, 0, 0], [0, 0, 1],
                            [self.offset, 0, 0]]})
        said, _ = self.named("cancels the rate")
        worst = said["overall"]["scale_factor"]["replayed"]
        for block in worst["within_2_deg_per_s"], worst["beyond"]:
            self.assertAlmostEqual(block["retained"], 0, delta=1e-6)
            self.assertAlmostEqual(block["temperature_degC"], 5, delta=0.1)

    def test_a_tenth_of_a_kelvin_where_rates_of_20_to_40_are_eaten(self):
        """Two windows in one network: tanh up and down, both within."""
        ends = [[5.0, 5.1], [20, 40]]
        steep = [200, 5]
        into = np.zeros((2, 4))
        for i in range(2):
            into[i, 2 * i:2 * i + 2] = steep[i]
        start = [-steep[i] * end for i in range(2) for end in ends[i]]
        gate = 20.0
        self.cheat(["temperature", "rate"], "bp", {
            "layer_sizes": [2, 4, 1, 1],
            "weights": [*into.flatten(), *start,
                        *(gate * np.array([0.5, -0.5] * 2)), -1.6 * gate,
                        15.0, 15.0 + self.offset]})
        _, answer = self.named("cancels the rate")
        self.assertRegex(
            answer.stdout, r"FAILED scale factor: -0\.\d+ replayed over every "
            r"temperature \(\d\d\.\d+ deg/s, 5\.[01] degC")

    def test_a_network_on_what_a_replay_cannot_move(self):
        inputs = ["quadrature", "drive_voltage", "drive_frequency"]
        self.write("network.toml", NETWORK.replace(
            '["temperature"]', json.dumps(inputs)))
        self.ok("train", "train.h5", "--held-out", "test.h5", "--model",
                "network.toml", "-o", "c.json")
        self.run_scenario("other", text=ramp(low=-25, high=35, seed=6))
        said, answer = self.judged("other.h5")
        self.assertEqual(said["words"], "scale factor not tested")
        for score in [said["overall"], *said["runs"]]:
            scale = score["scale_factor"]
            self.assertEqual(scale["not_tested"], inputs)
            self.assertIsNone(scale["replayed"])
            self.assertIsNone(scale["replayed_at_rest"])
        self.assertNotIn("1.000000", answer.stdout)
        self.assertIn("not tested, no replay moves quadrature", answer.stdout)

    def test_what_is_eaten_beyond_the_full_scale_asked_for(self):
        rates = [-400, -200, 200, 400]
        self.cheat(["rate"], "table", {
            "temperatures_degC": rates,
            "values_deg_per_s": [self.offset + eaten
                                 for eaten in (-200, 0, 0, 200)]})
        self.judged(status=0)
        answer = self.beamgyro("validate", "c.json", "test.h5",
                               "--full-scale", 400)
        self.assertIn("verdict: cancels the rate", answer.stdout)
        self.rejected("validate", "c.json", "test.h5", "--full-scale", -1,
                      says="--full-scale")


class Yardsticks(Validate):
    def test_the_cubic_of_the_file_is_only_claimed(self):
        """A huge one flatters, and the fitted one tells."""
        forged = {**self.cubic["baseline"],
                  "bias_scale": {"centre": 0.0, "half_width": 1e3}}
        self.compensator(baseline=forged)
        said, answer = self.judged(status=0)
        overall = said["overall"]
        self.assertLess(overall["percent_of_cubic"], 1e-3)
        self.assertEqual(overall["cubic"]["source"], "claimed by the file")
        self.assertIn("claimed by the file", answer.stdout)
        with h5py.File(self.dir / "test.h5") as file:  # the last block is short
            T, rate = (np.array([file[name][k:k + 60].mean()
                                 for k in range(0, len(file["time"]), 60)])
                       for name in ["temperature", "rate"])
        fit = np.polynomial.Polynomial.fit(T, rate, 3)
        fitted = overall["fitted_to_these_runs"]
        for name, left in [("constant", rate - rate.mean()),
                           ("cubic", rate - fit(T))]:
            self.assertAlmostEqual(fitted[name]["rms_deg_per_s"],
                                   np.sqrt(np.mean(left ** 2)), delta=1e-9)
        self.assertIn("cubic", overall["worse_than"])

    def test_worse_than_a_constant_is_said(self):
        """Half of a large offset is taken off."""
        self.cheat(["temperature"], "polynomial", {
            "coefficients": [0.5 * self.offset], "slopes": []})
        said, answer = self.judged(status=0)
        self.assertIn("constant", said["overall"]["worse_than"])
        self.assertIn("worse than a constant", answer.stdout)


class Twice(Validate):
    def test_a_recording_counts_once(self):
        shutil.copy(self.dir / "test.h5", self.dir / "copy.h5")
        for other in "test.h5", "./test.h5", "copy.h5":
            for more in [], ["--report", "page"]:
                with self.subTest((other, more)):
                    self.rejected("validate", "cubic.json", "test.h5", other,
                                  *more, says=["test.h5", "same recording"])

    def test_intervals_without_a_device_are_called_too_narrow(self):
        spec = ROOT / "specs/uav.toml"
        self.run_scenario("one", text=ramp(seed=9))
        self.ok("run", "one.toml", "-o", "one.csv")  # which holds no device
        for run, warned in [("one.h5", 0), ("one.csv", 1)]:
            answer = self.beamgyro("validate", "cubic.json", run, "--spec",
                                   spec, "--json", "v.json")
            found = json.loads((self.dir / "v.json").read_text())["warnings"]
            self.assertEqual(
                sum("one.csv: no device is stated" in text
                    for text in found), warned, found)
            self.assertEqual("too narrow" in answer.stderr, bool(warned))

    def test_the_table_is_told_though_the_file_cannot_be_written(self):
        told = self.beamgyro("validate", "cubic.json", "test.h5")

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
        answer = self.beamgyro("validate", "cubic.json", "test.h5", "--json",
                               "v.json", preexec_fn=limit)
        self.assertEqual(answer.returncode, 1)
        self.assertEqual(answer.stdout, told.stdout)
        self.assertIn("v.json: cannot write", answer.stderr)


class InSample(Validate):
    def in_sample(self, run):
        answer = self.beamgyro("validate", "cubic.json", run, "--json",
                               "v.json")
        said = json.loads((self.dir / "v.json").read_text())
        (score,) = said["runs"]
        self.assertEqual(any("in-sample" in text for text in said["warnings"]),
                         score["in_sample"])
        self.assertEqual("used in training: these scores are in-sample"
                         in answer.stderr, score["in_sample"])
        return score["in_sample"]

    def test_a_training_run_is_known_by_what_was_measured(self):
        self.assertTrue(self.in_sample("train.h5"))
        self.assertFalse(self.in_sample("test.h5"))
        shutil.copy(self.dir / "train.h5", self.dir / "named.h5")
        with h5py.File(self.dir / "named.h5", "r+") as file:
            file.attrs["comment"] = "another day"
        self.assertTrue(self.in_sample("named.h5"))
        self.ok("compensate", "cubic.json", "train.h5", "-o", "out.h5")
        self.assertTrue(self.in_sample("out.h5"))

    def changed(self, change):
        """The training run, changed by change(file)."""
        shutil.copy(self.dir / "train.h5", self.dir / "changed.h5")
        with h5py.File(self.dir / "changed.h5", "r+") as file:
            change(file)
        return "changed.h5"

    def test_it_is_known_though_moved_turned_round_or_mended(self):
        def moved(file):
            file["time"][...] += 3600

        def turned_round(file):
            for name in ["output", "rate", "temperature", "quadrature",
                         "drive_frequency", "drive_voltage"]:
                file[name][...] = file[name][()][::-1]

        def mended(file):
            file["rate"][7] += 1e-9

        for change in [moved, turned_round, mended]:
            self.assertTrue(self.in_sample(self.changed(change)), change)

        def other_values(file):
            file["rate"][...] += 1e-9

        self.assertFalse(self.in_sample(self.changed(other_values)))

    def test_it_cannot_be_held_out_under_another_name(self):
        shutil.copy(self.dir / "train.h5", self.dir / "named.h5")
        with h5py.File(self.dir / "named.h5", "r+") as file:
            file.attrs["comment"] = "another day"
        self.rejected("train", "train.h5", "--held-out", "named.h5", "--model",
                      "cubic.toml", "-o", "c.json",
                      says=["named.h5", "train.h5"])

    def test_a_file_that_names_no_training_is_said_to_be_one(self):
        self.assertNotIn("names no recording", self.beamgyro(
            "validate", "cubic.json", "test.h5").stderr)
        self.cubic["training"]["files"] = []
        self.compensator()
        said, answer = self.judged("train.h5", status=0)
        self.assertFalse(said["runs"][0]["in_sample"])
        self.assertIn("names no recording that it was trained on",
                      answer.stderr)
        self.assertIn("names no recording", said["warnings"][0])

    def test_files_without_the_new_keys_are_read(self):
        for file in self.cubic["training"]["files"]:
            del file["measured_sha256"], file["measured_sketch"]
        self.write("cubic.json", json.dumps(self.cubic))
        self.assertTrue(self.in_sample("train.h5"))


if __name__ == "__main__":
    unittest.main()
