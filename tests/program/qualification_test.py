# SPDX-License-Identifier: MIT
"""`validate --device`: qualifications, populations, bundles, wrong input."""

import hashlib
import json
import resource
import shutil
import signal
import subprocess
import time
import unittest

from program import CUBIC, PROGRAM, ROOT, SCENARIO, SCENARIOS, ProgramTest, ramp

NOMINAL = SCENARIOS / "devices/nominal.toml"

# A qualification that takes no time: ramps that train and a ramp that judges.
SHORT = """\
name = "short"

[[run]]
name = "ramp"
purpose = "ramp"
scenario = "ramp.toml"

[[run]]
name = "warm_up"
purpose = "warm_up"
scenario = "warm_up.toml"
[run.overrides]
"ambient.constant_degC" = 12
seed = 12

[[training]]
name = "training_ramp"
scenario = "ramp.toml"
[training.overrides]
"ambient.points" = [[0, 45], [4000, -35]]
seed = 21

[[training]]
name = "held_out_ramp"
scenario = "ramp.toml"
held_out = true
[training.overrides]
seed = 22
"""

CAMPAIGN = """\
name = "three"
device = "device.toml"
devices = 3
seed = 5

[tolerances]
"readout.quadrature_trim_deg_per_s" = { normal = { mean = 0, sigma = 30 } }

[[run]]
name = "ramp"
scenario = "ramp.toml"
"""

SPECIFICATION = """\
name = "a tenth"

[limits]
residual_rms_deg_per_s = { max = 0.1, source = "a test" }
residual_max_deg_per_s = { max = 50, source = "a test" }
"""


class Qualified(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("ramp.toml", ramp(seed=11))
        self.write("warm_up.toml", SCENARIO)
        self.write("q.toml", SHORT)
        self.write("cubic.toml", CUBIC)
        self.write("campaign.toml", CAMPAIGN)
        self.write("spec.toml", SPECIFICATION)

    def validate(self, *arguments, model="cubic.toml", status=None):
        answer = self.beamgyro("validate", model, "--device", "device.toml",
                               "--qualification", "q.toml", "--json",
                               "v.json", *arguments)
        self.assertIn(answer.returncode, (0, 3) if status is None
                      else (status,), answer.stderr + answer.stdout)
        return json.loads((self.dir / "v.json").read_text()), answer


class Verdicts(Qualified):
    def test_a_model_is_trained_and_judged(self):
        said, answer = self.validate()
        self.assertEqual(said["compensator"]["kind"], "model")
        metrics = {metric["name"]: metric for metric in said["metrics"]}
        residual = metrics["residual_rms_deg_per_s"]
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
        self.ok("run", "ramp.toml", "--seed", 21, "--set",
                "ambient.points=[[0, 45], [4000, -35]]", "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        of_file, _ = self.validate(model="c.json")
        of_model, _ = self.validate()
        self.assertEqual(of_file["metrics"], of_model["metrics"])

    def test_training_runs_among_the_scored_ones_are_found(self):
        self.write("q.toml", SHORT.replace('scenario = "ramp.toml"\n\n',
                                           'scenario = "ramp.toml"\n'
                                           '[run.overrides]\n'
                                           '"ambient.points" = '
                                           '[[0, 45], [4000, -35]]\n\n', 1))
        self.ok("run", "ramp.toml", "--set",
                "ambient.points=[[0, 45], [4000, -35]]", "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        said, _ = self.validate(model="c.json", status=3)
        checks = {check["name"]: check for check in said["checks"]}
        self.assertIs(checks["hold_out"]["passed"], False)
        self.assertIn("hold_out", said["words"])

    def test_limits_decide(self):
        said, answer = self.validate("--spec", "spec.toml", status=3)
        results = {limit["metric"]: limit for limit in said["limits"]}
        self.assertEqual(results["residual_rms_deg_per_s"]["result"], "fail")
        self.assertLess(results["residual_rms_deg_per_s"]["margin"], 0)
        self.assertEqual(results["residual_max_deg_per_s"]["result"], "pass")
        self.assertEqual(said["verdict"], "fail")
        self.assertTrue(answer.stdout.startswith("FAIL: "), answer.stdout)
        metrics = {metric["name"]: metric for metric in said["metrics"]}
        self.assertEqual(metrics["residual_rms_deg_per_s"]["limit"], 0.1)
        self.assertEqual(metrics["residual_rms_deg_per_s"]["result"], "fail")

    def test_a_metric_reads_the_runs_that_are_named(self):
        whole, _ = self.validate()
        self.write("q.toml", SHORT + "\n[metrics]\n"
                   'residual_rms_deg_per_s = ["warm_up"]\n')
        named, _ = self.validate()

        def rms(said):
            return next(metric["before"]["value"] for metric in said["metrics"]
                        if metric["name"] == "residual_rms_deg_per_s")
        self.assertNotEqual(rms(named), rms(whole))

    def test_the_result_depends_on_no_thread(self):
        texts = set()
        for jobs in 1, 2, 5:
            _, answer = self.validate("--jobs", jobs, "--campaign",
                                      "campaign.toml", "--report", "page")
            texts.add((answer.stdout, (self.dir / "v.json").read_bytes(),
                       (self.dir / "page/index.html").read_bytes()))
        self.assertEqual(len(texts), 1)

    def test_a_recording_of_the_qualification_is_that_of_run(self):
        """The raw figures are those of the recordings that `run` makes."""
        self.ok("run", "ramp.toml", "-o", "ramp.h5")
        self.ok("run", "warm_up.toml", "--seed", 12, "--set",
                "ambient.constant_degC=12", "-o", "warm_up.h5")
        self.ok("run", "ramp.toml", "--seed", 21, "--set",
                "ambient.points=[[0, 45], [4000, -35]]", "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        simulated, _ = self.validate(model="c.json")
        self.beamgyro("validate", "c.json", "ramp.h5", "warm_up.h5", "--json",
                      "r.json")
        recorded = json.loads((self.dir / "r.json").read_text())
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
            with self.subTest(command):
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
                found[name, model] = {one["name"]: one
                                      for one in said["metrics"]}
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
        self.ok("run", "ramp.toml", "--seed", 21, "--set",
                "ambient.points=[[0, 45], [4000, -35]]", "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        arguments = ["--campaign", "campaign.toml", "--spec", "spec.toml"]
        each, _ = self.validate(*arguments)
        one, _ = self.validate(*arguments, model="c.json")
        self.assertFalse(one["population"]["trained_on_each"])

        def worst(said):
            return max(said["population"]["metrics"][0]["after"])
        self.assertLess(worst(each), worst(one))


class Bundles(Qualified):
    def bundle(self, *arguments, model="cubic.toml"):
        answer = self.beamgyro(
            "validate", model, "--device", "device.toml", "--qualification",
            "q.toml", "--bundle", "bundle", *arguments)
        self.assertIn(answer.returncode, (0, 3), answer.stderr)
        return answer

    def check(self, status):
        answer = self.beamgyro("validate", "--check", "bundle")
        self.assertEqual(answer.returncode, status,
                         answer.stdout + answer.stderr)
        return answer.stdout

    def test_a_bundle_is_made_again(self):
        told = self.bundle("--spec", "spec.toml", "--campaign",
                           "campaign.toml", "--devices", 2)
        for name in ["device.toml", "q.toml", "cubic.toml", "ramp.toml",
                     "warm_up.toml", "spec.toml", "campaign.toml"]:
            (self.dir / name).unlink()  # the bundle needs none of them
        (self.dir / "bundle").rename(self.dir / "elsewhere")
        (self.dir / "elsewhere").rename(self.dir / "bundle")
        self.assertIn("are the same", self.check(0))
        self.assertEqual((self.dir / "bundle/report.txt").read_text(),
                         told.stdout)

    def test_a_changed_file_is_named(self):
        self.bundle()
        for name in ["result.json", "report.txt", "report/index.html",
                     "inputs/device/device.toml",
                     "inputs/qualification/ramp.toml",
                     "inputs/compensator/cubic.toml"]:
            path = self.dir / "bundle" / name
            whole = path.read_bytes()
            with self.subTest(name):
                path.write_bytes(whole + b" ")
                self.assertIn(name, self.check(1))
                path.unlink()
                self.assertIn(name, self.check(1))
            path.write_bytes(whole)
        self.check(0)

    def test_a_result_of_other_inputs_is_told_by_its_bytes(self):
        """A bundle whose result was improved by hand, hash and all."""
        self.bundle()
        path = self.dir / "bundle/result.json"
        said = json.loads(path.read_text())
        said["verdict"] = "pass"
        said["words"] = "all is well"
        path.write_text(json.dumps(said, indent=2) + "\n")
        self.assertIn("result.json", self.check(1))

    def test_recordings_are_bundled_too(self):
        self.ok("run", "ramp.toml", "-o", "ramp.h5")
        self.ok("run", "ramp.toml", "--seed", 3, "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        answer = self.beamgyro("validate", "c.json", "ramp.h5", "--bundle",
                               "bundle")
        self.assertIn(answer.returncode, (0, 3), answer.stderr)
        for path in self.dir.glob("*.h5"):
            path.unlink()
        self.check(0)

    def test_the_bundle_of_a_command_runs_it_again(self):
        self.write("same.py", "import sys\nrate = sys.stdin.readline()"
                   ".strip().split(',').index('rate')\n"
                   "for line in sys.stdin:\n"
                   "    print(line.split(',')[rate].strip())\n")
        answer = self.bundle(model="cmd:/usr/bin/python3 same.py")
        self.assertIn("residual_rms_deg_per_s: 1 [", answer.stdout)
        self.check(0)
        told = self.beamgyro("validate", "--check", "bundle", "--timeout-s", 9)
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn("bundle: runs cmd:/usr/bin/python3 same.py", told.stderr)
        (self.dir / "same.py").write_text("print(0)\n")
        self.assertIn("result.json", self.check(1))

    def altered(self, change):
        """Alters bundle.json, and returns the text that it had."""
        path = self.dir / "bundle/bundle.json"
        whole = path.read_text()
        said = json.loads(whole)
        change(said)
        path.write_text(json.dumps(said, indent=2, ensure_ascii=False) + "\n")
        self.assertNotEqual(path.read_text(), whole)
        return whole

    def test_bundle_json_that_was_edited_is_refused(self):
        self.bundle("--spec", "spec.toml")
        outside = self.dir / "cubic.toml"

        def put(key, value):
            return lambda said: said["request"].update({key: value})

        def entry(number, **keys):
            return lambda said: said["inputs"][number].update(keys)

        for change, says in [
                (put("compensator", str(outside)),
                 ["request.compensator", str(outside)]),
                (put("compensator", "../cubic.toml"), "../cubic.toml"),
                (put("compensator", "inputs/../../cubic.toml"),
                 "request.compensator"),
                (put("compensator", "inputs/compensator/other.toml"),
                 ["other.toml", "inputs"]),
                (put("device", "../device.toml"), "request.device"),
                (put("qualification", "/etc/passwd"), "request.qualification"),
                (put("qualification", None), "request.qualification"),
                (put("specification", "spec.toml"), "request.specification"),
                (put("workbench", "../c.json"), "request.workbench"),
                (put("campaign", "../campaign.toml"), "request.campaign"),
                (put("runs", ["inputs/device/device.toml"]), "request"),
                (put("devices", 5), ["request.devices", "campaign"]),
                (put("full_scale_deg_per_s", 50), "full_scale_deg_per_s"),
                (put("limits", {}), ["request", '"limits"', "unknown key"]),
                (lambda said: said.update(verdict="pass"), '"verdict"'),
                (entry(0, note=""), ["inputs[0]", '"note"']),
                (entry(0, file="../../../../etc/passwd"),
                 ["inputs[0].file", "etc/passwd"]),
                (entry(0, file="/etc/passwd"), "inputs[0].file"),
                (entry(0, file="inputs//device"), "inputs[0].file"),
                (entry(0, file="inputs/./device"), "inputs[0].file"),
                (entry(0, file=""), "inputs[0].file"),
                (entry(0, file="result.json"), "inputs[0].file"),
                (lambda said: said["outputs"][0].update(file="../v.json"),
                 "outputs[0].file"),
                (lambda said: said.update(inputs=[]), "request.compensator"),
                (lambda said: said["inputs"].pop(0), "is not in"),
                (lambda said: said["inputs"].append(said["inputs"][0]),
                 ["inputs[", "twice"])]:
            whole = self.altered(change)
            with self.subTest(says):
                self.rejected("validate", "--check", "bundle", says=says)
            (self.dir / "bundle/bundle.json").write_text(whole)
        self.check(0)

    def test_bundle_json_of_other_files_is_not_the_same(self):
        self.bundle()
        names = [file["file"] for file in json.loads(
            (self.dir / "bundle/bundle.json").read_text())["inputs"]]
        ramp_number = names.index("inputs/qualification/ramp.toml")

        def zeros(said):
            said["outputs"][0]["sha256"] = "0" * 64

        for change, says in [
                (lambda said: said["inputs"].pop(ramp_number),
                 "ramp.toml: is not listed"),
                (zeros, "result.json: is not the same"),
                (lambda said: said["outputs"].pop(),
                 "index.html: is not listed"),
                (lambda said: said["inputs"].reverse(),
                 "bundle.json: is not the same")]:
            whole = self.altered(change)
            with self.subTest(says):
                self.assertIn(says, self.check(1))
            (self.dir / "bundle/bundle.json").write_text(whole)

    def test_files_that_are_not_listed_are_named(self):
        self.bundle()
        for name in ["inputs/device/other.toml", "inputs/note.txt",
                     "read_me_first.txt", "report/second.html"]:
            path = self.dir / "bundle" / name
            path.write_text("A better result.\n")
            with self.subTest(name):
                self.assertIn(f"{name}: is not listed", self.check(1))
            path.unlink()
        self.check(0)

    def test_an_input_that_names_a_file_elsewhere_is_found(self):
        """Hash and all, a scenario of the bundle reads one outside."""
        self.bundle()
        path = self.dir / "bundle/inputs/qualification/q.toml"
        path.write_text(path.read_text().replace(
            'scenario = "warm_up.toml"',
            f'scenario = "{self.dir}/warm_up.toml"'))

        def change(said):
            for file in said["inputs"]:
                if file["file"].endswith("q.toml"):
                    file["sha256"] = hashlib.sha256(
                        path.read_bytes()).hexdigest()
        self.altered(change)
        told = self.check(1)
        self.assertIn(f"{self.dir}/warm_up.toml: is read and not in", told)
        self.assertIn("inputs/qualification/warm_up.toml: is listed", told)

    def test_the_version_that_made_it_is_said(self):
        self.bundle()
        for key in "beamgyro_version", "git_revision":
            whole = self.altered(lambda said: said.update({key: "older"}))
            answer = self.beamgyro("validate", "--check", "bundle")
            self.assertEqual(answer.returncode, 0, answer.stderr)
            self.assertIn("was made by beamgyro", answer.stderr)
            self.assertIn("older", answer.stderr)
            (self.dir / "bundle/bundle.json").write_text(whole)
        answer = self.beamgyro("validate", "--check", "bundle")
        self.assertEqual(answer.stderr, "")

    def test_what_an_interrupt_left_of_the_same_bundle_is_completed(self):
        self.bundle()
        whole = {path: path.read_bytes()
                 for path in (self.dir / "bundle").rglob("*")
                 if path.is_file()}
        (self.dir / "bundle/bundle.json").unlink()
        (self.dir / "bundle/report.txt").unlink()
        (self.dir / "bundle/result.json").write_text("of another version")
        self.bundle()
        for path, content in whole.items():
            self.assertEqual(path.read_bytes(), content, path)
        self.check(0)
        # A file of somebody else's is not taken for one of the bundle.
        (self.dir / "bundle/bundle.json").unlink()
        self.write("bundle/inputs/device/device.toml", "mine")
        self.rejected("validate", "cubic.toml", "--device", "device.toml",
                      "--qualification", "q.toml", "--bundle", "bundle",
                      says=["--bundle bundle", "new directory"])

    def test_a_directory_that_is_not_empty_is_not_taken(self):
        self.bundle()
        self.rejected("validate", "cubic.toml", "--device", "device.toml",
                      "--qualification", "q.toml", "--bundle", "bundle",
                      says=["--bundle bundle", "new directory"])

    def test_damaged_bundles_are_refused(self):
        self.bundle()
        path = self.dir / "bundle/bundle.json"
        whole = path.read_text()
        for change, says in [
                (whole[:50], "bundle.json"),
                (whole.replace("beamgyro-bundle", "a cake"), "filetype"),
                (whole.replace('"format_version": 1', '"format_version": 2'),
                 "format_version"),
                (whole.replace('"request"', '"demand"'), "request")]:
            path.write_text(change)
            with self.subTest(says):
                self.rejected("validate", "--check", "bundle", says=says)
        self.rejected("validate", "--check", "nowhere",
                      says="nowhere/bundle.json")


def small_files():
    """A limit in place of a full disk. The page is larger, no other file is."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, 150_000))


class Places(Qualified):
    """Where a validation writes."""

    def asked(self, *arguments, **options):
        return self.beamgyro("validate", "cubic.toml", "--device",
                             "device.toml", "--qualification", "q.toml",
                             *arguments, **options)

    def test_the_verdict_is_told_though_a_file_cannot_be_written(self):
        told = self.asked().stdout
        answer = self.asked("--json", "v.json", "--report", "page",
                            "--bundle", "b", preexec_fn=small_files)
        self.assertEqual(answer.returncode, 1)
        self.assertEqual(answer.stdout, told)
        self.assertIn("page/index.html: cannot write", answer.stderr)
        self.assertIn("b/report/index.html: cannot write", answer.stderr)
        json.loads((self.dir / "v.json").read_text())
        for name in "page", "b":
            self.assertFalse((self.dir / name).exists(), name)

    def test_files_are_written_though_the_verdict_cannot_be_told(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            answer = subprocess.run(
                [str(PROGRAM), "validate", "cubic.toml", "--device",
                 "device.toml", "--qualification", "q.toml", "--json",
                 "v.json"], cwd=self.dir, stdin=subprocess.DEVNULL,
                stdout=full, stderr=subprocess.PIPE, check=False, timeout=60)
        self.assertEqual(answer.returncode, 1)
        self.assertIn(b"standard output", answer.stderr)
        json.loads((self.dir / "v.json").read_text())

    def test_a_disk_that_becomes_full_leaves_no_half_bundle(self):
        for before in False, True:
            if before:
                (self.dir / "deep/b").mkdir(parents=True)
            answer = self.asked("--bundle", "deep/b",
                                preexec_fn=small_files)
            self.assertEqual(answer.returncode, 1, answer.stderr)
            self.assertIn("deep/b/report/index.html", answer.stderr)
            self.assertIn("residual_rms_deg_per_s", answer.stdout)
            self.assertEqual((self.dir / "deep").exists(), before)
            if before:
                self.assertEqual(list((self.dir / "deep/b").iterdir()), [])
        self.assertIn(self.asked("--bundle", "deep/b").returncode, (0, 3))
        self.ok("validate", "--check", "deep/b")

    def test_each_output_has_a_place_of_its_own(self):
        (self.dir / "there").mkdir()
        (self.dir / "link").symlink_to("there")
        for words, says in [
                (["--report", "r", "--bundle", "r"],
                 ["--report r", "--bundle r"]),
                (["--report", "r", "--bundle", "./r/"], "--bundle ./r/"),
                (["--report", "r/b", "--bundle", "r"], "inside --bundle r"),
                (["--report", "r", "--bundle", "r/b"], "inside --report r"),
                (["--report", "there", "--bundle", "link"], "--bundle link"),
                (["--report", "r", "--figures", "r"], "--figures r"),
                (["--json", "r/v.json", "--bundle", "r"], "--json r/v.json"),
                (["--json", "v", "--report", "v"], "--json v")]:
            with self.subTest(words):
                told = self.rejected("validate", "cubic.toml", "--device",
                                     "device.toml", "--qualification",
                                     "q.toml", *words, says=says)
                self.assertIn("place of its own", told)
                self.assertFalse((self.dir / "r").exists())

    def test_what_can_be_no_directory_is_refused_by_its_option(self):
        self.write("file", "mine")
        for option in "--report", "--figures", "--bundle":
            for name in ["/proc/x", "/dev/full", "file", "file/x", "c.json"]:
                with self.subTest((option, name)):
                    told = self.rejected(
                        "validate", "cubic.toml", "--device", "device.toml",
                        "--qualification", "q.toml", option, name,
                        says=f"{option} {name}: ")
                    self.assertNotIn("filesystem error", told)

    def test_what_fails_or_is_interrupted_leaves_no_directory(self):
        self.write("hang.py", "import time; time.sleep(60)")
        for number in signal.SIGINT, signal.SIGTERM:
            with subprocess.Popen(
                    [str(PROGRAM), "validate", "cmd:/usr/bin/python3 hang.py",
                     "--device", "device.toml", "--qualification", "q.toml",
                     "--report", "r", "--figures", "f", "--bundle", "b"],
                    cwd=self.dir, stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL) as process:
                time.sleep(2)
                self.assertIsNone(process.poll())
                process.send_signal(number)
                self.assertEqual(process.wait(20), -number)
            for name in "rfb":
                self.assertFalse((self.dir / name).exists(), name)


class WrongFiles(Qualified):
    def refused(self, says, *arguments, model="cubic.toml"):
        self.rejected("validate", model, "--device", "device.toml",
                      "--qualification", "q.toml", *arguments, says=says)

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
            with self.subTest(change[1]):
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
        self.write("q.toml", SHORT.replace(
            "held_out = true", "held_out = true\nscale_factor = true"))
        self.refused(["training[1].scale_factor", "held_out"])

    def test_nothing_to_train_on(self):
        self.write("q.toml", SHORT[:SHORT.index("[[training]]")])
        self.refused(["q.toml", "[[training]]", "cubic.toml"])
        self.ok("run", "ramp.toml", "--seed", 3, "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
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
            with self.subTest(line):
                self.refused(says)

    def test_a_wrong_scenario_is_named_by_its_own_place(self):
        self.write("warm_up.toml", SCENARIO.replace("duration_s = 600",
                                                     "duration_s = -600"))
        self.refused(["warm_up.toml:5:14: duration_s", "-600"])

    def test_training_runs_that_tell_too_little(self):
        self.write("q.toml", SHORT.replace(
            '"ambient.points" = [[0, 45], [4000, -35]]', "duration_s = 90"))
        self.refused(["[[training]]"])

    def test_a_training_run_equal_to_a_held_out_one(self):
        self.write("q.toml", SHORT.replace("seed = 22", "seed = 21"))
        self.refused(["held_out_ramp", "seed 21"])

    def test_wrong_devices_and_campaigns(self):
        self.refused(["--devices", "--campaign"], "--devices", 3)
        self.refused("nowhere.toml", "--campaign", "nowhere.toml")
        self.write("campaign.toml", CAMPAIGN.replace("sigma = 30",
                                                     "sigma = -30"))
        self.refused(["campaign.toml:7", "sigma"], "--campaign",
                     "campaign.toml")
        self.write("device.toml", "[beam]\n")
        self.refused("device.toml")


class WrongWords(Qualified):
    def test_words_that_do_not_go_together(self):
        self.ok("run", "ramp.toml", "-o", "ramp.h5")
        self.ok("run", "ramp.toml", "--seed", 3, "-o", "t.h5")
        self.ok("train", "t.h5", "--model", "cubic.toml", "-o", "c.json")
        device = ["--device", "device.toml"]
        for words, says in [
                ([], "COMPENSATOR is missing"),
                (["c.json"], ["nothing to validate on", "--device"]),
                (["c.json", "--device", 5], ["--device 5", "set"]),
                (["c.json", *device, "--device", "b.toml"],
                 ["--device b.toml", "second"]),
                (["c.json", "ramp.h5", *device], ["device.toml", "set"]),
                (["c.json", "ramp.h5", "--qualification", "q.toml"],
                 ["--qualification", "--device"]),
                (["c.json", "ramp.h5", "--campaign", "campaign.toml"],
                 ["--campaign", "--device"]),
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
            with self.subTest(words):
                self.rejected("validate", *words, says=says)


class Shipped(ProgramTest):
    def test_the_shipped_qualification_covers_every_metric(self):
        self.write("cubic.toml", CUBIC)
        answer = self.beamgyro("validate", "cubic.toml", "--device", NOMINAL,
                               "--json", "v.json", "--report", "page")
        self.assertIn(answer.returncode, (0, 3), answer.stderr)
        said = json.loads((self.dir / "v.json").read_text())
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
        self.assertTrue((ROOT / "scenarios/qualification.toml").is_file())


if __name__ == "__main__":
    unittest.main()
