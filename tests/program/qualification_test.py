# SPDX-License-Identifier: MIT
"""`validate --device`: qualifications, populations, wrong input."""

import shutil

from program import (CUBIC, SCENARIOS, ProgramTest, by_name, failed,
                     limits)
from qualified import DEVICE, NOMINAL, Qualified, SHORT, SPECIFICATION


class Verdicts(Qualified):
    def test_a_model_is_trained_and_judged(self):
        said, answer = self.validate()
        self.assertEqual(said["compensator"]["kind"], "model")
        residual = by_name(said["metrics"])["residual_rms_deg_per_s"]
        self.assertLess(residual["after"]["value"],
                        0.5 * residual["before"]["value"])
        self.assertEqual(residual["baselines"]["none"], residual["before"])
        # The model is a cubic, and so is the baseline, of the same runs.
        self.assertEqual(residual["baselines"]["cubic"]["value"],
                         residual["after"]["value"])
        self.assertLess(residual["after"]["value"],
                        residual["baselines"]["constant"]["value"])
        for name in ("constant", "cubic", "spline"):
            self.assertIn(name, answer.stdout)
        for line in answer.stdout.splitlines():
            self.assertLessEqual(len(line), 100, line)

    def test_a_compensator_file_gives_the_figures_of_its_model(self):
        of_file, _ = self.validate(model=self.trained_file())
        of_model, _ = self.validate()
        self.assertEqual(of_file["metrics"], of_model["metrics"])

    def test_training_runs_among_the_scored_ones_are_found(self):
        self.write("q.toml", SHORT.replace('scenario = "ramp.toml"\n\n',
                                           'scenario = "ramp.toml"\n'
                                           '[run.overrides]\n'
                                           '"ambient.points" = '
                                           '[[0, 45], [4000, -35]]\n\n', 1))
        said, _ = self.validate(status=3, model=self.trained_file(
            "--set", "ambient.points=[[0, 45], [4000, -35]]"))
        self.assertIn("hold_out", failed(said))
        self.assertIn("hold_out", said["words"])

    def test_limits_decide(self):
        said, answer = self.validate("--spec", "spec.toml", status=3)
        results = {limit["metric"]: limit for limit in said["limits"]}
        self.assertEqual(results["residual_rms_deg_per_s"]["result"], "fail")
        self.assertLess(results["residual_rms_deg_per_s"]["margin"], 0)
        self.assertEqual(results["residual_max_deg_per_s"]["result"], "pass")
        self.assertEqual(said["verdict"], "fail")
        self.assertIn("\nFAIL: Not met: residual_rms_deg_per_s", answer.stdout)
        residual = by_name(said["metrics"])["residual_rms_deg_per_s"]
        self.assertEqual((residual["limit"], residual["result"]), (0.1, "fail"))

    def test_limits_below_the_noise_are_named_first(self):
        # The turn-on offset alone is 0.03 deg/s; no run is a rate table.
        self.write("spec.toml", SPECIFICATION.replace("0.1", "1e-4") + (
            'scale_factor_error_ppm = { max = 100, source = "a test" }\n'))
        said, answer = self.validate("--spec", "spec.toml", status=3)
        residual, scale = said["warnings"][:2]
        self.assertIn("residual_rms_deg_per_s, at most 0.0001: cannot be "
                      "decided, because a gyro without any error", residual)
        self.assertIn("scale_factor_error_ppm, at most 100: cannot be "
                      "decided, because no run shows it", scale)
        first, second = answer.stderr.splitlines()[:2]
        self.assertIn(residual, first)
        self.assertIn(scale, second)
        self.assertEqual(answer.stderr.count(residual), 1)

    def test_a_metric_reads_the_runs_that_are_named(self):
        rms = []
        for named in "", '\n[metrics]\nresidual_rms_deg_per_s = ["warm_up"]\n':
            self.write("q.toml", SHORT + named)
            said, _ = self.validate()
            rms.append(by_name(said["metrics"])["residual_rms_deg_per_s"])
        self.assertNotEqual(*[one["before"]["value"] for one in rms])

    def test_the_result_depends_on_no_thread(self):
        texts = set()
        for jobs in 1, 2, 5:
            _, answer = self.validate("--jobs", jobs, "--campaign",
                                      "campaign.toml", "--report", "page")
            texts.add((answer.stdout, self.text("v.json"),
                       self.text("page/index.html")))
        self.assertEqual(len(texts), 1)

    def test_a_recording_of_the_qualification_is_that_of_run(self):
        """The raw figures are those of the recordings that `run` makes."""
        self.ok("run", "ramp.toml", "-o", "ramp.h5")
        self.ok("run", "warm_up.toml", "--seed", 12, "--set",
                "ambient.constant_degC=12", "-o", "warm_up.h5")
        simulated, _ = self.validate(model=self.trained_file())
        recorded, _ = self.validated("c.json", "ramp.h5", "warm_up.h5")
        for one, other in zip(simulated["metrics"], recorded["metrics"]):
            self.assertEqual(one["name"], other["name"])
            self.assertEqual(one["before"], other["before"], one["name"])
            self.assertEqual(one["after"], other["after"], one["name"])

    def test_a_compensator_without_an_answer_is_judged(self):
        self.write("q.toml", SHORT + """
[[run]]
name = "rest"
purpose = "rest"
scenario = "warm_up.toml"
[run.overrides]
seed = 41
""")
        for command in ("cmd:false", "cmd:cat >/dev/null", "cmd:yes nan"):
            said, answer = self.validate("--report", "page", model=command,
                                         status=3)
            self.assertEqual(said["verdict"], "fail")
            failed, passed = (
                [check["name"] for check in said["checks"]
                 if check["passed"] is state] for state in (False, True))
            self.assertIn("answers", failed)
            self.assertNotIn("reset", passed)
            self.assertNotIn("real_time", passed)
            for metric in said["metrics"]:
                if metric["name"] != "turn_on_time_s":
                    value = (metric["after"] or {}).get("value")
                    self.assertIsNone(value, metric["name"])
            self.assertTrue((self.dir / "page/index.html").exists())
            shutil.rmtree(self.dir / "page")

    def test_a_model_learns_the_scale_factor_from_runs_that_turn(self):
        table = """
[[run]]
name = "table"
purpose = "rate_table"
scenario = "ramp.toml"
[run.overrides]
"ambient.points" = [[0, -20]]
"rate.steps" = [[0, 0], [800.5, -80], [1400.5, -40], [2000.5, 0], [2600.5, 40], [3200.5, 80]]
seed = 31
"""
        turning = """
[[training]]
name = "turning"
scenario = "ramp.toml"
scale_factor = true
[training.overrides]
"ambient.points" = [[0, -20]]
"rate.steps" = [[0, 100], [1500.5, -100]]
seed = 32
"""
        found = {}
        for name, runs in (("without", table), ("with", table + turning)):
            self.write("q.toml", SHORT + runs)
            for model, addition in (("cubic", ""), ("both",
                                                    "[scale_factor]\n")):
                if (name, model) == ("without", "both"):
                    continue  # has nothing to learn it from
                self.write("m.toml", CUBIC + addition)
                said, _ = self.validate(model="m.toml")
                found[name, model] = by_name(said["metrics"])
        # Models and baselines that know no scale factor are as without it.
        self.assertEqual(found["with", "cubic"], found["without", "cubic"])
        for metric, one in found["with", "both"].items():
            self.assertEqual(one["baselines"],
                             found["with", "cubic"][metric]["baselines"])
        error = {key: one["scale_factor_error_ppm"]["after"]["value"]
                 for key, one in found.items()}
        self.assertGreater(error["with", "cubic"], 1000)
        self.assertLess(error["with", "both"], 400)


class Populations(Qualified):
    def test_every_device_is_decided_on(self):
        self.write("spec.toml", SPECIFICATION.replace("0.1,", "5,"))
        said, answer = self.validate("--campaign", "campaign.toml",
                                     "--devices", 4, "--spec", "spec.toml")
        found = said["population"]
        self.assertEqual(found["devices"], 4)
        self.assertTrue(found["trained_on_each"])
        self.assertEqual(found["passed"] + found["failed"]
                         + found["undecided"], 4)
        self.assertEqual(found["passed"], 4)
        # Clopper and Pearson: all of n pass with 0.025^(1/n) or more.
        self.assertAlmostEqual(found["interval"][0], 0.025 ** 0.25, delta=1e-9)
        self.assertEqual(found["interval"][1], 1)
        self.assertIn("4 of 4 devices pass", answer.stdout)
        metric = found["metrics"][0]
        self.assertEqual(len(set(metric["after"])), 4)

    def test_a_device_trained_for_itself_is_better_than_one_for_all(self):
        arguments = ["--campaign", "campaign.toml", "--spec", "spec.toml"]
        each, _ = self.validate(*arguments)
        one, _ = self.validate(*arguments, model=self.trained_file())
        self.assertFalse(one["population"]["trained_on_each"])

        def worst(said):
            return max(said["population"]["metrics"][0]["after"])
        self.assertLess(worst(each), worst(one))

    def test_a_limit_on_the_extrapolated_share_is_decided_for_a_file(self):
        self.write("spec.toml", limits(extrapolated_share_percent=90))
        arguments = ["--campaign", "campaign.toml", "--spec", "spec.toml"]
        for model in (self.trained_file(), "cubic.toml"):
            said, _ = self.validate(*arguments, model=model)
            self.assertEqual(said["population"]["passed"], 3, model)

    def test_the_words_of_a_device_name_the_limit_that_decided(self):
        # Below no limit, near the second and beyond the third.
        self.write("spec.toml", limits(
            residual_max_deg_per_s=500, rate_ramp_deg_per_h_per_h=1,
            residual_rms_deg_per_s=1e-6))
        said, _ = self.validate("--campaign", "campaign.toml", "--spec",
                                "spec.toml", status=3)
        for device in said["population"]["verdicts"]:
            self.assertEqual(device["verdict"], "fail")
            self.assertRegex(device["words"],
                             "^residual_rms_deg_per_s: .* beyond by ")

    def test_a_device_that_cannot_be_trained_fails_and_was_simulated(self):
        # One step of the thermometer covers every temperature.
        self.change("campaign.toml", '^"readout.*', '"temperature_sensor.'
                    'resolution_K" = { discrete = { values = [0.0625, 1000], '
                    "weights = [1, 1] } }")
        said, _ = self.validate("--campaign", "campaign.toml", "--devices", 6,
                                "--spec", "spec.toml")
        found = said["population"]
        untrained = [device for device in found["verdicts"]
                     if device["words"].startswith("cannot be trained: ")]
        self.assertIn(len(untrained), range(1, 6), found["verdicts"])
        for device in untrained:
            self.assertEqual(device["verdict"], "fail")
            self.assertIn("temperature", device["words"])
        self.assertEqual(found["not_simulated"], 0)

    def test_a_device_whose_drive_never_locks_fails(self):
        """However little drift it shows to a compensator that it did not
        train."""
        self.write("spec.toml", limits(residual_rms_deg_per_s=1e6))
        self.change("campaign.toml", '^"readout.*', '"drive.voltage_limit_V" = '
                    "{ discrete = { values = [0.01, 5], weights = [1, 1] } }")
        said, _ = self.validate("--campaign", "campaign.toml", "--devices", 6,
                                "--spec", "spec.toml",
                                model=self.trained_file())
        words = [device["words"] for device in said["population"]["verdicts"]]
        unlocked = [one for one in words if one.startswith(
            "the drive loop never locks in ")]
        self.assertIn(len(unlocked), range(1, 6), words)
        self.assertEqual(said["population"]["failed"], len(unlocked))

    def test_a_device_that_cannot_be_built_is_not_simulated(self):
        self.change("campaign.toml", '^"readout.*', '"bond.thickness_m" = '
                    "{ normal = { mean = 1e-5, sigma = 1e-5 } }")
        said, _ = self.validate("--campaign", "campaign.toml", "--devices",
                                12, "--spec", "spec.toml", status=3)
        found = said["population"]
        self.assertIn(found["not_simulated"], range(1, 12))
        self.assertLessEqual(found["not_simulated"], found["failed"])


class WrongFiles(Qualified):
    def refused(self, says, *arguments, model="cubic.toml"):
        self.rejected("validate", model, *DEVICE, *arguments, says=says)

    def test_wrong_qualifications(self):
        for change, says in [
                (("scenario = \"ramp.toml\"", "scenario = \"rump.toml\""),
                 ["q.toml:6:12: run[0].scenario", "rump.toml"]),
                (("purpose = \"ramp\"", "purpose = \"rump\""),
                 ["q.toml:5:11: run[0].purpose", '"rump"']),
                (("purpose = \"ramp\"\n", ""), "run[0].purpose"),
                (("name = \"ramp\"\n", ""), "run[0].name"),
                (("name = \"ramp\"", "name = \"Ramp 1\""),
                 ["q.toml:4:8: run[0].name", "Ramp 1", "a-z"]),
                (("name = \"warm_up\"", "name = \"ramp\""),
                 ["q.toml:9:8: run[1].name", "another run"]),
                (("seed = 12", "seed = 11"),
                 ["run[1].name", '"warm_up"', "seed 11", '"ramp"']),
                (("seed = 12", "sed = 12"),
                 ["q.toml:14:7: run[1].overrides.sed", "no such key", "seed"]),
                (("seed = 12", "seed = -1"), ["run[1].overrides.seed", "-1"]),
                (("\"ambient.constant_degC\" = 12",
                  "\"ambient.constant_degC\" = 1200"),
                 ["run[1].overrides", "1200"]),
                (("held_out = true", "held_out = 1"),
                 ["q.toml:26:12: training[1].held_out"]),
                (("purpose = \"warm_up\"", "purpose = \"warm_up\"\n"
                  "from_s = 600"), ["run[1].from_s", "600 s", "duration_s"]),
                (("purpose = \"warm_up\"", "purpose = \"warm_up\"\n"
                  "from_s = -1"), ["run[1].from_s", "-1"]),
                (("purpose = \"warm_up\"", "porpoise = \"warm_up\""),
                 "run[1].purpose"),
                (("name = \"short\"", "name = \"short\"\nruns = 3"),
                 ["q.toml:2:1: runs", "unknown key"]),
                (("name = \"short\"", "name = 3"), "q.toml:1:8: name"),
                (("name = \"short\"", "name = "), "q.toml:1")]:
            self.assertIn(change[0], SHORT)
            self.write("q.toml", SHORT.replace(*change, 1))
            self.refused(says)

    def test_a_qualification_without_runs(self):
        training = SHORT[SHORT.index("[[training]]"):]
        self.write("q.toml", 'name = "none"\n' + training)
        self.refused(["q.toml", "run", "at least one"])

    def test_every_training_run_held_out(self):
        head = SHORT[:SHORT.index("[[training]]")]
        self.write("q.toml", head + '[[training]]\nname = "a"\n'
                   'scenario = "ramp.toml"\nheld_out = true\n'
                   '[training.overrides]\nseed = 5\n')
        self.refused(["training", "held out"])

    def test_a_run_is_not_held_out_and_for_the_scale_factor(self):
        self.change("q.toml", "held_out = true",
                    "held_out = true\nscale_factor = true")
        self.refused(["training[1].scale_factor", "held_out"])

    def test_nothing_to_train_on(self):
        self.write("q.toml", SHORT[:SHORT.index("[[training]]")])
        self.refused(["q.toml", "[[training]]", "cubic.toml"])
        self.trained_file()
        self.write("spec.toml", 'name = "s"\n[limits_relative_to.cubic]\n'
                   'residual_rms_deg_per_s = { max = 1, source = "a test" }\n')
        self.refused(["spec.toml:3", "residual_rms_deg_per_s", "cubic"],
                     "--spec", "spec.toml", model="c.json")

    def test_metrics_of_the_qualification(self):
        for line, says in [
                ('residual_rms = ["ramp"]',
                 ["metrics.residual_rms", "residual_rms_deg_per_s"]),
                ('residual_rms_deg_per_s = ["rmp"]',
                 ["metrics.residual_rms_deg_per_s[0]", '"rmp"', '"ramp"']),
                ('scale_factor = ["ramp"]',
                 ["metrics.scale_factor[0]", "rate_table"]),
                ('scale_factor = "ramp"', "metrics.scale_factor")]:
            self.write("q.toml", f"{SHORT}\n[metrics]\n{line}\n")
            self.refused(says)

    def test_a_wrong_scenario_is_named_by_its_own_place(self):
        self.change("warm_up.toml", "duration_s = 600", "duration_s = -600")
        self.refused(["warm_up.toml:5:14: duration_s", "-600"])

    def test_training_runs_that_tell_too_little(self):
        self.change("q.toml", '^"ambient.points.*', "duration_s = 90")
        self.refused(["[[training]]"])

    def test_a_training_run_equal_to_a_held_out_one(self):
        self.change("q.toml", "seed = 22", "seed = 21")
        self.refused(["held_out_ramp", "seed 21"])

    def test_wrong_devices_and_campaigns(self):
        self.refused(["--devices", "--campaign"], "--devices", 3)
        self.refused("nowhere.toml", "--campaign", "nowhere.toml")
        self.change("campaign.toml", "sigma = 30", "sigma = -30")
        self.refused(["campaign.toml:7", "sigma"], "--campaign",
                     "campaign.toml")
        self.write("device.toml", "[beam]\n")
        self.refused("device.toml")


class WrongWords(Qualified):
    def test_words_that_do_not_go_together(self):
        self.ok("run", "ramp.toml", "-o", "ramp.h5")
        self.trained_file()
        device = ["--device", "device.toml"]
        for words, says in [
                ([], "COMPENSATOR is missing"),
                (["c.json"], ["nothing to validate on", "device"]),
                (["c.json", "--device", 5], ["--device 5", "set"]),
                (["c.json", *device, "--device", "b.toml"],
                 ["--device b.toml", "second"]),
                (["c.json", "ramp.h5", *device], ["device or recordings", "set"]),
                (["c.json", "ramp.h5", "--qualification", "q.toml"],
                 ["--qualification", "a simulated device"]),
                (["c.json", "ramp.h5", "--campaign", "campaign.toml"],
                 ["--campaign", "a simulated device"]),
                (["c.json", "ramp.h5", "--devices", 2], "--devices"),
                (["c.json", *device, "--run", "a"], ["--run", "set"]),
                (["c.json", *device, "--full-scale", 100], "--full-scale"),
                (["cubic.toml", "ramp.h5"], ["cubic.toml", "--device"]),
                (["c.json", "--check", "b"], ["--check b", "--jobs"]),
                (["c.json", "--list-metrics"], "--list-metrics"),
                (["--list-metrics", "--jobs", 1], "--list-metrics"),
                (["c.json", *device, "--timeout-s", 5],
                 ["--timeout-s", "c.json"]),
                (["cubic.toml", *device, "--memory-GiB", 1],
                 ["--memory-GiB", "cubic.toml"]),
                (["c.json", "ramp.h5", "--memory-GiB", 1], "--memory-GiB"),
                (["q.toml", *device], ["q.toml", "is a qualification"]),
                (["c.json", *device, "--qualification", "ramp.toml"],
                 ["ramp.toml", "is a scenario", "a qualification"]),
                (["c.json", *device, "--spec", "q.toml"],
                 ["q.toml", "is a qualification", "a specification"]),
                (["c.json", "--device", "ramp.toml"],
                 ["ramp.toml"]),
                (["c.json", *device, "--json", "device.toml"],
                 ["device.toml", "read by this command"]),
                (["c.json", *device, "--json", "no/v.json"], "no"),
                (["c.json", *device, "--jobs", 0], "--jobs 0"),
                (["none.json", *device], "none.json"),
                (["c.json", "--device", "none.toml"], "none.toml"),
                (["c.json", *device, "--qualification", "none.toml"],
                 "none.toml"),
                (["c.json", *device, "--spec", "none.toml"], "none.toml")]:
            self.rejected("validate", *words, says=says)


class Shipped(ProgramTest):
    def test_the_shipped_qualification_covers_every_metric(self):
        self.write("cubic.toml", CUBIC)
        said, answer = self.validated("cubic.toml", "--device", NOMINAL,
                                      "--report", "page")
        missing = {metric["name"] for metric in said["metrics"]
                   if metric["before"] is None and metric["after"] is None}
        # An hour is too short for them: white and flicker noise hide them.
        self.assertLessEqual(missing, {
            "rate_random_walk_deg_per_h_per_sqrt_h", "quantisation_deg",
            "rate_ramp_deg_per_h_per_h"})
        untested = [check["name"] for check in said["checks"]
                    if check["passed"] is None]
        self.assertEqual(untested, [])
        self.assertEqual(answer.stderr, "")
        self.assertLess((self.dir / "page/index.html").stat().st_size, 2e6)

    def test_it_is_the_default(self):
        text = (SCENARIOS / "qualification.toml").read_text()
        self.assertTrue(text.startswith("# "))
