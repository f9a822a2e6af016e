# SPDX-License-Identifier: MIT
"""Wheels of the build that the program comes from."""

import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import subprocess
import sys
import unittest
import zipfile

import pytest

from program import PROGRAM, ROOT, class_folder, said

sys.path.insert(0, str(ROOT / "packaging"))
# pylint: disable-next=wrong-import-position
import wheel_backend  # noqa: E402

BUILD = PROGRAM.parent
RUN = """
import sys
import beamgyro as bg
from beamgyro import _shipped
scenario = _shipped.file("scenarios/ten_minutes.toml")
bg.run_to_file(scenario, "python.h5")
print(bg.__file__, _shipped.program(), scenario, sep="\\n")
"""


class Wheels(unittest.TestCase):
    """What both kinds have in common; an environment with one of them."""

    @classmethod
    def environment(cls, name):
        """A Python of its own, which sees the packages of this one."""
        said(sys.executable, "-m", "venv", "--system-site-packages",
             cls.dir / name)
        return cls.dir / name

    @classmethod
    def pip(cls, place, *arguments):
        """Without an index and without a cache."""
        said(place / "bin/python", "-m", "pip", "install", "--no-index",
             "--no-cache-dir", "--disable-pip-version-check", *arguments,
             cwd=cls.dir)

    def check_environment(self, place):
        """The module and the command are those of the environment, and write
        the bytes of the program."""
        printed = said(place / "bin/python", "-c", RUN, cwd=self.dir,
                       env={**os.environ, "PYTHONPATH": ""}).splitlines()
        self.assertEqual(len(printed), 3)
        for line in printed:
            self.assertTrue(line.startswith(str(place)), line)
        program, scenario = printed[1:]
        for one, name in ((program, "wheel.h5"), (PROGRAM, "built.h5")):
            said(one, "run", scenario, "-o", self.dir / name)
        expected = (self.dir / "built.h5").read_bytes()
        for name in ("wheel.h5", "python.h5"):
            self.assertEqual((self.dir / name).read_bytes(), expected)


@unittest.skipUnless((BUILD / "python/beamgyro/__init__.py").exists(),
                     "the build has no Python package")
class Install(Wheels):
    def test_pip_installs_the_tree_without_an_index(self):
        dir_ = class_folder(type(self), "pip ")
        type(self).dir = dir_
        place = self.environment("venv")
        self.pip(place, "--config-settings", f"build={BUILD}", ROOT)
        self.check_environment(place)

    def test_the_version_is_that_of_the_header(self):
        self.assertIn(f" {wheel_backend.project()['version']} ",
                      said(PROGRAM, "--version"))

    def test_a_build_without_the_module_is_refused_by_name(self):
        with self.assertRaisesRegex(SystemExit, "elsewhere has no _core"):
            wheel_backend.staged_wheel(pathlib.Path("elsewhere"),
                                       pathlib.Path("nowhere"))


# What stands for it in test.sh: Install above, whose wheel is packed by the
# same code. That the libraries are found under their own names, with their
# licences, is tested only here; scripts/try_wheel.sh does so in a bare Debian.
@pytest.mark.deep
@unittest.skipUnless((BUILD / "python/beamgyro/__init__.py").exists(),
                     "the build has no Python package")
class Bundled(Wheels):
    @classmethod
    def setUpClass(cls):
        cls.dir = class_folder(cls, "wheel ")
        said(ROOT / "scripts/wheel.sh", BUILD, cls.dir / "wheels")
        cls.wheel, = (cls.dir / "wheels").glob("*.whl")
        cls.archive = zipfile.ZipFile(cls.wheel)
        cls.names = cls.archive.namelist()

    def test_its_name_says_for_what_it_is(self):
        self.assertRegex(
            self.wheel.name,
            r"^beamgyro-[\d.]+-cp311-cp311-manylinux_2_36_x86_64\.whl$")

    def test_the_record_has_every_file_with_its_digest(self):
        about, = {name.split("/")[0] for name in self.names
                  if name.endswith(".dist-info/RECORD")}
        rows = list(csv.reader(io.StringIO(
            self.archive.read(f"{about}/RECORD").decode())))
        self.assertEqual(sorted(row[0] for row in rows), sorted(self.names))
        for name, digest, size in rows:
            if name.endswith("/RECORD"):
                continue
            data = self.archive.read(name)
            self.assertEqual(int(size), len(data))
            value = base64.urlsafe_b64encode(hashlib.sha256(data).digest())
            self.assertEqual(digest, f"sha256={value.decode().rstrip('=')}")

    def test_it_asks_the_system_for_no_more_than_the_c_and_cpp_libraries(self):
        self.archive.extractall(self.dir / "files")
        held = {pathlib.Path(name).name for name in self.names
                if name.startswith("beamgyro.libs/")}
        self.assertGreater(len(held), 8)
        files = [path for path in (self.dir / "files").rglob("*")
                 if path.is_file() and path.read_bytes()[:4] == b"\x7fELF"]
        self.assertEqual(len(files), len(held) + 3)  # module, program, FMU
        allowed = re.compile(r"(ld-linux-x86-64|lib(c|m|stdc\+\+|gcc_s))\.so")
        for path in files:
            for name in said("patchelf", "--print-needed", path).split():
                self.assertTrue(name in held or allowed.match(name),
                                f"{path.name} needs {name}")
        for name in held:
            self.assertRegex(name, r"-[0-9a-f]{8}\.so")
            self.assertEqual(said("patchelf", "--print-soname", self.dir
                                  / "files/beamgyro.libs" / name), f"{name}\n")

    def test_it_has_the_licence_of_each_library(self):
        licences = {pathlib.Path(name).name: self.archive.read(name).decode()
                    for name in self.names if "/licenses/" in name}
        listed = re.findall(r"^(\S+\.so[\d.]*): (\S+)",
                            licences["LIBRARIES.txt"], re.MULTILINE)
        self.assertEqual({f"beamgyro.libs/{name}" for name, _ in listed},
                         {name for name in self.names
                          if name.startswith("beamgyro.libs/")})
        for _, package in listed:
            if package != "of":
                self.assertIn(f"{package}.copyright", licences)
        for package in ("libeigen3-dev", "pybind11-dev"):
            self.assertIn(f"{package}.copyright", licences)
        self.assertIn("Apache License", licences["Apache-2.0.licence"])

    def test_two_have_the_same_bytes(self):
        said(ROOT / "scripts/wheel.sh", BUILD, self.dir / "again",
             env={**os.environ, "TZ": "Asia/Tokyo"})
        again, = (self.dir / "again").glob("*.whl")
        self.assertEqual(again.read_bytes(), self.wheel.read_bytes())

    def test_it_runs_beside_the_hdf5_of_another_package(self):
        place = self.environment("venv")
        self.pip(place, self.wheel)
        self.check_environment(place)
        subprocess.run(
            [place / "bin/python", "-c",
             "import h5py, beamgyro\n"
             "with h5py.File('python.h5') as file:\n"
             "    again = beamgyro.open_recording('python.h5')\n"
             "    assert (file['rate'][:] == again.rate.values).all()"],
            cwd=self.dir, check=True)
