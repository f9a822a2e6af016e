# SPDX-License-Identifier: MIT
"""sensitivity: indices of a campaign, the same by any way, and bad input."""

import signal
import time

import pytest

from program import PATIENCE, SCENARIO, SCENARIOS, ProgramTest, ramp

CAMPAIGN = """\
name = "three"
device = "device.toml"
devices = 10
seed = 4

[tolerances]
"mount.axis_angle_deg" = {{ normal = {{ mean = 0, sigma = 2.5 }} }}
"readout.offset_tc_deg_per_s_per_K" = {{ normal = {{ mean = 0, sigma = 0.05 }} }}
"noise.turn_on_deg_per_s" = {{ uniform = {{ low = 0.01, high = 0.02 }} }}
{more}
[[run]]
name = "rest"
scenario = "rest.toml"
"""
PP = "bias_pp_deg_per_s"
FIGURES = [PP, "cubic_rms_deg_per_s", "scale_factor_drift_rel",
           "warm_up_change_deg_per_s"]
TURN_ON = "noise.turn_on_deg_per_s"


class Sensitivity(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("rest.toml", SCENARIO)
        self.write("c.toml", CAMPAIGN.format(more=""))

    def found(self, *arguments, samples=256):
        """Printed text, and what the JSON file says."""
        text = self.ok("sensitivity", "c.toml", "--samples", samples, "--json",
                       "s.json", *arguments)
        return text, self.json("s.json")

    def test_devices_that_never_lock_or_are_saturated_are_said(self):
        self.assertEqual(self.warned("sensitivity", "c.toml", "--samples", 32), "")
        for key, value, says in [
                ("drive.voltage_limit_V", 0.01, "drive.voltage_limit_V at some"),
                ("readout.full_scale_deg_per_s", 0.01, "output saturates there")]:
            self.write("bad.toml", CAMPAIGN.format(
                more=f'"{key}" = {{ uniform = {{ low = {value}, '
                     f'high = {2 * value} }} }}'))
            said = self.warned("sensitivity", "bad.toml", "--samples", 32)
            self.assertRegex(said, r"three: (\d+) of \1 devices ")
            self.assertIn(says, said)

    def test_the_table_and_the_file_have_the_indices_by_their_totals(self):
        text, found = self.found()
        self.assertEqual(list(found["figures"]), FIGURES)
        for name, figure in found["figures"].items():
            indices = figure["indices"]
            self.assertEqual(figure["samples"], 256)
            self.assertEqual(len(indices), 3)
            totals = [index["total"] for index in indices]
            self.assertEqual(totals, sorted(totals, reverse=True))
            for index in indices:
                for kind in ["first", "total"]:
                    low, high = index[f"{kind}_interval"]
                    self.assertLessEqual(low, high)
                self.assertRegex(text, rf"{index['key']} +-?\d\.\d\d\d")
            # What a static figure cannot see has no index.
            last = indices[-1]
            self.assertEqual((last["key"], last["total"], last["first"]),
                             (TURN_ON, 0, 0))
            signed = name == "warm_up_change_deg_per_s"
            self.assertEqual(figure["of"], name if signed else f"ln {name}")
        self.assertIn("Sum of the first orders", text)
        self.assertEqual(found["devices"], 256 * 6)
        self.assertEqual(found["failures"], 0)

    def test_the_bytes_depend_on_the_seed_and_not_on_the_threads(self):
        texts = []
        for jobs, seed in [(1, 5), (3, 5), (2, 6)]:
            text, _ = self.found("--figure", PP, "--jobs", jobs, "--seed", seed,
                                 "--limit", f"{PP}=3")
            texts.append((text, (self.dir / "s.json").read_bytes()))
        self.assertEqual(texts[0], texts[1])
        self.assertNotEqual(texts[0][1], texts[2][1])

    def test_a_limit_adds_the_yield_with_each_tolerance_halved(self):
        text, found = self.found("--figure", PP)
        median = found["figures"][PP]["median"]
        self.assertIsNone(found["figures"][PP]["yield"])
        text, found = self.found("--figure", PP, "--limit", f"{PP}={median}")
        good = found["figures"][PP]["yield"]
        self.assertAlmostEqual(good["as_is"], 0.5, delta=0.005)
        self.assertIn("as they are", text)
        halved = {each["key"]: each["yield"] for each in good["halved"]}
        self.assertEqual(halved[TURN_ON], good["as_is"])
        first = found["figures"][PP]["indices"][0]["key"]
        self.assertGreater(halved[first], good["as_is"])
        self.assertEqual(good["halved"][0]["key"], first)

    def test_two_tolerances_at_once_and_the_width_for_a_yield(self):
        text, found = self.found("--figure", PP)
        limit = found["figures"][PP]["median"]
        text, found = self.found("--figure", PP, "--limit", f"{PP}={limit}",
                                 "--yield", "0.7", samples=1024)
        good = found["figures"][PP]["yield"]
        self.assertEqual(len(good["pairs"]), 3)
        best = max(each["yield"] for each in good["halved"])
        self.assertGreater(good["pairs"][0]["yield"], best)
        self.assertEqual(set(good["pairs"][0]["keys"]), {
            "mount.axis_angle_deg", "readout.offset_tc_deg_per_s_per_K"})
        self.assertIn("Two of them at once:\n", text)
        self.assertIn("Width of one tolerance for a yield of 70 %", text)
        width = {each["key"]: each["width"] for each in good["needed"]}
        self.assertIsNone(width[TURN_ON])
        self.assertEqual(good["target"], 0.7)
        first = good["needed"][0]
        narrow, wide = first["width_interval"]
        self.assertTrue(0.125 < narrow < first["width"] < wide < 1)
        # A campaign with that tolerance, of other devices, has the yield.
        self.assertEqual(first["key"], "mount.axis_angle_deg")
        self.write("c.toml", CAMPAIGN.format(more="").replace(
            "sigma = 2.5", f"sigma = {2.5 * first['width']}"))
        _, again = self.found("--figure", PP, "--limit", f"{PP}={limit}",
                              "--seed", "77", samples=1024)
        # Three standard deviations of two shares of 1024.
        self.assertAlmostEqual(again["figures"][PP]["yield"]["as_is"], 0.7,
                               delta=3 * (2 * 0.21 / 1024) ** 0.5)

    def test_a_figure_as_it_is_has_other_indices_than_its_logarithm(self):
        _, logarithm = self.found("--figure", PP)
        _, linear = self.found("--figure", PP, "--linear")
        self.assertEqual(linear["figures"][PP]["of"], PP)
        self.assertEqual(linear["figures"][PP]["median"],
                         logarithm["figures"][PP]["median"])
        self.assertNotEqual(linear["figures"][PP]["indices"],
                            logarithm["figures"][PP]["indices"])

    def test_a_compensator_is_scored_on_every_device(self):
        self.run_scenario("train", text=ramp())
        self.train_on("train.h5", to="cubic.json")
        name = "compensator_rms_deg_per_s"
        _, found = self.found("--compensator", "cubic.json", "--figure", PP)
        self.assertEqual(list(found["figures"]), [PP, name])
        # Trained on one unit, it leaves the others about what they have.
        self.assertGreater(found["figures"][name]["median"], 0)
        self.rejected("sensitivity", "c.toml", "--figure", name,
                      says="expected a compensator with it")

    def test_correlated_tolerances_are_one_factor(self):
        self.write("c.toml", CAMPAIGN.format(
            more='[[correlated]]\nkeys = ["mount.axis_angle_deg", '
                 f'"{TURN_ON}"]\ncorrelation = 0.5\n'))
        _, found = self.found("--figure", PP)
        self.assertEqual({index["key"]
                          for index in found["figures"][PP]["indices"]},
                         {f"mount.axis_angle_deg + {TURN_ON}",
                          "readout.offset_tc_deg_per_s_per_K"})

    def test_devices_that_do_not_work_are_counted_and_named(self):
        self.write("c.toml", CAMPAIGN.format(
            more='"bond.thickness_m" = { normal = { mean = 30e-6, '
                 'sigma = 15e-6 } }\n'))
        text, found = self.found("--figure", PP)
        self.assertGreater(found["failures"], 0)
        self.assertIn("do not work", text)
        self.assertIn("bond.thickness_m", found["first_failure"])
        figure = found["figures"][PP]
        self.assertLess(figure["rows"], figure["samples"])
        self.assertTrue(all(index["rows"] <= figure["rows"]
                            for index in figure["indices"]))

    def test_what_no_tolerance_changes_is_said(self):
        self.write("c.toml", CAMPAIGN.format(more="").replace(
            "mount.axis_angle_deg", "noise.bias_instability_deg_per_s").replace(
            "mean = 0, sigma = 2.5", "mean = 0.01, sigma = 0.001").replace(
            "readout.offset_tc_deg_per_s_per_K", "temperature_sensor.offset_K"))
        text, found = self.found("--figure", PP)
        self.assertIn("No tolerance of the campaign changes", text)
        self.assertEqual(found["figures"][PP]["variance"], 0)
        self.assertTrue(all(index["total"] == 0 for index in
                            found["figures"][PP]["indices"]))

    # A fact of one campaign that sensitivity.md states; how indices and their
    # order are estimated has tests in test.sh.
    @pytest.mark.deep
    def test_the_first_five_of_the_shipped_population_are_certain(self):
        # Between two estimators of the total index and two seeds, and the
        # largest first order between two estimators. The fourth and the fifth
        # have total indices of 0.10 and 0.06, the sixth has 0.04.
        orders = set()
        for seed in [30, 31]:
            self.ok("sensitivity", SCENARIOS / "campaigns/population.toml",
                    "--figure", PP, "--seed", seed, "--samples", 2048,
                    "--json", "p.json")
            indices = self.json("p.json")["figures"][PP]["indices"]
            for estimator in ["total", "total_by_product"]:
                indices.sort(key=lambda index: -index[estimator])
                orders.add(tuple(index["key"] for index in indices[:5]))
            for estimator in ["first", "first_by_rank"]:
                self.assertEqual(
                    max(indices, key=lambda index: index[estimator])["key"],
                    "mount.axis_angle_deg")
        self.assertEqual(orders, {(
            "mount.axis_angle_deg", "patches.offset_m",
            "mount.glassy_stiffness_share", "readout.quadrature_trim_deg_per_s",
            "readout.offset_tc_deg_per_s_per_K")})

    def test_an_interruption_leaves_no_file(self):
        with self.working("sensitivity", "c.toml", "--samples", 1000000,
                          "--json", "s.json", until="c.toml") as work:
            time.sleep(1)
            work.send_signal(signal.SIGINT)
            work.communicate(timeout=PATIENCE)
        self.assertEqual(work.returncode, -signal.SIGINT)
        self.assertEqual(list(self.dir.glob("s.json*")), [])

    def test_wrong_words_are_refused(self):
        def refused(*words, says, campaign="c.toml"):
            self.rejected("sensitivity", campaign, *words, says=says)

        refused("--figure", "bias_pp", says=["--figure bias_pp", f'"{PP}"'])
        refused("--samples", 8, says=["--samples 8", "32"])
        refused("--samples", "many", says="--samples many")
        refused("--seed", -1, says="--seed -1")
        refused("--jobs", 0, says="--jobs 0")
        refused("--range", "-40", says=["--range -40", "LOW:HIGH"])
        refused("--range", "50:-40", says=["--range 50:-40", "LOW"])
        refused("--range", "-40:900", says=["--range", "150"])
        refused("--limit", "2", says=["--limit 2", "FIGURE=VALUE"])
        refused("--limit", "bias=2", says="--limit bias")
        refused("--limit", f"{PP}=much", says="--limit much")
        refused("--limit", f"{PP}=0", says="--limit 0")
        refused("--yield", "0.9", says="yield 0.9 of no limit")
        refused("--limit", f"{PP}=2", "--yield", "1", says="--yield 1")
        refused("--limit", f"{PP}=2", "--limit", f"{PP}=3", says="already")
        refused("--limit", f"{PP}=2", "--figure", FIGURES[1],
                says=f"limit 2 of {PP}, which is not studied")
        refused("--compensator", "none.json", says="none.json")
        refused("--compensator", "c.toml", says="c.toml")
        refused("--json", "c.toml", says="c.toml")
        refused("--json", "rest.toml", says="rest.toml")
        refused("--pictures", "p.json", says="--pictures p.json")
        refused("--pictures", "c.toml/p", says="--pictures c.toml/p")
        refused(says="none.toml", campaign="none.toml")
        refused(says=["rest.toml", "a scenario"], campaign="rest.toml")

    def test_a_campaign_with_nothing_to_compare_is_refused(self):
        lines = CAMPAIGN.format(more="").splitlines()
        one = [line for line in lines
               if not line.startswith(('"readout', '"noise'))]
        self.write("one.toml", "\n".join(one))
        self.rejected("sensitivity", "one.toml",
                      says=["one.toml", "only mount.axis_angle_deg"])
        none = [line for line in one if not line.startswith('"mount')]
        self.write("no.toml", "\n".join(none))
        self.rejected("sensitivity", "no.toml",
                      says=["no.toml", "no device differs"])

    def test_bar_charts_are_drawn(self):
        pytest.importorskip("matplotlib")
        self.found("--pictures", "p")
        self.assertEqual(sorted(path.name for path in (self.dir / "p").iterdir()),
                         sorted([f"{name}.png" for name in FIGURES] +
                                ["result.json"]))
        self.assertSameBytes("p/result.json", "s.json")
