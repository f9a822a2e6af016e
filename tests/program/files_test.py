# SPDX-License-Identifier: MIT
"""What files say of themselves, CSV that is read back, and names of files."""

import hashlib
import json
import shutil
import subprocess
import unittest

import h5py
import numpy as np
import pytest
import xarray

from program import CUBIC, ProgramTest, ramp
from sets import Set

ENGINES = ["h5netcdf", "netcdf4"]


class Attributes(ProgramTest):
    def setUp(self):
        super().setUp()
        self.run_scenario("run", text=ramp())
        self.write("m.toml", CUBIC)

    def test_xarray_shows_title_source_and_history(self):
        for engine in ENGINES:
            with self.subTest(engine), \
                    xarray.open_dataset(self.dir / "run.h5",
                                        engine=engine) as data:
                self.assertEqual(data.attrs["title"],
                                 "short: ten minutes at rest")
                self.assertRegex(
                    data.attrs["source"],
                    r"^quasistatic simulation of a virtual gyro by beamgyro "
                    r"0\.1\.0 \(\S+\)$")
                self.assertRegex(data.attrs["history"],
                                 r"^beamgyro 0\.1\.0 \(\S+\): run$")
                self.assertEqual(data["time"].attrs["axis"], "T")
                self.assertEqual(data["time"].attrs["standard_name"], "time")
                self.assertEqual(
                    data["true_ambient_temperature"].attrs["standard_name"],
                    "air_temperature")
                self.assertEqual(data["time"].dtype, np.float64)

    def test_a_compensated_recording_names_its_compensator(self):
        self.ok("train", "run.h5", "--model", "m.toml", "-o", "cubic.json")
        self.ok("compensate", "cubic.json", "run.h5", "-o", "out.h5")
        digest = hashlib.sha256((self.dir / "cubic.json").read_bytes())
        with xarray.open_dataset(self.dir / "out.h5", engine="h5netcdf") as data:
            self.assertEqual(data.attrs["compensator"], "cubic.json")
            self.assertEqual(data.attrs["compensator_sha256"],
                             digest.hexdigest())
            lines = data.attrs["history"].splitlines()
            self.assertEqual(len(lines), 2)
            self.assertTrue(lines[1].endswith(": compensate with cubic.json"))
        self.assertIn("cubic.json", self.ok("info", "out.h5"))

    def test_a_recording_without_these_attributes_is_still_read(self):
        shutil.copy(self.dir / "run.h5", self.dir / "old.h5")
        with h5py.File(self.dir / "old.h5", "r+") as file:
            for name in ["title", "source", "history"]:
                del file.attrs[name]
            for name in ["axis", "standard_name"]:
                del file["time"].attrs[name]
        self.ok("train", "old.h5", "--model", "m.toml", "-o", "c.json")
        self.ok("compensate", "c.json", "old.h5", "-o", "out.h5")

    def test_texts_have_a_fixed_length_for_octave_and_matlab(self):
        with h5py.File(self.dir / "run.h5") as file:
            objects = [file, *(file[name] for name in file if name != "meta")]
            for item in objects:
                for name in item.attrs:
                    kind = item.attrs.get_id(name).get_type()
                    if isinstance(kind, h5py.h5t.TypeStringID):
                        self.assertFalse(kind.is_variable_str(), name)

    # In test.sh the form of the texts is tested above and h5py reads values; no
    # Octave does.
    @pytest.mark.deep
    @unittest.skipUnless(shutil.which("octave-cli"), "octave is not installed")
    def test_octave_reads_texts_and_values(self):
        script = """
            pkg load netcdf
            disp(ncreadatt("run.h5", "/", "title"))
            disp(ncreadatt("run.h5", "rate", "units"))
            printf("%.17g\\n", ncread("run.h5", "rate")(end))"""
        said = subprocess.run(
            ["octave-cli", "--no-gui", "--eval", script], cwd=self.dir,
            capture_output=True, text=True, check=False)
        if "netcdf is not installed" in said.stderr:
            self.skipTest("no octave-netcdf here")
        self.assertEqual(said.returncode, 0, said.stderr)
        title, units, value = said.stdout.splitlines()[-3:]
        self.assertEqual((title, units),
                         ("short: ten minutes at rest", "degree/s"))
        with h5py.File(self.dir / "run.h5") as file:
            self.assertEqual(float(value), file["rate"][-1])


class Coordinates(Set):
    def test_drawn_values_part_and_status_of_devices_are_coordinates(self):
        self.generate("set")
        for name, engine in [("rest_00000.h5", "h5netcdf"),
                             ("rest_00000.h5", "netcdf4"),
                             ("rest.nc", "netcdf4")]:
            with self.subTest(name=name, engine=engine), \
                    xarray.open_dataset(self.dir / "set" / name,
                                        engine=engine) as data:
                self.assertLessEqual(
                    {"device", "time", "part", "device_status",
                     "readout_quadrature_trim_deg_per_s"}, set(data.coords))
                self.assertEqual(
                    data["rate"].coords["part"].dims, ("device",))
                self.assertIn("run rest", data.attrs["title"])
                self.assertIn("simulation", data.attrs["source"])
                self.assertTrue(data.attrs["history"].endswith(": generate"))
                self.assertEqual(data["time"].attrs["axis"], "T")


class Csv(ProgramTest):
    def setUp(self):
        super().setUp()
        text = ramp() + "\n[power]\non_s = [60]\n"
        self.run_scenario("run", text=text)
        self.ok("run", "run.toml", "-o", "run.csv")
        self.write("m.toml", CUBIC)

    def test_every_command_reads_a_recording_back_from_csv(self):
        for kind in ["h5", "csv"]:
            self.ok("train", f"run.{kind}", "--model", "m.toml", "-o",
                    f"{kind}.json")
            for out in ["h5", "csv"]:
                self.ok("compensate", "h5.json", f"run.{kind}", "-o",
                        f"{kind}_out.{out}")
        one, other = (json.loads((self.dir / f"{kind}.json").read_text())
                      for kind in ["h5", "csv"])
        self.assertEqual(one["parameters"], other["parameters"])
        with h5py.File(self.dir / "h5_out.h5") as one, \
                h5py.File(self.dir / "csv_out.h5") as other:
            self.assertEqual([name for name in one], [name for name in other])
            for name in set(one) - {"meta"}:
                np.testing.assert_array_equal(one[name][()], other[name][()],
                                              err_msg=name)
                self.assertEqual(dict(one[name].attrs).get("units"),
                                 dict(other[name].attrs).get("units"))
        self.assertEqual((self.dir / "h5_out.csv").read_bytes(),
                         (self.dir / "csv_out.csv").read_bytes())
        left = []
        for kind in ["h5", "csv"]:
            self.beamgyro("validate", "h5.json", f"run.{kind}", "--json",
                          "v.json")
            [run] = json.loads((self.dir / "v.json").read_text())["runs"]
            left.append(run["rms_deg_per_s"])
        self.assertEqual(*left)
        self.assertIn("compensated_rate", self.ok("info", "csv_out.csv"))
        curves = [self.ok("allan", f"run.{kind}") for kind in ["h5", "csv"]]
        self.assertEqual(*curves)

    def test_units_in_brackets_are_converted(self):
        lines = (self.dir / "run.csv").read_text().splitlines()
        names = lines[0].split(",")
        at = names.index("temperature")
        names[at] = "temperature [K]"
        rows = [line.split(",") for line in lines[1:]]
        for row in rows:
            if row[at] != "nan":
                row[at] = repr(float(row[at]) + 273.15)
        self.write("kelvin.csv", "\n".join(map(",".join, [names, *rows])))
        self.ok("train", "kelvin.csv", "--model", "m.toml", "-o", "k.json")
        self.ok("train", "run.csv", "--model", "m.toml", "-o", "c.json")
        one, other = (json.loads((self.dir / name).read_text())["parameters"]
                      for name in ["k.json", "c.json"])
        # 273.15 costs the temperatures six digits of 2^-52.
        np.testing.assert_allclose(one["coefficients"], other["coefficients"],
                                   rtol=1e-9)
