# SPDX-License-Identifier: MIT
"""The installed C++ library, as its users build and call it."""

import filecmp
import json
import pathlib
import re
import shutil
import unittest

import pytest

from program import PROGRAM, ROOT, class_folder, ended

BUILD = PROGRAM.parent
SCENARIOS = ROOT / "scenarios"
SPEC = ROOT / "specs/uav.toml"
HEADERS = sorted((ROOT / "include/beamgyro").glob("*.h"))
OF_CPP = [header for header in HEADERS if header.name != "plugin.h"]

TEN_LINES = """\
#include <beamgyro/simulate.h>

#include <cstdio>

int main(int, char** argv) {
  const auto scenario = beamgyro::Scenario::read(argv[1]);
  const auto run = beamgyro::simulate(scenario);
  std::printf("%zu samples\\n", run.recording.time.size());
}
"""
OWN_EIGEN = """\
#include <beamgyro/train.h>

#include <Eigen/Dense>

int main(int, char** argv) {
  const std::filesystem::path scenarios = argv[1];
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(50, 4);
  const Eigen::VectorXd y = Eigen::VectorXd::Random(50);
  const Eigen::VectorXd own = a.colPivHouseholderQr().solve(y);
  const auto model = beamgyro::Model::read(scenarios / "models/cubic.toml");
  beamgyro::train(model, {std::filesystem::path(argv[2])})
      .compensator.write("own.json");
  return own.allFinite() ? 0 : 1;
}
"""
GUIDE = (ROOT / "docs/guide/library.md").read_text()
LOOP_GUIDE = (ROOT / "docs/guide/in_the_loop.md").read_text()


def block_of_guide(kind, guide=GUIDE):
    return re.search(rf"^```{kind}\n(.*?)^```$", guide,
                     re.MULTILINE | re.DOTALL)[1]


USER_CMAKE = """\
cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(beamgyro 0.1 REQUIRED)
add_executable(few user.cpp)
target_link_libraries(few PRIVATE beamgyro::sim)
add_executable(loop loop.cpp)
target_link_libraries(loop PRIVATE beamgyro::sim)
add_executable(user {every_call})
target_link_libraries(user PRIVATE beamgyro::beamgyro)
add_executable(user_of_shared {every_call})
target_link_libraries(user_of_shared PRIVATE beamgyro::shared)
foreach(part dataset compensation validation)
  add_executable(${{part}} version.cpp)
  target_link_libraries(${{part}} PRIVATE beamgyro::${{part}})
endforeach()
"""
VERSION = """\
#include <beamgyro/version.h>

int main() { return beamgyro::version()[0] == '0' ? 0 : 1; }
"""
# What files_of_commands.cpp makes, by the program.
COMMANDS = """\
run {s}/ten_minutes.toml --seed 5 -o run.h5
run {s}/ten_minutes.toml --seed 5 -o run.csv
characterise {s}/devices/nominal.toml --beam-temperature -20:20:10 -o device.csv
train ramp.h5 --model {s}/models/cubic.toml -o cubic.json
compensate cubic.json run.h5 -o compensated.h5
validate cubic.json ramp.h5 --spec {spec} --json result.json
allan run.h5 --json allan.json
export cubic.json --format c -o firmware
generate {s}/campaigns/small.toml --devices 6 -o set
sensitivity {s}/campaigns/small.toml --samples 32 --json sensitivity.json
train set --model {s}/models/cubic.toml -o of_set.json
"""
PRINTED = {"train": "train.txt", "validate": "result.txt",
           "allan": "allan.txt", "generate": "generate.txt",
           "sensitivity": "sensitivity.txt"}


def files_below(folder):
    return sorted(path.relative_to(folder).as_posix()
                  for path in folder.rglob("*") if path.is_file())


class Call(unittest.TestCase):
    """A test that calls tools in a folder of its own."""

    @classmethod
    def setUpClass(cls):
        cls.dir = class_folder(cls, cls.PREFIX)

    @classmethod
    def call(cls, *command, cwd=None, allowed=(0,)):
        return ended(*command, cwd=cwd or cls.dir, allowed=allowed)


class PublicHeaders(Call):
    PREFIX = "headers_"

    def read_by(self, compiler, headers, *options):
        """What a compiler prints that includes these headers in this order."""
        return self.call(
            compiler, "-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
            *options, f"-I{ROOT}/include",
            *[word for header in headers for word in ["-include", header]],
            "-x", "c++", "/dev/null").stdout

    def check_what_they_include(self, headers):
        """Each other, and the standard library."""
        system = re.compile(r"^/usr/(include|lib)/")
        rule = self.read_by("g++", headers, "-M").replace("\\\n", " ")
        paths = [path for path in rule.split()[1:] if path != "/dev/null"]
        self.assertGreater(len(paths), len(headers))
        for path in paths:
            if system.match(path):
                self.assertRegex(
                    path, r"/(c\+\+|gcc|bits|asm|asm-generic|linux|gnu|sys"
                    r"|pthread|sched|time|wchar|features)|^/usr/include/"
                    r"\w+[.-]?\w*\.h$")
                self.assertNotRegex(
                    path, "(?i)eigen|hdf5|fmt|json|sundials|boost|toml")
            else:
                self.assertEqual(pathlib.Path(path).resolve().parent,
                                 ROOT / "include/beamgyro")

    def test_all_compile_together_in_either_order(self):
        for headers in [OF_CPP, OF_CPP[::-1]]:
            self.read_by("g++", headers, "-fsyntax-only")

    def test_together_they_include_the_standard_library_only(self):
        self.check_what_they_include(OF_CPP)

    # What stands for it in test.sh: the two tests above. That each header needs
    # no other before it, and that clang takes them, is shown only here.
    @pytest.mark.deep
    def test_each_compiles_alone_and_includes_the_standard_library_only(self):
        for header in OF_CPP:
            for compiler in filter(shutil.which, ["g++", "clang++"]):
                self.read_by(compiler, [header], "-fsyntax-only")
            self.check_what_they_include([header])


@unittest.skipUnless((BUILD / "cmake_install.cmake").exists(),
                     "the program does not stand in its build")
class Library(Call):
    PREFIX = "library_"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.prefix = cls.dir / "usr"
        cls.call("cmake", "--install", BUILD, "--prefix", cls.prefix)
        (cls.dir / "user.cpp").write_text(TEN_LINES)
        (cls.dir / "version.cpp").write_text(VERSION)
        (cls.dir / "loop.cpp").write_text(block_of_guide("cpp", LOOP_GUIDE))
        (cls.dir / "CMakeLists.txt").write_text(USER_CMAKE.format(
            every_call=ROOT / "examples/library/files_of_commands.cpp"))
        cls.call("cmake", "-G", "Ninja", "-B", "build",
                 f"-DCMAKE_PREFIX_PATH={cls.prefix}")
        cls.call("cmake", "--build", "build")

    def libraries(self):
        found = sorted(self.prefix.rglob("*.a"))
        self.assertGreater(len(found), 10)
        return found

    def test_the_ten_lines_run_as_find_package_builds_them(self):
        said = self.call("build/few", SCENARIOS / "ten_minutes.toml")
        self.assertEqual(said.stdout, "3000 samples\n")

    def test_a_gyro_is_stepped_as_in_the_guide(self):
        said = self.call("build/loop", SCENARIOS / "devices/nominal.toml")
        self.assertRegex(
            said.stdout,
            r"^after 1 s: 2\d\.\d deg/s, of which 0\.\d deg/s are bias$")

    def found(self, components):
        """What find_package says of components, in a project of C++."""
        folder = self.dir / "components"
        folder.mkdir(exist_ok=True)
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\n"
            "project(user LANGUAGES CXX)\n"
            f"find_package(beamgyro 0.1 {components})\n"
            "message(STATUS \"found: ${beamgyro_FOUND}; "
            "${beamgyro_NOT_FOUND_MESSAGE}\")\n")
        said = self.call("cmake", "-G", "Ninja", "-B", "build",
                         f"-DCMAKE_PREFIX_PATH={self.prefix}", cwd=folder)
        return " ".join((said.stdout + said.stderr).split())

    def test_find_package_takes_its_parts_as_components(self):
        self.assertIn("found: 1;", self.found(
            "REQUIRED COMPONENTS dataset sim compensation validation shared"))
        self.assertIn("found: 1;", self.found("OPTIONAL_COMPONENTS plot"))
        for unknown in ["plot", "internal_sim"]:
            said = self.found(f"COMPONENTS sim {unknown}")
            self.assertRegex(said, "found: (0|FALSE);")
            self.assertIn(f"beamgyro has no component {unknown}; it has "
                          "compensation, dataset, shared, sim and "
                          "validation.", said)

    def test_each_part_links_alone(self):
        for part in ["dataset", "compensation", "validation"]:
            self.call(f"build/{part}")

    def test_the_ten_lines_run_as_pkg_config_builds_them(self):
        pkgconfig = next(self.prefix.rglob("beamgyro.pc")).parent
        stated = self.call(self.prefix / "bin/beamgyro", "--version").stdout
        for module, also in [("beamgyro", ""), (
                "beamgyro-shared", f"-Wl,-rpath,{pkgconfig.parent}")]:
            self.call("sh", "-c", f"PKG_CONFIG_PATH={pkgconfig} && "
                      "export PKG_CONFIG_PATH && "
                      f"c++ user.cpp -o by_{module} {also} "
                      f"$(pkg-config --cflags --libs {module})")
            said = self.call(f"./by_{module}", SCENARIOS / "ten_minutes.toml")
            self.assertEqual(said.stdout, "3000 samples\n")
            version = ended("pkg-config", "--modversion", module,
                            env={"PKG_CONFIG_PATH": str(pkgconfig)}).stdout
            self.assertIn(f"beamgyro {version.strip()} (", stated)
        needed = self.call("readelf", "-d", "by_beamgyro-shared").stdout
        self.assertIn("Shared library: [libbeamgyro.so.0.1]", needed)

    # What stands for it in test.sh: the library makes the bytes of the program,
    # below. Nothing there links it with an Eigen of the user's, and the test of
    # strong symbols does not see templates, which are weak.
    @pytest.mark.deep
    def test_a_user_may_have_eigen_with_other_instructions(self):
        # Templates of Eigen, compiled for vectors of 32 bytes by the user, are
        # not those that the library calls.
        if not {"avx", "fma"} <= set(re.findall(
                r"\w+", pathlib.Path("/proc/cpuinfo").read_text())):
            self.skipTest("needs a processor with AVX and FMA")
        (self.dir / "eigen.cpp").write_text(OWN_EIGEN)
        pkgconfig = next(self.prefix.rglob("beamgyro.pc")).parent
        eigen = self.call("pkg-config", "--cflags", "eigen3").stdout.strip()
        self.call(PROGRAM, "run", SCENARIOS / "ten_minutes.toml", "-o",
                  "of_program.h5")
        self.call(PROGRAM, "train", "of_program.h5", "--model",
                  SCENARIOS / "models/cubic.toml", "-o", "of_program.json")
        for flags in ["-O2", "-O2 -mavx -mfma"]:
            self.call("sh", "-c", f"PKG_CONFIG_PATH={pkgconfig} && "
                      f"export PKG_CONFIG_PATH && c++ -std=c++20 {flags} "
                      f"eigen.cpp {eigen} -o own_eigen "
                      "$(pkg-config --cflags --libs beamgyro)")
            self.call("./own_eigen", SCENARIOS, "of_program.h5")
            of_program = json.loads((self.dir / "of_program.json").read_text())
            own = json.loads((self.dir / "own.json").read_text())
            self.assertEqual(own["parameters"], of_program["parameters"],
                             flags)

    def test_the_guide_builds_and_runs(self):
        folder = self.dir / "guide"
        folder.mkdir()
        (folder / "example.cpp").write_text(block_of_guide("cpp"))
        (folder / "CMakeLists.txt").write_text(block_of_guide("cmake"))
        self.call("cmake", "-G", "Ninja", "-B", "build",
                  f"-DCMAKE_PREFIX_PATH={self.prefix}", cwd=folder)
        self.call("cmake", "--build", "build", cwd=folder)
        said = self.call("build/example", SCENARIOS, cwd=folder).stdout
        self.assertRegex(said, r"^\d+ samples, the last one at \S+ deg/s, "
                         r"compensated -?0\.\d+$")
        self.call(PROGRAM, "info", "warm_up.h5", cwd=folder)
        self.call(PROGRAM, "compensate", "cubic.json", "warm_up.h5", "-o",
                  "out.h5", cwd=folder)
        stated = re.findall(r"`(\w+\.h)`", GUIDE)
        self.assertEqual(sorted(stated), [path.name for path in HEADERS])

    def test_no_header_but_the_public_ones_is_installed(self):
        installed = files_below(self.prefix / "include")
        self.assertEqual(installed,
                         [f"beamgyro/{header.name}" for header in HEADERS])

    def test_strong_symbols_are_in_our_namespace(self):
        named = re.compile(
            r"^(?:vtable|typeinfo|typeinfo name|guard variable|construction "
            r"vtable|VTT|TLS (?:init|wrapper) function)? ?(?:for )?"
            r"(?:\S.* )?beamgyro::")
        foreign = set()
        for library in self.libraries():
            listed = self.call("nm", "-C", "--defined-only", library).stdout
            for line in listed.splitlines():
                kind = re.match(r"^[0-9a-f]+ ([TDBRS]) (.*)$", line)
                if kind and not named.match(kind[2]):
                    foreign.add(f"{library.name}: {kind[2]}")
        self.assertEqual(foreign, set())

    def shared_library(self):
        return next(self.prefix.rglob("libbeamgyro.so"))

    def test_the_shared_library_shows_the_public_names_only(self):
        listed = self.call("nm", "-DC", "--defined-only",
                           self.shared_library()).stdout.splitlines()
        names = [line.split(maxsplit=2)[2] for line in listed]
        for name in names:
            self.assertRegex(name, r"^(?:(?:vtable|typeinfo|VTT)(?: name)? for )?"
                             "beamgyro::(?!internal)")
        for name in ["beamgyro::Device::read(", "beamgyro::version()",
                     "beamgyro::write_recording(", "beamgyro::validate(",
                     "typeinfo for beamgyro::OptionError",
                     "vtable for beamgyro::RateCompensator"]:
            self.assertTrue(any(shown.startswith(name) for shown in names),
                            name)

    def test_the_shared_library_has_a_version_and_needs_no_other_package(self):
        headers = self.call("readelf", "-d", self.shared_library()).stdout
        self.assertIn("Library soname: [libbeamgyro.so.0.1]", headers)
        self.assertNotRegex(headers, "R(?:UN)?PATH")
        folder = self.dir / "shared"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\n"
            "project(user LANGUAGES CXX)\n"
            "find_package(beamgyro 0.1 REQUIRED COMPONENTS shared)\n"
            "add_executable(user ../user.cpp)\n"
            "target_link_libraries(user PRIVATE beamgyro::shared)\n")
        said = self.call("cmake", "-G", "Ninja", "-B", "build",
                         f"-DCMAKE_PREFIX_PATH={self.prefix}", cwd=folder)
        self.assertNotIn("HDF5", said.stdout)
        self.call("cmake", "--build", "build", cwd=folder)
        said = self.call("build/user", SCENARIOS / "ten_minutes.toml",
                         cwd=folder)
        self.assertEqual(said.stdout, "3000 samples\n")

    def test_the_library_makes_the_bytes_of_the_program_and_prints_nothing(
            self):
        by_program = self.dir / "program"
        by_libraries = [self.dir / "lib", self.dir / "shared_lib"]
        for folder in [*by_libraries, by_program]:
            folder.mkdir()
            self.call(PROGRAM, "run", SCENARIOS / "ramp.toml", "-o", "ramp.h5",
                      "--set", "output_rate_Hz=1", cwd=folder)
        for folder, user in zip(by_libraries, ["user", "user_of_shared"]):
            said = self.call(self.dir / "build" / user, SCENARIOS, SPEC,
                             cwd=folder)
            self.assertEqual(said.stdout + said.stderr, "")
            (folder / "version").unlink()
        for line in COMMANDS.format(s=SCENARIOS, spec=SPEC).splitlines():
            words = line.split()
            said = self.call(PROGRAM, *words, cwd=by_program, allowed=(0, 3))
            if words[0] in PRINTED and words[1] != "set":
                (by_program / PRINTED[words[0]]).write_text(said.stdout)
        names = files_below(by_program)
        for folder in by_libraries:
            self.assertEqual(files_below(folder), names)
            for name in names:
                self.assertTrue(filecmp.cmp(by_program / name, folder / name,
                                            shallow=False), name)
