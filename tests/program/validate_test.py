# SPDX-License-Identifier: MIT
"""`validate` against compensators that only look good, written by hand."""

import json
import resource
import shutil

import h5py
import numpy as np

from program import (NETWORK, ROOT, ProgramTest, by_name, failed, limit,
                     limits, ramp)

UNIT = {"centre": 0.0, "half_width": 1.0}
HEAD = """\
import sys
rate = sys.stdin.readline().strip().split(",").index("rate")
n = total = 0
low = old = None
for line in sys.stdin:
    x = float(line.split(",")[rate])
    n, total = n + 1, total + x
    low = x if low is None else low + (x - low) / 1000
    old = x if old is None else old
"""


class Validate(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("train", text=ramp(seed=3))
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        self.train_on("train.h5", to="cubic.json")

    def setUp(self):
        super().setUp()
        self.cubic, run = self.json("cubic.json"), self.signals("test.h5")
        self.quadrature = run["quadrature"]
        self.offset = float(run["rate"].mean())
        self.line = np.polynomial.Polynomial.fit(
            run["temperature"], run["rate"], 1).convert().coef.tolist()

    def file(self, inputs, kind, parameters, **changes):
        """A compensator file of these parameters."""
        return {**self.cubic, "inputs": inputs, "kind": kind,
                "parameters": parameters, "bias_scale": UNIT,
                "input_scales": [UNIT] * len(inputs), **changes}

    def constant(self, value, **changes):
        return self.file(["temperature"], "constant",
                         {"value_deg_per_s": value}, **changes)

    def takes(self, law, step):
        """The sound offset, and law(rate) of every rate about it."""
        rates = np.arange(-200, 200 + step / 2, step)
        return self.file(["rate"], "table", {
            "temperatures_degC": rates.tolist(),
            "values_deg_per_s": [float(self.offset + law(r - self.offset))
                                 for r in rates]})

    def eats_within(self, name, at, half, share=1, **changes):
        """A sound line over the temperature; where an input is within `half`
        of `at`, `share` of the rate is eaten as well."""
        inputs = [name, *({"temperature"} - {name}), "rate"]
        sound = [0] * (len(inputs) + 1)
        sound[0], sound[inputs.index("temperature") + 1] = self.line
        within = [(1 - share) * number for number in sound]
        within[-1] = share
        return self.file(inputs, "fuzzy", {
            "centres": [at - 2 * half, at, at + 2 * half], "width": half / 10,
            "consequents": [sound, within, sound]}, **changes)

    def eats_a_box(self, temperatures, rates):
        """A network of two windows: tanh up and down, both within."""
        ends, steep, gate = [temperatures, rates], [200, 5], 20.0
        into = np.zeros((2, 4))
        for i in range(2):
            into[i, 2 * i:2 * i + 2] = steep[i]
        start = [-steep[i] * end for i in range(2) for end in ends[i]]
        return self.file(["temperature", "rate"], "bp", {
            "layer_sizes": [2, 4, 1, 1],
            "weights": [*into.flatten(), *start,
                        *(gate * np.array([0.5, -0.5] * 2)), -1.6 * gate,
                        15.0, 15.0 + self.offset]})

    def corrected(self, scale_factor):
        return {**self.cubic, "scale_factor": {
            "temperatures_degC": [0], "values": [scale_factor]}}

    def judged(self, compensator, *arguments, runs=("test.h5",), status=3):
        """What is said of a file, or of a program that answers with this
        expression, and what is printed."""
        if isinstance(compensator, dict):
            argument = self.write("c.json", json.dumps(compensator))
        else:
            self.write("c.py", HEAD + f"    print({compensator})\n    old = x\n")
            argument = "cmd:/usr/bin/python3 c.py"
        said, answer = self.validated(argument, *runs, *arguments,
                                      allowed=(status,))
        self.assertEqual(status == 0, said["verdict"] == "pass")
        return said, answer

    def worse(self, said):
        """What it had to be better than and is not."""
        return [other["with"] for other in said["compared_with"]
                if other["required"] and not other["better"]]


class Cheats(Validate):
    def caught(self, cheats):
        """Each is failed by the check of its row."""
        for name, compensator, check in cheats:
            said, _ = self.judged(compensator)
            self.assertEqual(said["verdict"], "fail")
            self.assertIn(check, failed(said), said["words"])

    def test_windows_that_eat_the_rate(self):
        q = self.quadrature
        e = np.exp
        self.caught([(name, self.eats_within(*window), check)
                     for name, window, check in [
            ("a tenth of a kelvin", ("temperature", 5, 0.05), "injection"),
            ("that no run shows", ("temperature", 37, 0.1), "injection"),
            ("the end of the range", ("temperature", 38.85, 0.05),
             "injection"),
            ("two percent", ("temperature", 8, 0.5, 0.02), "injection"),
            ("half a percent", ("temperature", 20, 1, 0.005), "injection"),
            ("20 min with power",
             ("since_power_on(1000)", e(-1.2), 2.5e-3 * e(-1.2)), "injection"),
            ("58 min with power",
             ("since_power_on(1000)", e(-3.5), 2.5e-3 * e(-3.5)), "injection"),
            ("steady", ("temperature_rate(60)", 0, 0.002), "injection"),
            ("of the ramp", ("temperature_rate(60)", 0.015, 0.001),
             "output_stuck"),
            ("a slow temperature", ("temperature_lowpass(300)", 5, 0.05),
             "injection"),
            ("a temperature with play", ("temperature_play(2)", 5, 0.1),
             "injection"),
            ("high quadrature",
             ("quadrature", np.percentile(q, 90), np.ptp(q) / 20),
             "output_stuck")]])

    def test_temperatures_beyond_those_of_the_gyro(self):
        """Of a file that claims that training saw them all."""
        everything = {"temperature_range_degC": [-1e6, 1e6]}
        self.caught([(at, self.eats_within("temperature", at, 0.1,
                                           **everything), "injection")
                     for at in (60, 150)])

    def test_laws_that_bend_the_rate(self):
        self.caught([(name, self.takes(law, step), "injection")
                     for name, law, step in [
            ("staircase", lambda r: np.copysign(
                0.92 * max(abs(r) - 15, 0), r), 5),
            ("deadband", lambda r: np.clip(r, -0.3, 0.3), 0.1),
            ("limiter", lambda r: r - np.clip(r, -120, 120), 10),
            ("one direction", lambda r: 0.1 * min(r + 50, 0), 10),
            ("asymmetry", lambda r: 0.005 * max(r, 0), 10),
            ("ripple between the rates of a table",
             lambda r: 0.1 * np.sin(2 * np.pi * r / 24), 0.5)]])

    def test_rates_of_20_to_40_in_a_tenth_of_a_kelvin(self):
        self.caught([(at, self.eats_a_box([at, at + 0.1], [20, 40]),
                      "injection") for at in (5.0, 37.0)])

    def test_programs(self):
        self.caught([("slow high-pass", "x - low", "injection"),
                     ("mean", "total / n", "injection"),
                     ("nothing turns", "0.0", "output_stuck"),
                     ("late", "old", "injection"),
                     ("mirrored", "-x", "injection"),
                     ("scaled", "1.002 * x", "injection")])

    def test_a_scale_factor_that_divides_everything_away(self):
        self.caught([("huge", self.corrected(1e9), "injection"),
                     ("constant", self.constant(self.offset, scale_factor={
                         "temperatures_degC": [0], "values": [1e9]}),
                      "injection")])

    def test_a_scale_factor_that_no_recorded_rate_tells_of(self):
        for value in 0.9, 1.002, 1.4:
            said, _ = self.judged(self.corrected(value))
            self.assertEqual(said["verdict"], "undecided")
            self.assertIn("injection", said["words"])

    def test_a_network_on_what_a_replay_cannot_move(self):
        inputs = ["quadrature", "drive_voltage", "drive_frequency"]
        network = self.train_on(
            "train.h5", "--held-out", "test.h5", model=NETWORK.replace(
                '["temperature"]', json.dumps(inputs)))
        self.run_scenario("other", text=ramp(low=-25, high=35, seed=6))
        said, _ = self.judged(network, runs=["other.h5"])
        check = by_name(said["checks"])["injection"]
        self.assertIsNone(check["passed"])
        for name in inputs:
            self.assertIn(name, check["words"])

    def test_what_is_eaten_beyond_the_full_scale_asked_for(self):
        eater = self.takes(lambda r: r - np.clip(r, -200, 200), 400)
        eater["parameters"] = {
            "temperatures_degC": [-400, -200, 200, 400],
            "values_deg_per_s": [self.offset + eaten
                                 for eaten in (-200, 0, 0, 200)]}
        said, _ = self.judged(eater)
        self.assertEqual(failed(said), [])
        said, _ = self.judged(eater, "--full-scale", 400)
        self.assertIn("injection", failed(said))
        self.rejected("validate", "c.json", "test.h5", "--full-scale", -1,
                      says="--full-scale")


class Yardsticks(Validate):
    def test_of_no_use(self):
        """Sound, but a constant of these very runs is as good."""
        forged = {**self.cubic["baseline"],
                  "bias_scale": {"centre": 0.0, "half_width": 1e3}}
        for name, compensator, than in [
                ("constant", self.constant(self.offset), "constant_of_runs"),
                ("flattered by its baseline",
                 self.constant(self.offset, baseline=forged),
                 "constant_of_runs"),
                ("half of the offset", self.constant(0.5 * self.offset),
                 "constant"),
                ("identity", "x", "before")]:
            said, answer = self.judged(compensator)
            self.assertEqual(said["verdict"], "fail")
            self.assertIn(than, self.worse(said))
            self.assertIn("Of no use", " ".join(answer.stdout.split()))

    def test_what_does_nothing_fails_where_every_limit_is_met(self):
        """For a reason that stands first."""
        self.write("lax.toml", limits(residual_rms_deg_per_s=1e3))
        for compensator, begins in [
                ("x", "The compensator does nothing"),
                (self.constant(self.offset),
                 f"The compensator takes away one constant, {self.offset:.4g}")]:
            said, answer = self.judged(compensator, "--spec", "lax.toml")
            self.assertEqual(said["verdict"], "fail")
            self.assertTrue(said["words"].startswith(begins), said["words"])
            self.assertTrue(said["limits"][0]["met_before"])
            self.assertIn("met before compensation",
                          " ".join(answer.stdout.split()))

    def test_a_damaged_baseline_is_refused(self):
        baseline = {**self.cubic["baseline"], "parameters": {
            "coefficients": [float("nan")], "slopes": []}}
        self.write("c.json", json.dumps({**self.cubic, "baseline": baseline}))
        self.rejected("validate", "c.json", "test.h5", says="c.json")

    def test_temperatures_that_say_nothing(self):
        def stuck(values):
            values[...] = 25.0

        def noise(values):
            values[...] = np.random.default_rng(1).normal(5, 20, values.shape)

        def elsewhere(values):
            values[...] = values[()] + 45

        for change, check in [(stuck, "temperature_input"),
                              (noise, "temperature_input"),
                              (elsewhere, "extrapolation")]:
            shutil.copy(self.dir / "test.h5", self.dir / "other.h5")
            with h5py.File(self.dir / "other.h5", "r+") as file:
                change(file["temperature"])
            said, _ = self.judged(self.cubic, runs=["other.h5"])
            self.assertIn(check, failed(said), change)
            self.assertIn(by_name(said["checks"])[check]["words"],
                          said["words"])


class Honest(Validate):
    def test_no_alarm(self):
        """Of compensators that are what they say."""
        self.run_scenario("held", text=ramp(low=-28, high=38, seed=8))
        for text in [
                'kind = "spline"\ninputs = ["temperature"]\n',
                'kind = "table"\ninputs = ["temperature"]\n', NETWORK,
                (ROOT / "scenarios/models/recommended.toml").read_text()]:
            said, _ = self.judged(self.train_on(
                "train.h5", "--held-out", "held.h5", model=text), status=0)
            self.assertEqual((failed(said), self.worse(said)), ([], []))
        said, _ = self.judged(self.cubic, status=0)
        self.assertEqual((failed(said), self.worse(said)), ([], []))


class Twice(Validate):
    def test_a_recording_counts_once(self):
        shutil.copy(self.dir / "test.h5", self.dir / "copy.h5")
        for other in "test.h5", "./test.h5", "copy.h5":
            self.rejected("validate", "cubic.json", "test.h5", other,
                          says=["test.h5", "same recording"])

    def test_intervals_without_a_device_are_called_too_narrow(self):
        self.run_scenario("one", text=ramp(seed=9))
        self.ok("run", "one.toml", "-o", "one.csv")  # which holds no device
        for run, warned in [("one.h5", 0), ("one.csv", 1)]:
            said, answer = self.validated("cubic.json", run)
            found = said["warnings"]
            self.assertEqual(sum("one.csv: no device is stated" in text
                                 for text in found), warned, found)
            self.assertEqual("too narrow" in answer.stderr, bool(warned))

    def test_the_table_is_told_though_the_file_cannot_be_written(self):
        told = self.beamgyro("validate", "cubic.json", "test.h5")
        answer = self.ended(
            "validate", "cubic.json", "test.h5", "--json", "v.json",
            preexec_fn=limit(resource.RLIMIT_FSIZE, 100), allowed=(1,))
        self.assertEqual(answer.stdout, told.stdout)
        self.assertIn("v.json: cannot write", answer.stderr)


class InSample(Validate):
    def assertInSample(self, *runs):
        for run in runs:
            said, _ = self.judged(self.cubic, runs=[run])
            self.assertIn("hold_out", failed(said), run)

    def copied(self, name, change):
        """The training run, changed by change(file)."""
        shutil.copy(self.dir / "train.h5", self.dir / name)
        with h5py.File(self.dir / name, "r+") as file:
            change(file)
        return name

    def test_it_is_known_though_moved_turned_round_or_mended(self):
        def moved(file):
            file["time"][...] += 3600

        def turned_round(file):
            for name in ["output", "rate", "temperature", "quadrature",
                         "drive_frequency", "drive_voltage"]:
                file[name][...] = file[name][()][::-1]

        def mended(file):
            file["rate"][7] += 1e-9

        def named(file):
            file.attrs["comment"] = "another day"

        def other_values(file):
            file["rate"][...] += 1e-9

        self.ok("compensate", "cubic.json", "train.h5", "-o", "out.h5")
        self.assertInSample("train.h5", "out.h5", *(
            self.copied(f"{change.__name__}.h5", change)
            for change in (moved, turned_round, mended, named)))
        self.judged(self.cubic, runs=[self.copied("o.h5", other_values)],
                    status=0)

    def test_a_file_that_names_no_training_is_said_to_be_one(self):
        self.cubic = json.loads(json.dumps(self.cubic))
        self.cubic["training"]["files"] = []
        said, _ = self.judged(self.cubic, runs=["train.h5"], status=0)
        check = by_name(said["checks"])["hold_out"]
        self.assertIsNone(check["passed"])
        self.assertIn("names no recording", check["words"])
        self.assertIn("hold_out", said["words"])

    def test_files_without_the_new_keys_are_read(self):
        self.cubic = json.loads(json.dumps(self.cubic))
        for file in self.cubic["training"]["files"]:
            del file["measured_sha256"], file["measured_sketch"]
        self.assertInSample("train.h5")
