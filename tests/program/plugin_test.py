# SPDX-License-Identifier: MIT
"""Compensators that are not ours: libraries and commands, in `compensate`."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy as np
import pytest

from export_firmware_test import CORE, EMULATOR, LINK, missing
from exported import MODELS, ExportTest
from program import (PATIENCE, PROGRAM, ROOT, ProgramTest, processes, ramp, said,
                     without_landlock)

EXAMPLES = ROOT / "examples/plugins"
PYTHON = f"'{sys.executable}'"
BIAS = [3.1422e-5, 2.0124e-3, -0.048258, 0.68417]  # of the examples
QEMU = (f"cmd:{EMULATOR} -M mps2-an386 -display none -serial none "
        "-monitor none -semihosting-config enable=on,target=native "
        "-kernel net.elf")

# Power is lost for a while, so that a plug-in begins twice.
TWICE = ramp(seconds=600, rate_Hz=5) + "[power]\non_s = [0, 320]\noff_s = [280]\n"


class Plugins(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=TWICE)

    def build(self, source, name, compiler="cc"):
        said(compiler, "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC",
             f"-I{ROOT}/include", source, "-o", name, cwd=self.dir)
        return f"./{name}"

    def compensated(self, compensator, name="out.h5"):
        self.ok("compensate", compensator, "run.h5", "-o", name)
        return self.signals(name)

    def test_the_cubic_in_c_and_in_python_gives_the_same_bits(self):
        in_c = self.compensated(self.build(EXAMPLES / "cubic.c", "cubic.so"))
        in_python = self.compensated(f"cmd:{PYTHON} '{EXAMPLES}/cubic.py'",
                                     "python.h5")
        np.testing.assert_array_equal(in_c["compensated_rate"],
                                      in_python["compensated_rate"])
        x = in_c["temperature"] - 25
        # Rounding of a bias of 1 deg/s and a rate.
        np.testing.assert_allclose(in_c["compensated_rate"],
                                   in_c["rate"] - np.polyval(BIAS, x),
                                   atol=1e-13)
        unpowered = in_c["status"] & 1 == 1
        self.assertGreater(unpowered.sum(), 100)
        np.testing.assert_array_equal(
            unpowered, np.isnan(in_c["compensated_rate"]))

    def test_the_filter_in_cpp_starts_anew_at_each_power_on(self):
        out = self.compensated(self.build(
            EXAMPLES / "lagging_cubic.cpp", "lagging.so", "c++"))
        gain, expected, slow = 1 - np.exp(-0.2 / 100), [], None
        for rate, temperature in zip(out["rate"], out["temperature"]):
            if np.isnan(rate):
                slow = None
                expected.append(np.nan)
                continue
            slow = temperature if slow is None else \
                slow + gain * (temperature - slow)
            x = temperature - 25
            expected.append(rate - (0.66218 + x * (-0.048326 + x * (
                2.0176e-3 + x * 3.156e-5)) + 0.1755 * (temperature - slow)))
        np.testing.assert_allclose(out["compensated_rate"], expected,
                                   atol=1e-12)

    def test_the_copy_names_the_plugin(self):
        library = self.build(EXAMPLES / "cubic.c", "cubic.so")
        self.compensated(library)
        with h5py.File(self.dir / "out.h5") as file:
            self.assertEqual(file.attrs["compensator"], b"cubic.so")
            self.assertEqual(len(file.attrs["compensator_sha256"]), 64)
        command = f"cmd:{PYTHON} '{EXAMPLES}/cubic.py'"
        self.compensated(command, "python.h5")
        with h5py.File(self.dir / "python.h5") as file:
            self.assertEqual(file.attrs["compensator"], command.encode())
            self.assertNotIn("compensator_sha256", file.attrs)

    def test_each_fault_is_one_message_with_status_3_and_no_file(self):
        per_line = "import sys; sys.stdin.readline()\nfor line in sys.stdin: "
        for code, says in [
                ("raise SystemExit(5)", "ended with status 5 at sample 0"),
                ("import os; os.abort()", "signal 6, Aborted"),
                ("x = bytearray(1 << 40)", "ran out of memory"),
                ("pass", "fewer answers than samples"),
                (per_line + "print(1); print(2)", "more answers than samples"),
                (per_line + "print('nan')", "answered nan at sample 0"),
                (per_line + "print('ok')", 'answered "ok", which is no number'),
                ("import time; time.sleep(60)", "hung at sample 0")]:
            script = self.write("bad.py", code)
            self.rejected("compensate", f"cmd:{PYTHON} {script}", "run.h5",
                          "-o", "out.h5", "--timeout-s", 1, says=says,
                          status=3)

    def test_what_is_no_plugin_is_wrong_input(self):
        self.write("text.so", "not a library")
        for name, inputs in [("wants", "rate,true_rate"),
                             ("spaced", "rate, temperature")]:
            self.write(f"{name}.c", (EXAMPLES / "cubic.c").read_text().replace(
                '"rate,temperature"', f'"{inputs}"'))
            self.build(f"{name}.c", f"{name}.so")
        told = self.rejected("compensate", "./spaced.so", "run.h5", "-o",
                             "out.h5", says=["' temperature'", "quadrature"])
        self.assertNotIn("true_", told)  # none of these may be asked for
        for compensator, says in [
                ("./text.so", "cannot be loaded"),
                ("./missing.so", "No such file"),
                ("./wants.so", '"true_rate", which no gyro measures'),
                ("cmd:", "no command")]:
            self.rejected("compensate", compensator, "run.h5", "-o", "out.h5",
                          says=says)

    def test_limits_are_for_code(self):
        self.write("mean.toml", 'kind = "constant"\n')
        self.ok("train", "run.h5", "--model", "mean.toml", "-o", "mean.json")
        for option in "--timeout-s", "--memory-GiB":
            self.rejected("compensate", "mean.json", "run.h5", "-o", "out.h5",
                          option, 1, says=[option, "mean.json"])

    def test_no_library_is_overwritten(self):
        self.build(EXAMPLES / "cubic.c", "cubic.so")
        os.link(self.dir / "cubic.so", self.dir / "out.h5")
        self.rejected("compensate", "./cubic.so", "run.h5", "-o", "out.h5",
                      says="is read by this command")

    def test_an_interrupt_ends_the_command_and_what_it_started(self):
        word = f"sleep 98{os.getpid() % 1000:03}"
        slept = word.replace(" ", "\0")
        for number in [signal.SIGINT, signal.SIGTERM]:
            (self.dir / "begun").unlink(missing_ok=True)
            with self.working("compensate", f"cmd:{word} | tee begun", "run.h5",
                              "-o", "out.h5", until="begun",
                              preexec_fn=without_landlock) as program:
                while not processes(slept):
                    self.assertIsNone(program.poll())
                program.send_signal(number)
                program.communicate(timeout=PATIENCE)
                self.assertEqual(program.returncode, -number)
            for _ in range(15000):  # until the system has ended them
                if not processes(slept):
                    break
                time.sleep(0.02)
            self.assertEqual(processes(slept), [])
            self.assertFalse((self.dir / "out.h5").exists())


class Stream(ProgramTest):
    """`compensate --stream`."""

    compensators = [
        "cubic.json", "./cubic.so", f"cmd:{PYTHON} '{EXAMPLES}/cubic.py'"]

    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=TWICE)
        self.ok("run", "run.toml", "-o", "run.csv")
        # With a sigma the file would answer two columns (stated_sigma_test.py).
        stored = self.train_on("run.h5")
        stored.pop("sigma", None)
        self.write("cubic.json", json.dumps(stored))
        said("cc", "-O2", "-shared", "-fPIC", f"-I{ROOT}/include",
             EXAMPLES / "cubic.c", "-o", "cubic.so", cwd=self.dir)

    def stream(self, *arguments, text, status=0):
        return self.ended("compensate", *arguments, "--stream", given=text,
                          allowed=(status,))

    def test_the_answers_are_those_to_the_recording(self):
        text = self.text("run.csv")
        for compensator in self.compensators:
            self.ok("compensate", compensator, "run.h5", "-o", "out.h5")
            answer = self.stream(compensator, text=text)
            self.assertEqual(answer.stderr, "")
            np.testing.assert_array_equal(
                [float(line) for line in answer.stdout.splitlines()],
                self.signals("out.h5")["compensated_rate"])

    def test_each_sample_is_answered_before_the_next_one_comes(self):
        flushing = (EXAMPLES / "cubic.py").read_text().replace(
            "bias)\n", "bias, flush=True)\n")
        self.write("flushing.py", flushing)
        for compensator in [*self.compensators[:2],
                            f"cmd:{PYTHON} -u flushing.py"]:
            with subprocess.Popen(
                    [PROGRAM, "compensate", compensator, "--stream",
                     "--rate-Hz", "5"], cwd=self.dir, text=True, bufsize=1,
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE) as program:
                program.stdin.write("time,temperature [K],rate\n")
                for k in range(5):
                    program.stdin.write(f"{k / 5},298.15,{k}\n")
                    rate = float(program.stdout.readline())
                    if compensator != "cubic.json":
                        # The rounding of 298.15 K - 273.15 K in degC.
                        self.assertAlmostEqual(rate, k - BIAS[3], delta=1e-12)
                program.stdin.close()
                self.assertEqual(program.wait(timeout=PATIENCE), 0)

    def test_what_the_compensator_reads_must_be_there(self):
        for text, says in [("rate,temperature\n", "1: no column time"),
                           ("time,temperature\n0,1\n1,2\n", "rate"),
                           ("time,rate\n0,1\n", "temperature")]:
            for compensator in self.compensators[:2]:
                answer = self.stream(compensator, text=text, status=2)
                self.assertIn(says, answer.stderr)
                self.assertEqual(len(answer.stderr.splitlines()), 1)

    def test_lines_may_end_in_carriage_return_and_newline(self):
        for names, cells in [("time,rate,temperature", "0,1,20"),
                             ("time,rate,temperature,status", "0,1,20,0")]:
            one, other = (self.stream("cubic.json", text=end.join(
                [names, cells, ""])) for end in ["\n", "\r\n"])
            self.assertEqual(other.stderr, "")
            self.assertEqual(other.stdout, one.stdout)

    def test_a_fault_ends_the_stream_with_status_3(self):
        text = "time,rate\n" + "".join(f"{k},{k}\n" for k in range(50))
        for command, says in [("exit 4", "ended with status 4"),
                              ("true", "fewer answers"),
                              ("echo what", '"what", which is no number'),
                              ("yes 1", "more answers than samples"),
                              ("sleep 60", "hung"),
                              ("while sleep 0.1; do echo . >&2; done", "hung"),
                              ("yes | tr -d '\\n'", "a line without end")]:
            self.assertIn(says, self.stream(
                f"cmd:{command}", "--timeout-s", 1, text=text, status=3).stderr)

    def test_a_file_and_a_stream_exclude_each_other(self):
        self.rejected("compensate", "cubic.json", "run.h5", "--stream",
                      says="expected neither")
        self.rejected("compensate", "cubic.json", "run.h5",
                      says="RUN.h5 or -o is missing")
        self.rejected("compensate", "cubic.json", "run.h5", "-o", "o.h5",
                      "--rate-Hz", 5, says="--rate-Hz is for --stream")


class Firmware(ExportTest):
    """The exported source is what runs."""

    def test_every_kind_of_exported_code_is_a_plugin(self):
        for kind in MODELS:
            folder = self.export(kind)
            self.compile(folder, "-std=c99", "-O2", "-Wall", "-Wextra",
                         "-Wpedantic", "-Wconversion", "-Wmissing-prototypes",
                         "-Werror", "-shared", "-fPIC", "net.c",
                         "net_plugin.c", "-o", "net.so")
            self.ok("compensate", f"./{kind}/net.so", "train.h5", "-o",
                    f"{kind}_c.h5")
            self.ok("compensate", f"{kind}.json", "train.h5", "-o",
                    f"{kind}_json.h5")
            firmware = self.signals(f"{kind}_c.h5")
            workbench = self.signals(f"{kind}_json.h5")
            # What export allows single precision.
            np.testing.assert_allclose(
                firmware["compensated_rate"],
                workbench["compensated_rate"], atol=1e-4, rtol=0)
            self.assertTrue((firmware["status"] & 1 == 1).any())

    def test_a_verdict_tells_the_difference_from_the_workbench(self):
        folder = self.export("cubic")
        self.compile(folder, "-O2", "-ffp-contract=off", "-shared", "-fPIC",
                     "net.c", "net_plugin.c", "-o", "net.so")
        result, answer = self.validated("./cubic/net.so", "held_out.h5",
                                        "--workbench", "cubic.json")
        self.assertIn("difference from cubic.json: at most", answer.stdout)
        told = result["compensator"]
        self.ok("compensate", "./cubic/net.so", "held_out.h5", "-o", "a.h5")
        self.ok("compensate", "cubic.json", "held_out.h5", "-o", "b.h5")
        difference = np.abs(self.signals("a.h5")["compensated_rate"]
                            - self.signals("b.h5")["compensated_rate"])
        difference = difference[np.isfinite(difference)]
        self.assertEqual(told["workbench"], "cubic.json")
        self.assertEqual(told["workbench_difference_largest_deg_per_s"],
                         difference.max())
        # Sums of squares in another order.
        self.assertAlmostEqual(
            told["workbench_difference_rms_deg_per_s"]
            / np.sqrt(np.mean(difference ** 2)), 1, delta=1e-9)
        self.assertGreater(difference.max(), 0)

    # A library and a command answer above; examples/plugins/cortex_m4.c is
    # compiled and run only here.
    @pytest.mark.deep
    @unittest.skipIf(missing(), missing())
    def test_the_image_of_a_cortex_m4_answers_as_the_library(self):
        folder = self.export("cubic")
        self.compile(folder, "-O2", "-ffp-contract=off", "-shared", "-fPIC",
                     "net.c", "net_plugin.c", "-o", "net.so")
        main = (EXAMPLES / "cortex_m4.c").read_text().replace("gyro_", "net_") \
            .replace("gyro.h", "net.h")
        (folder / "main.c").write_text(main)
        self.compile(folder, *CORE, "-ffp-contract=off", "-Wall", "-Wextra",
                     "main.c", "net.c", *LINK, "-o", "../net.elf",
                     compiler="arm-none-eabi-gcc")
        self.ok("compensate", "./cubic/net.so", "train.h5", "-o", "so.h5")
        self.ok("compensate", QEMU, "train.h5", "-o", "qemu.h5")
        np.testing.assert_array_equal(
            self.signals("so.h5")["compensated_rate"],
            self.signals("qemu.h5")["compensated_rate"])
