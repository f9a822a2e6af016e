# SPDX-License-Identifier: MIT
"""The checker of file-local names on small trees made to offend."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = (pathlib.Path(__file__).resolve().parents[2]
           / "scripts" / "check_names.py")


def local(text):
    return "namespace {\n\n" + text + "\n}  // namespace\n"


class CheckNames(unittest.TestCase):
    def check(self, files):
        with tempfile.TemporaryDirectory() as root:
            for path, text in files.items():
                file = pathlib.Path(root) / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            answer = subprocess.run([sys.executable, CHECKER, root],
                                    capture_output=True, text=True, check=False)
        self.assertEqual(answer.returncode, answer.stdout != "")
        return answer.stdout

    def test_a_constant_that_hides_one_of_a_header(self):
        answer = self.check({
            "compensation/a/a.cpp": local("constexpr double kSpan = 1e-9;\n"),
            "compensation/b/b.h": "constexpr double kSpan = 10.0;  // [K]\n"})
        self.assertEqual(answer, "kSpan: local to compensation/a/a.cpp, "
                         "declared in compensation/b/b.h\n")

    def test_a_function_that_two_sources_of_a_library_define(self):
        text = local("double scaled(double x) {\n  return x;\n}\n")
        answer = self.check({"sim/device/a.cpp": text,
                             "sim/device/b.cpp": text})
        self.assertIn("scaled: local to sim/device/a.cpp, sim/device/b.cpp",
                      answer)

    def test_a_type_that_two_headers_define(self):
        answer = self.check({
            "compensation/a/a.h": "struct Answered {\n  int k;\n};\n",
            "validation/b/b.h": "class Answered final : public Base {\n};\n",
            "api/c.h": "struct Answered::State {\n};\nclass Answered;\n"})
        self.assertEqual(answer, "Answered: a type in compensation/a/"
                         "a.h, validation/b/b.h\n")

    def test_a_constant_that_two_headers_define(self):
        answer = self.check({
            "sim/stepper/a.h": "inline constexpr double kLongest = 1e5;\n",
            "compensation/b.h": "constexpr double kLongest = 1.5;\n"})
        self.assertEqual(answer, "kLongest: a constant in compensation/b.h, "
                         "sim/stepper/a.h\n")

    def test_a_type_of_the_library_with_a_public_name(self):
        answer = self.check({
            "include/beamgyro/a.h": "class Gyro {\n};\nenum class Part {\n};\n",
            "sim/device/b.h": "struct Gyro {\n  int k;\n};\n"})
        self.assertEqual(answer, "Gyro: a type in sim/device/b.h, "
                         "include/beamgyro/a.h\n")

    def test_sources_of_python_meet_each_other_only(self):
        text = local("int options_of(int x) {\n  return x;\n}\n")
        header = "int options_of(int x);\n"
        answer = self.check({"python/core/a.cpp": text,
                             "api/a.h": header, "api/b.h": header})
        self.assertEqual(answer, "")
        answer = self.check({"python/core/a.cpp": text,
                             "python/core/b.cpp": text})
        self.assertIn("options_of: local to python/core/a.cpp, "
                      "python/core/b.cpp\n", answer)
        answer = self.check({"api/a.cpp": text, "python/core/a.h": header})
        self.assertEqual(answer, "")

    def test_names_that_cannot_meet(self):
        text = local("struct Points {};\n")
        answer = self.check({
            "sim/device/a.cpp": text, "compensation/a/a.cpp": text,
            "sim/campaign/a.h": "struct Points {};\n"})
        self.assertEqual(answer, "")
