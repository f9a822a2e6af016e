# SPDX-License-Identifier: MIT
"""Options and values that are mistyped."""

import unittest

import h5py

from program import SCENARIO, ProgramTest


class Options(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SCENARIO)

    def test_an_unknown_option_is_answered_with_the_nearest(self):
        for option, meant in [("--outptu", "--output"),
                              ("--fidelty", "--fidelity"),
                              ("--sead", "--seed"), ("-seed", "--seed"),
                              ("--quite", "--quiet"), ("--Output", "--output"),
                              ("--outptu=a.h5", "--output")]:
            with self.subTest(option):
                self.rejected("run", "s.toml", option, "a.h5",
                              says=[f'"{option.split("=")[0]}"',
                                    f'did you mean "{meant}"?'])
        self.rejected("run", "s.toml", "-o", "a.h5", "--frobnicate",
                      says=['"--frobnicate"', "see beamgyro run --help"])
        self.rejected("--verison", says='did you mean "--version"?')

    def test_what_is_missing_is_named(self):
        self.rejected("run", "s.toml",
                      says="--output is missing; expected beamgyro run "
                           "SCENARIO.toml -o RUN.h5")
        self.rejected("run", "-o", "a.h5", says="SCENARIO.toml is missing")
        self.rejected("run", "s.toml", "-o", says="-o has no value")
        self.rejected("run", "s.toml", "s2.toml", "-o", "a.h5",
                      says=['"s2.toml"', "expected beamgyro run"])
        self.rejected(says="see beamgyro --help")

    def test_a_long_name_behind_one_dash_is_no_value(self):
        for word in ["-output=a.h5", "-output"]:
            self.rejected("run", "s.toml", word, "a.h5",
                          says=['"-output"', 'did you mean "--output"?'])
        self.rejected("run", "s.toml", "-o=a.h5", says="expected -o a.h5")
        self.rejected("run", "s.toml", "-o", "a.h5", "-quiet",
                      says='did you mean "--quiet"?')
        self.ok("run", "s.toml", "-oa.h5")

    def test_an_option_without_its_value_is_the_one_that_is_named(self):
        for words, name in [(["-o", "--seed", "3"], "-o"),
                            (["-o", "a.h5", "--set", "--seed", "3"], "--set"),
                            (["-o", "a.h5", "--seed="], "--seed"),
                            (["--output=", "--seed", "3"], "--output")]:
            self.rejected("run", "s.toml", *words,
                          says=f"{name} has no value; expected {name} ")
        self.rejected("train", "r.h5", "--held-out", "--model", "m.toml", "-o",
                      "c.json", says="--held-out has no value")

    def test_what_is_given_too_often_is_named(self):
        self.rejected("run", "s.toml", "-o", "a.h5", "--output", "b.h5",
                      says="--output is given twice")
        self.rejected("generate", "s.toml", "-o", "d", "--strict=yes",
                      says="--strict takes no value")
        self.rejected("export", "a", "b", "c", "d", "--format", "px4", "-o",
                      "fw", says="expected beamgyro export")

    def test_json_does_not_replace_a_file_of_another_kind(self):
        self.ok("run", "s.toml", "-o", "a.h5")
        before = (self.dir / "a.h5").read_bytes()
        self.rejected("allan", "a.h5", "--json", "b.h5",
                      says='--json b.h5: is the name of a file of another kind')
        self.rejected("allan", "a.h5", "--json", "b.toml", says="--json b.toml")
        self.assertEqual((self.dir / "a.h5").read_bytes(), before)

    def test_a_wrong_number_is_answered_in_plain_words(self):
        for value, wrong in [("abc", "not a whole number"),
                             ("1.5", "not a whole number"),
                             ("", "not a whole number"),
                             ("7x", "not a whole number"),
                             ("99999999999999999999", "out of range"),
                             ("9223372036854775808", "out of range"),
                             ("-1", "out of range")]:
            with self.subTest(value):
                self.rejected(
                    "run", "s.toml", "-o", "a.h5", "--seed", value,
                    says=f"--seed {value}: {wrong}; expected a whole number "
                         "from 0 to 9223372036854775807")
        self.rejected("generate", "s.toml", "-o", "d", "--jobs", "0",
                      says="--jobs 0: out of range; expected a whole number "
                           "from 1 to 4096")
        self.rejected("allan", "s.csv", "--rate-Hz", "fast",
                      says="--rate-Hz fast: not a number")
        self.rejected("allan", "s.csv", "--from", "nan",
                      says="--from nan: not finite")

    def test_the_largest_seed_is_itself(self):
        self.ok("run", "s.toml", "-o", "a.h5", "--seed", 2**63 - 1)
        with h5py.File(self.dir / "a.h5") as file:
            self.assertEqual(file.attrs["seed"], 2**63 - 1)

    def test_a_wrong_word_is_answered_with_the_right_ones(self):
        self.rejected("run", "s.toml", "-o", "a.h5", "--fidelity", "carier",
                      says="--fidelity carier: not known; expected "
                           "quasistatic, envelope, carrier; "
                           'did you mean "carrier"?')
        self.rejected("train", "r.h5", "--model", "m.toml", "-o", "c.json",
                      "--cv", "day", says="expected run, cycle, leg")


if __name__ == "__main__":
    unittest.main()
