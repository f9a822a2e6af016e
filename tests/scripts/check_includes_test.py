# SPDX-License-Identifier: MIT
"""The include checker on small trees made to offend."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = (pathlib.Path(__file__).resolve().parents[2]
           / "scripts" / "check_includes.py")


class CheckIncludes(unittest.TestCase):
    def check(self, path, text):
        with tempfile.TemporaryDirectory() as root:
            file = pathlib.Path(root) / path
            file.parent.mkdir(parents=True)
            file.write_text(text)
            return subprocess.run([sys.executable, CHECKER, root],
                                  capture_output=True, text=True, check=False)

    def assert_offends(self, path, text, why):
        answer = self.check(path, text)
        self.assertEqual(answer.returncode, 1, answer)
        self.assertIn(f"{path}: ", answer.stdout)
        self.assertIn(why, answer.stdout)

    def assert_clean(self, path, text):
        answer = self.check(path, text)
        self.assertEqual((answer.returncode, answer.stdout), (0, ""))

    def test_sim_and_compensation_never_see_each_other(self):
        self.assert_offends("sim/device/a.h",
                            '#include "compensation/scoring/score.h"\n',
                            'must not include "compensation/scoring/score.h"')
        self.assert_offends("compensation/training/a.h",
                            '#include "sim/device/device.h"\n',
                            'must not include "sim/device/device.h"')
        self.assert_offends("tests/compensation/training/a_test.cpp",
                            '#include "sim/device/device.h"\n',
                            'must not include "sim/device/device.h"')

    def test_files_know_no_model(self):
        self.assert_clean("dataset/files/a.cpp", '#include "config/document.h"\n')
        self.assert_offends("dataset/files/a.cpp", '#include "sim/device/device.h"\n',
                            'must not include "sim/device/device.h"')
        self.assert_offends("config/a.cpp", '#include "dataset/recording/recording.h"\n',
                            'must not include "dataset/recording/recording.h"')

    def test_sub_rooms_have_a_direction(self):
        self.assert_offends("sim/numerics/a.h",
                            '#include "sim/device/device.h"\n',
                            'must not include "sim/device/device.h"')
        self.assert_offends("sim/dynamics/a.h",
                            '#include "sim/scenario/scenario.h"\n',
                            'must not include "sim/scenario/scenario.h"')
        self.assert_clean("sim/scenario/a.h",
                          '#include "sim/dynamics/static_map.h"\n')

    def test_each_c_library_has_one_home(self):
        for include, home in [("cvode/cvode.h", "sim/numerics/ode.cpp"),
                              ("hdf5.h", "dataset/netcdf/hdf5_id.cpp"),
                              ("toml++/toml.h", "config/toml_parser.cpp"),
                              ("CLI/CLI.hpp", "cli/main.cpp")]:
            text = f"#include <{include}>\n"
            self.assert_clean(home, text)
            self.assert_offends("compensation/models/a.cpp", text, f"<{include}>")

    def test_the_library_does_not_print_exit_or_read_the_environment(self):
        for call in ["std::cout << 1;", 'printf("x");', "std::exit(1);",
                     'fmt::print("x");', 'std::getenv("HOME");']:
            self.assert_offends("sim/device/a.cpp", call + "\n", "only cli/")
            self.assert_clean("cli/a.cpp", call + "\n")
        self.assert_clean("sim/device/a.cpp",
                          '// std::cout\nconst char* a = "exit(1)";\n'
                          "snprintf(a, 1, a);\n")

    def test_the_library_names_no_options_of_the_program(self):
        for text in ['"--soaks 3"', '"or a narrower --range"', 'x + "--set " + y']:
            self.assert_offends("api/a.cpp", f"auto a = {text};\n", "options of the program")
            self.assert_clean("cli/a.cpp", f"auto a = {text};\n")
        self.assert_clean("api/a.cpp", "// --soaks\n--soaks;\nauto a = \"a --- b\", b = \"a--b\";\n")
        self.assert_clean("config/overrides.cpp", 'auto a = "--set ";\n')
        self.assert_offends("config/overrides.cpp", 'auto a = "--range";\n', "--range")

    def test_commands_use_the_public_library(self):
        self.assert_clean("cli/a.cpp", '#include "include/beamgyro/plan.h"\n')
        for inner in ["planning/planner.h", "sim/device/device.h",
                      "compensation/inputs/features.h", "sensitivity/study/device_sample.h"]:
            self.assert_offends("cli/a.cpp", f'#include "{inner}"\n', f'include "{inner}"')

    def test_unknown_rooms_and_relative_includes(self):
        self.assert_offends("sim/other/a.h", "", "belongs to no room")
        self.assert_offends("sim/device/a.h", '#include "device.h"\n',
                            "must be named from the project root")
