# SPDX-License-Identifier: MIT
"""Metrics of the user's own, from a table: `validate --own-metrics`."""

import shutil

from program import by_name, ramp
from qualified import Qualified

TABLE = """\
name,unit,before,after,low,high
landing_error,m,41.5,3.25,,5
share_in_corridor,%,12,97,95,100
climb_error,m,9,0.5,,
"""
SPECIFICATION = """\
name = "landing"
not_tested = "does not decide"

[limits.own.climb_error]
max = 1
source = "a test"

[limits_relative_to.before.own.landing_error]
max = 0.1
source = "a test"
"""


class OwnMetrics(Qualified):
    def prepare(self):
        super().prepare()
        self.trained_file()
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        self.write("own.csv", TABLE)
        self.write("s.toml", SPECIFICATION)

    def judged(self, *arguments, status=0):
        return self.validated("c.json", "test.h5", "--own-metrics",
                              "own.csv", *arguments, allowed=(status,))

    def test_they_are_shown_and_limited(self):
        said, answer = self.judged("--spec", "s.toml", "--junit", "j.xml",
                                   "--report", "page")
        rows = by_name(said["own_metrics"])
        self.assertEqual(list(rows), ["landing_error", "share_in_corridor",
                                      "climb_error"])
        self.assertEqual(rows["landing_error"]["before"],
                         {"value": 41.5, "interval": None})
        self.assertEqual(rows["landing_error"]["after"]["value"], 3.25)
        self.assertEqual(rows["landing_error"]["result"], "pass")
        self.assertEqual(
            [(one["metric"], one["relative_to"], one["own"], one["result"])
             for one in said["limits"]],
            [("climb_error", None, True, "pass"),
             ("landing_error", "before", True, "pass"),
             ("landing_error", None, True, "pass"),
             ("share_in_corridor", None, True, "pass")])
        for limit in said["limits"]:
            self.assertIn("it has no interval", limit["words"])
        self.assertRegex(answer.stdout, r"\nown metric +before +after +unit\n"
                         r"landing_error +41.5 +3.25  m\n")
        self.assertIn("climb_error: 0.5 (no interval), at most 1",
                      answer.stdout)
        self.assertIn('name="landing_error at most 5"', self.text("j.xml"))
        self.assertIn('"own_metrics":[{"name":"landing_error"',
                      self.text("page/index.html"))

    def test_a_value_beyond_a_limit_fails(self):
        self.write("own.csv", TABLE.replace("3.25", "5.01"))
        said, answer = self.judged(status=3)
        self.assertEqual(said["verdict"], "fail")
        self.assertIn("Not met: landing_error.", said["words"])
        self.assertIn("landing_error: 5.01 (no interval), at most 5",
                      answer.stdout)

    def test_a_value_that_is_not_finite_is_undecided(self):
        for cell in "nan", "inf", "":
            self.write("own.csv", TABLE.replace("3.25", cell))
            said, answer = self.judged(status=3)
            self.assertEqual(said["verdict"], "undecided")
            self.assertIn("landing_error", said["words"])
            self.assertIn("landing_error: no finite value, at most 5",
                          answer.stdout)
            self.assertIsNone(by_name(said["own_metrics"])["landing_error"]
                              ["after"]["value"])

    def test_a_table_is_hashed_and_bundled(self):
        said, _ = self.judged("--bundle", "bundle", "--spec", "s.toml")
        self.assertIn("own_metrics", [one["group"] for one
                                      in said["provenance"]["files"]])
        self.assertEqual(self.text("bundle/inputs/own_metrics/own.csv"), TABLE)
        (self.dir / "own.csv").unlink()
        self.assertIn("are the same", self.ok("validate", "--check", "bundle"))
        self.write("bundle/inputs/own_metrics/own.csv",
                   TABLE.replace("3.25", "3.24"))
        self.assertIn("own.csv", self.ok("validate", "--check", "bundle",
                                         allowed=(1,)))

    def test_a_limit_that_passed_and_fails_is_lost(self):
        self.judged()
        shutil.copy(self.dir / "v.json", self.dir / "old.json")
        self.write("own.csv", TABLE.replace("3.25", "6"))
        said, _ = self.judged("--baseline-result", "old.json", status=3)
        self.assertEqual(said["baseline"]["lost"], ["landing_error"])

    def test_what_is_wrong_is_named(self):
        run = "validate", "c.json", "test.h5"
        own = "--own-metrics", "own.csv"
        self.rejected(*run, "--own-metrics", "none.csv", says="none.csv")
        self.rejected(*run, "--spec", "s.toml", says=[
            "s.toml:4:1", "climb_error", "expected one to be given"])
        self.rejected(*run, *own, "--against", "c.json",
                      says=["--own-metrics", "--against"])
        self.write("own.csv", TABLE.replace("climb_error", "climb_eror"))
        self.rejected(*run, *own, "--spec", "s.toml", says=[
            "s.toml:4:1", "did you mean 'climb_eror'?"])
        self.write("own.csv", TABLE.replace("3.25", "3,25"))
        self.rejected(*run, *own, says="own.csv:2:")
        self.rejected("validate", "cubic.toml", "--device", "device.toml",
                      *own, "--seeds", 2, says=["--own-metrics", "--seeds"])

    def test_on_a_device(self):
        said, _ = self.validate("--own-metrics", "own.csv", "--seed", "4",
                                status=0)
        self.assertEqual(len(said["own_metrics"]), 3)
        self.assertIn("2 limits met", said["words"])
