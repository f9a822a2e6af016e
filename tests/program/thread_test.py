# SPDX-License-Identifier: MIT
"""What several threads make together is what one makes.

With BEAMGYRO=build/tsan/beamgyro the thread sanitizer watches; a race ends that
program with status 66.
"""

import json
import os

from program import NETWORK, SCENARIOS, ramp
from qualified import Qualified
from sets import Set

# Every sample a row: enough of them that one training uses two threads.
SAMPLES = "\n[rows]\nseconds = 0\n"


class Threads(Set):
    def test_files_of_a_set(self):
        self.generate("one", "--jobs", 1)
        self.generate("four", "--jobs", 4)
        self.assertEqual(self.contents("four"), self.contents("one"))

    def trained(self, name, model, *arguments):
        """The compensator trained on all cores; on one it is the same."""
        self.write(f"{name}.toml", model)
        command = ["train", "a.h5", "b.h5", "--model", f"{name}.toml",
                   *arguments]
        self.ok(*command, "-o", f"{name}.json")
        cores = os.sched_getaffinity(0)
        try:
            os.sched_setaffinity(0, {min(cores)})
            self.ok(*command, "-o", "one_core.json")
        finally:
            os.sched_setaffinity(0, cores)
        text = (self.dir / f"{name}.json").read_bytes()
        self.assertEqual((self.dir / "one_core.json").read_bytes(), text)
        return json.loads(text)

    def test_restarts_batches_and_folds_of_a_training(self):
        for seed, name in enumerate(["a", "b", "held_out"]):
            self.run_scenario(name, text=ramp(seed=seed))
        few_epochs = NETWORK.replace("max_epochs = 30", "max_epochs = 3")
        self.trained("restarts", few_epochs.replace("restarts = 1",
                                                    "restarts = 3"),
                     "--held-out", "held_out.h5")
        self.trained("batches", few_epochs + SAMPLES,
                     "--held-out", "held_out.h5")
        folds = self.trained("folds", few_epochs, "--cv", "run")
        self.assertEqual(
            folds["training"]["cross_validation"]["groups"], 2)

    def test_devices_of_a_sensitivity_study(self):
        for jobs in [1, 4]:
            self.ok("sensitivity", SCENARIOS / "campaigns/population.toml",
                    "--samples", 32, "--figure", "bias_pp_deg_per_s",
                    "--jobs", jobs, "--json", f"{jobs}.json")
        self.assertSameBytes("4.json", "1.json")


class ThreadsOfAValidation(Qualified):
    def test_runs_and_devices(self):
        for jobs in [1, 4]:
            self.validate("--campaign", "campaign.toml", "--jobs", jobs)
            (self.dir / "v.json").rename(self.dir / f"{jobs}.json")
        self.assertSameBytes("4.json", "1.json")
