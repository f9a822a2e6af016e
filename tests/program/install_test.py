# SPDX-License-Identifier: MIT
"""`cmake --install` of the build that the program comes from."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, class_folder, said

BUILD = PROGRAM.parent
# Where to type what a page shows.
STATED = """\
- From the sources: type everything in the source tree, after
  `scripts/build.sh release`.
- With the [Debian packages](../install.md#debian-packages): make an empty
  folder, type `cp -r /usr/share/beamgyro/* .` in it, and then `beamgyro` in
  place of `build/release/beamgyro`.
"""


@unittest.skipUnless((BUILD / "cmake_install.cmake").exists(),
                     "the program does not stand in its build")
class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = class_folder(cls, "a prefix ")
        cls.prefix = cls.dir / "usr"
        cls.call("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.program = cls.prefix / "bin/beamgyro"
        cls.call(cls.program, "run", cls.prefix
                 / "share/beamgyro/scenarios/ten_minutes.toml", "-o", "run.h5")

    @classmethod
    def call(cls, *command):
        return said(*command, cwd=cls.dir)

    def test_the_program_runs_an_installed_scenario_from_elsewhere(self):
        self.assertIn("recording", self.call(self.program, "info", "run.h5"))

    def test_pictures_need_nothing_of_the_source_tree(self):
        self.call(self.program, "plot", "run.h5", "-o", "run.svg")
        self.assertIn("rate at rest", (self.dir / "run.svg").read_text())
        self.call(self.program, "train", "run.h5", "-o", "c.json", "--model",
                  self.prefix
                  / "share/beamgyro/scenarios/models/constant.toml")
        self.call(self.program, "plot", "c.json", "-o", "c.svg")
        self.assertIn("bias taken away", (self.dir / "c.svg").read_text())
        shipped = self.prefix / "share/beamgyro/python"
        self.assertEqual(list(shipped.rglob("__pycache__")), [])

    def test_the_specifications_are_installed(self):
        specs = self.prefix / "share/beamgyro/specs"
        self.assertEqual(sorted(path.name for path in specs.iterdir()),
                         ["default.toml", "paper.toml", "share.toml",
                          "tactical.toml", "uav.toml"])

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
        self.call(self.program, "compensate", "./cubic.so", "run.h5", "-o",
                  "out.h5")
        self.assertIn("recording", self.call(self.program, "info", "out.h5"))

    def test_the_links_of_the_pages_lead_to_installed_files(self):
        documents = self.prefix / "share/doc/beamgyro"
        pages = list(documents.rglob("*.md"))
        self.assertGreater(len(pages), 50)
        for page in pages:
            text = re.sub("```.*?```", "", page.read_text(), flags=re.DOTALL)
            for link in re.findall(r"\]\(([^)\s#]+)[^)]*\)", text):
                if not re.match(r"\w+:", link):
                    self.assertTrue((page.parent / link).exists())

    def test_the_files_that_pages_name_are_installed(self):
        shared = self.prefix / "share/beamgyro"
        named = set()
        for page in (ROOT / "docs/guide").glob("*.md"):
            named |= set(re.findall(
                r"(?:examples|scenarios|specs)/[\w/]+\.\w+"
                r"|scripts/(?:flight|slurm)\w+\.\w+", page.read_text()))
        self.assertGreater(len(named), 20)
        self.assertEqual([name for name in sorted(named)
                          if not (shared / name).exists()], [])
        self.call(shared / "scripts/flight_log_to_csv.py", "--help")
        self.assertTrue((self.prefix / "share/doc/beamgyro/LICENSE").exists())

    def test_a_page_runs_in_an_empty_folder_as_it_says(self):
        pages = [page for folder in ["guide", "tutorials"]
                 for page in sorted((ROOT / "docs" / folder).glob("*.md"))
                 if "=build/release" in page.read_text()]
        self.assertGreater(len(pages), 12)
        for page in pages:
            head = page.read_text().split("\n```")[0]
            self.assertIn(" ".join(STATED.split()), " ".join(head.split()))
        code = "".join(re.findall(
            r"^```sh\n(.*?)^```", (ROOT / "docs/tutorials/"
                                   "1_first_drift_curve.md").read_text(),
            re.MULTILINE | re.DOTALL))
        copy = re.search(r"`(cp .*?)`", STATED)[1].replace(
            "/usr/share", f"'{self.prefix}/share'")
        folder = self.dir / "empty"
        folder.mkdir()
        subprocess.run(
            ["bash", "-euc", f"{copy}\n{code}".replace(
                "build/release/beamgyro", "beamgyro")],
            cwd=folder, check=True, stdout=subprocess.DEVNULL, env={
                **os.environ,
                "PATH": f"{self.prefix}/bin:{os.environ['PATH']}"})
        self.assertTrue((folder / "static.csv").exists())
        self.assertTrue((folder / "ramp.h5").exists())

    def test_no_cache_and_no_page_of_developers_is_installed_as_python(self):
        package = self.prefix / "lib/python3/dist-packages"
        self.assertEqual({path.suffix for path in package.rglob("*")
                          if path.is_file() and "__pycache__" not in
                          path.parts}, {".py", ".pyi", ".so", ".typed"})
        self.assertEqual(list(package.rglob(".*")), [])

    def test_it_is_removed_as_the_page_of_installation_says(self):
        page = (ROOT / "docs/install.md").read_text()
        lines = re.search(r"^To remove it(?:.+\n)+\n((?:    .*\n)+)", page,
                          re.MULTILINE)[1]
        prefix = self.dir / "to be removed"
        printed = self.call("cmake", "--install", BUILD, "--prefix", prefix)
        manifest = self.dir / "install_manifest.txt"
        names = re.findall(r"^-- (?:Installing|Up-to-date): (.*)$", printed,
                           re.MULTILINE)
        manifest.write_text("".join(f"{name}\n" for name in names
                                    if not pathlib.Path(name).is_dir()))
        other = prefix / "share/doc/another/file"
        other.parent.mkdir()
        other.write_text("of another package\n")
        for old, new in [("build/release/install_manifest.txt", manifest),
                         ("DIR", prefix)]:
            self.assertIn(old, lines)
            lines = lines.replace(old, f"'{new}'")
        self.call("bash", "-euc", lines)
        left = [path for path in prefix.rglob("*") if not path.is_dir()]
        self.assertEqual(left, [other])
        self.assertEqual([path.name for path in prefix.rglob("*")
                          if "beamgyro" in path.name], [])
