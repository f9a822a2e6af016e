# SPDX-License-Identifier: MIT
"""Opens a generated set in h5py, xarray, netCDF4, ncdump and Octave."""

import hashlib
import json
import shutil
import unittest

import h5py
import netCDF4
import numpy as np
import pytest
import xarray as xr

from program import PROGRAM, SCENARIOS, by_octave, class_folder, said

ENGINES = ("h5netcdf", "netcdf4")
FIXED = ("device", "time", "truth_time", "part", "device_status", "status")


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


class SetTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.set = class_folder(cls, "beamgyro set ") / "a set"
        said(PROGRAM, "generate", SCENARIOS / "campaigns/small.toml", "-o",
             cls.set)
        lines = [json.loads(line) for line in
                 (cls.set / "manifest.jsonl").read_text().splitlines()]
        cls.head = lines[0]
        cls.entries = [line for line in lines if "index" in line]
        cls.views = [line for line in lines if "view" in line]

    def first_files(self):
        for run in self.head["runs"]:
            yield run, self.set / f"{run}_00000.h5"

    def decoded(self, variable):
        values = variable[:].astype(float)
        if "_FillValue" in variable.attrs:
            values[variable[:] == variable.attrs["_FillValue"]] = np.nan
        return (values * variable.attrs.get("scale_factor", 1.0)
                + variable.attrs.get("add_offset", 0.0))

    def test_the_manifest_lists_every_file_with_its_bytes(self):
        listed = {e["file"]: e for e in self.entries}
        listed.update({v["view"]: v for v in self.views})
        found = {p.name for p in self.set.iterdir()
                 if p.suffix in (".h5", ".nc")}
        self.assertEqual(set(listed), found)
        for name, entry in listed.items():
            data = (self.set / name).read_bytes()
            self.assertEqual(len(data), entry["bytes"])
            self.assertEqual(hashlib.sha256(data).hexdigest(), entry["sha256"])
        for source in self.head["sources"]:
            data = (self.set / source["file"]).read_bytes()
            self.assertEqual(hashlib.sha256(data).hexdigest(),
                             source["sha256"])

    def test_every_line_of_the_manifest_can_be_checked_by_itself(self):
        for line in (self.set / "manifest.jsonl").read_bytes().splitlines():
            body, check = line.rsplit(b',"check":"', 1)
            self.assertEqual(hashlib.sha256(body).hexdigest()[:16],
                             check.decode().removesuffix('"}'))

    def test_the_last_line_is_the_hash_of_all_before(self):
        before, last = (self.set / "manifest.jsonl").read_bytes().rstrip(
            b"\n").rsplit(b"\n", 1)
        self.assertEqual(json.loads(last)["sha256_before"],
                         hashlib.sha256(before + b"\n").hexdigest())

    def test_every_dimension_of_every_variable_has_its_scale(self):
        for run, path in self.first_files():
            for name in (path, self.set / f"{run}.nc"):
                with h5py.File(name) as file:
                    for key in set(file) - {"meta"}:
                        variable = file[key]
                        for i in range(variable.ndim):
                            if not h5py.h5ds.is_scale(variable.id):
                                self.assertIn(variable.dims[i][0].name, (
                                    "/device", "/time", "/truth_time"), key)
                        for attribute in ("units", "long_name", "role"):
                            kind = variable.attrs.get_id(attribute).get_type()
                            self.assertFalse(kind.is_variable_str(), key)

    def test_files_hold_values_compressed_or_as_they_are(self):
        for _, path in self.first_files():
            with h5py.File(path) as file:
                self.assertEqual(text(file.attrs["filetype"]), "beamgyro-set")
                for name in set(file) - {"meta"}:
                    if file[name].ndim == 2 and file[name].chunks:
                        self.assertEqual(file[name].chunks[0], 1)
                        self.assertTrue(file[name].fletcher32)
                        self.assertTrue(file[name].shuffle)

    def test_a_flipped_byte_of_a_chunk_is_an_error_in_h5py(self):
        _, path = next(self.first_files())
        with h5py.File(path) as file:
            self.assertTrue(file["output"].chunks)
            place = file["output"].id.get_chunk_info(0).byte_offset
        data = bytearray(path.read_bytes())
        data[place + 100] ^= 1
        copy = self.set.parent / "flipped.h5"
        copy.write_bytes(data)
        with h5py.File(copy) as file, self.assertRaises(OSError):
            file["output"][0]

    def test_both_engines_give_the_values_of_the_counts(self):
        for engine in ENGINES:
            for run, path in self.first_files():
                with xr.open_dataset(path, engine=engine) as data, \
                        h5py.File(path) as file:
                    self.assertEqual(set(data.variables),
                                     set(file) - {"meta"})
                    for name in data.variables:
                        expected = self.decoded(file[name])
                        # xarray makes float32 of 16-bit counts
                        np.testing.assert_allclose(
                            data[name].values.astype(float), expected,
                            rtol=1e-6)
                        self.assertIn("units", data[name].attrs)

    def test_a_view_shows_what_the_files_hold(self):
        for run in self.head["runs"]:
            paths = sorted(self.set.glob(f"{run}_[0-9]*.h5"))
            with h5py.File(self.set / f"{run}.nc") as view:
                self.assertEqual(len(view["device"]), self.head["devices"])
                for path in paths:
                    with h5py.File(path) as file:
                        at = file["device"][:]
                        self.assertEqual(set(view), set(file))
                        for name in set(file) - {"meta", "time", "truth_time"}:
                            np.testing.assert_array_equal(view[name][at],
                                                          file[name][:])
            for engine in ENGINES:
                with xr.open_dataset(self.set / f"{run}.nc",
                                     engine=engine) as data:
                    self.assertEqual(data.sizes["device"],
                                     self.head["devices"])
                    one = data.isel(device=-1).load()
                    self.assertEqual(one.output.dims, ("time",))

    def test_a_view_shows_a_missing_file_as_unknown(self):
        copy = self.set.parent / "copy"
        shutil.copytree(self.set, copy)
        self.addCleanup(shutil.rmtree, copy)
        run, path = next(self.first_files())
        with h5py.File(path) as file:
            devices = file["device"][:]
        (copy / path.name).unlink()
        for engine in ENGINES:
            with xr.open_dataset( copy / f"{run}.nc", engine=engine) as data:
                lost = data.isel(device=devices)
                self.assertTrue(np.isnan(lost.output.values).all())
                self.assertTrue((lost.device_status.values == 255).all())
                self.assertTrue((lost.part.values == 255).all())
                self.assertTrue((lost.status.values == 1).all())

    def test_netcdf4_masks_what_is_not_there(self):
        _, path = next(self.first_files())
        with netCDF4.Dataset(path) as data, h5py.File(path) as file:
            found = np.ma.filled(data["output"][:].astype(float), np.nan)
            np.testing.assert_allclose(found, self.decoded(file["output"]),
                                       rtol=1e-12)

    def test_ncdump_lists_variables_over_device_and_time(self):
        for run, path in self.first_files():
            for name in (path, self.set / f"{run}.nc"):
                header = said("ncdump", "-h", name)
                self.assertIn("output(device, time) ;", header)
                self.assertIn("ubyte status(device, time) ;", header)
                self.assertIn('flag_meanings = "train validation test"',
                              header)
                self.assertNotIn("phony_dim", header)

    # In test.sh ncdump, h5py, netCDF4 and xarray read the same files; no Octave
    # does.
    @pytest.mark.deep
    def test_octave_reads_files_and_views(self):
        run, path = next(self.first_files())
        rows = [line.split() for line in by_octave("".join(
            f"x = ncread('{name}', 'output', [1 1], [Inf 1]);\n"
            "printf('%d %.17g\\n', numel(x), x(end));\n"
            for name in (path, self.set / f"{run}.nc")), self.set)]
        with h5py.File(path) as file:
            values = self.decoded(file["output"])[0]
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertEqual(int(row[0]), len(values))
            np.testing.assert_allclose(float(row[1]), values[-1], rtol=1e-12)

    def test_the_texts_are_those_of_the_sources(self):
        _, path = next(self.first_files())
        with h5py.File(path) as file:
            campaign = file["meta/campaign"][()].decode()
            for line in file["meta/failures"][()].decode().splitlines():
                self.assertIn("reason", json.loads(line))
        self.assertEqual(campaign, (SCENARIOS / "campaigns/small.toml")
                         .read_text(encoding="utf-8"))
