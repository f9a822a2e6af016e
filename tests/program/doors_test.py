# SPDX-License-Identifier: MIT
"""One compensator and one verdict, by whatever name and way it is judged."""

import json
import shutil

from program import (CUBIC, IDENTITY, PROGRAM, ROOT, SCENARIO, ProgramTest, ended,
                     failed, ramp, without_landlock)
from qualified import SHORT
from sets import write_campaign

NAMES = ["x.json", "x.comp", "x.JSON", "link"]


class Judged(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("train", text=ramp(seed=3))
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        self.write("cubic.toml", CUBIC)
        self.ok("train", "train.h5", "--model", "cubic.toml", "-o", "x.json")
        for name in "x.comp", "x.JSON":
            shutil.copy(self.dir / "x.json", self.dir / name)
        (self.dir / "link").symlink_to("x.json")

    def judged(self, compensator, *arguments, status, **options):
        """What is said, without the name of the compensator."""
        said, _ = self.validated(compensator, *arguments, allowed=(status,),
                                 **options)
        del said["compensator"]["name"]
        for file in said["provenance"]["files"]:
            if file["group"] == "compensator":
                del file["name"]
        return said

    def in_python(self, compensator, run):
        """Verdict, words and checks of beamgyro.validate()."""
        said = self.beamgyro(
            "-c", "import json, sys, beamgyro as bg\n"
            "r = bg.validate(sys.argv[1], [sys.argv[2]])\n"
            "print(json.dumps([r.passed, r.data['words']]))", compensator, run,
            program="/usr/bin/python3",
            env={"PYTHONPATH": str(PROGRAM.parent / "python")})
        if "No module named" in said.stderr:
            return None  # a build without Python
        self.assertEqual(said.returncode, 0, said.stderr)
        return json.loads(said.stdout)


class Doors(Judged):
    """Names, outputs and languages."""

    def test_every_name_and_every_way(self):
        default = ["--spec", ROOT / "specs/default.toml"]
        for run, status in [("test.h5", 0), ("train.h5", 3)]:
            first = self.judged("x.json", run, status=status)
            self.assertEqual(failed(first), ["hold_out"] if status else [])
            pages = []
            for name in NAMES:
                bundle = f"of_{run[:-3]}_{name}".replace(".", "_")
                self.assertEqual(self.judged(name, run, status=status), first)
                self.assertEqual(
                    self.judged(name, run, "--report", "page", "--bundle",
                                bundle, status=status), first)
                self.ok("validate", "--check", bundle)
                asked = self.judged(name, run, *default, status=status)
                for key in "verdict", "words", "checks", "metrics":
                    self.assertEqual(asked[key], first[key])
                self.assertEqual(asked.keys(), first.keys())
            for _ in range(2):
                self.judged("x.json", run, "--report", "page", status=status)
                pages.append((self.dir / "page/index.html").read_bytes())
            self.assertEqual(*pages)
            for name in NAMES:
                told = self.in_python(name, run)
                if told is not None:
                    self.assertEqual(told, [status == 0, first["words"]])

    def test_a_set_is_judged_alike(self):
        write_campaign(self, seconds=4000, rate_Hz=0.5,
                       ramp="points = [[0, -30], [4000, 40]]")
        self.ok("generate", "campaign.toml", "-o", "set")
        devices = ["--device", 1, "--device", 4]
        keys = self.judged("x.json", "test.h5", status=0).keys()
        first = self.judged("x.json", "set", *devices, status=3)
        self.assertEqual(first.keys() - {"population", "yield"},
                         keys - {"population", "yield"})
        for name in NAMES:
            for page in [], ["--report", "page"]:
                self.assertEqual(self.judged(name, "set", *devices, *page,
                                             status=3), first)

    def test_a_command_may_name_any_file(self):
        self.write("same.py", IDENTITY)
        for file in "x.json", "cubic.toml", "lib.so":
            said = self.judged(f"cmd:/usr/bin/python3 same.py {file}",
                               "test.h5", status=3)
            self.assertEqual(said["compensator"]["kind"], "command")

    def test_a_library_is_one_by_its_bytes(self):
        ended("cc", "-shared", "-fPIC", f"-I{ROOT}/include",
              ROOT / "examples/plugins/cubic.c", "-o", "lib.json", cwd=self.dir)
        said = self.judged("./lib.json", "test.h5", status=0)
        self.assertEqual(said["compensator"]["kind"], "library")

    def test_code_of_a_bundle_runs_where_it_may(self):
        (self.dir / "ran").touch()
        self.write("same.py", "open('ran', 'a').write('x')\n" + IDENTITY)
        writes = {"preexec_fn": without_landlock}
        self.judged("cmd:/usr/bin/python3 same.py", "test.h5", "--bundle", "b",
                    status=3, **writes)
        ran = self.text("ran")
        self.rejected("validate", "--check", "b",
                      says=["/usr/bin/python3 same.py", "--run-code"], **writes)
        self.assertEqual(self.text("ran"), ran)
        self.ok("validate", "--check", "b", "--run-code", **writes)
        self.assertNotEqual(self.text("ran"), ran)

    def test_a_constant_is_not_good_enough_for_a_device(self):
        self.write("constant.toml", 'kind = "constant"\n'
                   'inputs = ["temperature"]\n')
        self.write("ramp.toml", ramp(seed=11))
        self.write("warm_up.toml", SCENARIO)
        self.write("q.toml", SHORT)
        said = self.judged("constant.toml", "--device", "device.toml",
                           "--qualification", "q.toml", status=3)
        self.assertIn("Of no use", said["words"])


class ChangedMeanwhile(Judged):
    """What is bundled is what was judged."""

    def changed_while_judged(self, name, *arguments):
        """Its bytes, of which others take the place while a slow command
        answers, and the status."""
        before = (self.dir / name).read_bytes()
        self.write("slow.py", "import pathlib, time\n"
                   "pathlib.Path('asked').touch()\n"
                   "while not pathlib.Path('go').exists():\n"
                   "    time.sleep(0.05)\n" + IDENTITY)
        with self.working("validate", "cmd:/usr/bin/python3 slow.py",
                          *arguments, "--bundle", "b", until="asked",
                          preexec_fn=without_landlock) as asked:
            shutil.copy(self.dir / "other", self.dir / name)
            (self.dir / "go").touch()
            _, words = asked.communicate()
        return before, asked.returncode, words

    def test_a_specification(self):
        shutil.copy(ROOT / "specs/default.toml", self.dir / "spec.toml")
        self.write("other", 'name = "other"\n[limits]\n'
                   'residual_max_deg_per_s = { max = 1e-9, source = "s" }\n')
        before, status, words = self.changed_while_judged(
            "spec.toml", "test.h5", "--spec", "spec.toml")
        self.assertEqual(status, 3, words)
        copy = self.dir / "b/inputs/specification/spec.toml"
        self.assertEqual(copy.read_bytes(), before)
        self.ok("validate", "--check", "b", "--run-code",
                preexec_fn=without_landlock)

    def test_a_recording(self):
        shutil.copy(self.dir / "train.h5", self.dir / "other")
        before, status, words = self.changed_while_judged("test.h5", "test.h5")
        if status == 1:
            self.assertIn("test.h5: changed", words)
            self.assertFalse((self.dir / "b").exists())
            return
        self.assertEqual(status, 3, words)
        self.assertEqual((self.dir / "b/inputs/runs/test.h5").read_bytes(),
                         before)
        self.ok("validate", "--check", "b", "--run-code",
                preexec_fn=without_landlock)
