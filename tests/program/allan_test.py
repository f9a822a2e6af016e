# SPDX-License-Identifier: MIT
"""`allan` of the shipped program: coefficients, gaps, units and windows."""

import numpy as np

from bench_log import table
from program import ProgramTest, SCENARIO

HERTZ = 100.0
SAMPLES = 1 << 17
N = 0.02  # [deg/sqrt(s)], 1.2 deg/sqrt(h)


def normals(purpose):
    """From a counter-based stream of its own."""
    return np.random.Generator(np.random.Philox(key=[40, purpose])).normal(
        size=SAMPLES)


def band_limited(rate, pole=0.02):
    """Through two equal poles [s], as an output filter."""
    keep = np.exp(-1 / (HERTZ * pole))
    for _ in range(2):
        state, answer = 0.0, np.empty_like(rate)
        for k, value in enumerate(rate):
            state = keep * state + (1 - keep) * value
            answer[k] = state
        rate = answer
    return rate


class Allan(ProgramTest):
    def noise(self, *arguments):
        """Printed text, warnings, and what the JSON file says."""
        answer = self.ended("allan", *arguments, "--json", "a.json")
        return (answer.stdout, answer.stderr, self.json("a.json"))

    def random_walk(self, found):
        return found["noise"]["N"]["per_second"]["value"]

    def test_a_filter_does_not_make_the_white_noise_less(self):
        rate = band_limited(normals(1) * N * HERTZ**0.5)
        self.write("s.csv", table("rate", zip(rate)))
        text, _, found = self.noise("s.csv", "--rate-Hz", HERTZ, "--unit",
                                    "deg/s")
        # 1-sigma of N over the taus that are left is 0.7 %; the fit may be
        # 2 % low.
        self.assertAlmostEqual(self.random_walk(found) / N, 1, delta=0.04)
        fit = found["noise"]["fit"]
        self.assertIn(0.01, [tau["tau_s"] for tau in fit["left_out"]])
        self.assertNotIn(0.01, fit["taus_s"])
        self.assertIn("left out: 0.01 s", text)
        self.assertRegex(text, r"fitted to \d+ taus")
        self.assertEqual(found["noise"]["N"]["per_hour"]["unit"],
                         "deg/sqrt(h)")
        self.assertAlmostEqual(
            found["noise"]["N"]["per_hour"]["value"],
            60 * self.random_walk(found), places=12)

    def test_a_time_column_sets_the_rate_and_shows_the_gaps(self):
        rate = normals(2) * N * HERTZ**0.5
        kept = np.arange(SAMPLES) % 7 != 3
        self.write("s.csv", table("time,rate", zip(
            np.arange(SAMPLES)[kept] / HERTZ, rate[kept])))
        text, errors, found = self.noise("s.csv", "--unit", "deg/s")
        missing = np.flatnonzero(kept)[-1] + 1 - kept.sum()
        self.assertEqual(found["series"]["samples"], kept.sum())
        self.assertEqual(found["series"]["missing"], missing)
        self.assertAlmostEqual(found["series"]["rate_Hz"], HERTZ, places=6)
        # Of white noise 0.1 %, over 16 octaves.
        self.assertAlmostEqual(self.random_walk(found) / N, 1, delta=0.01)
        self.assertGreater(found["oadev"][-1]["tau_s"], 300)
        used = f"{kept.sum()} samples at 100 Hz"
        self.assertIn(used, text)
        self.assertIn(f"{kept.sum()} of {kept.sum()} samples used; "
                      f"{missing} missing", errors)
        self.rejected("allan", "s.csv", "--rate-Hz", 50,
                      says="say 100 Hz; expected no --rate-Hz")

    def test_a_csv_has_the_unit_that_is_stated(self):
        self.write("s.csv", table("output", zip(normals(3))))
        text, errors, found = self.noise("s.csv", "--rate-Hz", HERTZ, "--unit",
                                         "V")
        self.assertNotIn("deg", text)
        self.assertIn("oadev V", text)
        self.assertEqual(errors, "")
        self.assertEqual(found["noise"]["N"]["per_second"]["unit"],
                         "V sqrt(s)")
        text, errors, assumed = self.noise("s.csv", "--rate-Hz", HERTZ)
        self.assertIn("states no unit; taken as deg/s", errors)
        self.assertIn("states no unit", assumed["warnings"][0])
        _, _, radians = self.noise("s.csv", "--rate-Hz", HERTZ, "--unit",
                                   "rad/s")
        for one, other in zip(assumed["oadev"], radians["oadev"]):
            self.assertAlmostEqual(
                np.degrees(one["deviation"]) / other["deviation"], 1,
                places=12)
        self.assertEqual(radians["series"]["unit"], "deg/s")

    def test_the_times_of_a_csv_are_in_the_unit_of_their_column(self):
        rate = normals(4) * N * HERTZ**0.5 * 3600
        seconds = np.arange(SAMPLES) / HERTZ
        for header, per_second in [("time", 1), ("time_s", 1), ("time [s]", 1),
                                   ("time [ms]", 1e3), ("time [us]", 1e6),
                                   ("time [ns]", 1e9), ("time [min]", 1 / 60),
                                   ("time [h]", 1 / 3600)]:
            self.write("s.csv", table(f"{header},rate [deg/h]",
                                      zip(seconds * per_second, rate)))
            _, errors, found = self.noise("s.csv")
            self.assertEqual(errors, "")
            self.assertAlmostEqual(found["series"]["rate_Hz"], HERTZ, places=6)
            self.assertAlmostEqual(found["series"]["to_s"], seconds[-1],
                                   places=6)
            # Of white noise 0.1 %, over 16 octaves.
            self.assertAlmostEqual(self.random_walk(found) / N, 1, delta=0.01)

    def test_a_window_of_time(self):
        text = SCENARIO.replace("output_rate_Hz = 2", "output_rate_Hz = 10")
        self.run_scenario("run", text=text)
        _, _, found = self.noise("run.h5", "--from", 100, "--to", 300)
        run = self.signals("run.h5")
        within = (run["time"] >= 100) & (run["time"] <= 300)
        self.write("s.csv", table("rate", zip(run["rate"][within])))
        _, _, same = self.noise("s.csv", "--rate-Hz", 10, "--unit", "deg/s")
        self.assertEqual(found["series"]["samples"], within.sum())
        self.assertEqual(found["series"]["from_s"], 100)
        for one, other in zip(found["adev"], same["adev"]):
            self.assertAlmostEqual(one["deviation"] / other["deviation"], 1,
                                   places=9)

    def test_a_constant_has_a_curve_and_no_coefficients(self):
        self.write("s.csv", "5\n" * 500)
        text = self.ok("allan", "s.csv", "--rate-Hz", 10, "--json", "a.json")
        self.assertIn("oadev deg/s", text)
        self.assertNotIn("random walk", text)


class Kinds(ProgramTest):
    def white(self):
        rate = normals(4)[:1 << 12] * N * HERTZ**0.5
        self.write("s.csv", table("rate", zip(rate)))
        return ["s.csv", "--rate-Hz", HERTZ, "--unit", "deg/s"]

    def found(self, *arguments):
        text = self.ok("allan", *self.white(), *arguments, "--json", "a.json")
        return text, self.json("a.json")

    def test_the_kinds_asked_for_are_printed_and_written(self):
        kinds = ["adev", "oadev", "mdev", "hdev", "ohdev", "totdev"]
        text, answer = self.found("--kind", ",".join(kinds))
        self.assertEqual([key for key in answer if key.endswith("dev")],
                         kinds)
        for kind in kinds:
            self.assertIn(f"{kind} deg/s", text)
            for point in answer[kind]:
                low, high = point["interval"]
                self.assertLess(low, point["deviation"])
                self.assertLess(point["deviation"], high)
            # Of white noise mdev falls to 1/sqrt(2) of the others.
            law = N / point["tau_s"]**0.5
            self.assertLess(low / law, 1)
            self.assertGreater(high / law, 0.7)
        self.assertIn("95 % of totdev", text)
        again, _ = self.found("--kind", "hdev", "--kind", "hdev")
        self.assertEqual(again.count("hdev deg/s"), 1)

    def test_taus_are_octaves_decades_or_all(self):
        _, octave = self.found()
        _, decade = self.found("--taus", "decade")
        _, every = self.found("--taus", "all", "--kind", "oadev")
        taus = [round(point["tau_s"] * HERTZ) for point in decade["adev"]]
        self.assertEqual(taus, [1, 2, 4, 10, 20, 40, 100, 200, 400, 1000,
                                2000])
        self.assertEqual(len(every["oadev"]), 2048)
        self.assertEqual(len(octave["oadev"]), 12)
        # The coefficients are those of the octaves.
        self.assertEqual(octave["noise"], decade["noise"])
        self.assertEqual(octave["noise"], every["noise"])
        self.assertNotIn("adev", every)

    def test_coefficients_have_intervals_in_both_units(self):
        text, answer = self.found()
        found = answer["noise"]["N"]
        low, high = found["per_second"]["interval"]
        self.assertLess(low, N)
        self.assertGreater(high, N)
        for one, other in zip(found["per_second"]["interval"],
                              found["per_hour"]["interval"]):
            self.assertAlmostEqual(60 * one, other, places=12)
        self.assertIn(f"{60 * low:.4g} to {60 * high:.4g}", text)
        self.assertIn(f"{low:.4g} to {high:.4g}", text)
