# SPDX-License-Identifier: MIT
"""What a review of a design and a server of continuous integration take from
`validate`: JUnit XML, lines, the trained compensator, the head of the page."""

import re
import shutil
import xml.etree.ElementTree as ElementTree

from program import limits, ramp
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
