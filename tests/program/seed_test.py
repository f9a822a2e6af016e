# SPDX-License-Identifier: MIT
"""`validate --seed` and `--seeds`: other runs from each seed."""

import re

from program import IDENTITY, by_name
from qualified import SHORT, Qualified

# The ramp goes up or down, at temperatures of its own; the warm-up is another.
# No draw is near the runs of the file.
VARIED = SHORT.replace("""\
scenario = "ramp.toml"

""", """\
scenario = "ramp.toml"
[run.vary]
"ambient.offset_K" = { uniform = { low = 8, high = 14 } }
"ambient.points" = { discrete = { values = [[[0, -30], [4000, 40]], [[0, 40], [4000, -30]]] } }
duration_s = { uniform = { low = 3600, high = 4000 } }

""", 1).replace("""\
seed = 12
""", """\
seed = 12
[run.vary]
"ambient.constant_degC" = { uniform = { low = 17, high = 27 } }
duration_s = { uniform = { low = 600, high = 700 } }
""", 1)

# Knows the public runs by heart: it finds the one that it is given by the noise
# of its temperature, else by its length, else by its first temperature, and
# takes away the bias that it has stored.
MEMORISER = """\
import sys

def columns(file, *names):
    names_of_file = next(file).strip().split(",")
    at = [names_of_file.index(name) for name in names]
    lines = (line.split(",") for line in file)
    return [[float(cells[k]) for k in at] for cells in lines]

known = [zip(*columns(open(path), "temperature", "true_bias"))
         for path in sys.argv[1:]]
known = [tuple(map(list, run)) for run in known]
rows = columns(sys.stdin, "rate", "temperature")

def distance(run):
    temperature, _ = run
    return (temperature[:9] != [row[1] for row in rows[:9]],
            len(temperature) != len(rows), abs(temperature[0] - rows[0][1]))

_, bias = min(known, key=distance)
for k, (rate, _) in enumerate(rows):
    print(repr(rate - bias[min(k, len(bias) - 1)]))
"""


class Seeds(Qualified):
    def prepare(self):
        super().prepare()
        self.write("q.toml", VARIED)

    def outputs(self, *arguments, **options):
        """Everything that a validation tells."""
        _, answer = self.validate(*arguments, "--report", "page", **options)
        return (answer.stdout, self.text("v.json"),
                self.text("page/index.html"))

    def test_the_same_seed_gives_the_same_bytes_on_any_threads(self):
        for arguments in ("--seed", 5), ("--seed", 5, "--seeds", 3):
            self.assertEqual(1, len({
                self.outputs(*arguments, "--jobs", jobs)
                for jobs in (1, 2, 5)}))

    def test_another_seed_gives_other_runs(self):
        public, _ = self.validate()
        drawn = [self.validate("--seed", seed)[0] for seed in range(5)]
        every = [public, *drawn]
        self.assertNotIn("seed", public["provenance"])
        for seed, said in enumerate(drawn):
            self.assertEqual(said["provenance"]["seed"], seed)
        for run in public["provenance"]["seeds"]:
            self.assertEqual(6, len({said["provenance"]["seeds"][run]
                                     for said in every}))
        for run in "ramp", "warm_up":
            self.assertEqual(6, len({by_name(said["runs"])[run]
                                     ["rms_deg_per_s"]["before"]
                                     for said in every}))
        orders = {tuple(run["name"] for run in said["runs"])
                  for said in every}
        self.assertEqual(orders, {("ramp", "warm_up"), ("warm_up", "ramp")})

    def test_a_random_seed_is_told_and_gives_the_same_again(self):
        text, json_text, page = self.outputs("--seed", "random")
        seed = int(re.search(r", seed (\d+); specification", text)[1])
        self.assertLess(seed, 2**52)
        self.assertEqual(self.outputs("--seed", seed), (text, json_text, page))
        self.assertNotEqual(self.outputs("--seed", "random")[1], json_text)

    def test_the_verdict_over_seeds(self):
        single = [self.validate("--seed", seed, "--spec", "spec.toml")[0]
                  for seed in range(20, 24)]
        said, answer = self.validate("--seed", 20, "--seeds", 4, "--spec",
                                     "spec.toml", "--report", "page")
        seeds = said["seeds"]
        self.assertEqual([(one["seed"], one["verdict"], one["words"])
                          for one in seeds["verdicts"]],
                         [(one["provenance"]["seed"], one["verdict"],
                           one["words"]) for one in single])
        passed = sum(one["verdict"] == "pass" for one in single)
        self.assertEqual((seeds["first"], seeds["count"], seeds["passed"],
                          seeds["share"]), (20, 4, passed, passed / 4))
        self.assertEqual(
            passed + seeds["failed"] + seeds["undecided"], 4)
        shown = single[seeds["shown_seed"] - 20]
        for key in "verdict", "runs", "metrics", "limits", "checks":
            self.assertEqual(said[key], shown[key], key)
        self.assertEqual(said["words"],
                         f"{passed} of 4 seeds pass. Seed "
                         f"{seeds['shown_seed']}: {shown['words']}")
        self.assertIn(f"{passed} of 4 seeds from 20 on pass", answer.stdout)
        for line in answer.stdout.splitlines():
            self.assertLessEqual(len(line), 100, line)
        residual = [by_name(one["metrics"])["residual_rms_deg_per_s"]["after"]
                    ["value"] for one in single]
        self.assertEqual(by_name(seeds["metrics"])["residual_rms_deg_per_s"]
                         ["after"], residual)

    def test_without_a_seed_the_seeds_begin_at_1(self):
        said, _ = self.validate("--seeds", 2)
        self.assertEqual([one["seed"] for one in said["seeds"]["verdicts"]],
                         [1, 2])

    def test_the_devices_of_a_campaign_are_drawn_too(self):
        population = [self.validate("--campaign", "campaign.toml", "--spec",
                                    "spec.toml", *seed)[0]["population"]
                      for seed in ((), ("--seed", 5), ("--seed", 6))]
        # The campaign's own seed is 5.
        self.assertEqual(3, len({tuple(one["metrics"][0]["before"])
                                 for one in population}))

    def test_a_bundle_keeps_the_seed(self):
        for arguments, request in [
                (("--seed", 3), (3, None)), (("--seeds", 2), (None, 2)),
                (("--seed", "random", "--seeds", 2), None)]:
            self.validate(*arguments, "--bundle", "b")
            kept = self.json("b/bundle.json")["request"]
            if request is not None:
                self.assertEqual((kept["seed"], kept["seeds"]), request)
            self.assertIn("are the same",
                          self.ok("validate", "--check", "b"))
            self.change("b/bundle.json", r'"seeds?": \d+',
                        lambda found: found[0][:-1] +
                        str((int(found[0][-1]) + 1) % 10))
            self.assertIn("result.json: is not the same", self.ok(
                "validate", "--check", "b", allowed=(1,)))
            for path in sorted((self.dir / "b").rglob("*"), reverse=True):
                path.rmdir() if path.is_dir() else path.unlink()

    def test_code_that_was_judged_on_public_runs_is_marked(self):
        self.write("same.py", IDENTITY)
        code = "cmd:/usr/bin/python3 same.py"
        for model, seed, marked in [
                (code, (), True), (code, ("--seed", 1), False),
                (code, ("--seeds", 2), True), ("cubic.toml", (), False)]:
            text, json_text, page = self.outputs(*seed, model=model)
            for told in " ".join(text.split()), json_text, page:
                self.assertEqual("with the public seed" in told, marked,
                                 (model, seed))

    def test_who_knows_the_public_runs_by_heart_passes_those_alone(self):
        self.ok("run", "ramp.toml", "-o", "ramp.csv")
        self.ok("run", "warm_up.toml", "--seed", 12, "--set",
                "ambient.constant_degC=12", "-o", "warm_up.csv")
        self.write("cheat.py", MEMORISER)
        cheat = "cmd:/usr/bin/python3 cheat.py ramp.csv warm_up.csv"
        self.write("spec.toml", """\
name = "a tenth"
not_tested = "does not decide"
[limits]
residual_rms_deg_per_s = { max = 0.2, source = "a test" }
""")
        known = ("--plugin-files", "ramp.csv", "--plugin-files", "warm_up.csv")
        public, _ = self.validate("--spec", "spec.toml", *known, model=cheat)
        self.assertEqual(public["verdict"], "pass", public["words"])
        drawn, _ = self.validate("--spec", "spec.toml", *known, "--seed", 34,
                                 "--seeds", 6, model=cheat)
        self.assertEqual(drawn["seeds"]["passed"], 0, drawn["seeds"])
        self.assertEqual(drawn["seeds"]["failed"], 6, drawn["seeds"])


class WrongSeeds(Qualified):
    def refused(self, says, *arguments):
        self.rejected("validate", "cubic.toml", "--device", "device.toml",
                      "--qualification", "q.toml", *arguments, says=says)

    def test_wrong_values(self):
        for word in "-1", "1.5", "rnd", str(2**53), "Random":
            self.refused([f"--seed {word}", "random", str(2**53 - 1)],
                         f"--seed={word}")
        for word in "0", "x", "10001":
            self.refused(f"--seeds {word}", f"--seeds={word}")
        self.refused([f"--seed {2**53 - 1}", str(2**53 - 2)],
                     "--seed", 2**53 - 1, "--seeds", 2)

    def test_what_a_seed_does_not_go_with(self):
        self.ok("run", "ramp.toml", "-o", "r.h5")
        self.trained_file()
        for option in "--seed", "--seeds":
            self.rejected("validate", "c.json", "r.h5", option, 1,
                          says=[option, "a simulated device", "recordings"])
        self.refused(["--seeds 2", "--campaign"], "--seeds", 2, "--campaign",
                     "campaign.toml")

    def test_wrong_distributions(self):
        for line, says in [
                ("seed = { uniform = { low = 1, high = 2 } }",
                 ["q.toml:16:8: run[1].vary.seed", "always drawn"]),
                ("fidelity = { discrete = { values = [\"carrier\"] } }",
                 ["run[1].vary.fidelity", "the same for all seeds"]),
                ("duration_s = { uniform = { low = 2, high = 1 } }",
                 ["q.toml:16", "run[1].vary.duration_s", "low"]),
                ("duration_s = { uniform = { low = -3, high = -1 } }",
                 ["q.toml:16", "duration_s", "-2"]),
                ("duration = { uniform = { low = 3, high = 4 } }",
                 ["q.toml:16", "duration", "no such key", "duration_s"]),
                ("duration_s = 3", ["q.toml:16", "duration_s"])]:
            self.write("q.toml", SHORT.replace(
                "seed = 12\n", f"seed = 12\n[run.vary]\n{line}\n", 1))
            self.refused(says)

    def test_a_drawn_value_that_the_scenario_does_not_take(self):
        self.write("q.toml", SHORT.replace("seed = 12\n", """\
seed = 12
[run.vary]
duration_s = { uniform = { low = -1e9, high = 2e9 } }
""", 1).replace('purpose = "warm_up"\n', 'purpose = "warm_up"\nfrom_s = 1\n'))
        for seed in 1, 2:
            self.refused("q.toml:17:14: duration_s", "--seed", seed)
