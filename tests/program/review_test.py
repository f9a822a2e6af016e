# SPDX-License-Identifier: MIT
"""What a review of a design and a server of continuous integration take from
`validate`: JUnit XML, lines, an earlier result, another compensator."""

import json
import re
import shutil
import xml.etree.ElementTree as ElementTree

from program import IDENTITY, by_name, limits, ramp
from qualified import Qualified

# What servers read: the attributes and children that an element may have.
# Those with a star must be there.
JUNIT = {
    "testsuites": ("name tests failures errors time", "testsuite"),
    "testsuite": ("name* tests* failures* errors* skipped time",
                  "properties testcase"),
    "properties": ("", "property"),
    "property": ("name* value*", ""),
    "testcase": ("name* classname time", "failure skipped system-out"),
    "failure": ("type message", ""),
    "skipped": ("message", ""),
    "system-out": ("", ""),
}
CONSTANT = 'kind = "constant"\n'


class Review(Qualified):
    def prepare(self):
        super().prepare()
        self.write("constant.toml", CONSTANT)
        self.trained_file()
        shutil.copy(self.dir / "c.json", self.dir / "cubic.json")
        self.ok("train", "t.h5", "--model", "constant.toml", "-o",
                "constant.json")
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))

    def assertIsJUnit(self, element):
        attributes, children = JUNIT[element.tag]
        names = {name.rstrip("*") for name in attributes.split()}
        needed = {name[:-1] for name in attributes.split()
                  if name.endswith("*")}
        self.assertLessEqual(set(element.attrib), names, element.tag)
        self.assertLessEqual(needed, set(element.attrib), element.tag)
        for child in element:
            self.assertIn(child.tag, children.split())
            self.assertIsJUnit(child)

    def junit(self, name="j.xml"):
        """The cases of a file by suite and name, after a look at its form."""
        root = ElementTree.parse(self.dir / name).getroot()
        self.assertEqual(root.tag, "testsuites")
        self.assertIsJUnit(root)
        cases = {}
        for suite in root:
            for key, tag in [("failures", "failure"), ("skipped", "skipped"),
                             ("tests", None)]:
                count = len([case for case in suite.iter("testcase")
                             if tag is None or case.find(tag) is not None])
                self.assertEqual(int(suite.get(key)), count)
            for case in suite.iter("testcase"):
                self.assertNotIn((suite.get("name"), case.get("name")), cases)
                cases[suite.get("name"), case.get("name")] = case
        for key in "tests", "failures":
            self.assertEqual(int(root.get(key)),
                             sum(int(suite.get(key)) for suite in root))
        return cases


class JUnit(Review):
    def test_a_limit_is_a_case(self):
        self.write("s.toml", limits(residual_max_deg_per_s=50,
                                    residual_rms_deg_per_s=1e-4))
        said, _ = self.validate("--spec", "s.toml", "--junit", "j.xml",
                                status=3)
        cases = self.junit()
        for limit in said["limits"]:
            case = cases["limits", f"{limit['metric']} at most {limit['max']:g}"]
            failure = case.find("failure")
            self.assertEqual(failure is None, limit["result"] == "pass")
            if failure is not None:
                self.assertEqual(failure.get("message"), limit["words"])
        for check in said["checks"]:
            case = cases["checks", check["name"]]
            self.assertEqual(case.find("failure") is not None,
                             check["passed"] is False)
            self.assertEqual(case.find("skipped") is not None,
                             check["passed"] is None)
        self.assertIsNotNone(cases["verdict", "verdict"].find("failure"))

    def test_it_is_red_whenever_the_status_is(self):
        for compensator, status in [("cubic.json", 0), ("constant.json", 3)]:
            said, _ = self.validated(compensator, "test.h5", "--junit", "j.xml",
                                     allowed=(status,))
            cases = self.junit()
            red = [key for key, case in cases.items()
                   if case.find("failure") is not None]
            self.assertEqual(bool(red), status != 0)
            for other in said["compared_with"]:
                if other["required"]:
                    self.assertEqual(
                        ("comparisons", f"better_than_{other['with']}") in red,
                        not other["better"])

    def test_the_same_inputs_give_the_same_bytes(self):
        for name, jobs in [("a.xml", 1), ("b.xml", 2)]:
            self.ended("validate", "cubic.json", "test.h5", "--junit", name,
                       "--jobs", jobs, allowed=(0, 3))
        self.assertSameBytes("a.xml", "b.xml")

    def test_a_name_of_any_bytes_is_text(self):
        name = b'a<b>&"\x01\xff\xc3\xa9.json'.decode("utf-8", "surrogateescape")
        shutil.copy(self.dir / "cubic.json", self.dir / name)
        self.ok("validate", name, "test.h5", "--junit", "j.xml")
        place = self.junit()["verdict", "verdict"].get("classname")
        self.assertEqual(place, 'a<b>&"\ufffd\ufffdé.json.verdict')

    def test_one_line_for_each_case(self):
        self.ended("validate", "cubic.toml", "--device", "device.toml",
                   "--qualification", "q.toml", "--spec", "spec.toml",
                   "--json", "v.json", "--junit", "j.xml", allowed=(0, 3))
        lines = self.ended(
            "validate", "cubic.toml", "--device", "device.toml",
            "--qualification", "q.toml", "--spec", "spec.toml", "--lines",
            allowed=(0, 3)).stdout.splitlines()
        self.assertEqual(len(lines), len(self.junit()))
        said = self.json("v.json")
        for line, limit in zip(lines, said["limits"]):
            result, name, value, low, high, unit, most, words = line.split("\t")
            self.assertEqual(
                (result, name, unit, most, words),
                (limit["result"], limit["metric"], "deg/s",
                 f"at most {limit['max']:g}", limit["words"]))
            for text, number in zip((value, low, high), (
                    limit["compared"]["value"],
                    *limit["compared"]["interval"])):
                self.assertAlmostEqual(float(text), number,
                                       delta=1e-5 * abs(number))
        self.assertEqual(lines[-1].split("\t")[:2], [said["verdict"], "verdict"])
        self.rejected("validate", "cubic.json", "test.h5", "--lines",
                      "--all-metrics", says="--all-metrics")


class Trained(Review):
    def test_the_compensator_of_a_model_is_written_and_bundled(self):
        of_model, _ = self.validate("--save-trained", "own.json", "--bundle",
                                    "bundle")
        self.assertEqual(self.text("own.json"),
                         self.text("bundle/trained.json"))
        self.assertIn("are the same", self.ok("validate", "--check", "bundle"))
        of_file, _ = self.validate(model="own.json")
        self.assertEqual(of_file["metrics"], of_model["metrics"])
        self.flip("bundle/trained.json")
        self.assertIn("trained.json", self.ok("validate", "--check", "bundle",
                                              allowed=(1,)))

    def test_of_a_compensator_there_is_nothing_to_write(self):
        self.rejected("validate", "cubic.json", "test.h5", "--save-trained",
                      "own.json", says=["--save-trained", "cubic.json"])
        self.rejected("validate", "cubic.toml", "--device", "device.toml",
                      "--qualification", "q.toml", "--save-trained", "own.toml",
                      says="--save-trained own.toml")


class Baseline(Review):
    def beside(self, compensator, *arguments, status):
        return self.validated(compensator, "test.h5", "--baseline-result",
                              "old.json", *arguments, allowed=(status,))

    def prepare(self):
        super().prepare()
        self.ok("validate", "cubic.json", "test.h5", "--json", "old.json")

    def test_the_same_is_no_worse(self):
        said, answer = self.beside("cubic.json", status=0)
        self.assertFalse(said["baseline"]["worse"])
        self.assertEqual({row["change"] for row in said["baseline"]["metrics"]},
                         {"same"})
        self.assertIn("Nothing is worse than in old.json.", said["words"])
        self.assertIn("metrics beside old.json (verdict pass): 0 better",
                      answer.stdout)

    def test_what_is_worse_fails_where_it_would_pass(self):
        cubic = self.json("cubic.json")
        scale = cubic["bias_scale"]
        scale["centre"] -= 0.25  # [deg/s], less than the drift of 2.8
        self.write("worse.json", json.dumps(cubic))
        self.ok("validate", "worse.json", "test.h5")
        said, answer = self.beside("worse.json", "--junit", "j.xml", status=3)
        self.assertEqual(said["verdict"], "fail")
        self.assertTrue(said["words"].startswith("Worse than old.json: "))
        rows = by_name(said["baseline"]["metrics"])
        self.assertEqual(rows["residual_mean_deg_per_s"]["change"], "worse")
        self.assertIn("FAIL: Worse than old.json", answer.stdout)
        self.assertIsNotNone(self.junit()[
            "earlier", "earlier_residual_mean_deg_per_s"].find("failure"))

    def test_a_check_that_passed_and_fails_is_named(self):
        said, _ = self.validated("cubic.json", "t.h5", "--baseline-result",
                                 "old.json", allowed=(3,))
        self.assertEqual(said["baseline"]["lost"], ["hold_out"])
        self.assertEqual(said["baseline"]["other_inputs"], ["runs"])
        self.assertTrue(any("old.json" in text for text in said["warnings"]))

    def test_it_is_bundled(self):
        self.beside("cubic.json", "--bundle", "bundle", status=0)
        (self.dir / "old.json").unlink()
        self.ok("validate", "--check", "bundle")

    def test_a_file_that_is_no_result_is_refused(self):
        for text, says in [("{}", "filetype"), ("[", "old.json"),
                           (self.text("cubic.json"), "is a compensator")]:
            self.write("old.json", text)
            self.rejected("validate", "cubic.json", "test.h5",
                          "--baseline-result", "old.json", says=says)


class Against(Review):
    def beside(self, one, other, *arguments, status):
        said, answer = self.validated(one, "test.h5", "--against", other,
                                      *arguments, allowed=(status,))
        return said["against"], said, answer

    def test_the_better_of_two(self):
        for one, other, status in [("cubic.json", "constant.json", 0),
                                   ("constant.json", "cubic.json", 3)]:
            found, said, answer = self.beside(one, other, status=status)
            self.assertTrue(found["sentence"].startswith(
                "cubic.json is better than constant.json: "))
            self.assertIn(found["sentence"], " ".join(answer.stdout.split()))
            self.assertEqual(found["compensator"]["name"], other)
            self.assertEqual({said["verdict"], found["verdict"]},
                             {"pass", "fail"})
            rms = by_name(found["metrics"])["residual_rms_deg_per_s"]
            low, high = rms["difference"]["interval"]
            self.assertEqual(rms["change"], "worse" if status else "better")
            self.assertGreater(low if status else -high, 0)
            self.assertAlmostEqual(rms["difference"]["value"],
                                   rms["own"]["value"] - rms["other"]["value"],
                                   delta=1e-9)

    def test_the_other_is_judged_as_alone(self):
        found, said, _ = self.beside("cubic.json", "constant.json", status=0)
        for name, here in [("constant.json", found), ("cubic.json", said)]:
            alone, _ = self.validated(name, "test.h5")
            for key in "verdict", "checks":
                self.assertEqual(alone[key], here[key], name)
            values = {row["name"]: row["after"] for row in alone["metrics"]}
            side = "other" if here is found else "own"
            for row in found["metrics"]:
                self.assertEqual(row[side], values[row["name"]])

    def test_of_the_same_the_runs_do_not_tell(self):
        found, _, _ = self.beside("cubic.json", "cubic.json", status=0)
        self.assertTrue(found["sentence"].startswith(
            "The runs do not tell which of"))
        self.assertEqual({row["change"] for row in found["metrics"]}, {"same"})

    def test_on_a_device_and_in_a_bundle(self):
        said, _ = self.validate("--against", "constant.json", "--bundle",
                                "bundle")
        self.assertIn("cubic.toml is better than constant.json",
                      said["against"]["sentence"])
        self.ok("validate", "--check", "bundle")

    def test_the_paired_difference_is_known_better(self):
        """Two cubics that differ by less than the interval of either."""
        cubic = self.json("cubic.json")
        cubic["bias_scale"]["centre"] += 0.02
        self.write("off.json", json.dumps(cubic))
        found, _, _ = self.beside("cubic.json", "off.json", status=0)
        rms = by_name(found["metrics"])["residual_rms_deg_per_s"]

        def width(estimate):
            low, high = estimate["interval"]
            return high - low

        self.assertLess(width(rms["difference"]), width(rms["own"]))

    def test_a_command_is_refused(self):
        self.write("same.py", IDENTITY)
        self.rejected("validate", "cubic.json", "test.h5", "--against",
                      "cmd:/usr/bin/python3 same.py", says="cmd:")
        self.rejected("validate", "cubic.json", "test.h5", "--against",
                      "cubic.toml", says="cubic.toml")


class Page(Review):
    def test_the_head_has_what_a_review_asks_for(self):
        """The template; what a browser shows of it is in report_page_test."""
        self.validate("--spec", "spec.toml", "--report", "report")
        page = self.text("report/index.html")
        for title in ("Device", "Qualification", "Specification", "Program",
                      "Risk of a false pass", "Seeds of the noise", "Date",
                      "Signature"):
            self.assertIn(f'"{title}"', page)
        result = self.json("v.json")
        for metric in result["metrics"]:
            self.assertNotRegex(metric["title"], re.compile(r"_|\bper\b|ppm|Hz"))
