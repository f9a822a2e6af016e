# SPDX-License-Identifier: MIT
"""generate: the same bytes by any way, and bad input."""

import json
import os
import pty
import re
import signal
import subprocess
import time

import h5py
import numpy as np

from program import PROGRAM
from sets import CAMPAIGN, Set

NO_MEMORY = """\
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
void* CVodeCreate(int method, void* context) {
  static int calls;
  if (++calls == atoi(getenv("FAIL_AT"))) return NULL;
  void* (*next)(int, void*);
  *(void**)&next = dlsym(RTLD_NEXT, "CVodeCreate");
  return next(method, context);
}
"""


class Generate(Set):
    def test_a_set_has_a_file_for_every_range_of_devices_and_run(self):
        said = self.generate("set")
        self.assertIn("8 files", said)
        self.assertIn("14 device runs", said)
        self.assertEqual(
            sorted(self.contents("set")),
            sorted([f"{run}_{k:05}.h5" for run in ["rest", "ramp"]
                    for k in range(4)] + ["rest.nc", "ramp.nc",
                                          "manifest.jsonl"]))

    def test_jobs_tasks_and_their_order_do_not_change_a_byte(self):
        self.generate("one", "--jobs", 1)
        expected = self.contents("one")
        for jobs in [2, 4]:
            self.generate(f"jobs{jobs}", "--jobs", jobs)
            self.assertEqual(self.contents(f"jobs{jobs}"), expected)
        for name, tasks in [("shards", ["1/3", "2/3", "3/3"]),
                            ("backwards", ["5/5", "2/5", "4/5", "1/5", "3/5"]),
                            ("more_than_files", [f"{k}/11" for k in
                                                 range(11, 0, -1)])]:
            for task in tasks:
                self.generate(name, "--shard", task)
            self.assertEqual(self.contents(name), expected)

    def test_tasks_at_once_share_a_directory(self):
        self.generate("one")
        tasks = [subprocess.Popen(
            [str(PROGRAM), "generate", "campaign.toml", "-o", "shared",
             "--shard", f"{k}/4"], cwd=self.dir, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True) for k in range(1, 5)]
        for task in tasks:
            _, error = task.communicate()
            self.assertEqual(task.returncode, 0, error)
        self.assertEqual(self.contents("shared"), self.contents("one"))

    def test_tasks_that_are_lacking_are_listed(self):
        lacking = ["generate", "campaign.toml", "-o", "set", "--lacking", 4]
        self.assertEqual(self.ok(*lacking), "1-4\n")
        self.generate("set", "--shard", "2/4")
        self.assertEqual(self.ok(*lacking), "1,3-4\n")
        for k in [1, 3, 4]:
            self.generate("set", "--shard", f"{k}/4")
        self.assertEqual(self.ok(*lacking), "\n")

    def test_fewer_devices_are_the_first_ones(self):
        self.generate("all")
        self.generate("some", "--devices", 4)
        for k in range(2):
            self.assertEqual(self.contents("some")[f"ramp_{k:05}.h5"],
                             self.contents("all")[f"ramp_{k:05}.h5"])

    def test_a_whole_run_goes_on_only_when_told(self):
        self.generate("set")
        before = self.contents("set")
        self.rejected("generate", "campaign.toml", "-o", "set",
                      says=["set", "--resume"])
        (self.dir / "set/rest_00001.h5").unlink()
        self.generate("set", "--resume")
        self.assertEqual(self.contents("set"), before)

    def test_a_manifest_that_lost_all_its_lines_is_begun_anew(self):
        self.generate("set")
        before = self.contents("set")
        (self.dir / "set/manifest.jsonl").write_bytes(b"")
        self.generate("set", "--resume")
        self.assertEqual(self.contents("set"), before)

    def test_a_set_that_lost_a_file_is_not_called_whole(self):
        self.generate("set")
        (self.dir / "set/rest_00000.h5").unlink()
        said = self.generate("set", "--shard", "2/2")
        self.assertIn("7 of 8 files", said)
        self.assertNotIn("whole", said)

    def test_a_step_too_fine_for_counts_is_stored_as_floating_point(self):
        device = (self.dir / "device.toml").read_text()
        fine = re.sub("(?m)^drive_frequency_resolution_Hz = .*",
                      "drive_frequency_resolution_Hz = 1e-6", device)
        self.assertNotEqual(fine, device)
        self.write("device.toml", fine)
        self.generate("set")
        with h5py.File(self.dir / "set/rest_00000.h5") as file:
            self.assertEqual(file["drive_frequency"].dtype, np.float64)
            self.assertEqual(file["drive_voltage"].dtype, np.int32)
            self.assertEqual(file["temperature"].dtype, np.int16)

    def test_a_set_of_another_campaign_is_left_alone(self):
        self.generate("set")
        self.write("campaign.toml", CAMPAIGN.replace("seed = 5", "seed = 6"))
        for how in [["--resume"], ["--shard", "1/2"]]:
            self.rejected("generate", "campaign.toml", "-o", "set", *how,
                          says=["set", "another"])

    def test_a_device_shows_what_run_shows_of_it(self):
        """Without noise, whose streams are the device's own."""
        for name in ["rest.toml", "ramp.toml"]:
            self.write(name, (self.dir / name).read_text() +
                       "\n[noise]\nenabled = false\n")
        self.generate("set")
        with h5py.File(self.dir / "set/rest_00001.h5") as file:
            values = {name: file[name][1] for name in file
                      if name.startswith(("patches_", "readout_"))}
            drawn = {name: file[name][()] for name in ["status"]}
            shown = {}
            for name in ["output", "rate", "temperature", "quadrature",
                         "drive_frequency", "drive_voltage", "true_bias"]:
                row = file[name][1]
                attributes = file[name].attrs
                if "scale_factor" in attributes:
                    row = row * attributes["scale_factor"] + \
                        attributes["add_offset"]
                shown[name] = row
        offsets = [float(values[f"patches_offset_m_{k}"]) for k in range(4)]
        trim = float(values["readout_quadrature_trim_deg_per_s"])
        self.ok("run", "rest.toml", "-o", "run.h5", "--set",
                f"patches.offset_m={offsets}", "--set",
                f"readout.quadrature_trim_deg_per_s={trim}")
        with h5py.File(self.dir / "run.h5") as file:
            np.testing.assert_array_equal(drawn["status"][1], file["status"])
            for name, row in shown.items():
                tolerance = 2e-7 if name == "true_bias" else 1e-9
                np.testing.assert_allclose(row, file[name], rtol=tolerance,
                                           atol=tolerance, err_msg=name)

    def test_a_device_that_cannot_be_is_flagged_with_its_reason(self):
        self.write("campaign.toml", CAMPAIGN.replace(
            '"readout.quadrature_trim_deg_per_s" = { normal = '
            '{ mean = 0, sigma = 50 } }',
            '"beam.side_difference" = { normal = '
            '{ mean = -0.0095, sigma = 0.4 } }')
            .replace("devices = 7", "devices = 12"))
        said = self.generate("set")
        self.assertRegex(said, r"[1-9]\d* failed")
        self.assertEqual(
            self.beamgyro("generate", "campaign.toml", "-o", "strict",
                          "--strict").returncode, 4)
        failed = 0
        for path in sorted((self.dir / "set").glob("rest_*.h5")):
            with h5py.File(path) as file:
                for i, status in enumerate(file["device_status"]):
                    drawn = file["beam_side_difference"][i]
                    self.assertEqual(status == 1, abs(drawn) > 0.5)
                    if status:
                        failed += 1
                        self.assertTrue((file["status"][i] == 1).all())
                        fill = file["output"].attrs["_FillValue"]
                        self.assertTrue((file["output"][i] == fill).all())
                reasons = file["meta/failures"][()].decode().splitlines()
                self.assertEqual(
                    len(reasons),
                    np.count_nonzero(file["device_status"][()]))
        self.assertGreater(failed, 0)
        lines = [json.loads(line) for line in
                 (self.dir / "set/manifest.jsonl").read_text().splitlines()]
        reasons = [failure for line in lines
                   for failure in line.get("failures", [])]
        self.assertEqual(len(reasons), 2 * failed)
        self.assertTrue(all(entry["reason"] for entry in reasons))
        self.ok("verify", "set")

    def test_a_whole_table_may_be_drawn(self):
        choices = ('[run.vary]\n"ambient" = { discrete = { values = ['
                   "{ constant_degC = 5 }, { points = [[0, 0], [60, 40]] }"
                   "] } }\n")
        self.write("campaign.toml", CAMPAIGN.replace(
            "ambient_offset_K = { uniform = { low = -5, high = 5 } }\n",
            choices))
        self.generate("set")
        with h5py.File(self.dir / "set/ramp.nc") as file:
            self.assertEqual(set(file["ambient_choice"][()]), {0.0, 1.0})

    def vary(self, seed, variation):
        self.write("campaign.toml", CAMPAIGN.replace("seed = 5", f"seed = {seed}")
                   + f"[run.vary]\n{variation}\n")
        return self.generate(f"set{seed}")

    def axis_of(self, seed, name, parameter):
        """Of every device: what is drawn, and the smallest and largest truth."""
        with h5py.File(self.dir / f"set{seed}/ramp.nc") as file:
            rows = file[name][()]
            return list(zip(file[parameter][()], rows.min(axis=1),
                            rows.max(axis=1)))

    def assert_axis_is_kept(self, varied, name, parameter, firsts, unit=1):
        """The truth of every device is what it drew, and the first devices of
        several sets drew each of `firsts`."""
        found = set()
        for seed in range(6):
            self.assertIn("0 failed", self.vary(seed, varied))
            rows = self.axis_of(seed, name, parameter)
            found.add(rows[0][0])
            for drawn, lowest, highest in rows:
                self.assertEqual(lowest, highest)
                self.assertAlmostEqual(highest, unit * drawn, places=5)
        self.assertEqual(found, firsts)

    def test_an_axis_is_kept_whatever_the_first_device_draws(self):
        self.assert_axis_is_kept(
            '"cross_rate.x.constant_deg_per_s" = '
            "{ discrete = { values = [0, 5] } }", "true_cross_rate_x",
            "cross_rate_x_constant_deg_per_s", {0.0, 5.0})

    def test_an_axis_that_only_some_choices_have_is_kept(self):
        self.assert_axis_is_kept(
            '"acceleration" = { discrete = { values = '
            "[{}, { z = { constant_g = 1 } }] } }", "true_acceleration_z",
            "acceleration_choice", {0.0, 1.0}, unit=9.80665)
        for seed in range(6):
            with h5py.File(self.dir / f"set{seed}/ramp.nc") as file:
                self.assertNotIn("true_acceleration_x", file)

    def test_an_axis_that_no_choice_moves_is_left_out(self):
        self.vary(0, '"cross_rate.x.constant_deg_per_s" = '
                  "{ discrete = { values = [0, 5], weights = [1, 0] } }")
        with h5py.File(self.dir / "set0/ramp.nc") as file:
            self.assertNotIn("true_cross_rate_x", file)

    def test_a_table_of_the_device_may_be_drawn(self):
        """The step of a converter is then each device's own."""
        def sensor(resolution):
            return ("{ noise_K = 0.01, resolution_K = %s, offset_K = 0 }"
                    % resolution)
        for name, steps, kind in [("same", [0.05, 0.05], np.int16),
                                  ("other", [0.05, 0.017], np.float64),
                                  ("new", [0.017, 0.017], np.float64)]:
            with self.subTest(name):
                tables = ", ".join(map(sensor, steps))
                self.write("campaign.toml", CAMPAIGN.replace(
                    "[tolerances]", '[tolerances]\n"temperature_sensor" = '
                    f"{{ discrete = {{ values = [{tables}] }} }}"))
                self.assertIn("0 failed", self.generate(name))
                with h5py.File(self.dir / name / "rest_00000.h5") as file:
                    self.assertEqual(file["temperature"].dtype, kind)

    def test_only_failures_of_a_device_are_data(self):
        """An integrator without memory says nothing about the device."""
        self.write("fault.c", NO_MEMORY)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "fault.so", "fault.c"],
                       cwd=self.dir, check=True)
        # The plan makes the first one for each run.
        answer = self.beamgyro(
            "generate", "campaign.toml", "-o", "set", "--jobs", "1",
            env={**os.environ, "LD_PRELOAD": str(self.dir / "fault.so"),
                 "FAIL_AT": "8"})
        self.assertEqual(answer.returncode, 1, answer.stdout)
        self.assertIn("CVodeCreate failed", answer.stderr)
        self.generate("set", "--resume")
        self.generate("whole")
        self.assertEqual(self.contents("set"), self.contents("whole"))

    def test_threads_that_the_system_does_not_grant_are_fewer_threads(self):
        self.generate("free")
        self.alone("generate", "campaign.toml", "-o", "alone", "--jobs", "4")
        self.assertEqual(self.contents("alone"), self.contents("free"))

    def test_termination_leaves_only_whole_files(self):
        self.write("campaign.toml", CAMPAIGN.replace("devices = 7",
                                                     "devices = 4000"))
        process = subprocess.Popen(
            [str(PROGRAM), "generate", "campaign.toml", "-o", "set"],
            cwd=self.dir, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not list(self.dir.glob("set/*.h5")):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(), -signal.SIGTERM)
        self.assertEqual(list(self.dir.glob("set/*partial*")), [])

    def test_a_terminal_shows_rate_time_left_and_failures(self):
        self.write("campaign.toml", CAMPAIGN.replace("devices = 7",
                                                     "devices = 40000"))
        main, terminal = pty.openpty()
        process = subprocess.Popen(
            [str(PROGRAM), "generate", "campaign.toml", "-o", "set"],
            cwd=self.dir, stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = b""
        while b" failed" not in shown and process.poll() is None:
            shown += os.read(main, 1000)
        process.kill()
        process.wait()
        os.close(main)
        self.assertRegex(shown.decode(), r", \d:\d\d:\d\d left, "
                         r"\d+ of 80000 runs, 0 failed")


class ReadOnly(Set):
    def test_a_read_only_file_system_is_named(self):
        if os.geteuid() != 0:
            self.skipTest("mounting needs root")
        mount = self.dir / "disk"
        mount.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "tmpfs",
                           str(mount)], check=False).returncode != 0:
            self.skipTest("mounting is not allowed here")
        self.addCleanup(subprocess.run, ["umount", str(mount)], check=True)
        answer = self.beamgyro("generate", "campaign.toml", "-o", mount / "set")
        self.assertEqual(answer.returncode, 2)
        self.assertIn(str(mount / "set"), answer.stderr)
        self.assertIn("ead-only", answer.stderr)

    def test_too_little_memory_is_an_error_and_not_a_crash(self):
        for kilobytes in [60_000, 80_000, 100_000, 150_000]:
            answer = subprocess.run(
                ["bash", "-c", f"ulimit -v {kilobytes}; exec \"$@\"", "-",
                 str(PROGRAM), "generate", "campaign.toml", "-o", "memory",
                 "--resume", "--jobs", "1"], cwd=self.dir, text=True,
                check=False, capture_output=True)
            self.assertIn(answer.returncode, [0, 1, 127], answer.stderr)
            self.assertEqual(
                [p for p in (self.dir / "memory").glob("*partial*")]
                if (self.dir / "memory").exists() else [], [])
        self.generate("memory", "--resume")
        self.generate("free")
        self.assertEqual(self.contents("memory"), self.contents("free"))

    def test_a_name_that_is_no_utf8_serves(self):
        folder = os.fsencode(self.dir) + b"/s\xe9t"
        subprocess.run([os.fsencode(PROGRAM), b"generate", b"campaign.toml",
                        b"-o", folder], cwd=self.dir, check=True,
                       capture_output=True)
        subprocess.run([os.fsencode(PROGRAM), b"verify", folder], check=True,
                       capture_output=True)
