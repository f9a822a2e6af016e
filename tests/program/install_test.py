# SPDX-License-Identifier: MIT
"""`cmake --install` of the build that the program comes from."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from program import PROGRAM, ROOT

BUILD = PROGRAM.parent


@unittest.skipUnless((BUILD / "cmake_install.cmake").exists(),
                     "the program does not stand in its build")
class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="a prefix ")
        cls.addClassCleanup(folder.cleanup)
        cls.dir = pathlib.Path(folder.name)
        cls.prefix = cls.dir / "usr"
        cls.call("cmake", "--install", BUILD, "--prefix", cls.prefix)

    @classmethod
    def call(cls, *command):
        answer = subprocess.run([str(part) for part in command], cwd=cls.dir,
                                capture_output=True, text=True, check=False)
        if answer.returncode != 0:
            raise AssertionError(answer.stdout + answer.stderr)
        return answer.stdout

    def scenario(self, name):
        return self.prefix / "share/beamgyro/scenarios" / name

    def test_the_program_runs_an_installed_scenario_from_elsewhere(self):
        program = self.prefix / "bin/beamgyro"
        self.call(program, "run", self.scenario("ten_minutes.toml"), "-o",
                  "run.h5")
        self.assertIn("recording", self.call(program, "info", "run.h5"))

    def test_pictures_need_nothing_of_the_source_tree(self):
        program = self.prefix / "bin/beamgyro"
        self.call(program, "run", self.scenario("ten_minutes.toml"), "-o",
                  "run.h5")
        self.call(program, "plot", "run.h5", "-o", "run.svg")
        self.assertIn("rate at rest", (self.dir / "run.svg").read_text())
        shipped = self.prefix / "share/beamgyro/python"
        self.assertEqual(list(shipped.rglob("__pycache__")), [])

    def test_the_specifications_are_installed(self):
        specs = self.prefix / "share/beamgyro/specs"
        self.assertEqual(sorted(path.name for path in specs.iterdir()),
                         ["paper.toml", "tactical.toml", "uav.toml"])

    def test_the_python_package_runs_from_the_prefix(self):
        package = self.prefix / "lib/python3/dist-packages"
        code = ("import sys; sys.path.insert(0, sys.argv[1]); "
                "import beamgyro as bg; from beamgyro import _shipped; "
                "print(bg.__file__, _shipped.program(), sep='\\n'); "
                "scenario = _shipped.file('scenarios/ten_minutes.toml'); "
                "print(scenario, bg.run(scenario).sizes['time'], sep='\\n')")
        printed = self.call(sys.executable, "-c", code, package).splitlines()
        self.assertEqual(printed[0], str(package / "beamgyro/__init__.py"))
        self.assertEqual(printed[1], str(self.prefix / "bin/beamgyro"))
        self.assertGreater(int(printed[-1]), 100)

    def test_a_plugin_is_compiled_with_the_installed_header(self):
        self.call("cc", "-shared", "-fPIC", f"-I{self.prefix}/include",
                  ROOT / "examples/plugins/cubic.c", "-o", "cubic.so")
        program = self.prefix / "bin/beamgyro"
        self.call(program, "run", self.scenario("ten_minutes.toml"), "-o",
                  "run.h5")
        self.call(program, "compensate", "./cubic.so", "run.h5", "-o",
                  "out.h5")
        self.assertIn("recording", self.call(program, "info", "out.h5"))


if __name__ == "__main__":
    unittest.main()
