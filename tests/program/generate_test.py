# SPDX-License-Identifier: MIT
"""generate: the same bytes by any way, and bad input."""

import os
import resource
import subprocess

import h5py
import numpy as np

from program import PROGRAM, limit, said
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
        self.assertSays(self.generate("set"), ["8 files", "14 device runs"])
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
        words = self.generate("set", "--shard", "2/2")
        self.assertIn("7 of 8 files", words)
        self.assertNotIn("whole", words)

    def test_a_step_too_fine_for_counts_is_stored_as_floating_point(self):
        self.change("device.toml", "^drive_frequency_resolution_Hz = .*",
                    "drive_frequency_resolution_Hz = 1e-6")
        self.generate("set")
        stored = self.signals("set/rest_00000.h5")
        self.assertEqual(stored["drive_frequency"].dtype, np.float64)
        self.assertEqual(stored["drive_voltage"].dtype, np.int32)
        self.assertEqual(stored["temperature"].dtype, np.int16)

    def test_a_set_of_another_campaign_is_left_alone(self):
        self.generate("set")
        self.change("campaign.toml", "seed = 5", "seed = 6")
        for how in [["--resume"], ["--shard", "1/2"]]:
            self.rejected("generate", "campaign.toml", "-o", "set", *how,
                          says=["set", "another"])

    def test_a_device_shows_what_run_shows_of_it(self):
        """Without noise, whose streams are the device's own."""
        for name in ["rest.toml", "ramp.toml"]:
            self.write(name, self.text(name) + "\n[noise]\nenabled = false\n")
        self.generate("set")
        with h5py.File(self.dir / "set/rest_00001.h5") as file:
            drawn = {name: file[name][1] for name in file
                     if name.startswith(("patches_", "readout_"))}
            shown = {name: file[name][1] * file[name].attrs.get("scale_factor", 1)
                     + file[name].attrs.get("add_offset", 0)
                     for name in ["output", "rate", "temperature", "quadrature",
                                  "drive_frequency", "drive_voltage",
                                  "true_bias", "status"]}
        offsets = [float(drawn[f"patches_offset_m_{k}"]) for k in range(4)]
        trim = float(drawn["readout_quadrature_trim_deg_per_s"])
        self.ok("run", "rest.toml", "-o", "run.h5", "--set",
                f"patches.offset_m={offsets}", "--set",
                f"readout.quadrature_trim_deg_per_s={trim}")
        run = self.signals("run.h5")
        for name, row in shown.items():
            tolerance = {"true_bias": 2e-7, "status": 0}.get(name, 1e-9)
            np.testing.assert_allclose(row, run[name], rtol=tolerance,
                                       atol=tolerance, err_msg=name)

    def test_a_device_that_cannot_be_is_flagged_with_its_reason(self):
        self.change("campaign.toml", "devices = 7", "devices = 12")
        self.change("campaign.toml", '^"readout.*', '"beam.side_difference" = '
                    "{ normal = { mean = -0.0095, sigma = 0.4 } }")
        self.assertRegex(self.generate("set"), r"[1-9]\d* failed")
        self.ended("generate", "campaign.toml", "-o", "strict", "--strict",
                   allowed=(4,))
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
                self.assertEqual(file["meta/failures"][()].count(b"\n"),
                                 np.count_nonzero(file["device_status"][()]))
        self.assertGreater(failed, 0)
        reasons = [failure for line in self.manifest("set")
                   for failure in line.get("failures", [])]
        self.assertEqual(len(reasons), 2 * failed)
        self.assertTrue(all(entry["reason"] for entry in reasons))
        self.ok("verify", "set")

    def test_runs_whose_samples_say_little_are_counted(self):
        self.assertEqual(
            self.warned("generate", "campaign.toml", "-o", "healthy"), "")
        self.assertNotIn("cautions", self.text("healthy/manifest.jsonl"))
        self.change("campaign.toml", "\\[tolerances\\]",
                    "[tolerances]\n\"drive.voltage_limit_V\" = "
                    "{ uniform = { low = 0.01, high = 0.02 } }")
        says = ("14 of 14 device runs are not locked in half of the powered "
                "samples or more")
        self.assertIn(f"weak: {says}",
                      self.warned("generate", "campaign.toml", "-o", "weak"))
        self.assertIn(says, self.ok("info", "weak"))
        self.ok("verify", "weak")
        self.assertIn("the drive of 7 of 7 devices needs more than its voltage "
                      "limit", self.warned("characterise", "campaign.toml", "-o",
                                           "c.csv"))

    def test_a_whole_table_may_be_drawn(self):
        self.change("campaign.toml", "^ambient_offset_K.*", "[run.vary]\n"
                    '"ambient" = { discrete = { values = [{ constant_degC = 5 '
                    "}, { points = [[0, 0], [60, 40]] }] } }")
        self.generate("set")
        self.assertEqual({*self.signals("set/ramp.nc")["ambient_choice"]},
                         {0.0, 1.0})

    def vary(self, seed, variation):
        self.write("campaign.toml", CAMPAIGN.replace("seed = 5", f"seed = {seed}")
                   + f"[run.vary]\n{variation}\n")
        return self.generate(f"set{seed}")

    def assert_axis_is_kept(self, varied, name, parameter, firsts, unit=1):
        """The truth of every device is what it drew, and the first devices of
        several sets drew each of `firsts`."""
        found = set()
        for seed in range(6):
            self.assertIn("0 failed", self.vary(seed, varied))
            view = self.signals(f"set{seed}/ramp.nc")
            found.add(view[parameter][0])
            for drawn, truth in zip(view[parameter], view[name]):
                self.assertEqual(truth.min(), truth.max())
                self.assertAlmostEqual(truth[0], unit * drawn, places=5)
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
            self.assertNotIn("true_acceleration_x",
                             self.signals(f"set{seed}/ramp.nc"))

    def test_an_axis_that_no_choice_moves_is_left_out(self):
        self.vary(0, '"cross_rate.x.constant_deg_per_s" = '
                  "{ discrete = { values = [0, 5], weights = [1, 0] } }")
        self.assertNotIn("true_cross_rate_x", self.signals("set0/ramp.nc"))

    def test_a_table_of_the_device_may_be_drawn(self):
        """The step of a converter is then each device's own."""
        def sensor(resolution):
            return ("{ noise_K = 0.01, resolution_K = %s, offset_K = 0 }"
                    % resolution)
        for name, steps, kind in [("same", [0.05, 0.05], np.int16),
                                  ("other", [0.05, 0.017], np.float64),
                                  ("new", [0.017, 0.017], np.float64)]:
            tables = ", ".join(map(sensor, steps))
            self.write("campaign.toml", CAMPAIGN.replace(
                "[tolerances]", '[tolerances]\n"temperature_sensor" = '
                f"{{ discrete = {{ values = [{tables}] }} }}"))
            self.assertIn("0 failed", self.generate(name))
            stored = self.signals(f"{name}/rest_00000.h5")
            self.assertEqual(stored["temperature"].dtype, kind, name)

    def test_only_failures_of_a_device_are_data(self):
        """An integrator without memory says nothing about the device."""
        self.write("fault.c", NO_MEMORY)
        said("cc", "-shared", "-fPIC", "-o", "fault.so", "fault.c",
             cwd=self.dir)
        # The plan makes the first one for each run.
        self.assertIn("CVodeCreate failed", self.warned(
            "generate", "campaign.toml", "-o", "set", "--jobs", "1",
            allowed=(1,), env={**os.environ, "FAIL_AT": "8",
                               "LD_PRELOAD": str(self.dir / "fault.so")}))
        self.generate("set", "--resume")
        self.generate("whole")
        self.assertEqual(self.contents("set"), self.contents("whole"))

    def test_threads_that_the_system_does_not_grant_are_fewer_threads(self):
        self.generate("free")
        self.alone("generate", "campaign.toml", "-o", "alone", "--jobs", "4")
        self.assertEqual(self.contents("alone"), self.contents("free"))


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
        self.rejected("generate", "campaign.toml", "-o", mount / "set",
                      says=[str(mount / "set"), "ead-only"])

    def test_too_little_memory_is_an_error_and_not_a_crash(self):
        for kilobytes in [60_000, 80_000, 100_000, 150_000]:
            self.ended("generate", "campaign.toml", "-o", "memory", "--resume",
                       "--jobs", 1, allowed=(0, 1, 127), preexec_fn=limit(
                           resource.RLIMIT_AS, 1024 * kilobytes))
            self.assertEqual(list(self.dir.glob("memory/*partial*")), [])
        self.generate("memory", "--resume")
        self.generate("free")
        self.assertEqual(self.contents("memory"), self.contents("free"))

    def test_a_name_that_is_no_utf8_serves(self):
        folder = os.fsencode(self.dir) + b"/s\xe9t"
        for words in [b"generate", b"campaign.toml", b"-o"], [b"verify"]:
            subprocess.run([os.fsencode(PROGRAM), *words, folder], check=True,
                           cwd=self.dir, capture_output=True)
