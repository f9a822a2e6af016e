# SPDX-License-Identifier: MIT
"""What files say of themselves, CSV that is read back, and names of files."""

import hashlib
import shutil

import h5py
import numpy as np
import pytest
import xarray

from program import ProgramTest, by_octave, ramp
from sets import Set

ENGINES = ["h5netcdf", "netcdf4"]


class Attributes(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=ramp())

    def test_xarray_shows_title_source_and_history(self):
        for engine in ENGINES:
            with xarray.open_dataset(self.dir / "run.h5", engine=engine) as data:
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
        self.train_on("run.h5", to="cubic.json")
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
        self.train_on("old.h5")
        self.ok("compensate", "c.json", "old.h5", "-o", "out.h5")

    # In test.sh tests/dataset/reader_test.py finds texts of a fixed length, and
    # h5py reads values; no Octave does.
    @pytest.mark.deep
    def test_octave_reads_texts_and_values(self):
        title, units, value = by_octave("""
            disp(ncreadatt("run.h5", "/", "title"))
            disp(ncreadatt("run.h5", "rate", "units"))
            printf("%.17g\\n", ncread("run.h5", "rate")(end))""", self.dir)[-3:]
        self.assertEqual((title, units),
                         ("short: ten minutes at rest", "degree/s"))
        self.assertEqual(float(value), self.signals("run.h5")["rate"][-1])


class Coordinates(Set):
    def test_drawn_values_part_and_status_of_devices_are_coordinates(self):
        self.generate("set")
        for name, engine in [("rest_00000.h5", "h5netcdf"),
                             ("rest_00000.h5", "netcdf4"),
                             ("rest.nc", "netcdf4")]:
            with xarray.open_dataset(self.dir / "set" / name,
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
    def prepare(self):
        super().prepare()
        text = ramp() + "\n[power]\non_s = [60]\n"
        self.run_scenario("run", text=text)
        self.ok("run", "run.toml", "-o", "run.csv")

    def test_every_command_reads_a_recording_back_from_csv(self):
        for kind in ["h5", "csv"]:
            self.train_on(f"run.{kind}", to=f"{kind}.json")
            for out in ["h5", "csv"]:
                self.ok("compensate", "h5.json", f"run.{kind}", "-o",
                        f"{kind}_out.{out}")
        one, other = (self.json(f"{kind}.json") for kind in ["h5", "csv"])
        self.assertEqual(one["parameters"], other["parameters"])
        with h5py.File(self.dir / "h5_out.h5") as one, \
                h5py.File(self.dir / "csv_out.h5") as other:
            self.assertEqual([name for name in one], [name for name in other])
            for name in set(one) - {"meta"}:
                np.testing.assert_array_equal(one[name][()], other[name][()],
                                              err_msg=name)
                self.assertEqual(dict(one[name].attrs).get("units"),
                                 dict(other[name].attrs).get("units"))
        self.assertSameBytes("h5_out.csv", "csv_out.csv")
        left = [self.validated("h5.json", f"run.{kind}")[0]["runs"][0]
                for kind in ["h5", "csv"]]
        self.assertEqual(*[run["rms_deg_per_s"] for run in left])
        self.assertIn("compensated_rate", self.ok("info", "csv_out.csv"))
        self.assertEqual(self.ok("allan", "run.h5"),
                         self.ok("allan", "run.csv"))

    def test_units_in_brackets_are_converted(self):
        lines = self.text("run.csv").splitlines()
        names = lines[0].split(",")
        at = names.index("temperature")
        names[at] = "temperature [K]"
        rows = [line.split(",") for line in lines[1:]]
        for row in rows:
            if row[at] != "nan":
                row[at] = repr(float(row[at]) + 273.15)
        self.write("kelvin.csv", "\n".join(map(",".join, [names, *rows])))
        one, other = (self.train_on(name)["parameters"]
                      for name in ["kelvin.csv", "run.csv"])
        # 273.15 costs the temperatures six digits of 2^-52.
        np.testing.assert_allclose(one["coefficients"], other["coefficients"],
                                   rtol=1e-9)
