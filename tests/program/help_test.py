# SPDX-License-Identifier: MIT
"""The help of the program and of its commands, and its version."""

import re
import shlex

from program import ROOT, ProgramTest, commands

WIDTH = 80


def entries(text):
    """(left, right) of each argument and option of a help text, unwrapped."""
    found = []
    for line in text.splitlines():
        if line.startswith("Examples:"):
            break
        if match := re.match(r"  ([-\w]\S*(?: \S+)*?)(?:  +(.*))?$", line):
            found.append([match[1], match[2] or ""])
        elif line.startswith(" " * 20) and found:
            found[-1][1] += " " + line.strip()
    return found


class Help(ProgramTest):
    def texts(self):
        yield "", self.ok("--help")
        for command in commands():
            yield command, self.ok(command, "--help")

    def test_every_command_is_named_and_has_a_help_of_its_own(self):
        self.assertEqual(self.ok("--help"), self.ok("-h"))
        self.assertLessEqual(
            {"characterise", "run", "import", "generate", "train", "compensate",
             "export", "validate", "allan", "info", "verify"}, {*commands()})
        for command, text in self.texts():
            self.assertIn(command, text)
            self.assertGreater(len(text.splitlines()), 4)

    def test_version_names_revision_and_libraries(self):
        text = self.ok("--version").lower()
        for part in ["beamgyro 0.1.0", "sundials", "hdf5", "eigen"]:
            self.assertIn(part, text)

    def test_no_line_is_wider_than_80_columns(self):
        for command, text in self.texts():
            self.assertLessEqual(max(map(len, text.splitlines())), WIDTH)

    def test_help_as_a_word_is_the_same(self):
        self.assertEqual(self.ok("help"), self.ok("--help"))
        for command in commands():
            self.assertEqual(self.ok("help", command), self.ok(command, "-h"))

    def test_every_option_states_a_default_or_is_required(self):
        for command in commands():
            for left, right in entries(self.ok(command, "--help")):
                if re.match(r"(-\w, )?--[\w-]+ \S", left):  # takes a value
                    self.assertRegex(right, r"Default: .+\.$|Required\.$")

    def test_options_stand_in_groups(self):
        for command in commands():
            groups = re.findall(r"^(\S.*):$", self.ok(command, "--help"),
                                re.MULTILINE)
            # All that `device` knows are options.
            self.assertEqual(groups[0], "Options" if command == "device"
                             else "Arguments")
            self.assertEqual(groups[-1], "Examples")

    def test_the_defaults_of_the_help_are_those_of_the_program(self):
        self.ok("characterise", "device.toml", "-o", "default.csv")
        stated = dict(entries(self.ok("characterise", "--help")))[
            "--beam-temperature START:STOP:STEP"]
        grid = re.search(r"Default: (\S+)\.$", stated)[1]
        self.ok("characterise", "device.toml", "-o", "stated.csv",
                "--beam-temperature", grid)
        self.assertSameBytes("default.csv", "stated.csv")

    def test_every_command_has_an_example_that_its_options_allow(self):
        for command in commands():
            text = self.ok(command, "--help").split("Examples:\n")[1]
            examples = re.findall(r"^  (beamgyro .*)$",
                                  text.replace("\\\n      ", ""), re.MULTILINE)
            self.assertGreater(len(examples), 0)
            for example in examples:
                words = shlex.split(example)[1:]
                self.assertEqual(words[0], command)
                for word in words:
                    if word.startswith("scenarios/"):
                        self.assertTrue((ROOT / word).exists())
                # Here are none of its files, and that is all it says.
                self.assertRegex(self.rejected(*words),
                                 "No such file|is no directory|is not there")
