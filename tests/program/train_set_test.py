# SPDX-License-Identifier: MIT
"""train and validate on a set: what is read of it, and what is refused."""

import json
import re
import shutil

import numpy as np

from program import (CUBIC, IDENTITY, SCENARIOS, ProgramTest, by_name,
                     limits)

CAMPAIGN = """\
name = "tiny"
device = "device.toml"
devices = 24
devices_per_file = 6
seed = 5

[split]
train = 0.6
validation = 0.2
test = 0.2

[tolerances]
"patches.offset_m" = { normal = { mean = 0, sigma = 10e-6 } }
"readout.quadrature_trim_deg_per_s" = { normal = { mean = 0, sigma = 50 } }

[[run]]
name = "sweep"
scenario = "sweep.toml"

[[run]]
name = "check"
scenario = "check.toml"
"""

SCENARIO = """\
name = "{name}"
device = "device.toml"
fidelity = "quasistatic"
duration_s = {duration}
output_rate_Hz = 0.1
seed = 1

[ambient.soaks]
temperatures_degC = {temperatures}
hold_s = 2700
ramp_K_per_min = 1

[chamber]
stirred = true
"""

STEADY = """
[rows]
seconds = 60
steady_K_per_min = 0.05
"""

POPULATION = """\
kind = "population"
inputs = ["temperature", "quadrature"]

[rows]
seconds = 60
steady_K_per_min = 0.05

[population]
grid_K = 15
"""

TRAIN, VALIDATION, TEST = range(3)  # of the variable part


class TrainSet(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("sweep.toml", SCENARIO.format(
            name="sweep", temperatures=list(range(-35, 41, 15)),
            duration=6 * 2700 + 75 * 60))
        self.write("check.toml", SCENARIO.format(
            name="check", temperatures=[-20, 0, 15, 30],
            duration=4 * 2700 + 50 * 60))
        self.write("campaign.toml", CAMPAIGN)
        self.write("cubic.toml", CUBIC + STEADY)
        self.write("population.toml", POPULATION)
        shutil.copy(SCENARIOS / "population/adapted.toml", self.dir)
        self.ok("generate", "campaign.toml", "-o", "set", "--jobs", 1)

    def devices(self, part):
        parts = self.signals("set/sweep.nc")["part"]
        return [int(k) for k in np.flatnonzero(parts == part)]

    def train(self, model, name, *arguments):
        """What a compensator trained on the set says of its training."""
        self.ok("train", "set", "--model", model, "-o", name, *arguments)
        return self.json(name)["training"]

    def scores(self, name, *arguments):
        said, answer = self.validated(name, "set", *arguments)
        found = said["population"]
        rms = by_name(found["metrics"])["residual_rms_deg_per_s"]["after"]
        devices = [one["device"] for one in found["verdicts"]]
        return answer.stdout, list(zip(devices, rms, strict=True))


class Split(TrainSet):
    def test_training_devices_are_fitted_and_those_of_validation_held_out(self):
        counts = [len(self.devices(k)) for k in (TRAIN, VALIDATION, TEST)]
        self.assertTrue(all(counts) and len(set(counts)) > 1, counts)
        said = self.train("cubic.toml", "cubic.json", "--run", "sweep")
        self.assertEqual(said["set"]["devices"], counts[TRAIN])
        self.assertEqual(said["held_out_set"]["devices"], counts[VALIDATION])

    def test_devices_for_testing_do_not_change_a_compensator(self):
        """Left out of a set by their number they leave the same curve."""
        self.train("cubic.toml", "all.json", "--run", "sweep")
        self.train("cubic.toml", "same.json", "--run", "sweep",
                   "--device", *self.devices(TRAIN))
        self.train("cubic.toml", "more.json", "--run", "sweep", "--device",
                   *self.devices(TRAIN), *self.devices(TEST))
        every, same, more = (self.json(f"{name}.json")["parameters"]
                             for name in ("all", "same", "more"))
        self.assertEqual(every, same)
        self.assertNotEqual(every, more)

    def test_a_run_is_chosen_by_its_name(self):
        rows = {}
        for run in ("sweep", "check"):
            text = self.ok("train", "set", "--run", run, "--model",
                           "cubic.toml", "-o", f"{run}.json")
            rows[run] = int(re.search(r"(\d+) rows", text)[1])
        text = self.ok("train", "set", "--model", "cubic.toml", "-o",
                       "both.json")
        self.assertIn(f" {rows['sweep'] + rows['check']} rows", text)
        self.assertGreater(rows["sweep"], rows["check"])

    def test_one_device_is_cross_validated(self):
        said = self.train("cubic.toml", "one.json", "--device", 3, "--cv",
                          "run")
        found = said["cross_validation"]
        self.assertEqual((found["by"], found["groups"]), ("run", 2))
        self.assertEqual(said["set"]["devices"], 1)
        self.assertGreater(min(found["group_rms_deg_per_s"]), 0)

    def test_scores_are_those_of_the_test_devices(self):
        self.train("cubic.toml", "cubic.json", "--run", "sweep")
        text, scores = self.scores("cubic.json", "--run", "check")
        self.assertEqual([device for device, _ in scores],
                         [str(k) for k in self.devices(TEST)])
        residuals = [rms for _, rms in scores]
        (line,) = [line for line in text.splitlines()
                   if line.startswith("residual_rms_deg_per_s")
                   and len(line.split()) == 5
                   and line.split()[3:] == [f"{np.median(residuals):.3g}",
                                            f"{max(residuals):.3g}"]]
        self.assertIn(f"{len(scores)} devices", text)


class InSample(TrainSet):
    def in_sample(self, name, *arguments):
        """Of each score, whether its device was used in training."""
        said, _ = self.validated(name, "set", *arguments)
        return ["hold_out" in one["words"]
                for one in said["population"]["verdicts"]]

    def test_devices_used_in_training_are_known_by_their_number(self):
        said = self.train("cubic.toml", "cubic.json", "--run", "sweep")
        numbers = [k for first, last in said["set"]["device_ranges"]
                   for k in range(first, last + 1)]
        self.assertEqual(numbers, self.devices(TRAIN))
        self.assertEqual(said["set"]["runs"], ["sweep"])
        tests = self.devices(TEST)
        self.assertEqual(self.in_sample("cubic.json", "--run", "sweep"),
                         [False] * len(tests))
        for part in (TRAIN, VALIDATION):
            device = self.devices(part)[0]
            self.assertEqual(self.in_sample("cubic.json", "--run", "sweep",
                                            "--device", device), [True])
            # Nor is another run of it a device never seen.
            self.assertEqual(self.in_sample("cubic.json", "--run", "check",
                                            "--device", device,
                                            "--device", tests[0]),
                             [device < tests[0], device > tests[0]])

    def test_every_device_is_judged_by_a_specification(self):
        self.train("cubic.toml", "cubic.json")
        judge = ["cubic.json", "set", "--spec", "spec.toml"]
        self.write("spec.toml", limits(residual_rms_deg_per_s=0.5))
        said, answer = self.validated(*judge)
        tests = self.devices(TEST)
        self.assertEqual([one["device"] for one in
                          said["population"]["verdicts"]],
                         [str(number) for number in tests])
        self.assertIn(f"of {len(tests)} devices pass", said["words"])
        # The table is that of one device, and says so.
        shown = said["population"]["shown_device"]
        self.assertIn(f"Device {shown}: ", said["words"])
        self.assertIn(f"cubic.json on device {shown} of set; s",
                      " ".join(answer.stdout.split()))
        (rms,) = said["population"]["metrics"]
        # The same figure as of the device alone, and on any number of threads.
        one, _ = self.validated(*judge, "--device", tests[1])
        self.assertEqual(one["population"]["metrics"][0]["after"],
                         rms["after"][1:2])
        again, _ = self.validated(*judge, "--jobs", 1)
        self.assertEqual(again, said)
        # The verdict is that of the worst device.
        self.write("spec.toml", limits(
            residual_rms_deg_per_s=0.2 * max(rms["after"])))
        said, _ = self.validated(*judge, allowed=(3,))
        self.assertEqual(said["verdict"], "fail")

    def test_a_device_that_was_trained_on_fails_the_check(self):
        self.train("cubic.toml", "cubic.json", "--run", "sweep")
        self.write("spec.toml", limits(residual_rms_deg_per_s=100))
        for part in TRAIN, VALIDATION, TEST:
            said, _ = self.validated(
                "cubic.json", "set", "--spec", "spec.toml", "--run", "check",
                "--device", self.devices(part)[0])
            self.assertIs(by_name(said["checks"])["hold_out"]["passed"],
                          part == TEST)

    def test_a_command_is_judged_on_a_set(self):
        self.write("same.py", IDENTITY)
        said, _ = self.validated("cmd:/usr/bin/python3 same.py", "set", "--run",
                                 "check")
        for metric in said["metrics"]:
            if metric["name"].startswith("residual"):
                self.assertEqual(metric["after"]["value"],
                                 metric["before"]["value"])

    def test_no_bundle_takes_a_set(self):
        self.train("cubic.toml", "cubic.json")
        self.rejected("validate", "cubic.json", "set", "--bundle", "b",
                      says=["--bundle", "is a set", "recordings"])
        # Each device to score has an option of its own.
        self.rejected("validate", "cubic.json", "set", "--device", 3, 5,
                      says="--device 3 --device 5")

    def test_another_run_of_the_one_device_trained_on_is_unseen(self):
        device = self.devices(TEST)[0]
        self.train("cubic.toml", "mine.json", "--run", "sweep", "--device",
                   device)
        self.assertEqual(self.in_sample("mine.json", "--device", device),
                         [True])
        self.assertIn("Training saw 1 of the 2 runs", self.text("v.json"))

    def test_a_compensator_that_does_not_tell_its_devices(self):
        self.train("cubic.toml", "cubic.json", "--run", "sweep")
        stored = self.json("cubic.json")
        for part in ("set", "held_out_set"):
            for key in ("device_ranges", "runs", "seed", "campaign_sha256"):
                del stored["training"][part][key]
        self.write("cubic.json", json.dumps(stored))
        _, answer = self.validated("cubic.json", "set", "--device",
                                   self.devices(TRAIN)[0])
        self.assertIn("may be in-sample", answer.stdout)


class Adapted(TrainSet):
    def test_new_devices_are_closer_to_own_curves_than_to_the_mean(self):
        said = self.train("population.toml", "population.json", "--run",
                          "sweep")
        self.assertEqual(said["set"]["devices"], len(self.devices(TRAIN)))
        _, mean = self.scores("population.json", "--run", "sweep")
        own = []
        for device in self.devices(TEST):
            said = self.train("adapted.toml", "mine.json", "--run", "check",
                              "--device", device)
            self.assertEqual(said["set"]["devices"], 1)
            _, scores = self.scores("mine.json", "--run", "sweep",
                                    "--device", device)
            own += scores
        self.assertEqual([device for device, _ in own],
                         [device for device, _ in mean])
        self.assertLess(*(np.median([rms for _, rms in scores])
                          for scores in (own, mean)))


class Refused(TrainSet):
    def refused(self, *arguments, says):
        self.rejected("train", "set", "--model", "cubic.toml", "-o",
                      "cubic.json", *arguments, says=says)

    def test_a_file_of_other_bytes_than_the_manifest_says(self):
        self.train("cubic.toml", "before.json", "--run", "sweep")
        self.flip("set/sweep_00001.h5")
        self.refused("--run", "sweep", says=["sweep_00001.h5", "verify"])
        self.rejected("validate", "before.json", "set",
                      says=["sweep_00001.h5", "verify"])
        self.train("cubic.toml", "check.json", "--run", "check")  # unharmed

    def test_a_file_in_the_place_of_another(self):
        shutil.copy(self.dir / "set/sweep_00000.h5",
                    self.dir / "set/sweep_00002.h5")
        self.refused(says=["sweep_00002.h5", "other bytes"])

    def test_a_line_of_the_manifest_that_was_changed(self):
        self.change("set/manifest.jsonl", '"first_device":6', '"first_device":7')
        self.refused(says=["manifest"])

    def test_a_set_that_is_not_finished(self):
        self.write("set/manifest.jsonl",  # whose last line is torn
                   self.text("set/manifest.jsonl")[:-20])
        self.refused(says=["set", "not finished"])
        shutil.rmtree(self.dir / "set")
        self.ok("generate", "campaign.toml", "-o", "set", "--shard", "1/2")
        self.refused(says=["set: holds no set, or none that is finished"])

    def test_runs_devices_and_options_it_does_not_have(self):
        self.refused("--run", "ramp", says=["ramp", "sweep, check"])
        self.refused("--device", 24, says=["24", "0 to 23"])
        self.refused("--held-out", "set/check_00000.h5",
                     says="is a file of a set; expected a recording")
        self.refused("--held-out", "elsewhere.h5", says="--held-out and --cv")
        self.refused("--cv", "run", says="--cv takes one device, --device K")
        self.refused("--cv", "run", "--device", 3, 5, says="--cv")
        self.rejected("train", "nowhere", "--model", "cubic.toml", "-o",
                      "cubic.json", says="nowhere")
