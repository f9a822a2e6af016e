# SPDX-License-Identifier: MIT
"""`validate --device`: bundles, and where a validation writes."""

import hashlib
import json
import resource
import signal
import subprocess

from program import IDENTITY, PATIENCE, PROGRAM, limit, without_landlock
from qualified import DEVICE, Qualified


class Bundles(Qualified):
    def bundle(self, *arguments, model="cubic.toml"):
        return self.ended("validate", model, *DEVICE, "--bundle", "bundle",
                          *arguments, allowed=(0, 3))

    def check(self, status, *arguments):
        return self.ok("validate", "--check", "bundle", *arguments,
                       allowed=(status,))

    def test_a_bundle_is_made_again(self):
        told = self.bundle("--spec", "spec.toml", "--campaign",
                           "campaign.toml", "--devices", 2, "--all-metrics")
        for name in ["device.toml", "q.toml", "cubic.toml", "ramp.toml",
                     "warm_up.toml", "spec.toml", "campaign.toml"]:
            (self.dir / name).unlink()  # the bundle needs none of them
        (self.dir / "bundle").rename(self.dir / "elsewhere")
        (self.dir / "elsewhere").rename(self.dir / "bundle")
        self.assertIn("are the same", self.check(0))
        self.assertEqual(self.text("bundle/report.txt"), told.stdout)

    def test_a_changed_file_is_named(self):
        self.bundle()
        for name in ["result.json", "report.txt", "report/index.html",
                     "inputs/device/device.toml",
                     "inputs/qualification/ramp.toml",
                     "inputs/compensator/cubic.toml"]:
            path = self.dir / "bundle" / name
            whole = path.read_bytes()
            path.write_bytes(whole + b" ")
            self.assertIn(name, self.check(1))
            path.unlink()
            self.assertIn(name, self.check(1))
            path.write_bytes(whole)
        self.check(0)

    def test_a_result_of_other_inputs_is_told_by_its_bytes(self):
        """A bundle whose result was improved by hand, hash and all."""
        self.bundle()
        said = self.json("bundle/result.json") | {
            "verdict": "pass", "words": "all is well"}
        self.write("bundle/result.json", json.dumps(said, indent=2) + "\n")
        self.assertIn("result.json", self.check(1))

    def test_recordings_are_bundled_too(self):
        self.ok("run", "ramp.toml", "-o", "ramp.h5")
        self.ended("validate", self.trained_file(), "ramp.h5", "--bundle",
                   "bundle", allowed=(0, 3))
        for path in self.dir.glob("*.h5"):
            path.unlink()
        self.check(0)

    def test_the_bundle_of_a_command_runs_it_again(self):
        self.write("same.py", IDENTITY)
        answer = self.bundle(model="cmd:/usr/bin/python3 same.py")
        self.assertIn("Of no use", answer.stdout)
        self.check(0, "--run-code")
        self.assertIn("bundle: runs cmd:/usr/bin/python3 same.py", self.warned(
            "validate", "--check", "bundle", "--run-code", "--timeout-s", 9))
        self.write("same.py", "print(0)\n")
        self.assertIn("result.json", self.check(1, "--run-code"))

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
                (put("qualification", None), "qualification is missing"),
                (put("specification", "spec.toml"), "request.specification"),
                (put("workbench", "../c.json"), "request.workbench"),
                (put("campaign", "../campaign.toml"), "request.campaign"),
                (put("runs", ["inputs/device/device.toml"]), "request"),
                (put("devices", 5), ["request", "devices needs campaign"]),
                (put("full_scale_deg_per_s", 50), ["request", "full_scale"]),
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
                (lambda said: said["inputs"].append(said["inputs"][0]),
                 ["inputs[", "twice"])]:
            whole = self.altered(change)
            self.rejected("validate", "--check", "bundle", says=says)
            (self.dir / "bundle/bundle.json").write_text(whole)
        self.check(0)
        self.altered(lambda said: said.update(inputs=[]))
        self.assertIn("cubic.toml: is not listed", self.check(1))

    def test_bundle_json_of_other_files_is_not_the_same(self):
        self.bundle()
        names = [file["file"] for file in
                 self.json("bundle/bundle.json")["inputs"]]
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
            self.assertIn(says, self.check(1))
            (self.dir / "bundle/bundle.json").write_text(whole)

    def test_files_that_are_not_listed_are_named(self):
        self.bundle()
        for name in ["inputs/device/other.toml", "inputs/note.txt",
                     "read_me_first.txt", "report/second.html"]:
            path = self.dir / "bundle" / name
            path.write_text("A better result.\n")
            self.assertIn(f"{name}: is not listed", self.check(1))
            path.unlink()
        self.check(0)

    def test_an_input_that_names_a_file_elsewhere_is_found(self):
        """Hash and all, a scenario of the bundle reads one outside."""
        self.bundle()
        self.renewed("inputs/qualification/q.toml",
                     'scenario = "warm_up.toml"',
                     f'scenario = "{self.dir}/warm_up.toml"')
        self.assertEqual(self.check(1), f"{self.dir}/warm_up.toml: is named by "
                         "an input and not in the bundle; it was not read\n")

    def renewed(self, name, pattern, new):
        """Alters an input of the bundle, its size and its hash."""
        self.change(f"bundle/{name}", pattern, new)
        data = self.text(f"bundle/{name}").encode()

        def change(said):
            for file in said["inputs"]:
                if file["file"] == name:
                    file["bytes"] = len(data)
                    file["sha256"] = hashlib.sha256(data).hexdigest()
        self.altered(change)

    def test_no_file_elsewhere_is_opened(self):
        """Its text would be quoted."""
        self.bundle()
        self.write("secret", "root:x:0:0\n")
        for name, pattern, new in [
                ("q.toml", 'scenario = "warm_up.toml"', 'scenario = "{}"'),
                ("ramp.toml", r"^points = .*", 'file = "{}"')]:
            whole = self.files()
            for place in [self.dir / "secret", "../../../secret", "/etc/passwd"]:
                self.renewed(f"inputs/qualification/{name}", pattern,
                             new.format(place))
                said = self.ended("validate", "--check", "bundle",
                                  allowed=(1,))
                self.assertIn("not in the bundle; it was not read", said.stdout)
                self.assertNotIn("root", said.stdout + said.stderr)
                for path, text in whole.items():
                    (self.dir / path).write_bytes(text)

    def test_limits_for_code_are_taken_whether_a_bundle_has_some_or_not(self):
        self.bundle()
        self.check(0, "--timeout-s", 3, "--memory-GiB", 1)

    def test_the_version_that_made_it_is_said(self):
        self.bundle()
        for key in "beamgyro_version", "git_revision":
            whole = self.altered(lambda said: said.update({key: "older"}))
            self.assertSays(self.warned("validate", "--check", "bundle"),
                            ["was made by beamgyro", "older"])
            self.write("bundle/bundle.json", whole)
        self.assertEqual(self.warned("validate", "--check", "bundle"), "")

    def test_what_an_interrupt_left_of_the_same_bundle_is_completed(self):
        self.bundle()
        whole = self.files()
        (self.dir / "bundle/bundle.json").unlink()
        (self.dir / "bundle/report.txt").unlink()
        self.write("bundle/result.json", "of another version")
        self.bundle()
        self.assertEqual(self.files(), whole)
        self.check(0)
        # A file of somebody else's is not taken for one of the bundle.
        (self.dir / "bundle/bundle.json").unlink()
        self.write("bundle/inputs/device/device.toml", "mine")
        self.refused_again()

    def refused_again(self):
        self.rejected("validate", "cubic.toml", *DEVICE, "--bundle", "bundle",
                      says=["--bundle bundle", "new directory"])

    def test_a_directory_that_is_not_empty_is_not_taken(self):
        self.bundle()
        self.refused_again()

    def test_damaged_bundles_are_refused(self):
        self.bundle()
        whole = self.text("bundle/bundle.json")
        for change, says in [
                (whole[:50], "bundle.json"),
                (whole.replace("beamgyro-bundle", "a cake"), "filetype"),
                (whole.replace('"format_version": 2', '"format_version": 1'),
                 "format_version"),
                (whole.replace('"request"', '"demand"'), "request")]:
            self.write("bundle/bundle.json", change)
            self.rejected("validate", "--check", "bundle", says=says)
        self.rejected("validate", "--check", "nowhere",
                      says="nowhere/bundle.json")


# In place of a full disk. The page is larger, no other file is.
SMALL_FILES = limit(resource.RLIMIT_FSIZE, 150_000)


class Places(Qualified):
    """Where a validation writes."""

    def asked(self, *arguments, **options):
        return self.ended("validate", "cubic.toml", *DEVICE, *arguments,
                          **{"allowed": (0, 3)} | options)

    def test_the_verdict_is_told_though_a_file_cannot_be_written(self):
        told = self.asked().stdout
        answer = self.asked("--json", "v.json", "--report", "page", "--bundle",
                            "b", allowed=(1,), preexec_fn=SMALL_FILES)
        self.assertEqual(answer.stdout, told)
        self.assertSays(answer.stderr, ["page/index.html: cannot write",
                                        "b/report/index.html: cannot write"])
        self.json("v.json")
        for name in "page", "b":
            self.assertFalse((self.dir / name).exists(), name)

    def test_files_are_written_though_the_verdict_cannot_be_told(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            answer = subprocess.run(
                [PROGRAM, "validate", "cubic.toml", *DEVICE, "--json", "v.json"],
                cwd=self.dir, stdin=subprocess.DEVNULL, stdout=full,
                stderr=subprocess.PIPE, check=False, timeout=PATIENCE)
        self.assertEqual(answer.returncode, 1)
        self.assertIn(b"standard output", answer.stderr)
        self.json("v.json")

    def test_a_disk_that_becomes_full_leaves_no_half_bundle(self):
        for before in False, True:
            if before:
                (self.dir / "deep/b").mkdir(parents=True)
            answer = self.asked("--bundle", "deep/b", allowed=(1,),
                                preexec_fn=SMALL_FILES)
            self.assertIn("deep/b/report/index.html", answer.stderr)
            self.assertIn("residual_rms_deg_per_s", answer.stdout)
            self.assertEqual((self.dir / "deep").exists(), before)
            if before:
                self.assertEqual(list((self.dir / "deep/b").iterdir()), [])
        self.asked("--bundle", "deep/b")
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
            self.assertIn("place of its own", self.rejected(
                "validate", "cubic.toml", *DEVICE, *words, says=says))

    def test_what_can_be_no_directory_is_refused_by_its_option(self):
        self.write("file", "mine")
        for option in "--report", "--figures", "--bundle":
            for name in ["/proc/x", "/dev/full", "file", "file/x", "c.json"]:
                self.assertNotIn("filesystem error", self.rejected(
                    "validate", "cubic.toml", *DEVICE, option, name,
                    says=f"{option} {name}: "))

    def test_what_fails_or_is_interrupted_leaves_no_directory(self):
        self.write("hang.py", "import pathlib, time\n"
                   "pathlib.Path('begun').touch()\ntime.sleep(600)\n")
        for number in signal.SIGINT, signal.SIGTERM:
            self.interrupted(
                "validate", "cmd:/usr/bin/python3 hang.py", *DEVICE, "--report",
                "r", "--figures", "f", "--bundle", "b", until="begun", by=number,
                preexec_fn=without_landlock)
            (self.dir / "begun").unlink()
            for name in "rfb":
                self.assertFalse((self.dir / name).exists(), name)
