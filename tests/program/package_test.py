# SPDX-License-Identifier: MIT
"""The Debian packages of the build that the program comes from."""

import gzip
import os
import pathlib
import re
import subprocess
import sys
import unittest

import pytest

from program import PROGRAM, ROOT, class_folder, commands, said

sys.path.insert(0, str(ROOT / "packaging"))
# pylint: disable-next=wrong-import-position
from help_pages import read_help  # noqa: E402

BUILD = PROGRAM.parent
PAGES = BUILD / "help_pages"


@unittest.skipUnless((PAGES / "completions/beamgyro").exists(),
                     "the program does not stand in its build")
class HelpPages(unittest.TestCase):
    def test_every_command_has_a_page_of_the_manual(self):
        pages = PAGES / "man1"
        self.assertEqual(
            {path.name for path in pages.iterdir()},
            {"beamgyro.1.gz", *(f"beamgyro-{command}.1.gz"
                                for command in commands())})
        for page in pages.iterdir():
            answer = subprocess.run(
                ["man", "--warnings", "-l", page], text=True, check=True,
                capture_output=True, env={**os.environ, "MANWIDTH": "80"})
            self.assertEqual(answer.stderr, "")
            # Neither name, flags nor time stamp: as of gzip -9n.
            self.assertEqual(page.read_bytes()[3:9], bytes(5) + b"\2")

    def test_a_page_says_all_that_the_help_says(self):
        pages = PAGES / "man1"
        for command in commands():
            page = gzip.open(pages / f"beamgyro-{command}.1.gz", "rt").read()
            page = page.replace("\\fB", "").replace("\\fR", "").replace(
                "\\-", "-").replace("\\(aq", "'").replace("\\e", "\\")
            text = read_help(said(PROGRAM, "help", command))
            self.assertGreater(len(text.sections), 2)
            for section in text.sections:
                for left, right in section.entries:
                    self.assertIn(left, page)
                    self.assertIn(right, page)

    def completed(self, *words):
        """What bash offers for the last word."""
        script = ('. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1));'
                  '_beamgyro; printf "%s\\n" "${COMPREPLY[@]}"')
        file = PAGES / "completions/beamgyro"
        return said("bash", "-c", script, file, "beamgyro", *words,
                    cwd=ROOT).split()

    def test_bash_completes_commands_options_values_and_files(self):
        self.assertEqual(self.completed(""), ["help", *commands()])
        self.assertEqual(self.completed("help", "al"), ["allan"])
        for command in commands():
            listed = re.findall(r"^  (?:-\w, )?(--[\w-]+)",
                                said(PROGRAM, "help", command), re.MULTILINE)
            self.assertEqual(self.completed(command, "--"), listed)
        self.assertEqual(self.completed("--v"), ["--version"])
        self.assertIn("--help", self.completed("-"))
        self.assertEqual(self.completed("allan", "--kind", "o"),
                         ["oadev", "ohdev"])
        levels = ["quasistatic", "envelope", "carrier"]
        self.assertEqual(self.completed("run", "--fidelity", ""), levels)
        self.assertEqual(self.completed("run", "--fidelity", "=", "e"),
                         levels[1:2])
        self.assertEqual(self.completed("run", "--fidelity", "="), levels)
        self.assertIn("scenarios/warm_up.toml",
                      self.completed("run", "scenarios/w"))
        self.assertEqual(self.completed("verify", "scenarios/dev"),
                         ["scenarios/devices"])
        self.assertEqual(self.completed("run", "README"), [])


# What stands for it in test.sh: install_test.py runs what cmake installs, the
# class above reads manual and completion. That packages can be made, their
# fields, their documents, lintian's verdict, equal bytes elsewhere, and a
# library that is found where it was unpacked are tested only here.
@pytest.mark.deep
@unittest.skipUnless((BUILD / "CPackConfig.cmake").exists(),
                     "the program does not stand in its build")
class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = class_folder(cls, "packages ")
        said(ROOT / "scripts/package.sh", BUILD, cls.dir / "debs")
        cls.debs = {path.name.split("_")[0]: path
                    for path in sorted((cls.dir / "debs").glob("*.deb"))}
        for name, path in cls.debs.items():
            said("dpkg-deb", "-x", path, cls.dir / name)

    def files(self, package):
        """What a package installs, without the directories."""
        root = self.dir / package
        return {str(path.relative_to(root)): path
                for path in root.rglob("*") if not path.is_dir()}

    def field(self, package, name):
        return said("dpkg-deb", "-f", self.debs[package], name)

    def test_there_are_four(self):
        self.assertEqual(list(self.debs), ["beamgyro", "libbeamgyro-dev",
                                           "libbeamgyro0.1",
                                           "python3-beamgyro"])

    def test_the_unpacked_module_runs_an_unpacked_scenario(self):
        usr = self.dir / "python3-beamgyro/usr"
        scenario = (self.dir / "beamgyro/usr/share/beamgyro/scenarios"
                    / "ten_minutes.toml")
        said_by = said(
            "/usr/bin/python3", "-c", "import sys, beamgyro; "
            "print(beamgyro.__file__, beamgyro.run(sys.argv[1]).rate.shape)",
            scenario, cwd=self.dir, env={
                **os.environ, "PYTHONDONTWRITEBYTECODE": "1",
                "PYTHONPATH": str(usr / "lib/python3/dist-packages")})
        self.assertEqual(said_by, f"{usr}/lib/python3/dist-packages/beamgyro/"
                         "__init__.py (3000,)\n")

    def test_another_time_and_place_give_the_same_bytes(self):
        elsewhere = self.dir / "another place"
        said(ROOT / "scripts/package.sh", BUILD, elsewhere, umask=0o077,
             env={**os.environ, "TZ": "Asia/Tokyo", "LC_ALL": "C.UTF-8"})
        for path in self.debs.values():
            self.assertEqual(path.read_bytes(),
                             (elsewhere / path.name).read_bytes())

    def test_no_file_tells_where_it_was_built(self):
        for package in self.debs:
            for name, path in self.files(package).items():
                if path.is_symlink():  # its target is in another package
                    continue
                data = path.read_bytes()
                self.assertNotIn(str(ROOT).encode() + b"/", data)
                self.assertNotIn(str(BUILD).encode(), data)

    def test_lintian_finds_no_error(self):
        found = said("lintian", "--allow-root", "--fail-on", "error",
                     *self.debs.values())
        self.assertNotRegex(found, "(?m)^E:")

    def test_no_file_is_in_two_packages(self):
        names = [name for package in self.debs
                 for name in self.files(package)]
        self.assertEqual(len(names), len(set(names)))

    def test_the_packages_depend_on_what_they_need(self):
        needed = {"beamgyro": ["libhdf5-103-1", "libsundials-cvode6",
                               "libfmt9"],
                  "libbeamgyro-dev": ["libsundials-dev", "libhdf5-dev",
                                      "libbeamgyro0.1 (= "],
                  "libbeamgyro0.1": ["libhdf5-103-1", "libfmt9"],
                  "python3-beamgyro": ["python3-numpy", "python3-xarray",
                                       "libhdf5-103-1", "python3 (<< 3.12~)"]}
        for package in self.debs:
            depends = self.field(package, "Depends")
            for name in needed[package]:
                self.assertIn(name, depends)
            self.assertNotIn("-dev", self.field("beamgyro", "Depends"))

    def test_the_module_recommends_the_files_that_it_reads(self):
        self.assertIn("beamgyro", self.field("python3-beamgyro",
                                             "Recommends"))

    def test_libraries_stand_in_the_folder_of_their_architecture(self):
        triple = said("gcc", "-print-multiarch").strip()
        folders = {os.path.dirname(name)
                   for name in self.files("libbeamgyro-dev")
                   if name.startswith("usr/lib")}
        lib = f"usr/lib/{triple}"
        self.assertEqual(folders, {lib, f"{lib}/cmake/beamgyro",
                                   f"{lib}/pkgconfig"})

    def test_a_program_is_built_with_the_unpacked_library(self):
        # With the library that it depends on.
        for name in ["libbeamgyro-dev", "libbeamgyro0.1"]:
            said("dpkg-deb", "-x", self.debs[name], self.dir / "both")
        usr = self.dir / "both/usr"
        user = self.dir / "user"
        user.mkdir()
        (user / "user.cpp").write_text(
            "#include <beamgyro/version.h>\n"
            "int main() { return beamgyro::version()[0] == '0' ? 0 : 1; }\n")
        (user / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\n"
            "project(user LANGUAGES CXX)\n"
            "find_package(beamgyro REQUIRED COMPONENTS dataset)\n"
            "add_executable(user user.cpp)\n"
            "target_link_libraries(user PRIVATE beamgyro::dataset)\n")
        said("cmake", "-B", "build", f"-DCMAKE_PREFIX_PATH={usr}", cwd=user)
        said("cmake", "--build", "build", cwd=user)
        said(user / "build/user")
        pkgconfig = next(usr.rglob("beamgyro.pc")).parent
        stated = said("pkg-config", "--variable=libdir", "beamgyro", env={
            **os.environ, "PKG_CONFIG_PATH": str(pkgconfig)}).strip()
        libraries = pathlib.Path(stated.replace("\\ ", " "))
        self.assertGreater(len(list(libraries.glob("libbeamgyro_*.a"))), 10)

    def test_links_of_the_pages_lead_to_files_of_the_package(self):
        documents = self.dir / "beamgyro/usr/share/doc/beamgyro"
        for page in documents.rglob("*.md"):
            text = re.sub("```.*?```", "", page.read_text(), flags=re.DOTALL)
            for link in re.findall(r"\]\(([^)\s#:]+)(?:#[^)]*)?\)", text):
                self.assertTrue((page.parent / link).exists())

    def test_the_unpacked_program_runs_an_unpacked_scenario(self):
        usr = self.dir / "beamgyro/usr"
        said(usr / "bin/beamgyro", "run",
             usr / "share/beamgyro/scenarios/ten_minutes.toml", "-o", "run.h5",
             cwd=self.dir)
        header = said("readelf", "-d", usr / "bin/beamgyro")
        self.assertNotIn("RUNPATH", header)
        self.assertNotIn("RPATH", header)

    def test_they_have_the_manual_and_the_completion_of_the_build(self):
        for made, place in [("man1", "man/man1"),
                            ("completions", "bash-completion/completions")]:
            packaged, built = [
                {path.name: path.read_bytes() for path in folder.iterdir()}
                for folder in [self.dir / "beamgyro/usr/share" / place,
                               PAGES / made]]
            self.assertEqual(packaged, built)

    def test_the_documents_of_a_package_are_those_of_debian(self):
        for package in self.debs:
            documents = self.dir / package / "usr/share/doc" / package
            text = gzip.open(documents / "changelog.gz", "rt").read()
            self.assertEqual(text, (ROOT / "CHANGELOG.md").read_text())
            debian = gzip.open(documents / "changelog.Debian.gz", "rt").read()
            version = self.field(package, "Version").strip()
            self.assertTrue(debian.startswith(f"beamgyro ({version})"))
            self.assertIn("License: Expat",
                          (documents / "copyright").read_text())


class ThirdParty(unittest.TestCase):
    def test_the_licences_are_those_that_the_packages_state(self):
        rows = re.findall(r"^\| .+ \| (\S+) \| (.+) \|$",
                          (ROOT / "THIRD_PARTY.md").read_text(), re.MULTILINE)
        rows = [row for row in rows if row[0] != "Debian"]
        self.assertGreater(len(rows), 15)
        for package, licences in rows:
            file = pathlib.Path("/usr/share/doc") / package / "copyright"
            if not file.exists():  # not needed for a build
                continue
            for licence in licences.removesuffix(", changed").split(", "):
                self.assertIn(licence.lower(), file.read_text().lower())

    def test_the_citation_names_this_version_and_licence(self):
        citation = (ROOT / "CITATION.cff").read_text()
        version = ".".join(re.findall(
            r"#define BEAMGYRO_VERSION_[A-Z]+ (\d+)",
            (ROOT / "include/beamgyro/version.h").read_text()))
        self.assertRegex(version, r"^\d+\.\d+\.\d+$")
        self.assertIn(f"\nversion: {version}\n", citation)
        self.assertIn("\nlicense: MIT\n", citation)

    def test_every_library_that_is_linked_is_listed(self):
        listed = (ROOT / "THIRD_PARTY.md").read_text()
        packages = (ROOT / "scripts/setup.sh").read_text()
        build = packages.split("build=(")[1].split(")")[0].split()
        self.assertIn("libeigen3-dev", build)
        for name in build:
            if re.match(r"lib|nlohmann|pybind", name):
                self.assertIn(name.replace("libboost-dev",
                                           "libboost1.74-dev"), listed)
