# SPDX-License-Identifier: MIT
"""`export --format px4|ardupilot` of the shipped program."""

import json
import re
import shutil

import numpy as np

from exported import ExportTest
from program import ramp


class ExportParameters(ExportTest):
    def parameters(self, kind, form, *arguments):
        """Values by name."""
        folder = self.export(kind, *arguments, form=form)
        ending, separator, at = (".params", "\t", 2) if form == "px4" else \
            (".parm", ",", 0)
        path, = folder.glob("net.par*")
        self.assertEqual(path.name, f"net{ending}")
        rows = [line.split(separator) for line in path.read_text().splitlines()
                if not line.startswith("#")]
        shutil.rmtree(folder)
        return {row[at]: float(np.float32(row[at + 1])) for row in rows}

    def bias(self, kind):
        """Temperatures, and what `compensate` took off there."""
        self.ok("compensate", f"{kind}.json", "train.h5", "-o", "out.h5",
                "--quiet")
        out = self.signals("out.h5")
        on = out["status"] & 1 == 0
        return (out["temperature"][on],
                (out["rate"] - out["compensated_rate"])[on])

    def test_px4_takes_off_what_compensate_takes_off(self):
        for kind in ["none", "constant", "cubic", "px4"]:
            p = self.parameters(kind, "px4", "--axis", "y", "--instance", 3,
                                "--device-id", 4_000_000)
            temperature, bias = self.bias(kind)
            d = np.clip(temperature, p["TC_G3_TMIN"], p["TC_G3_TMAX"]) \
                - p["TC_G3_TREF"]
            offset = sum(p[f"TC_G3_X{k}_1"] * d ** k for k in range(4))
            self.assertLess(np.max(np.abs(np.degrees(offset) - bias)), 1e-6)
            self.assertEqual(p["TC_G3_ID"], 4_000_000)
            self.assertEqual(p["TC_G3_X0_0"], 0)

    def test_ardupilot_takes_off_what_compensate_takes_off(self):
        for kind in ["none", "constant", "cubic", "ardupilot"]:
            p = self.parameters(kind, "ardupilot", "--axis", "x", "--instance",
                                2)
            temperature, bias = self.bias(kind)
            d = np.clip(temperature, p["INS_TCAL2_TMIN"],
                        p["INS_TCAL2_TMAX"]) - 35
            offset = p["INS_GYR2OFFS_X"] + 1e-6 * sum(
                p[f"INS_TCAL2_GYR{k}_X"] * d ** k for k in (1, 2, 3))
            self.assertEqual(p["INS_GYR2_CALTEMP"], 35)
            self.assertLess(np.max(np.abs(np.degrees(offset) - bias)), 1e-6)

    def test_ardupilot_reference_is_clamped_as_the_autopilot_does(self):
        """Training that ends below 35 degC: CALTEMP is the highest of it."""
        cold = ramp(low=-40, high=10)
        self.run_scenario("train", text=cold)
        self.run_scenario("held_out", "--seed", 4, text=cold)
        p = self.parameters("cubic", "ardupilot")
        low, high = p["INS_TCAL1_TMIN"], p["INS_TCAL1_TMAX"]
        self.assertLess(high, 35)
        temperature, bias = self.bias("cubic")
        reference = np.clip(p["INS_GYR1_CALTEMP"], low, high)
        self.assertEqual(reference, p["INS_GYR1_CALTEMP"])

        def polynomial(at):
            return 1e-6 * sum(p[f"INS_TCAL1_GYR{k}_Z"] * (at - 35) ** k
                              for k in (1, 2, 3))
        offset = polynomial(np.clip(temperature, low, high)) \
            - polynomial(reference) + p["INS_GYROFFS_Z"]
        self.assertLess(np.max(np.abs(np.degrees(offset) - bias)), 3e-6)

    def test_three_axes_in_one_file(self):
        files = [self.train(kind) for kind in ["cubic", "constant", "px4"]]
        single = {}
        for axis, file in zip("xyz", files):
            self.ok("export", file, "--format", "px4", "-o", "one", "--name",
                    "net", "--axis", axis, "--device-id", 1)
            single[axis] = self.text("one/net.params")
        self.ok("export", *files, "--format", "px4", "-o", "three",
                "--device-id", 1)
        merged = self.text("three/cubic.params").splitlines()
        for line in merged[1:]:
            power, axis = re.match(r"1\t1\t(?:TC_G0_X(\d)_(\d)|\S+)\t",
                                   line).groups()
            for name, text in single.items():
                if power is None or name == "xyz"[int(axis)]:
                    self.assertIn(line, text.splitlines())
        self.ok("export", *files[:2], "--format", "ardupilot", "-o", "two",
                "--axis", "z,x")
        two = self.text("two/cubic.parm")
        self.assertNotIn("INS_GYROFFS_Z,0\n", two)
        self.assertIn("INS_GYROFFS_Y,0\n", two)
        self.assertNotIn("INS_GYROFFS_X,0\n", two)

    def test_axes_of_other_temperatures_share_what_all_saw(self):
        self.ok("export", self.train("cubic"), "--format", "ardupilot", "-o",
                "one")
        content = self.json("cubic.json")
        content.pop("sigma", None)  # which lies within the range of training
        text = json.dumps(content)
        start = text.index("[", text.index('"temperature_range_degC"'))
        end = text.index("]", start)
        self.write("other.json", text[:start] + "[-20.0, 60.0" + text[end:])
        answer = self.ended("export", "cubic.json", "other.json", "--format",
                            "ardupilot", "-o", "two", "--axis", "x,y")
        self.assertIn("clamp all of them to -20.00 to", answer.stderr)
        self.assertIn("INS_TCAL1_TMIN,-20\n", self.text("two/cubic.parm"))

    def test_the_first_gyro_and_axis_z_without_options(self):
        p = self.parameters("cubic", "px4", "--device-id", 1)
        self.assertNotEqual(p["TC_G0_X0_2"], 0)
        self.assertEqual(p["TC_G0_X0_1"], 0)
        a = self.parameters("cubic", "ardupilot")
        self.assertNotEqual(a["INS_GYROFFS_Z"], 0)

    def test_px4_without_a_device_is_warned_of(self):
        answer = self.ended("export", self.train("cubic"), "--format", "px4",
                            "-o", "out")
        self.assertIn("expected its device id", answer.stderr)
        answer = self.beamgyro("export", "cubic.json", "--format", "px4", "-o",
                               "out", "--device-id", 5)
        self.assertEqual(answer.stderr, "")

    def test_fit_cubic_exports_the_cubic_of_the_same_rows(self):
        of_cubic = self.parameters("cubic", "px4", "--device-id", 1)
        self.rejected("export", self.train("spline"), "--format", "px4", "-o",
                      "none", says=["spline.json: ", "of kind spline",
                                    "deg/s rms in-sample", "--fit-cubic"])
        of_spline = self.parameters("spline", "px4", "--device-id", 1,
                                    "--fit-cubic")
        self.assertEqual(set(of_spline), set(of_cubic))
        for name, value in of_cubic.items():
            self.assertAlmostEqual(of_spline[name], value,
                                   delta=1e-5 * abs(value) + 1e-12)
