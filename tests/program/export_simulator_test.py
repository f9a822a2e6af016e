# SPDX-License-Identifier: MIT
"""`export --format ardupilot-sitl|sdf` of the shipped program."""

import math
import re
import tomllib
import xml.etree.ElementTree as ElementTree

import numpy as np

from exported import ExportTest
from pages import page, rows
from program import ROOT, SCENARIOS, ProgramTest
from rejections import Rejections, row

single = np.float32


class Sitl:
    """ArduPilot's gyro and that of its simulator, in single precision, by the
    equations of AP_InertialSensor_tempcal.cpp and AP_InertialSensor_SITL.cpp."""

    def __init__(self, *texts, n=1, axis="Z"):
        self.p = {}
        for text in texts:
            for line in text.splitlines():
                if not line.startswith("#"):
                    name, value = line.split(",")
                    self.p[name] = single(value)
        self.n, self.axis = n, axis

    def polynomial(self, prefix, x):
        c1, c2, c3 = (self.p[f"{prefix}{self.n}_GYR{k}_{self.axis}"]
                      for k in (1, 2, 3))
        x = single(x)
        return single((c1 + (c2 + c3 * x) * x) * x * single(1e-6))

    def disturbance(self, T):
        """rad/s; no limits, and not about 35 degC."""
        low, high = (self.p[f"SIM_IMUT{self.n}_T{end}"] for end in ("MIN", "MAX"))
        middle = single(0.5 * float(low + high))
        return self.polynomial("SIM_IMUT", single(T) - middle) \
            + self.p[f"SIM_GYR{self.n}_BIAS_{self.axis}"]

    def compensated(self, rate, T):
        low, high = (self.p[f"INS_TCAL{self.n}_T{end}"] for end in ("MIN", "MAX"))
        number = "" if self.n == 1 else self.n

        def part(at):
            return self.polynomial("INS_TCAL",
                                   np.clip(single(at), low, high) - single(35))
        rate = single(rate) - part(T) + part(self.p[f"INS_GYR{self.n}_CALTEMP"])
        return rate - self.p[f"INS_GYR{number}OFFS_{self.axis}"]

    def temperature(self, t):
        start, end, tau = (self.p[f"SIM_IMUT_{name}"]
                           for name in ("START", "END", "TCONST"))
        return end - (end - start) * np.exp(-single(t) / tau)


class ExportSitl(ExportTest):
    def sitl(self, *arguments, name, **options):
        self.said = self.ok("export", *arguments, "--format", "ardupilot-sitl",
                            "-o", "out", "--name", name)
        return Sitl(self.text(f"out/{name}_sitl.parm"),
                    self.text(f"out/{name}.parm"), **options)

    def assertCancels(self, sitl, places=50):
        """Single precision keeps 24 bits of terms of up to 0.4 rad/s that
        cancel: 5e-8 rad/s, of which a dozen add up."""
        low, high = sitl.p["INS_TCAL%d_TMIN" % sitl.n], \
            sitl.p["INS_TCAL%d_TMAX" % sitl.n]
        for T in np.linspace(low, high, places):
            self.assertLess(
                abs(sitl.compensated(sitl.disturbance(T), T)), 6e-7, T)

    def test_disturbance_and_compensation_cancel_in_single_precision(self):
        """Of shipped devices, whatever the middle of their range is."""
        for name in ["nominal", "trimmed", "hard_pzt", "rebalance"]:
            for span in ["-40:50", "0:60", "-10:70"]:
                sitl = self.sitl(SCENARIOS / f"devices/{name}.toml", "--range",
                                 span, "--axis", "x", "--instance", 2,
                                 name=name, n=2, axis="X")
                self.assertCancels(sitl)
        drift = np.degrees(sitl.disturbance(60) - sitl.disturbance(0))
        self.assertGreater(abs(drift), 0.1)

    def test_the_disturbance_is_the_drift_that_characterise_shows(self):
        """A sweep of the chamber, seen over the sensor's temperature. Of a
        device whose sensor, board and beam are as warm as the chamber only the
        residual of the cubic is between them, which the file states."""
        self.change("device.toml", "^electronics_power_W = .*",
                    "electronics_power_W = 0")
        self.change("device.toml", "^offset_K = .*", "offset_K = 0")
        sitl = self.sitl("device.toml", name="cold")
        self.ok("characterise", "device.toml", "--beam-temperature", "-40:50:5",
                "-o", "c.csv")
        T, bias = np.genfromtxt(self.dir / "c.csv", delimiter=",",
                                skip_header=1)[:, :2].T
        shown = [np.degrees(sitl.disturbance(at)) for at in T]
        most = float(re.search(r"(\S+) deg/s at most", self.said)[1])
        # The drive heats the beam by some millikelvin.
        self.assertLess(np.max(np.abs(shown - bias)), most + 2e-3)
        self.assertGreater(np.max(np.abs(shown - bias)), most - 2e-3)

    def test_the_warm_up_has_the_residual_that_is_stated(self):
        sitl = self.sitl("device.toml", name="warm")
        self.ok("run", SCENARIOS / "warm_up.toml", "--set",
                f'device="{self.dir}/device.toml"', "--set",
                "output_rate_Hz=1", "-o", "warm.h5")
        out = self.signals("warm.h5")
        T = out["true_sensor_temperature"] + 0.3  # offset_K of the device
        left = T - [sitl.temperature(t) for t in out["time"]]
        rms, most = re.search(r"(\S+) K rms, (\S+) K at most", self.said).groups()
        self.assertAlmostEqual(float(rms), np.sqrt(np.mean(left ** 2)), delta=2e-3)
        self.assertAlmostEqual(float(most), np.max(np.abs(left)), delta=0.02)
        # No other single lag is nearer.
        for name in ["START", "END", "TCONST"]:
            kept = sitl.p[f"SIM_IMUT_{name}"]
            for factor in [0.99, 1.01]:
                sitl.p[f"SIM_IMUT_{name}"] = single(kept * factor)
                other = T - [sitl.temperature(t) for t in out["time"]]
                self.assertGreater(np.mean(other ** 2), np.mean(left ** 2))
            sitl.p[f"SIM_IMUT_{name}"] = kept

    def test_a_device_beside_its_compensator(self):
        """The compensation is the one that `ardupilot` writes, and what the two
        leave between them is stated."""
        cubic = self.train("cubic")
        sitl = self.sitl("device.toml", cubic, name="both")
        self.ok("export", cubic, "--format", "ardupilot", "-o", "alone",
                "--name", "both")
        self.assertSameBytes("alone/both.parm", "out/both.parm")
        low = max(sitl.p["INS_TCAL1_TMIN"], sitl.p["SIM_IMUT1_TMIN"])
        high = min(sitl.p["INS_TCAL1_TMAX"], sitl.p["SIM_IMUT1_TMAX"])
        left = [np.degrees(sitl.compensated(sitl.disturbance(T), T))
                for T in np.linspace(low, high, 201)]
        most = float(re.search(r"less compensation is .* rms, (\S+) deg/s at most",
                               self.said)[1])
        self.assertAlmostEqual(np.max(np.abs(left)), most, delta=0.01 * most)

    def test_a_compensator_alone_disturbs_by_what_it_takes_off(self):
        sitl = self.sitl(self.train("cubic"), name="alone")
        self.assertCancels(sitl)
        self.assertNotIn("SIM_IMUT_START", sitl.p)
        self.ok("compensate", "cubic.json", "train.h5", "-o", "out.h5", "--quiet")
        out = self.signals("out.h5")
        on = out["status"] & 1 == 0
        for T, bias in zip(out["temperature"][on][::200],
                           (out["rate"] - out["compensated_rate"])[on][::200]):
            self.assertAlmostEqual(float(np.degrees(sitl.disturbance(T))), bias,
                                   delta=1e-5)

    def test_three_devices_have_three_axes(self):
        devices = [SCENARIOS / f"devices/{name}.toml"
                   for name in ("nominal", "hard_pzt", "rebalance")]
        self.ok("export", *devices, "--format", "ardupilot-sitl", "-o", "out",
                "--name", "three", "--range", "0:40")
        texts = [self.text("out/three_sitl.parm"), self.text("out/three.parm")]
        for axis, device in zip("xyz", devices):
            sitl = Sitl(*texts, axis=axis.upper())
            self.assertCancels(sitl)
            self.assertIn(f"{axis}: {device.name} drifts", texts[0])

    def test_a_device_that_does_not_warm_up_is_said(self):
        self.change("device.toml", "^electronics_power_W = .*",
                    "electronics_power_W = 0")
        answer = self.ended("export", "device.toml", "--format", "ardupilot-sitl",
                            "--temperature-degC", 0, "-o", "out")
        self.assertIn("does not warm up", answer.stderr)
        sitl = Sitl(self.text("out/device_sitl.parm"))
        # SIM_IMUT_FIXED = 0 is no temperature but "not fixed".
        self.assertEqual(sitl.p["SIM_IMUT_FIXED"], 0)
        self.assertEqual(sitl.p["SIM_IMUT_START"], sitl.p["SIM_IMUT_END"])
        self.assertAlmostEqual(float(sitl.temperature(100)), 0.3, delta=0.02)

    def test_same_bytes_again_from_another_folder(self):
        for name in ["a", "b"]:
            (self.dir / name).mkdir()
            self.write(f"{name}/device.toml", self.text("device.toml"))
            for form in ["ardupilot-sitl", "sdf"]:
                self.ok("export", f"{name}/device.toml", "--format", form, "-o",
                        f"{name}/out")
        for file in (self.dir / "a/out").iterdir():
            self.assertSameBytes(f"a/out/{file.name}", f"b/out/{file.name}")


# What SDF 1.6 and later allow of an IMU, as far as we write it: the children of
# an element in their order, or the values of its text.
SCHEMA = {
    "sensor": ["update_rate", "imu"], "imu": ["angular_velocity"],
    "angular_velocity": ["axis"], "axis": ["noise"],
    "noise": ["mean", "stddev", "bias_mean", "bias_stddev",
              "dynamic_bias_stddev", "dynamic_bias_correlation_time",
              "precision"],
    "update_rate": (1e-9, math.inf), "mean": (-math.inf, math.inf),
    "stddev": (0, math.inf), "bias_mean": (-math.inf, math.inf),
    "bias_stddev": (0, math.inf), "dynamic_bias_stddev": (0, math.inf),
    "dynamic_bias_correlation_time": (0, math.inf), "precision": (0, math.inf),
}


def values_of(element, optional=("precision",)):
    """Values by name of what the schema allows; raises for anything else."""
    name = "axis" if element.tag in "xyz" else element.tag
    allowed = SCHEMA[name]
    if isinstance(allowed, tuple):
        value = float(element.text)
        if not (allowed[0] <= value <= allowed[1] and math.isfinite(value)):
            raise ValueError(f"{name} {value}")
        return {name: value}
    tags = ["axis" if child.tag in "xyz" else child.tag for child in element]
    expected = [tag for tag in allowed if tag in tags or tag not in optional]
    if tags != expected:
        raise ValueError(f"{name}: {tags}")
    found = {}
    for child in element:
        found |= values_of(child)
    return found


class ExportSdf(ProgramTest):
    def sensor(self, *arguments):
        self.said = self.ok("export", "device.toml", "--format", "sdf", "-o",
                            "out", *arguments)
        root = ElementTree.parse(self.dir / "out/device.sdf").getroot()
        self.assertEqual(root.attrib, {"name": "device", "type": "imu"})
        self.noise, = root.iter("noise")
        return values_of(root)

    def test_the_block_has_the_schema_and_the_figures_of_the_device(self):
        values = self.sensor("--update-rate-Hz", 400, "--axis", "y")
        self.assertEqual(self.noise.attrib, {"type": "gaussian_quantized"})
        self.assertIsNotNone(self.noise)
        for name, expected in {
                "update_rate": 400,
                "bias_mean": 0, "bias_stddev": math.radians(0.03),
                "dynamic_bias_stddev": math.radians(2e-4),
                "dynamic_bias_correlation_time": 360000,  # 100 h
                "precision": math.radians(300 / 2 ** 16)}.items():
            self.assertAlmostEqual(values[name], expected,
                                   delta=1e-8 * abs(expected))
        # N sqrt(f), with a little of the motion of the beam.
        self.assertAlmostEqual(values["stddev"], math.radians(0.010 * 20),
                               delta=1e-4 * values["stddev"])
        self.ok("run", SCENARIOS / "warm_up.toml", "--set",
                f'device="{self.dir}/device.toml"', "-o", "warm.h5")
        bias = self.signals("warm.h5")["true_bias"][-1]
        self.assertAlmostEqual(math.degrees(values["mean"]), bias, delta=1e-4)

    def test_the_noise_is_that_of_the_output(self):
        """Of a device whose beam and amplifiers make most of it."""
        self.ok("export", SCENARIOS / "devices/trimmed.toml", "--format", "sdf",
                "-o", "small", "--update-rate-Hz", 100)
        root = ElementTree.parse(self.dir / "small/trimmed.sdf").getroot()
        density = tomllib.loads(
            (ROOT / "docs/hardware/xv7081bb.toml").read_text())[
                "data_sheet"]["noise_density_deg_per_s_per_sqrt_Hz"]
        walk = math.degrees(values_of(root)["stddev"]) / 10
        self.assertAlmostEqual(walk * 2 ** 0.5, density, delta=0.02 * density)

    def test_gazebo_walks_as_the_device_does(self):
        """A step of its dynamic bias, by GaussianNoiseModel.cc of gz-sensors,
        has the variance K^2 dt of a random walk."""
        values = self.sensor()
        s, tau = (values[f"dynamic_bias_{name}"]
                  for name in ("stddev", "correlation_time"))
        dt = 0.01
        variance = -s * s * tau / 2 * math.expm1(-2 * dt / tau)
        self.assertAlmostEqual(variance, math.radians(2e-4) ** 2 * dt,
                               delta=1e-6 * variance)

    def test_what_it_cannot_say_is_said(self):
        self.sensor()
        text = self.text("out/device.sdf")
        for words in ["samples at 100 Hz", "random sign", "rad/s/sqrt(s)",
                      "left out is how it drifts with the temperature",
                      "bias instability of 0.01 deg/s"]:
            self.assertIn(words, text)
            self.assertIn(words, self.said)

    def test_a_resolution_that_gazebo_takes_for_none_is_left_out(self):
        self.change("device.toml", "^adc_bits = .*", "adc_bits = 24")
        self.assertNotIn("precision", self.sensor())
        self.assertEqual(self.noise.attrib, {"type": "gaussian"})

    def test_the_schema_refuses_what_is_no_block(self):
        self.sensor()
        text = self.text("out/device.sdf")
        for old, new in [("<mean>", "<average>"), ("<imu>", "<imu><imu>"),
                         ("<stddev>", "<stddev>-")]:
            with self.assertRaises((ValueError, KeyError,
                                    ElementTree.ParseError)):
                values_of(ElementTree.fromstring(text.replace(old, new)))


class SimulatorPage(ExportTest):
    def test_names_of_the_parameters(self):
        documented = rows(page("simulator_parameters"))
        self.ok("export", "device.toml", "--format", "ardupilot-sitl", "-o", "out",
                "--instance", 2)
        written = {line.split(",")[0] for line in
                   self.text("out/device_sitl.parm").splitlines()
                   if line[0] != "#"}
        expected = set()
        for name in documented:
            if not name.startswith("SIM_"):
                continue
            for k in "123" if "k_" in name else "-":
                for axis in "XYZ" if name.endswith("_a") else "-":
                    expected.add(re.sub("(GYR|IMUT)n", r"\g<1>2", name)
                                 .replace("k_", f"{k}_")
                                 .removesuffix("_a") +
                                 (f"_{axis}" if name.endswith("_a") else ""))
        self.assertEqual(expected, written)
        self.ok("export", "device.toml", "--format", "sdf", "-o", "out")
        for element in values_of(ElementTree.parse(
                self.dir / "out/device.sdf").getroot()):
            self.assertIn(element, documented)


class BadSimulatorExport(Rejections, ExportTest):
    table = [*[row(f"export {words} -o out", *says) for words, *says in [
        ("gone.toml --format sdf", "gone.toml"),
        ("device.toml --format c", "device.toml", "is a device file",
         "ardupilot-sitl and sdf"),
        ("train.toml --format sdf", "is a scenario"),
        ("device.toml --format sdf --range -40:20", "--range",
         "ardupilot-sitl"),
        ("device.toml --format ardupilot-sitl --update-rate-Hz 5",
         "--update-rate-Hz", "sdf"),
        ("device.toml --format sdf --update-rate-Hz 0", "--update-rate-Hz"),
        ("device.toml --format ardupilot-sitl --range 40:-40", "--range"),
        ("device.toml --format ardupilot-sitl --range -60:90", "device.toml",
         "-70 to 80 degC and 10 K apart"),
        ("device.toml --format ardupilot-sitl --range 20:25", "device.toml",
         "10 K apart"),
        ("device.toml --format ardupilot-sitl --range -200:50", "--range"),
        ("device.toml --format ardupilot-sitl --instance 4", "instance 4"),
        ("device.toml --format ardupilot-sitl --axis x,y", "2 axes for 1"),
        ("device.toml device.toml --format ardupilot-sitl", "0 axes for 2"),
        ("device.toml --format ardupilot-sitl --rest train.h5", "--rest",
         "ardupilot-sitl"),
        ("device.toml --format ardupilot-sitl --force", "--force"),
        ("cubic.json --format ardupilot-sitl --range -40:50", "--range",
         "devices"),
        ("cubic.json --format c --range -40:50", "--range", "ardupilot-sitl"),
        ("spline.json device.toml --format ardupilot-sitl", "spline.json",
         "of kind spline", "--fit-cubic"),
        ("cubic.json device.toml device.toml --format ardupilot-sitl --axis x,y",
         "2 devices and 1 compensators"),
        ("cubic.json --format sdf", "expected one device"),
        ("device.toml device.toml --format sdf", "expected one device"),
    ]], row("export hot.toml --format sdf -o out", "-100 to 150 degC", status=1)]

    def prepare(self):
        super().prepare()
        self.train("cubic")
        self.train("spline")
        self.write("hot.toml", re.sub("(?m)^electronics_power_W = .*",
                                      "electronics_power_W = 60",
                                      self.text("device.toml")))
