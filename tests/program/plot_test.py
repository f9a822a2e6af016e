# SPDX-License-Identifier: MIT
"""`plot`: a picture of every kind of file that the program writes."""

import os
import re
import resource
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

import windows
from plan_test_population import population_of
from program import (CUBIC, NETWORK, PATIENCE, PROGRAM, ROOT, SCENARIO,
                     ProgramTest, limit, ramp)

CAMPAIGN = """\
name = "few"
device = "device.toml"
devices = 6
devices_per_file = 3
seed = 4

[tolerances]
"mount.axis_angle_deg" = { normal = { mean = 0, sigma = 1 } }
"readout.quadrature_trim_deg_per_s" = { normal = { mean = 0, sigma = 50 } }

[[run]]
name = "sweep"
scenario = "sweep.toml"
"""

SVG = "{http://www.w3.org/2000/svg}"


def texts(path):
    """All texts of an SVG, joined."""
    return "\n".join("".join(node.itertext()) for node in
                     ElementTree.parse(path).iter(f"{SVG}text"))


def curves(path):
    """The names of the curves of an SVG: panel and label."""
    return [node.get("id") for node in ElementTree.parse(path).iter(f"{SVG}g")
            if str(node.get("id")).startswith("curve-")]


class PlotTest(ProgramTest):
    def refused(self, *words, says, status=2, **options):
        self.rejected("plot", *words, says=says, status=status, **options)

    def picture(self, *files, name="picture.svg"):
        self.ok("plot", *files, "-o", name)
        return self.dir / name

    def says(self, path, *words):
        found = texts(path)
        for word in words:
            self.assertIn(word, found)


class Recordings(PlotTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("rest")

    def test_a_run_at_rest(self):
        svg = self.picture("rest.h5")
        self.says(svg, "rest.h5", "virtual gyro device, seed 7",
                  "rate at rest [°/s]", "temp. [°C]",
                  "drive [Hz]", "quad. [°/s]", "time [min]", "sensor", "beam")
        self.assertEqual(
            curves(svg)[:2], ["curve-1-measured",
                              "curve-1-true-bias-without-noise-and-turn-on-offset"])

    def test_the_csv_of_a_run_has_the_same_curves(self):
        self.ok("run", "rest.toml", "-o", "rest.csv")
        self.assertEqual(curves(self.picture("rest.h5")),
                         curves(self.picture("rest.csv", name="csv.svg")))

    def test_units_of_a_csv_are_converted(self):
        self.write("log.csv", "time [ms],status,rate [deg/h],temperature [K]\n"
                   + "".join(f"{1000 * k},0,{7200 + k},{273.15 + 20 + k}\n"
                             for k in range(60)))
        svg = self.picture("log.csv")
        self.says(svg, "rate [°/s]", "temp. [°C]", "time [s]")
        ticks = re.findall(r"^[\d.]+$", texts(svg), re.MULTILINE)
        self.assertIn("2.000", ticks)  # 7200 deg/h
        self.assertIn("40", ticks)  # degC
        self.assertNotIn("300", ticks)

    def test_a_turning_run_after_compensation(self):
        self.cubic_of_a_ramp("train")
        self.run_scenario("turn", text=SCENARIO + "\n[rate]\nsteps = "
                          "[[0, 0.0], [200, 20.0], [400, -20.0]]\n")
        self.ok("compensate", "c.json", "turn.h5", "-o", "done.h5")
        svg = self.picture("done.h5")
        self.says(svg, "rate [°/s]", "error [°/s]", "error left [°/s]",
                  "compensated by c.json")
        names = curves(svg)
        for name in ("curve-1-measured", "curve-1-compensated",
                     "curve-1-true", "curve-2-measured-less-true-rate",
                     "curve-3-compensated-less-true-rate"):
            self.assertIn(name, names)
        self.assertEqual(any("stated" in name for name in names),
                         "compensated_rate_sigma" in self.signals("done.h5"))

    def test_what_was_unpowered_is_shaded(self):
        self.run_scenario("cycle", text=SCENARIO +
                          "\n[power]\non_s = [0, 400]\noff_s = [200]\n")
        svg = self.picture("cycle.h5")
        self.says(svg, "unpowered")
        # One stretch in each of the panels.
        self.assertEqual(svg.read_text().count('id="state unpowered"'), 4)

    def test_the_same_bytes_twice_and_no_date(self):
        for name in ("a.svg", "a.png"):
            first = self.picture("rest.h5", name=name).read_bytes()
            again = self.picture("rest.h5", name=f"again_{name}").read_bytes()
            self.assertEqual(first, again)
            self.assertNotRegex(first, rb"<dc:date>|tIME|Matplotlib v")

    def test_a_png_is_as_wide_as_a_slide(self):
        head = self.picture("rest.h5", name="a.png").read_bytes()[:24]
        self.assertEqual(head[:4], b"\x89PNG")
        self.assertEqual(struct.unpack(">I", head[16:20]), (1600,))

    def test_several_recordings_over_each_other(self):
        self.run_scenario("one")
        self.run_scenario("two", "--set", "ambient.constant_degC=10")
        svg = self.picture("one.h5", "two.h5", "--compare")
        self.assertEqual(curves(svg), ["curve-1-one-h5", "curve-1-two-h5",
                                       "curve-2-one-h5", "curve-2-two-h5"])

    def test_files_of_one_name_are_told_apart(self):
        self.run_scenario("one")
        for folder in ("first", "second"):
            (self.dir / folder).mkdir()
            (self.dir / folder / "run.h5").write_bytes(
                (self.dir / "one.h5").read_bytes())
        self.says(self.picture("first/run.h5", "second/run.h5", "--compare"),
                  "first/run.h5", "second/run.h5")
        self.says(self.picture("one.h5", "one.h5", "--compare"),
                  "one.h5 (1)", "one.h5 (2)")
        begin, end = 30 * "a" + "_x_" + 30 * "b", 30 * "a" + "_y_" + 30 * "b"
        for name in (begin, end):
            (self.dir / f"{name}.h5").write_bytes(
                (self.dir / "one.h5").read_bytes())
        self.says(self.picture(f"{begin}.h5", f"{end}.h5", "--compare"),
                  "aaa…bbb", "bbb.h5 (1)", "bbb.h5 (2)")

    def test_letters_that_the_font_lacks_are_named(self):
        for name, shown in [("測定 ü.h5", r"\u6e2c\u5b9a ü.h5"),
                            ("two\nlines.h5", r"two\nlines.h5"),
                            (b"\xff.h5".decode(errors="surrogateescape"),
                             r"\udcff.h5")]:
            (self.dir / "rest.h5").rename(self.dir / name)
            self.says(self.picture(name), shown)
            (self.dir / name).rename(self.dir / "rest.h5")

    def test_one_sample_and_samples_apart_are_marked(self):
        # Of each series the values that a marker shows.
        for name, times, marked in [
                ("one", [7], 1), ("minutes", [*range(999), 2000], 1),
                ("weeks", [*range(9), *range(10**6, 10**6 + 9)], 2),
                ("whole", range(9), 0)]:
            self.write("log.csv", "time,status,rate\n" + "".join(
                f"{t},0,{k % 5}\n" for k, t in enumerate(times)))
            figure = ElementTree.parse(self.picture("log.csv")).find(
                f".//{SVG}g[@id='curve-1-measured']")
            self.assertEqual(len(figure.findall(f".//{SVG}use")), marked)

    def test_a_name_with_spaces_and_dollars(self):
        (self.dir / "rest.h5").rename(self.dir / "my -run $x^$ 2.h5")
        self.says(self.picture("my -run $x^$ 2.h5", name="a picture.svg"),
                  "my -run $x^$ 2.h5")


class Results(PlotTest):
    def test_a_table_of_characterise(self):
        self.ok("characterise", "device.toml", "-o", "table.csv")
        self.ok("characterise", "device.toml", "-o", "short.csv", "--set",
                "beam.length_m=0.038")
        svg = self.picture("table.csv")
        self.says(svg, "bias [°/s]", "scale factor − 1 [%]", "Q",
                  "drive frequency [Hz]", "temperature of the beam [°C]")
        self.assertEqual(curves(svg), ["curve-7-drive", "curve-7-sense"])
        svg = self.picture("table.csv", "short.csv", "--compare")
        self.assertEqual(len(curves(svg)), 16)  # two in each of eight panels

    def test_curves_of_a_campaign(self):
        self.write("sweep.toml", SCENARIO)
        self.write("few.toml", CAMPAIGN)
        for name in ("few.csv", "few.h5"):
            self.ok("characterise", "few.toml", "-o", name, "--devices", 30,
                    "--beam-temperature", "-20:50:2", "--json", "f.json")
            svg = self.picture(name)
            self.says(svg, name, "30 devices at rest", "bias [°/s]",
                      "principal component", "shape", "90 of 100 between")
            self.assertEqual(curves(svg), [
                "curve-1-median", "curve-1-90-of-100-between", "curve-3-1",
                "curve-3-2", "curve-3-3"])
            # The numbers above the bars are those that the command states.
            self.says(svg, *(f"{100 * share:.0f}" for share in
                             self.json("f.json")["component_shares"]))

    def test_curves_of_few_devices_and_temperatures(self):
        self.write("sweep.toml", SCENARIO)
        self.write("few.toml", CAMPAIGN)
        for devices, grid, names in [
                (6, "0:10:1", ["curve-3-1", "curve-3-2", "curve-3-3"]),
                (2, "0:10:10", ["curve-3-1", "curve-3-2"]),
                (1, "0:10:1", []), (6, "25", []), (1, "25", [])]:
            self.ok("characterise", "few.toml", "-o", "few.h5", "--devices",
                    devices, "--beam-temperature", grid)
            svg = self.picture("few.h5")
            self.assertEqual(curves(svg), names)
            self.says(svg, f"{devices} device")

    def test_curves_that_are_none_are_refused(self):
        head = "temperature_degC,device_0_bias_deg_per_s,"
        for name, text, says in [
                ("a.csv", head + "x\n1,2,3\n", '"x"; expected device_N'),
                ("b.csv", head[:-1] + "\n1,2,3\n", "b.csv:2: 3 values"),
                ("c.csv", head[:-1] + "\n", "no rows"),
                ("d.csv", head[:-1] + "\n1,nan\n", "bias: nan"),
                ("e.csv", head[:-1] + "\n1e300,2\n", "temperature: 1e+300"),
                ("f.csv", head[:-1] + "\n1,x\n", "expected numbers")]:
            self.write(name, text)
            self.refused(name, "-o", "p.png", says=says)

    def test_one_row_of_a_table(self):
        self.ok("characterise", "device.toml", "-o", "table.csv",
                "--beam-temperature", "25")
        self.picture("table.csv")

    def test_allan_deviations(self):
        self.run_scenario("rest")
        self.ok("allan", "rest.h5", "--json", "a.json", "--kind",
                "oadev,adev,hdev")
        svg = self.picture("a.json")
        self.says(svg, "deviation [°/s]", "averaging time τ [s]", "N = ",
                  "9.99 min", "[°/h]", "°/√h")
        self.assertEqual(curves(svg), [
            "curve-1-overlapping-Allan-deviation", "curve-1-Allan-deviation",
            "curve-1-Hadamard-deviation"])
        self.ok("allan", "rest.h5", "--json", "b.json", "--to", "300")
        self.assertEqual(
            curves(self.picture("a.json", "b.json", "--compare")),
            ["curve-1-a-json", "curve-1-b-json"])

    def test_a_validation_without_limits(self):
        self.cubic_of_a_ramp("train")
        self.run_scenario("check", text=ramp(seed=5))
        self.run_scenario("other", text=ramp(seed=6, high=30))
        self.ok("validate", "c.json", "check.h5", "other.h5", "--json",
                "v.json")
        svg = self.picture("v.json")
        self.says(svg, "PASS: c.json", "better than no compensator",
                  "Residuals at rest, after compensation")
        self.assertNotIn("share of the limit", texts(svg))

    def test_a_validation_and_its_limits(self):
        self.cubic_of_a_ramp("train")
        self.run_scenario("check", text=ramp(seed=5))
        answer = self.ended("validate", "c.json", "check.h5", "--spec",
                            ROOT / "specs/uav.toml", "--json", "v.json",
                            allowed=(3,))
        self.says(self.picture("v.json"), ": c.json",
                  "residual_sigma_deg_per_s", "Limits", "share of the limit",
                  "Residuals at rest, after compensation",
                  "Share of the minutes [%]")

    def test_a_study_of_sensitivity(self):
        self.write("sweep.toml", SCENARIO)
        self.write("few.toml", CAMPAIGN)
        self.ok("sensitivity", "few.toml", "--samples", "64", "--figure",
                "bias_pp_deg_per_s,cubic_rms_deg_per_s", "--json", "s.json")
        self.says(self.picture("s.json"), "Sensitivity: few",
                  "mount.axis_angle_deg", "share of the variance", "total",
                  "first order", "peak to peak of the bias")


class Compensators(PlotTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("train", text=ramp())
        self.run_scenario("held", text=ramp(seed=8))

    def train(self, name, model):
        self.train_on("train.h5", "--held-out", "held.h5", model=model,
                      to=f"{name}.json")
        return f"{name}.json"

    def test_one(self):
        svg = self.picture(self.train("cubic", CUBIC))
        self.says(svg, "cubic.json", "bias [°/s]",
                  "measured temperature [°C]", "in-sample", "held out",
                  "rms left [°/s]")
        self.assertEqual(sorted(curves(svg)), [
            "curve-1-bias-taken-away", "curve-1-cubic-of-its-training"])

    def test_one_that_follows_other_inputs_has_no_curve(self):
        name = self.train("net", NETWORK.replace(
            '["temperature"]', '["temperature", "drive_frequency"]'))
        svg = self.picture(name)
        self.says(svg, "follows drive_frequency", "no curve")
        self.assertNotIn("curve-1-bias-taken-away", curves(svg))

    def test_two(self):
        svg = self.picture(self.train("cubic", CUBIC),
                           self.train("net", NETWORK), "--compare")
        names = curves(svg)
        self.assertEqual(names[:2], ["curve-1-cubic-json", "curve-1-net-json"])


class Sets(PlotTest):
    def test_a_set_and_one_of_its_files(self):
        self.write("sweep.toml", ramp())
        self.write("few.toml", CAMPAIGN)
        self.ok("generate", "few.toml", "-o", "few")
        svg = self.picture("few")
        self.says(svg, "Set few", "6 devices", "run sweep", "drift [°/s]",
                  "p-p of each device [°/s]")
        self.says(self.picture("few/sweep_00000.h5"), "3 devices")

    def test_a_population_and_its_plan(self):
        population_of(self.dir, devices=30)
        self.says(self.picture("population.json"), "population of ",
                  "bias [°/s]", "quadrature [°/s]", "mean of the devices",
                  "change of bias [°/s]", "change of quadrature [°/s]")
        self.ok("plan", "population.json", "--soaks", "3", "--json", "plan.json",
                "--picture", "drawn by plan.svg")
        svg = self.picture("plan.json")
        self.says(svg, "What soaks buy", "rms left [°/s]", "this schedule",
                  "straight lines, even: median")
        self.assertEqual(curves(svg),
                         curves(self.dir / "drawn by plan.svg"))
        self.assertEqual(len(curves(svg)), 7)


class Refusals(PlotTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("rest")

    def test_files_without_a_picture(self):
        self.write("notes.txt", "no data at all\n")
        self.write("other.json", '{"a": 1}\n')
        self.write("list.json", "[1, 2]\n")
        self.write("cut.json", '{"adev": [')
        self.write("empty.h5", "")
        (self.dir / "folder").mkdir()
        self.write("s.toml", SCENARIO)
        for name, says in [
                ("nothing.h5", "nothing.h5"),
                ("notes.txt", "has no picture"),
                ("other.json", "has no picture"),
                ("list.json", "list.json"),
                ("cut.json", "no JSON"),
                ("empty.h5", "empty.h5"),
                ("folder", "manifest.jsonl"),
                ("device.toml", "is a device file"),
                ("s.toml", "is a scenario")]:
            self.refused(name, "-o", "p.png", says=[name, says])

    def test_a_log_is_not_yet_a_recording(self):
        self.write("log.csv", "time,rate\n0,1\n1,2\n")
        self.write("other.csv", "a,b\n1,2\n")
        self.refused("log.csv", "-o", "p.png", says=[
            "log.csv: no column status;", "beamgyro import"])
        self.refused("other.csv", "-o", "p.png", says=[
            "no column time and none status;", "beamgyro import"])

    def test_results_that_were_changed(self):
        self.write("table.csv", "temperature_degC,bias_deg_per_s\n1,2\n3\n")
        self.write("head.csv", "temperature_degC,bias_deg_per_s\n")
        self.write("few.csv", "temperature_degC,bias_deg_per_s\n1,2\n3,4\n")
        self.write("allan.json", '{"adev": [{"tau_s": 1}], "series": {}, '
                   '"noise": null}')
        self.write("unit.csv", "time,status,rate [furlong/s]\n0,0,1\n1,0,1\n")
        for name, says in [("table.csv", "table.csv:3: 1 values"),
                           ("head.csv", "no rows"),
                           ("few.csv", "no column scale_factor_rel"),
                           ("allan.json", "adev[0].deviation: missing"),
                           ("unit.csv", "furlong/s")]:
            self.refused(name, "-o", "p.png", says=[name, says])

    def test_a_damaged_recording(self):
        self.flip("rest.h5")
        self.refused("rest.h5", "-o", "p.png", says=["rest.h5", "damaged"])

    def test_what_cannot_be_compared(self):
        self.ok("characterise", "device.toml", "-o", "table.csv")
        self.ok("allan", "rest.h5", "--json", "allan.json")
        self.refused("rest.h5", "table.csv", "--compare", "-o", "p.png",
                     says=["table.csv", "rest.h5", "one kind"])
        self.refused("rest.h5", "allan.json", "--compare", "-o", "p.png",
                     says="one kind")
        for name, column in [("cold", "temperature [degC]"),
                             ("rate", "rate [deg/s]")]:
            self.write(f"{name}.csv",
                       f"time [s],{column},status\n0,20,0\n1,21,0\n")
        self.refused("cold.csv", "rate.csv", "--compare", "-o", "p.png",
                     says=["cold.csv", "rate.csv", "in common"])
        self.ok("plot", "cold.csv", "rest.h5", "--compare", "-o", "p.png")
        self.refused("rest.h5", "rest.h5", "-o", "p.png", says="--compare")
        self.refused("rest.h5", "--compare", "-o", "p.png", says="--compare")

    def test_names_of_the_picture(self):
        for name, says in [("p.jpg", '".jpg"'), ("p", '""'),
                           ("none/p.png", "none")]:
            self.refused("rest.h5", "-o", name, says=says)
        self.ok("plot", "rest.h5", "-o", "p.PNG")
        self.assertEqual((self.dir / "p.PNG").read_bytes()[:4], b"\x89PNG")
        self.ok("plot", "rest.h5", "-o", "p.Svg")
        self.assertIn(b"<svg", (self.dir / "p.Svg").read_bytes())
        (self.dir / "rest.h5").rename(self.dir / "rest.png")
        self.refused("rest.png", "-o", "rest.png", says="rest.png")
        self.refused("-o", "p.png", says="FILE")

    def test_a_picture_that_was_there_stays_when_drawing_fails(self):
        self.write("p.png", "mine")
        self.write("notes.txt", "no data at all\n")
        self.refused("notes.txt", "-o", "p.png", says="has no picture")


class Surroundings(PlotTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("rest")

    def without(self, module):
        broken = self.dir / "modules"
        broken.mkdir(exist_ok=True)
        (broken / f"{module}.py").write_text(
            f'raise ModuleNotFoundError("No module named {module!r}", '
            f'name="{module}")')
        return {**os.environ, "PYTHONPATH": str(broken)}

    def test_without_matplotlib_or_h5py(self):
        for module in ("matplotlib", "h5py"):
            env = self.without(module)
            self.refused("rest.h5", "-o", "p.png", status=1, env=env, says=[
                f"No module named '{module}'", f"python3-{module}"])
            (self.dir / f"modules/{module}.py").unlink()

    def test_without_a_display_there_is_no_window(self):
        env = {name: value for name, value in os.environ.items()
               if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.refused("rest.h5", env=env, says=["no display", "-o PICTURE.png"])

    @unittest.skipIf(windows.missing(), windows.missing())
    def test_a_window_for_each_file_until_all_are_closed(self):
        self.ok("allan", "rest.h5", "--json", "allan.json")
        with windows.display() as name:
            env = {**os.environ, "DISPLAY": name}
            env.pop("MPLBACKEND", None)
            plot = subprocess.Popen(
                [PROGRAM, "plot", "rest.h5", "allan.json"], cwd=self.dir,
                env=env, stderr=subprocess.PIPE, text=True)
            there = windows.Windows(name)
            until = time.monotonic() + PATIENCE
            while len(there.titles()) < 2 and plot.poll() is None:
                self.assertLess(time.monotonic(), until, "no window came")
                time.sleep(0.1)
            titles = there.titles()
            self.assertEqual(set(titles), {"rest.h5", "allan.json"})
            # As wide as a picture, not as matplotlib's 640 pixels.
            self.assertEqual([there.width(one) for one in titles.values()],
                             [800, 800])
            there.close(titles["rest.h5"])
            while "rest.h5" in there.titles():
                self.assertLess(time.monotonic(), until, "it was not closed")
                time.sleep(0.1)
            self.assertIsNone(plot.poll())
            there.close(titles["allan.json"])
            self.assertEqual(plot.communicate(timeout=PATIENCE), (None, ""))
            self.assertEqual(plot.returncode, 0)

    def test_what_the_user_set_for_matplotlib_does_not_matter(self):
        plain = self.picture("rest.h5").read_bytes()
        (self.dir / "settings").mkdir()
        self.write("settings/matplotlibrc", "text.usetex: true\n"
                   "font.size: 40\naxes.facecolor: red\nlines.marker: o\n"
                   "savefig.bbox: tight\nsvg.fonttype: path\n")
        for change in ({"MPLCONFIGDIR": str(self.dir / "settings")},
                       {"MPLBACKEND": "nonsense"}, {"HOME": "/proc"}):
            self.assertEqual("", self.warned(
                "plot", "rest.h5", "-o", "other.svg",
                env={**os.environ, **change}))
            self.assertEqual((self.dir / "other.svg").read_bytes(), plain)

    def test_windows_that_cannot_be(self):
        for backend, status, says in [
                ("nonsense", 2, "MPLBACKEND is nonsense; expected"),
                ("agg", 1, "MPLBACKEND is agg")]:
            self.refused("rest.h5", says=says, status=status, env={
                **os.environ, "DISPLAY": ":987", "MPLBACKEND": backend})

    def test_a_full_disk_leaves_no_picture(self):
        self.refused("rest.h5", "-o", "p.png", status=1, says=re.compile(
            r"\Abeamgyro: the picture was not written: File too large\n\Z"),
            preexec_fn=limit(resource.RLIMIT_FSIZE, 10240))

    def test_the_rest_of_the_package_is_not_needed(self):
        """The pictures are there where only they were installed."""
        self.ok("plot", "rest.h5", "-o", "p.png", env=self.without("beamgyro"))

    def test_a_spike_of_one_sample_among_many_is_drawn(self):
        count, spike = 100_000, 54_321
        rate = np.zeros(count)
        rate[spike] = 9.0
        self.write("log.csv", "time,status,rate,temperature\n" + "".join(
            f"{k},0,{rate[k]:g},25\n" for k in range(count)))
        ticks = re.findall(r"^[\d.]+$", texts(self.picture("log.csv")),
                           re.MULTILINE)
        self.assertTrue({"8", "7.5"} & set(ticks), ticks)
