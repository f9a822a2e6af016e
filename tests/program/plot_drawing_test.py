# SPDX-License-Identifier: MIT
"""The functions that draw, called from Python with plain data."""

import itertools
import json
import re
import sys
import unittest

import h5py
import numpy as np
import xarray
from matplotlib.figure import Figure

from program import (CUBIC, NETWORK, PROGRAM, ROOT, SCENARIOS, ProgramTest,
                     ramp)

sys.path.insert(0, str(PROGRAM.parent / "python"))
from beamgyro import plots  # noqa: E402  (where it is comes first)
from beamgyro.plots import style  # noqa: E402
from beamgyro.plots.envelope import bins_of, envelope, spans  # noqa: E402
from beamgyro.plots.validation import draw_figure  # noqa: E402

MODELS = SCENARIOS / "models"


class Envelopes(unittest.TestCase):
    def test_no_extreme_is_lost_and_means_are_means(self):
        random = np.random.default_rng(1)
        values = random.normal(size=100_003)
        values[[7, 50_001, 100_002]] = 90, -80, 70
        bins = bins_of(np.arange(len(values)) / 10)
        found = envelope(bins, values)
        self.assertEqual(len(found.mean), 1000)
        self.assertEqual(found.high.max(), 90)
        self.assertEqual(found.low.min(), -80)
        self.assertEqual(found.high[-1], 70)
        sizes = np.diff([*bins.starts, len(values)])
        self.assertAlmostEqual((found.mean * sizes).sum(), values.sum(), 8)

    def test_a_short_series_stays_as_it_is(self):
        values = np.array([1.0, np.nan, 3.0])
        found = envelope(bins_of(np.array([0.0, 1.0, 2.0])), values)
        np.testing.assert_array_equal(found.mean, values)
        np.testing.assert_array_equal(found.time, [0, 1, 2])

    def test_missing_values_and_missing_times_break_the_line(self):
        count = 10_000
        values = np.ones(count)
        values[2000:4000] = np.nan
        when = np.arange(count) / 2.0
        when[6000:] += 3000.0
        found = envelope(bins_of(when), values)
        inside = (found.time > 1001) & (found.time < 1990)
        self.assertGreater(inside.sum(), 100)
        self.assertTrue(np.isnan(found.mean[inside]).all())
        # One break where time itself has a gap.
        self.assertEqual(np.isnan(found.time).sum(), 1)
        at = np.flatnonzero(np.isnan(found.time))[0]
        self.assertGreater(found.time[at + 1] - found.time[at - 1], 2900)

    def test_short_states_are_wide_enough_to_be_seen(self):
        flags = np.zeros(50_000, dtype=bool)
        flags[20_000] = flags[30_000:30_100] = True
        found = spans(bins_of(np.arange(50_000.0)), flags)
        self.assertEqual(len(found), 2)
        self.assertAlmostEqual(found[0][1] - found[0][0], 50, delta=1)
        self.assertTrue(found[0][0] <= 20_000 <= found[0][1])
        self.assertTrue(found[1][0] <= 30_000 and found[1][1] >= 30_099)


class Recordings(ProgramTest):
    def dataset(self):
        path = self.run_scenario("rest")
        return path, xarray.open_dataset(path, engine="h5netcdf")

    def test_a_dataset_a_dict_and_the_file_give_the_same_picture(self):
        path, dataset = self.dataset()
        with h5py.File(path) as file:
            plain = {name: file[name][()] for name in file
                     if isinstance(file[name], h5py.Dataset)}
        pictures = []
        for figure in (plots.plot_recording(dataset, names=["rest.h5"]),
                       plots.plot_recording(plain, names=["rest.h5"])):
            axes = figure.axes
            self.assertEqual(axes[0].get_ylabel(), "rate at rest [°/s]")
            pictures.append([line.get_ydata() for one in axes
                             for line in one.lines])
        drawn = [line.get_ydata() for one in plots.plot(path).axes
                 for line in one.lines]
        self.assertEqual(len(drawn), len(pictures[0]))
        for lines in zip(drawn, *pictures):
            np.testing.assert_array_equal(lines[0], lines[1])
            np.testing.assert_array_equal(lines[0], lines[2])

    def test_without_truth_and_without_status(self):
        figure = plots.plot_recording(
            {"time": np.arange(10.0), "rate": np.ones(10)})
        self.assertEqual([axes.get_ylabel() for axes in figure.axes],
                         ["rate [°/s]"])

    def test_stated_sigma_is_a_band_about_zero(self):
        figure = plots.plot_recording({
            "time": np.arange(50.0), "rate": np.full(50, 1.0),
            "compensated_rate": np.full(50, 0.2), "true_rate": np.zeros(50),
            "compensated_rate_sigma": np.full(50, 0.5)})
        left = figure.axes[1]
        self.assertEqual(left.get_ylabel(), "error left [°/s]")
        levels = sorted({float(line.get_ydata()[0]) for line in left.lines})
        self.assertEqual(levels, [-0.5, 0.0, 0.2, 0.5])

    def test_the_histogram_of_a_set_is_clear_of_its_neighbour(self):
        self.ok("generate", SCENARIOS / "campaigns/small.toml", "--devices",
                "6", "-o", "set")
        figure = plots.plot(self.dir / "set")
        figure.draw_without_rendering()
        left, right = figure.axes
        gap = (right.yaxis.label.get_window_extent().x0
               - left.get_window_extent().x1)
        self.assertGreater(gap, 10 * figure.dpi / 72)  # a letter's height

    def test_few_devices_of_a_set_are_drawn_one_by_one(self):
        for devices, lines, bands in (("1", 1, 0), ("6", 7, 0), ("20", 3, 2)):
            with self.subTest(devices):
                self.ok("generate", SCENARIOS / "campaigns/small.toml",
                        "--devices", devices, "-o", devices)
                figure = plots.plot(self.dir / devices)
                figure.draw_without_rendering()
                left = figure.axes[0]
                legend = left.get_legend().get_window_extent()
                inside = left.get_window_extent()
                self.assertGreater(legend.x0, inside.x0)
                self.assertLess(legend.x1, inside.x1)
                self.assertEqual(len(left.lines), lines)
                self.assertEqual(len(left.collections), bands)

    def test_a_set_of_devices_and_nothing_are_refused(self):
        with self.assertRaisesRegex(plots.PlotError, "isel"):
            plots.plot_recording({"time": np.arange(3.0),
                                  "rate": np.ones((2, 3))})
        with self.assertRaisesRegex(plots.PlotError, "no samples"):
            plots.plot_recording({"time": np.empty(0), "rate": np.empty(0)})
        with self.assertRaises(plots.PlotError):
            plots.plot([])


class Validations(ProgramTest):
    def test_no_legend_lies_over_a_title_or_a_bar(self):
        self.write("model.toml", CUBIC)
        self.run_scenario("train", text=ramp())
        self.run_scenario("held", text=ramp(seed=8))
        self.run_scenario("held_2", text=ramp(seed=9))
        self.run_scenario("check", text=ramp(seed=5))
        self.ok("train", "train.h5", "--held-out", "held.h5", "--held-out",
                "held_2.h5", "--model", "model.toml", "-o", "c.json")
        self.beamgyro("validate", "c.json", "check.h5", "--spec",
                      ROOT / "specs/uav.toml", "--json", "v.json")
        figure = plots.plot(self.dir / "v.json")
        figure.draw_without_rendering()
        legends = [one for part in [*figure.subfigs, *figure.axes]
                   for one in (getattr(part, "legends", None) or
                               filter(None, [getattr(part, "legend_", None)]))]
        self.assertGreaterEqual(len(legends), 2)
        drawn = [axes.title.get_window_extent() for axes in figure.axes]
        drawn += [bar.get_window_extent() for axes in figure.axes
                  for bar in axes.patches if bar.get_height() > 0]
        for legend in legends:
            box = legend.get_window_extent().padded(-1)
            for other in drawn:
                self.assertFalse(box.overlaps(other), (box, other))
        labels = [axes.get_xlabel() for axes in figure.axes]
        self.assertIn("Φ(residual / σ)", labels)

    def test_the_title_says_of_what_and_on_what(self):
        self.cubic_of_a_ramp("train")
        for number in range(3):
            self.run_scenario(f"run{number}", text=ramp(seed=5 + number))
        for runs, says in [(["run0.h5"], "on run0.h5"),
                           (["run0.h5", "run1.h5"], "on run0.h5 and run1.h5"),
                           (["run0.h5", "run1.h5", "run2.h5"],
                            "on run0.h5 and 2 more runs")]:
            self.ended("validate", "c.json", *runs, "--json", "v.json",
                       allowed=(0, 3))
            result = json.loads((self.dir / "v.json").read_text())
            title = plots.plot_validation(result)._suptitle.get_text()
            self.assertEqual(title.split("\n")[0],
                             f"{result['verdict'].upper()}: c.json {says}")
        result["provenance"] |= {"device": "mine.toml",
                                 "qualification": "turns.toml"}
        figure = plots.plot_validation(result)
        self.assertIn(": c.json on mine.toml", figure._suptitle.get_text())
        self.assertIn("turns.toml with the virtual gyro mine.toml",
                      " ".join(figure.texts[-1].get_text().split()))

    def test_an_allan_deviation_has_an_axis_of_data_sheets(self):
        axis = {"label": "x", "unit": "s", "scale": "log"}
        shown = {"title": "t", "kind": "points", "x": axis,
                 "y": {**axis, "unit": "deg/s"},
                 "series": [{"name": "after", "x": [1.0, 10.0],
                             "y": [0.1, 0.01]}]}
        for name, sides in (("allan", ["[°/h]"]), ("other", [])):
            axes = style.new_figure(3.0).subplots()
            draw_figure(axes, {"id": name, **shown})
            self.assertEqual([side.get_ylabel() for side in axes.child_axes],
                             sides)

    def test_every_panel_says_what_its_curves_are(self):
        self.cubic_of_a_ramp("train")
        for number, low in enumerate((-20, 0, 15)):
            self.run_scenario(f"ramp{number}", text=ramp(
                seed=5 + number, low=low))
        self.ended("validate", "c.json", "ramp0.h5", "ramp1.h5", "ramp2.h5",
                   "--spec", ROOT / "specs/uav.toml", "--json", "v.json",
                   allowed=(3,))
        result = json.loads((self.dir / "v.json").read_text())
        figure = plots.plot_validation(result)
        drawn = {axes.get_title("left"): axes for axes in figure.axes}
        seen = 0
        for one in result["figures"]:
            axes = drawn.get(style.spoken(one["title"]))
            others = {series["name"].removeprefix("after, ")
                      for series in one["series"]} - {"before", "after"}
            others = {name for name in others
                      if not name.startswith("before, ")}
            if axes is None or not others or len(one["series"]) < 2:
                continue
            seen += 1
            said = {text.get_text().removeprefix("after, ")
                    for text in axes.get_legend().get_texts()}
            self.assertLessEqual({style.spoken(name) for name in others}, said)
        self.assertGreater(seen, 1)

    def test_a_limit_that_no_run_shows_is_drawn_as_undecided(self):
        self.cubic_of_a_ramp("train")
        self.run_scenario("check", text=ramp(seed=5))
        self.ended("validate", "c.json", "check.h5", "--spec",
                   ROOT / "specs/uav.toml", "--json", "v.json", allowed=(3,))
        result = json.loads((self.dir / "v.json").read_text())
        without = [one for one in result["limits"]
                   if (one["compared"] or {}).get("value") is None]
        self.assertGreater(len(without), 0)
        axes = plots.plot_validation(result).axes[0]
        self.assertEqual(len(axes.get_yticks()), len(result["limits"]))
        said = [text.get_text() for text in axes.texts]
        self.assertEqual(said.count("undecided: no run shows it"),
                         len(without))


class Ticks(unittest.TestCase):
    """Of a logarithmic axis, whatever it spans."""

    def test_numbers_never_lie_over_each_other(self):
        random = np.random.default_rng(1)
        spans = [(0.011, 0.09), (0.05, 0.09), (1e-3, 20.0), (1e-9, 1e9),
                 (0.97, 1.02), (2.0, 3.0)]
        for decades in (0.02, 0.1, 0.3, 0.7, 1, 2, 4, 8, 15):
            for low in 10 ** random.uniform(-9, 6, 4):
                spans.append((low, low * 10**decades))
        for (low, high), marks in itertools.product(spans, [(), (1, 2, 5)]):
            if marks and high > 100 * low:
                continue  # for less than two decades
            with plots.look():
                figure = Figure(figsize=(style.WIDTH / 2, 1.8),
                                layout="constrained")
                axes = figure.subplots()
                for axis in (axes.xaxis, axes.yaxis):
                    style.log_scale(axis, marks)
                axes.set(xlim=(low, high), ylim=(low, high))
                figure.draw_without_rendering()
                for axis in (axes.xaxis, axes.yaxis):
                    boxes = [label.get_window_extent()
                             for label in axis.get_ticklabels()
                             if label.get_text()]
                    self.assertGreaterEqual(len(boxes), 2, (low, high))
                    for box, other in itertools.combinations(boxes, 2):
                        self.assertFalse(box.overlaps(other),
                                         (low, high, axis.axis_name))


class Allan(unittest.TestCase):
    def test_it_has_the_units_of_data_sheets_beside_its_own(self):
        points = [{"tau_s": 2.0**k, "deviation": 0.01 / 2**(k / 2)}
                  for k in range(6)]
        noise = {"N": {"per_second": {"value": 0.01, "unit": "deg/sqrt(s)"}}}
        figure = plots.plot_allan({"oadev": points, "noise": noise})
        right, = figure.axes[0].child_axes
        self.assertEqual(right.get_ylabel(), "[°/h]")
        figure.draw_without_rendering()
        np.testing.assert_allclose(
            right.get_ylim(), 3600 * np.array(figure.axes[0].get_ylim()))
        self.assertIn("N = 0.01 °/√s (0.6 °/√h)", "".join(
            text.get_text() for text in figure.texts))
        volts = plots.plot_allan({"oadev": points, "series": {
            "dataset": "output", "unit": "V", "rate_Hz": 1.0, "from_s": 0.0,
            "to_s": 9.0, "samples": 10}})
        self.assertEqual(volts.axes[0].child_axes, [])

    def test_a_line_of_another_height_than_its_letter_says_so(self):
        figure = plots.plot_allan({
            "oadev": [{"tau_s": tau, "deviation": 0.7}
                      for tau in (0.1, 1.0, 10.0)],
            "noise": {"B": {"per_second": {"value": 1.0, "unit": "deg/s"}}},
            "series": {"dataset": "rate", "unit": "deg/s", "rate_Hz": 10.0,
                       "from_s": 0.0, "to_s": 100.0, "samples": 1000}})
        line = figure.axes[0].lines[-1]
        label, = figure.axes[0].texts
        self.assertEqual(label.get_text(), "0.664 B")
        np.testing.assert_allclose(line.get_ydata(), 0.664, atol=5e-4)
        self.assertEqual(label.xy[1], line.get_ydata()[0])


class Compensators(ProgramTest):
    def test_the_curve_is_what_compensate_takes_away(self):
        """Of each kind that files may have, within and beyond the training."""
        self.run_scenario("train", text=ramp(rate_Hz=2))
        self.run_scenario("held", text=ramp(seed=8))
        self.write("model.toml", CUBIC)
        self.ok("train", "train.h5", "--model", "model.toml", "-o", "c.json")
        self.write("lie.json", (self.dir / "c.json").read_text().replace(
            '"kind": "polynomial"', '"kind": ""', 1))
        kinds = set(self.beamgyro(
            "plot", "lie.json", "-o", "p.png").stderr.strip().partition(
                "must be one of ")[2].split(", "))
        self.assertIn("polynomial", kinds)
        quick = {"polynomial": CUBIC, "bp": NETWORK}
        for kind in sorted(kinds - {"resonances"}):  # reads quadrature, too
            text = quick.get(kind) or (MODELS / f"{kind}.toml").read_text()
            self.write("model.toml", text.replace(
                '["temperature", "since_power_on(300)"]', '["temperature"]'))
            self.require_curve()

    def require_curve(self):
        """The curve of a compensator that model.toml describes."""
        self.ok("train", "train.h5", "--held-out", "held.h5", "--model",
                "model.toml", "-o", "c.json")
        axes = plots.plot(self.dir / "c.json").axes[0]
        drawn = {line.get_label(): line for line in axes.lines}
        T, bias = drawn["bias taken away"].get_data()
        low, high = json.loads((self.dir / "c.json").read_text())[
            "temperature_range_degC"]
        self.assertTrue(T[0] < low and T[-1] > high)
        self.write("steps.csv", "time,status,rate,temperature\n" + "".join(
            f"{k},0,0,{value!r}\n" for k, value in enumerate(map(float, T))))
        self.ok("compensate", "c.json", "steps.csv", "-o", "done.h5")
        with h5py.File(self.dir / "done.h5") as file:
            np.testing.assert_array_equal(-file["compensated_rate"][()], bias)
            if (sigma := file.get("compensated_rate_sigma")) is not None:
                self.assertEqual(sigma.shape, T.shape)
        self.ok("plot", "c.json", "-o", "c.svg")
        self.assertIn("bias taken away", (self.dir / "c.svg").read_text())


class Speed(unittest.TestCase):
    def test_a_million_samples_become_a_small_picture(self):
        count = 1_000_000
        data = {"time": np.arange(count) / 100.0,
                "rate": np.sin(np.arange(count)), "temperature":
                np.linspace(-40, 50, count), "true_rate": np.zeros(count)}
        figure = plots.plot_recording(data)
        self.assertLessEqual(max(len(line.get_xdata()) for axes in figure.axes
                                 for line in axes.lines), 2000)
