# SPDX-License-Identifier: MIT
"""`plot` of files that lie: one message with the file and the key, no
picture."""

import copy
import json
import shutil
import sys

import h5py
import numpy as np

from program import PROGRAM, ROOT, ProgramTest, ramp

sys.path.insert(0, str(PROGRAM.parent / "python"))
from beamgyro import plots  # noqa: E402  (where it is comes first)
from beamgyro.plots.kinds import KINDS, kind_of  # noqa: E402

DROPPED = object()
WRONG = [None, "x", [], {}, [[]], -1, True, DROPPED, float("nan"),
         float("inf"), 10**400]


def places(value, above=()):
    """The keys of each value within a document, of lists the first two."""
    inner = value.items() if isinstance(value, dict) else \
        list(enumerate(value))[:2] if isinstance(value, list) else ()
    for key, one in inner:
        yield (*above, key)
        yield from places(one, (*above, key))


def changed(document, place, value):
    document = copy.deepcopy(document)
    inside = document
    for key in place[:-1]:
        inside = inside[key]
    if value is DROPPED:
        del inside[place[-1]]
    else:
        inside[place[-1]] = value
    return document


class Lies(ProgramTest):
    def setUp(self):
        super().setUp()
        self.cubic_of_a_ramp("train")
        self.run_scenario("check", text=ramp(seed=5))

    def result(self, kind):
        """A document of that kind, as a command writes it."""
        if kind == "allan":
            self.ok("allan", "check.h5", "--json", "result.json")
        elif kind == "compensator":
            shutil.copy(self.dir / "c.json", self.dir / "result.json")
        else:
            self.beamgyro("validate", "c.json", "check.h5", "--spec",
                          ROOT / "specs/uav.toml", "--json", "result.json")
        self.assertEqual(kind_of(self.dir / "result.json"), kind)
        return self.json("result.json")

    def test_a_wrong_value_is_named(self):
        lies = {
            "allan": [
                (("oadev", 1, "deviation"), "q", "oadev[1].deviation: \"q\""),
                (("oadev", 0, "tau_s"), -1, "oadev[0].tau_s: -1;"),
                (("oadev", 0, "interval"), [2.0, 1.0],
                 "oadev[0].interval: [2.0, 1.0]; expected"),
                (("oadev",), "x", "oadev: \"x\"; expected a list"),
                (("series",), None, "series: null; expected an object"),
                (("series", "unit"), "furlong", "noise.N.per_second.unit"),
                (("oadev", 0, "deviation"), float("nan"), "NaN; expected"),
                (("oadev", 0, "deviation"), 10**400, "Infinity; expected")],
            "compensator": [
                (("bias_scale",), None, "bias_scale: null"),
                (("temperature_range_degC",), [3, 2], "must be [lowest"),
                (("kind",), "magic", 'kind: "magic", must be one of none, '),
                (("parameters", "slopes"), [1.0], "slopes")],
            "validation": [
                (("verdict",), None, "verdict: null; expected a text"),
                (("compensator",), None, "compensator: null"),
                (("compensator", "name"), DROPPED,
                 "compensator.name: missing"),
                (("checks", 0, "passed"), 3, "checks[0].passed: 3;"),
                (("figures",), None, "figures: null; expected a list"),
                (("metrics",), None, "metrics: null; expected a list"),
                (("figures", 0, "series", 0, "x"), [1.0], "values; expected "
                 "1, as x has"),
                (("figures", 0, "x", "scale"), "cubic", "figures[0].x.scale"),
                (("limits", 0, "max"), None, "limits[0]: neither min nor "
                 "max")]}
        for kind, cases in lies.items():
            result = self.result(kind)
            for place, value, says in cases:
                self.write("lie.json", json.dumps(
                    changed(result, place, value)))
                with self.assertRaises(plots.PlotError) as caught:
                    plots.plot(self.dir / "lie.json")
                self.assertIn("lie.json: ", str(caught.exception))
                self.assertIn(says, str(caught.exception))
            self.rejected("plot", "lie.json", "-o", "p.png",
                          says=["lie.json: ", says])

    def test_every_value_is_checked_or_does_not_matter(self):
        """A document in which any one value is wrong is refused with a
        message, or its picture can be drawn."""
        for kind in ("allan", "compensator", "validation"):
            result = self.result(kind)
            refused = drawn = 0
            for place in places(result):
                for number, wrong in enumerate(WRONG):
                    lie = {**changed(result, place, wrong), "name": "lie"}
                    try:
                        lie = KINDS[kind].checked(lie, "lie.json")
                    except plots.PlotError as error:
                        self.assertRegex(str(error), "^lie.json:.+")
                        refused += 1
                    else:  # of those it would take too long to draw all
                        drawn += 1
                        if drawn % 40 == 0:
                            KINDS[kind].draw(
                                plots.style.new_figure(5),
                                [lie] if KINDS[kind].compares else lie)
            self.assertGreater(refused, 50, kind)

    def test_what_is_no_json_and_no_text(self):
        for name, text, says in [
                ("deep.json", '{"adev": ' + 10**5 * "[", "nested too deeply"),
                ("bytes.json", b'{"adev": "\xff\xfe"}', "not UTF-8"),
                ("bytes.csv", b"temperature_degC,bias_deg_per_s\n\xff,1\n",
                 "not UTF-8")]:
            self.write(name, text)
            self.rejected("plot", name, "-o", "p.png", says=[name, says])


class Table(ProgramTest):
    def test_rows_are_finite_and_drawn_in_the_order_of_temperatures(self):
        self.ok("characterise", "device.toml", "--beam-temperature",
                "-20:20:10", "-o", "device.csv")
        head, *rows = self.text("device.csv").splitlines()
        self.write("shuffled.csv", "\n".join([head, *rows[::-1]]))
        drawn = [plots.plot(self.dir / name).axes[0].lines[0].get_xydata()
                 for name in ["device.csv", "shuffled.csv"]]
        self.assertEqual(drawn[0].tolist(), drawn[1].tolist())
        for value in ["nan", "inf", "1e300"]:
            wrong = ",".join([rows[2].split(",")[0], value,
                              *rows[2].split(",")[2:]])
            self.write("lie.csv", "\n".join([head, *rows[:2], wrong]))
            self.rejected("plot", "lie.csv", "-o", "p.png",
                          says=["lie.csv: bias_deg_per_s: "])


class Hdf5(ProgramTest):
    def lie(self, path, name, values, **attributes):
        """Puts other values in the place of a variable."""
        with h5py.File(path, "r+") as file:
            if name in file:
                del file[name]
            if values is not None:
                file[name] = values
                file[name].attrs.update(attributes)

    def test_recordings(self):
        path = self.run_scenario("rest")
        whole = path.read_bytes()
        for name, values, says in [
                ("time", None, "time"),
                ("rate", np.zeros((1200, 2)), "rate"),
                ("rate", np.zeros(7), "rate"),
                ("rate", np.array([b"x"] * 1200), "rate"),
                ("time", np.zeros(1200)[::-1] - np.arange(1200), "time"),
                ("status", np.zeros(5, np.uint8), "status")]:
            path.write_bytes(whole)
            self.lie(path, name, values, units=b"degree/s"
                     if name == "rate" else b"s")
            self.rejected("plot", "rest.h5", "-o", "p.png",
                          says=["rest.h5", says])
            with self.assertRaisesRegex(plots.PlotError, says):
                plots.plot(path)  # which does not ask the program first
        path.write_bytes(whole[:len(whole) // 2])
        self.rejected("plot", "rest.h5", "-o", "p.png", says="rest.h5")
        with self.assertRaisesRegex(plots.PlotError, "rest.h5: HDF5"):
            plots.plot(path)

    def test_sets(self):
        self.write("sweep.toml", ramp())
        self.write("few.toml", """\
name = "few"
device = "device.toml"
devices = 4
devices_per_file = 4
seed = 4

[tolerances]
"mount.axis_angle_deg" = { normal = { mean = 0, sigma = 1 } }

[[run]]
name = "sweep"
scenario = "sweep.toml"
""")
        self.ok("generate", "few.toml", "-o", "few")
        path = self.dir / "few/sweep_00000.h5"
        whole = path.read_bytes()
        manifest = self.text("few/manifest.jsonl")
        for name, values, says in [
                ("time", None, "time: missing"),
                ("device", np.arange(3), "3 values of device"),
                ("part", np.array([b"train"] * 4), "part: values of type"),
                ("rate", np.zeros(4), "rate: 1 dimensions"),
                ("rate", np.zeros((4, 3)), "rate: (4, 3)"),
                ("rate", np.full((4, 4000), np.nan), "no device has values")]:
            path.write_bytes(whole)
            self.lie(path, name, values)
            self.rejected("plot", "few", "-o", "p.png", says=says)
        path.write_bytes(whole[:5000])
        self.rejected("plot", "few", "-o", "p.png",
                      says=["sweep_00000.h5", "HDF5 cannot read it"])
        path.write_bytes(whole)
        for text, says in [
                ("", "manifest.jsonl: empty"),
                (manifest.replace('"runs":["sweep"]', '"runs":"sweep"'),
                 'manifest.jsonl:1: runs: "sweep"'),
                (manifest.replace('"devices":4', '"devices":"many"', 1),
                 'manifest.jsonl:1: devices: "many"'),
                (manifest.splitlines()[0] + "\n", "no file of the run sweep"),
                (manifest.replace('"sweep_00000.h5"', "7"),
                 "manifest.jsonl:2: file: 7;")]:
            self.write("few/manifest.jsonl", text)
            self.rejected("plot", "few", "-o", "p.png", says=says)
