#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Opens a recording in h5py, xarray (both engines) and ncdump.

Usage: reader_test.py WRITE_SAMPLE
"""
import csv
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np
import xarray as xr

SAMPLES = 1000
UNITS = {
    "output": "V",
    "rate": "degree/s",
    "temperature": "degC",
    "drive_frequency": "Hz",
    "drive_voltage": "V",
    "quadrature": "degree/s",
    "true_rate": "degree/s",
    "true_bias": "degree/s",
    "true_beam_temperature": "degC",
    "true_pzt_temperature": "degC",
    "true_mount_temperature": "degC",
    "true_housing_temperature": "degC",
    "true_board_temperature": "degC",
    "true_sensor_temperature": "degC",
    "true_ambient_temperature": "degC",
    "compensated_rate": "degree/s",
}
FILE_ORDER = (["time"] + list(UNITS)[:6] + ["status"] + list(UNITS)[6:])
ROOT = {
    "Conventions": "CF-1.10",
    "filetype": "beamgyro-recording",
    "format_version": 2,
    "beamgyro_version": "1.2.3",
    "git_revision": "0123abc",
    "seed": 2**64 - 1,
    "fidelity": "quasistatic",
    "source": "quasistatic simulation of a virtual gyro by beamgyro 1.2.3 "
              "(0123abc)",
    "title": "a sample",
    "history": "made\ncompensated",
    "compensator": "c.json",
    "compensator_sha256": "0123",
}
META = {
    "scenario": "name = \"Gr\u00fc\u00dfe\"\r\n\tx = 1",
    "device": "[beam]\nlength_m = 0.04\n",
    "overrides": "",
}


def role(name):
    if name == "compensated_rate":
        return "compensated"
    return "truth" if name.startswith("true_") else "measured"


def expected_values(name):
    k = np.arange(SAMPLES)
    values = (list(UNITS).index(name) + 1) * k / 8 - 3
    if role(name) != "truth":
        values[k < SAMPLES // 5] = math.nan
    return values


def expected_status():
    status = np.zeros(SAMPLES, np.uint8)
    status[:SAMPLES // 5] = 1
    status[-2:] = [6, 2]
    return status


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


class ReaderTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory(prefix="beamgyro reader ")
        cls.folder = pathlib.Path(cls.holder.name)
        cls.file = cls.folder / "run.h5"
        cls.write(cls.file)

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @staticmethod
    def write(path):
        subprocess.run([WRITE_SAMPLE, str(SAMPLES), str(path)], check=True)

    def check_attributes(self, found, units, of_role):
        self.assertEqual(text(found["units"]), units)
        self.assertEqual(text(found["role"]), of_role)
        self.assertIn("long_name", found)

    def test_h5py_finds_everything_with_its_time_axis(self):
        with h5py.File(self.file) as file:
            self.assertEqual(set(file), {*FILE_ORDER, "meta"})
            self.assertEqual({k: text(v) for k, v in file.attrs.items()},
                             {k: str(v) for k, v in ROOT.items()})
            self.assertTrue(h5py.h5ds.is_scale(file["time"].id))
            for name in FILE_ORDER[1:]:
                self.assertEqual(file[name].dims[0][0].name, "/time")
                self.assertIsNone(file[name].chunks)
            for name, units in UNITS.items():
                self.assertEqual(file[name].dtype, np.dtype("<f8"))
                self.check_attributes(file[name].attrs, units, role(name))
                np.testing.assert_array_equal(file[name][:],
                                              expected_values(name))
            np.testing.assert_array_equal(file["status"][:], expected_status())
            self.assertEqual(file["status"].dtype, np.uint8)

    def test_attributes_are_fixed_length_utf8(self):
        with h5py.File(self.file) as file:
            for item in [file] + [file[name] for name in FILE_ORDER]:
                for name in item.attrs:
                    kind = item.attrs.get_id(name).get_type()
                    if (not isinstance(kind, h5py.h5t.TypeStringID)
                            or name in ("CLASS", "NAME")):  # HDF5's own
                        continue
                    self.assertFalse(kind.is_variable_str(), name)
                    self.assertEqual(kind.get_cset(), h5py.h5t.CSET_UTF8)

    def test_meta_holds_the_texts_byte_for_byte(self):
        with h5py.File(self.file) as file:
            self.assertEqual({name: file["meta"][name][()].decode()
                              for name in file["meta"]}, META)

    def test_xarray_opens_it_with_both_engines(self):
        for engine in ("h5netcdf", "netcdf4"):
            with self.subTest(engine), xr.open_dataset(
                    self.file, engine=engine) as data:
                self.assertEqual(set(data.data_vars), set(FILE_ORDER[1:]))
                self.assertEqual(set(data.coords), {"time"})
                self.assertEqual(dict(data.sizes), {"time": SAMPLES})
                self.assertEqual(data["time"].dtype, np.float64)
                self.assertEqual(data["time"].attrs["units"], "s")
                np.testing.assert_array_equal(data["time"],
                                              np.arange(SAMPLES) / 10)
                for name, units in UNITS.items():
                    self.check_attributes(data[name].attrs, units, role(name))
                    self.assertEqual(data[name].dtype, np.float64)
                    np.testing.assert_array_equal(data[name],
                                                  expected_values(name))
                self.check_status(data["status"])
                self.assertEqual({k: text(v) for k, v in data.attrs.items()},
                                 {k: str(v) for k, v in ROOT.items()})

    def check_status(self, status):
        self.check_attributes(status.attrs, "1", "measured")
        self.assertEqual(status.dtype, np.uint8)
        np.testing.assert_array_equal(status, expected_status())
        self.assertEqual(list(status.attrs["flag_masks"]), [1, 2, 4])
        self.assertEqual(status.attrs["flag_meanings"],
                         "unpowered output_saturated loop_not_locked")

    def test_netcdf4_reads_the_texts(self):
        with xr.open_dataset(self.file, engine="netcdf4", group="meta") as meta:
            self.assertEqual({name: str(meta[name].values) for name in meta},
                             META)

    def test_ncdump_lists_variables_units_and_texts(self):
        header = subprocess.run(["ncdump", "-h", str(self.file)], check=True,
                                capture_output=True, text=True).stdout
        self.assertIn(f"time = {SAMPLES} ;", header)
        self.assertIn("double time(time) ;", header)
        self.assertIn("ubyte status(time) ;", header)
        self.assertIn('status:units = "1" ;', header)
        self.assertIn("status:flag_masks = 1UB, 2UB, 4UB ;", header)
        for name, units in UNITS.items():
            self.assertIn(f"double {name}(time) ;", header)
            self.assertIn(f'{name}:units = "{units}" ;', header)
            self.assertIn(f'{name}:role = "{role(name)}" ;', header)
        for name in ROOT:
            self.assertIn(f"\t\t:{name} = ", header)
        places = [header.index(f" {name}(time) ;") for name in FILE_ORDER]
        self.assertEqual(places, sorted(places))
        self.assertIn("string scenario ;", header)
        self.assertNotIn("phony_dim", header)

    def test_ncdump_reads_every_value(self):
        dump = subprocess.run(["ncdump", "-v", "status,true_rate",
                               str(self.file)], check=True,
                              capture_output=True, text=True).stdout
        rows = dump.split(" true_rate = ")[1].split(";")[0].split(",")
        np.testing.assert_array_equal([float(row) for row in rows],
                                      expected_values("true_rate"))

    def test_two_writes_are_byte_identical(self):
        again = self.folder / "again.h5"
        time.sleep(1.1)  # HDF5 time stamps count seconds
        self.write(again)
        self.assertEqual(again.read_bytes(), self.file.read_bytes())

    def test_only_the_finished_file_is_there(self):
        self.assertEqual([p.name for p in self.folder.iterdir()
                          if p.suffix not in (".h5", ".csv")], [])

    def test_csv_holds_the_same_columns(self):
        path = self.folder / "run.csv"
        self.write(path)
        with path.open(newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0], FILE_ORDER)
        columns = np.array(rows[1:], float).T
        self.assertEqual(columns.shape, (len(FILE_ORDER), SAMPLES))
        for name, values in zip(FILE_ORDER, columns):
            expected = (np.arange(SAMPLES) / 10 if name == "time" else
                        expected_status() if name == "status" else
                        expected_values(name))
            np.testing.assert_array_equal(values, expected)


if __name__ == "__main__":
    WRITE_SAMPLE = sys.argv.pop(1)
    unittest.main()
