# SPDX-License-Identifier: MIT
"""Bad input: one clear message, exit status 2, nothing written or damaged."""

import re
import unittest

import h5py

from program import CUBIC, NETWORK, SCENARIO, ProgramTest, ramp

PLACE = re.compile(r"\.(toml|csv):\d+:\d+")


class BadScenario(ProgramTest):
    def run_rejected(self, text, says, place=True):
        self.write("s.toml", text)
        message = self.rejected("run", "s.toml", "-o", "out.h5", says=says)
        if place:
            self.assertRegex(message, PLACE)
        return message

    def changed(self, old, new):
        self.assertIn(old, SCENARIO)
        return SCENARIO.replace(old, new)

    def test_missing_files(self):
        self.rejected("run", "missing.toml", "-o", "out.h5",
                      says="missing.toml")
        self.run_rejected(self.changed("device.toml", "gone.toml"), "gone.toml",
                          place=False)
        self.run_rejected(
            self.changed("constant_degC = 25", 'file = "gone.csv"'), "gone.csv")

    def test_text_that_is_not_toml(self):
        for text in ["[[[", "name = \n", "a b c\n", "x = 1 é\n", "\0\1"]:
            with self.subTest(text):
                self.run_rejected(text, "s.toml")
        self.run_rejected(b"name = \"\xff\xfe\"\n", "s.toml", place=False)
        self.run_rejected("", "s.toml", place=False)

    def test_a_directory_is_no_scenario(self):
        (self.dir / "folder.toml").mkdir()
        self.rejected("run", "folder.toml", "-o", "out.h5", says="folder.toml")

    def test_unknown_keys_are_answered_with_the_nearest(self):
        self.run_rejected(self.changed("duration_s", "duraton_s"),
                          ["duraton_s", "duration_s"])
        self.run_rejected(SCENARIO.replace("[ambient]", "[ambiant]"),
                          ["ambiant", "ambient"])
        device = (self.dir / "device.toml").read_text()
        self.write("device.toml", device.replace("length_m", "lenght_m", 1))
        self.run_rejected(SCENARIO, ["lenght_m", "length_m", "device.toml"])

    def test_wrong_types(self):
        self.run_rejected(self.changed("duration_s = 600",
                                       'duration_s = "long"'),
                          ["duration_s", "long"])
        self.run_rejected(self.changed("constant_degC = 25",
                                       "constant_degC = [25]"),
                          "constant_degC")
        self.run_rejected(self.changed("seed = 7", "seed = 7.5"),
                          ["seed", "7.5"])
        self.run_rejected(self.changed('name = "short"', "name = 1"), "name")

    def test_numbers_that_are_not_finite(self):
        for value in ["nan", "inf", "-inf"]:
            with self.subTest(value):
                self.run_rejected(self.changed("= 600", f"= {value}"),
                                  ["duration_s", value.lstrip("-")])
                self.run_rejected(
                    self.changed("constant_degC = 25",
                                 f"points = [[0, 20], [9, {value}]]"),
                    "points")

    def test_device_values_outside_their_range(self):
        for key, value in [("beam.density_kg_per_m3", "-8050"),
                           ("beam.length_m", "0"),
                           ("patches.thickness_m", "-1e-4"),
                           ("bond.thickness_m", "[1e-5, 1e-5, 1e-5]"),
                           ("beam.poisson_ratio", "0.7"),
                           ("readout.adc_bits", "0"),
                           ("drive.amplitude_m", "nan")]:
            with self.subTest(key):
                self.write("s.toml", SCENARIO)
                self.rejected("run", "s.toml", "-o", "out.h5", "--set",
                              f"{key}={value}", says=key.split(".")[1])

    def test_profiles_that_are_empty_or_run_backwards(self):
        for form in ["points = []", "points = [[10, 20], [5, 30]]",
                     "points = [[10, 20], [10, 30]]", "points = [[1, 2, 3]]",
                     "points = [5]"]:
            with self.subTest(form):
                self.run_rejected(self.changed("constant_degC = 25", form),
                                  "points")
        self.run_rejected(SCENARIO + "[rate]\nsteps = [[5, 1], [4, 2]]\n",
                          "steps")
        self.run_rejected(
            SCENARIO + "[power]\non_s = [0, 100]\noff_s = [200]\n", "off_s")

    def test_profile_files_that_are_empty_or_run_backwards(self):
        scenario = self.changed("constant_degC = 25", 'file = "log.csv"')
        head = "time_s,temperature_degC\n"
        for text, says in [("", "log.csv"), (head, "log.csv"),
                           (head + "0,20\n5,21\n5,22\n", "log.csv:4"),
                           (head + "0,20\n5,warm\n", "log.csv:3"),
                           (head + "0,20\n5\n", "log.csv:3"),
                           (head + "0,nan\n", "log.csv:2"),
                           ("t,T\n0,20\n", "log.csv:1")]:
            with self.subTest(text):
                self.write("log.csv", text)
                self.run_rejected(scenario, says, place=False)

    def test_a_profile_has_exactly_one_form(self):
        self.run_rejected(SCENARIO + "points = [[0, 25]]\n",
                          ["constant_degC", "points"])
        self.run_rejected(SCENARIO.replace("constant_degC = 25\n", ""),
                          "ambient")

    def test_duration_and_output_rate(self):
        self.run_rejected(self.changed("= 600", "= 0"), ["duration_s", "0"])
        self.run_rejected(self.changed("= 600", "= -5"), ["duration_s", "-5"])
        self.run_rejected(self.changed("= 600", "= 0.2"), "duration_s")
        self.run_rejected(self.changed("= 600", "= 1e12"), "duration_s")
        self.run_rejected(self.changed("= 600", "= 1e300"), "duration_s")
        self.run_rejected(self.changed("output_rate_Hz = 2",
                                       "output_rate_Hz = 201"),
                          ["output_rate_Hz", "201", "200"])

    def test_fidelities_and_modes(self):
        self.run_rejected(self.changed("quasistatic", "quasi"), "quasistatic")
        self.rejected("characterise", "device.toml", "-o", "out.csv", "--set",
                      'readout.mode="whole_angle"', says=["mode", "open_loop"])
        self.run_rejected(
            self.changed("quasistatic", "envelope").replace(
                "output_rate_Hz = 2", "output_rate_Hz = 2001"),
            ["output_rate_Hz", "2001", "2000"])
        self.run_rejected(
            self.changed("quasistatic", "carrier").replace(
                "output_rate_Hz = 2", "output_rate_Hz = 2500"),
            ["output_rate_Hz", "2500", "quarter"], place=False)

    def test_a_carrier_run_of_hours_wants_consent(self):
        self.run_rejected(
            self.changed("quasistatic", "carrier").replace("= 600", "= 9000"),
            ["9000 s", "--yes"], place=False)

    def test_motion_of_the_other_axes(self):
        for lines, says in [
                ("[cross_rate]\nz = { constant_deg_per_s = 1 }",
                 "cross_rate.z"),
                ("[cross_rate]\nx = { constant_g = 1 }",
                 "constant_deg_per_s"),
                ("[acceleration]\nx = 9.81", "acceleration.x"),
                ("[acceleration]\ny = { sine = { amplitude_g = 1 } }",
                 "frequency_Hz"),
                ("[acceleration]\nz = { constant_g = inf }", "constant_g")]:
            with self.subTest(lines):
                self.run_rejected(SCENARIO + "\n" + lines + "\n", says)

    def test_a_drive_that_cannot_hold_its_amplitude(self):
        for fidelity in ["quasistatic", "envelope", "carrier"]:
            with self.subTest(fidelity):
                text = SCENARIO.replace("quasistatic", fidelity).replace(
                    "= 600", "= 2")
                self.write("s.toml", text)
                arguments = ["run", "s.toml", "-o", "out.h5", "--set",
                             "drive.voltage_limit_V=0.4"]
                self.rejected(*arguments, "--stop-on-unlock", status=1,
                              says=["not locked at 1", "drive at 0.4 V"])
                self.ok(*arguments)

    def test_a_board_that_nothing_stands_is_named_with_its_cause(self):
        for fidelity in ["quasistatic", "envelope", "carrier"]:
            with self.subTest(fidelity):
                self.write("s.toml", SCENARIO.replace("quasistatic", fidelity)
                           .replace("= 600", "= 5"))
                self.rejected("run", "s.toml", "-o", "out.h5", "--set",
                              "thermal.electronics_power_W=600", status=1,
                              says=["board at 1", "-100 to 150 degC",
                                    "ceramic", "electronics_power_W = 600"])

    def test_overrides(self):
        self.write("s.toml", SCENARIO)
        for argument, says in [("beam.lenght_m=0.04", "beam.length_m"),
                               ("beam.length_m", "beam.length_m"),
                               ("beam.length_m=", "beam.length_m"),
                               ("beam.length_m=forty", "forty"),
                               ("duration_s=0", "duration_s"),
                               ("=3", "=3")]:
            with self.subTest(argument):
                self.rejected("run", "s.toml", "-o", "out.h5", "--set",
                              argument, says=says)

    def test_outputs_that_cannot_be_written(self):
        self.write("s.toml", SCENARIO)
        (self.dir / "folder.h5").mkdir()
        for output in ["nowhere/out.h5", "folder.h5", "s.toml/out.h5",
                       "out.txt", ""]:
            with self.subTest(output):
                self.rejected("run", "s.toml", "-o", output, says=output)
        self.rejected("characterise", "device.toml", "-o", "nowhere/out.csv",
                      says="nowhere")

    def test_a_failure_leaves_the_old_output_alone(self):
        self.write("out.h5", "precious")
        self.run_rejected(self.changed("= 600", "= 0"), "duration_s")


class BadData(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("cubic.toml", CUBIC)
        self.write("bp.toml", NETWORK)

    def test_files_that_are_not_recordings(self):
        self.write("text.h5", "not HDF5\n")
        with h5py.File(self.dir / "other.h5", "w") as file:
            file["x"] = [1.0]
        whole = self.run_scenario("run").read_bytes()
        self.write("half.h5", whole[:len(whole) // 2])
        self.write("empty.h5", "")
        for name in ["text.h5", "other.h5", "half.h5", "empty.h5", "gone.h5"]:
            with self.subTest(name):
                self.rejected("info", name, says=name)
                self.rejected("train", name, "--model", "cubic.toml", "-o",
                              "c.json", says=name)
                self.rejected("allan", name, says=name)

    def test_model_files(self):
        self.run_scenario("run", text=ramp())
        for text, says in [("kind = \"cubist\"\n", "cubist"),
                           (CUBIC.replace("temperature", "temprature"),
                            "temprature"),
                           (CUBIC.replace("temperature", "true_bias"),
                            "true_bias"),
                           (CUBIC.replace("degree = 3", "degree = -1"),
                            "degree"),
                           (CUBIC.replace("degree", "degre"), "degre"),
                           (CUBIC.replace('["temperature"]', "[]"), "inputs"),
                           (NETWORK.replace("[2]", "[0]"), "hidden"),
                           (NETWORK.replace("levenberg_marquardt", "magic"),
                            "magic")]:
            with self.subTest(text):
                self.write("m.toml", text)
                self.rejected("train", "run.h5", "--model", "m.toml",
                              "--held-out", "run.h5", "-o", "c.json", says=says)

    def test_a_network_asks_for_held_out_runs(self):
        self.run_scenario("run", text=ramp())
        self.rejected("train", "run.h5", "--model", "bp.toml", "-o", "c.json",
                      says="held-out")

    def test_a_recording_without_the_inputs(self):
        self.run_scenario("run", text=ramp())
        self.run_scenario("held_out", text=ramp(seed=9))
        self.write("m.toml", NETWORK.replace(
            '["temperature"]', '["temperature", "quadrature"]'))
        self.ok("train", "run.h5", "--model", "m.toml", "--held-out",
                "held_out.h5", "-o", "c.json")
        with h5py.File(self.dir / "run.h5", "a") as file:
            del file["quadrature"]
        for command in [["train", "run.h5", "--model", "m.toml", "--held-out",
                         "held_out.h5", "-o", "d.json"],
                        ["compensate", "c.json", "run.h5", "-o", "out.h5"],
                        ["validate", "c.json", "run.h5"]]:
            with self.subTest(command[0]):
                self.rejected(*command, says=["quadrature", "run.h5"])

    def test_a_compensator_cut_in_half(self):
        self.run_scenario("run", text=ramp())
        self.ok("train", "run.h5", "--model", "cubic.toml", "-o", "c.json")
        whole = (self.dir / "c.json").read_bytes()
        for name, data in [("half.json", whole[:len(whole) // 2]),
                           ("empty.json", b""), ("other.json", b"{}"),
                           ("kind.json", whole.replace(
                               b"beamgyro-compensator", b"beamgyro-recording"))]:
            self.write(name, data)
            with self.subTest(name):
                self.rejected("compensate", name, "run.h5", "-o", "out.h5",
                              says=name)
                self.rejected("validate", name, "run.h5", says=name)

    def test_compensate_does_not_write_over_its_input(self):
        self.run_scenario("run", text=ramp())
        self.ok("train", "run.h5", "--model", "cubic.toml", "-o", "c.json")
        self.rejected("compensate", "c.json", "run.h5", "-o", "nowhere/o.h5",
                      says="nowhere")

    def test_allan_input(self):
        self.run_scenario("run")
        self.rejected("allan", "run.h5", "--dataset", "rte",
                      says=["rte", "rate"])
        for text in ["", "rate\n", "1\nx\n3\n", "1\nnan\n3\n"]:
            with self.subTest(text):
                self.write("s.csv", text)
                self.rejected("allan", "s.csv", "--rate-Hz", 10, says="s.csv")


if __name__ == "__main__":
    unittest.main()
