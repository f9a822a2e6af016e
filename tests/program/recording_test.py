# SPDX-License-Identifier: MIT
"""`beamgyro run`: recordings, read by what other people read them with."""

import csv
import resource

import h5py
import netCDF4
import numpy as np
import xarray

from program import (ROOT, SCENARIO, SHIPPED_SCENARIOS, ProgramTest, limit,
                     said)

NODES = ["beam", "pzt", "mount", "housing", "board", "sensor"]
MEASURED = {"output": "V", "rate": "degree/s", "temperature": "degC",
            "drive_frequency": "Hz", "drive_voltage": "V",
            "quadrature": "degree/s"}
TRUTH = {"true_rate": "degree/s", "true_bias": "degree/s",
         "true_ambient_temperature": "degC"} | {
             f"true_{node}_temperature": "degC" for node in NODES}
UNITS = MEASURED | TRUTH

CYCLES = SCENARIO + """
[power]
on_s = [60, 300]
off_s = [240]
"""


class Recording(ProgramTest):
    def test_xarray_reads_every_variable_unit_and_coordinate(self):
        path = self.run_scenario("a")
        for engine in ["h5netcdf", "netcdf4"]:
            with xarray.open_dataset(path, engine=engine) as data:
                self.assertEqual(set(data.data_vars), {*UNITS, "status"})
                self.assertEqual(dict(data.sizes), {"time": 1200})
                np.testing.assert_array_equal(data["time"],
                                              np.arange(1200) / 2)
                self.assertEqual(data["time"].attrs["units"], "s")
                for name, units in UNITS.items():
                    self.assertEqual(data[name].dims, ("time",))
                    self.assertEqual(data[name].dtype, np.float64)
                    self.assertEqual(data[name].attrs["units"], units)
                    self.assertTrue(data[name].attrs["long_name"])
                    self.assertEqual(
                        data[name].attrs["role"],
                        "measured" if name in MEASURED else "truth")
                self.assertEqual(data["status"].dtype, np.uint8)
                self.assertEqual(list(data["status"].attrs["flag_masks"]),
                                 [1, 2, 4])
                self.assertEqual(
                    len(data["status"].attrs["flag_meanings"].split()), 3)

    def test_memory_does_not_grow_with_the_samples(self):
        self.write("short.toml", SCENARIO)
        # The recording of 600,000 samples takes 77 MB, a block of them 2 MB,
        # the program without any 12 MB of data.
        self.ok("run", "short.toml", "-o", "long.h5", "--set",
                "output_rate_Hz=10", "--set", "duration_s=60000",
                preexec_fn=limit(resource.RLIMIT_DATA, 32_000 * 1024))

    def test_h5py_reads_the_root_and_the_texts(self):
        path = self.run_scenario("a", "--set", "beam.length_m=0.039",
                                 "--seed", "12")
        with h5py.File(path) as file:
            attributes = file.attrs
            for name, value in [("filetype", "beamgyro-recording"),
                                ("fidelity", "quasistatic"),
                                ("beamgyro_version", "0.1.0")]:
                self.assertEqual(attributes[name], value.encode())
            self.assertEqual(attributes["seed"], 12)
            for name in ["Conventions", "format_version", "git_revision"]:
                self.assertIn(name, attributes)
            self.assertEqual(file["meta/scenario"][()].decode(), SCENARIO)
            self.assertEqual(file["meta/device"][()],
                             (self.dir / "device.toml").read_bytes())
            overrides = file["meta/overrides"][()].decode()
            self.assertIn("beam.length_m=0.039", overrides)
            self.assertIn("12", overrides)
            for name in UNITS:
                self.assertEqual(file[name].dims[0][0].name, "/time")

    def test_ncdump_reads_the_header_and_the_data(self):
        path = self.run_scenario("a")
        text = said("ncdump", path)
        self.assertIn("time = 1200 ;", text)
        for name, units in (UNITS | {"time": "s"}).items():
            self.assertIn(f'{name}:units = "{units}"', text)

    def test_netcdf4_reads_the_values_h5py_reads(self):
        path = self.run_scenario("a")
        with h5py.File(path) as file, netCDF4.Dataset(path) as data:
            data.set_auto_mask(False)
            for name in [*UNITS, "status", "time"]:
                np.testing.assert_array_equal(file[name][()], data[name][:])

    def test_unpowered_samples_are_nan_where_measured_and_only_there(self):
        path = self.run_scenario("a", text=CYCLES)
        with h5py.File(path) as file:
            time = file["time"][()]
            off = (time < 60) | ((time >= 240) & (time < 300))
            np.testing.assert_array_equal(file["status"][()] & 1, off)
            for name in MEASURED:
                np.testing.assert_array_equal(np.isnan(file[name][()]), off)
            for name in TRUTH:
                self.assertTrue(np.isfinite(file[name][()]).all(), name)
            beam = file["true_beam_temperature"][()]
            np.testing.assert_allclose(beam[time <= 60], 25, atol=1e-9)
            self.assertGreater(beam[-1], 25.1)

    def test_rate_is_the_scaled_output(self):
        path = self.run_scenario("a", "--set", "rate.constant_deg_per_s=30")
        with h5py.File(path) as file:
            np.testing.assert_allclose(file["true_rate"][()], 30, rtol=1e-15)
            np.testing.assert_allclose((file["output"][()] - 2.5) / 12.5e-3,
                                       file["rate"][()], atol=1e-9)
            drift = file["rate"][()] - file["true_rate"][()]
            self.assertLess(np.abs(drift - file["true_bias"][()]).max(), 0.3)

    def test_same_bytes_again_and_other_bytes_for_another_seed(self):
        for suffix in ["h5", "csv"]:
            self.write("s.toml", SCENARIO)
            data = []
            for seed in [1, 1, 2]:
                self.ok("run", "s.toml", "-o", f"a.{suffix}", "--seed", seed)
                data.append((self.dir / f"a.{suffix}").read_bytes())
            self.assertEqual(data[0], data[1])
            self.assertNotEqual(data[0], data[2])

    def test_without_noise_the_seed_has_no_part_in_the_signals(self):
        data = []
        for seed in [1, 2]:
            self.run_scenario("a", "--set", "noise.enabled=false", "--seed",
                              seed)
            data.append(self.signals("a.h5"))
        for name in UNITS:
            np.testing.assert_array_equal(data[0][name], data[1][name])

    def test_csv_has_the_same_columns_and_values(self):
        self.run_scenario("a", text=CYCLES)
        self.ok("run", "a.toml", "-o", "a.csv")
        signals = self.signals("a.h5")
        rows = list(csv.DictReader(self.text("a.csv").splitlines()))
        self.assertEqual(set(rows[0]), {"time", "status", *UNITS})
        for name in rows[0]:
            column = np.array([float(row[name]) for row in rows])
            np.testing.assert_allclose(column, signals[name], rtol=1e-8,
                                       atol=1e-12, err_msg=name)

    def test_info_describes_a_recording(self):
        path = self.run_scenario("a")
        self.assertSays(self.ok("info", path), ["quasistatic", "1200", *UNITS])

    def test_every_shipped_scenario_runs_without_a_warning(self):
        self.assertGreater(len(SHIPPED_SCENARIOS), 5)
        for path in SHIPPED_SCENARIOS:
            self.assertTrue(path.read_text().startswith("# "))
            self.assertEqual(self.warned("run", path, "-o", "out.h5"), "")

    def test_a_path_with_a_space_and_another_directory(self):
        folder = self.dir / "a folder"
        folder.mkdir()
        (self.dir / "device.toml").rename(folder / "device.toml")
        (folder / "s.toml").write_text(SCENARIO)
        self.ok("run", folder / "s.toml", "-o", folder / "o.h5", cwd=ROOT.anchor)
        self.assertTrue((folder / "o.h5").exists())
