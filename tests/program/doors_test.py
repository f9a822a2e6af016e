# SPDX-License-Identifier: MIT
"""One compensator and one verdict, by whatever name and way it is judged."""

import json
import shutil
import subprocess
import time

from program import CUBIC, PROGRAM, ROOT, ProgramTest, class_folder, ramp
from sets import CAMPAIGN, SCENARIO

NAMES = ["x.json", "x.comp", "x.JSON", "link"]
IDENTITY = """\
import sys
rate = sys.stdin.readline().strip().split(",").index("rate")
for line in sys.stdin:
    print(line.split(",")[rate])
"""


class Judged(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        case = cls()
        cls.kept = case.dir = class_folder(cls)
        case.prepare()
        case.run_scenario("train", text=ramp(seed=3))
        case.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        case.write("cubic.toml", CUBIC)
        case.ok("train", "train.h5", "--model", "cubic.toml", "-o", "x.json")

    def setUp(self):
        super().setUp()
        shutil.copytree(self.kept, self.dir, dirs_exist_ok=True)
        for name in "x.comp", "x.JSON":
            shutil.copy(self.dir / "x.json", self.dir / name)
        (self.dir / "link").symlink_to("x.json")

    def judged(self, compensator, *arguments, status):
        """What is said, without the name of the compensator."""
        answer = self.beamgyro("validate", compensator, *arguments, "--json",
                               "v.json")
        self.assertEqual(answer.returncode, status,
                         answer.stdout + answer.stderr)
        said = json.loads((self.dir / "v.json").read_text())
        del said["compensator"]["name"]
        for file in said["provenance"]["files"]:
            if file["group"] == "compensator":
                del file["name"]
        return said

    def in_python(self, compensator, run):
        """Verdict, words and checks of beamgyro.validate()."""
        said = subprocess.run(
            ["/usr/bin/python3", "-c",
             "import json, sys, beamgyro as bg\n"
             "r = bg.validate(sys.argv[1], [sys.argv[2]])\n"
             "print(json.dumps([r.passed, r.data['words']]))", compensator, run],
            cwd=self.dir, capture_output=True, text=True, check=False,
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
            failed = [check["name"] for check in first["checks"]
                      if check["passed"] is False]
            self.assertEqual(failed, ["hold_out"] if status else [])
            pages = []
            for name in NAMES:
                with self.subTest((run, name)):
                    bundle = f"of_{run[:-3]}_{name}".replace(".", "_")
                    self.assertEqual(
                        self.judged(name, run, status=status), first)
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
        for name, ambient in [("rest", "constant_degC = 25"),
                              ("ramp", "points = [[0, -30], [4000, 40]]")]:
            self.write(f"{name}.toml", SCENARIO.format(
                name=name, ambient=ambient).replace(
                    "duration_s = 60\noutput_rate_Hz = 2",
                    "duration_s = 4000\noutput_rate_Hz = 0.5"))
        self.write("campaign.toml", CAMPAIGN)
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
        subprocess.run(["cc", "-shared", "-fPIC", f"-I{ROOT}/include",
                        ROOT / "examples/plugins/cubic.c", "-o", "lib.json"],
                       cwd=self.dir, check=True)
        said = self.judged("./lib.json", "test.h5", status=0)
        self.assertEqual(said["compensator"]["kind"], "library")

    def test_code_of_a_bundle_runs_where_it_may(self):
        (self.dir / "ran").touch()
        self.write("same.py", "open('ran', 'a').write('x')\n" + IDENTITY)
        self.judged("cmd:/usr/bin/python3 same.py", "test.h5", "--bundle", "b",
                    status=3)
        ran = (self.dir / "ran").read_text()
        self.rejected("validate", "--check", "b",
                      says=["/usr/bin/python3 same.py", "--run-code"])
        self.assertEqual((self.dir / "ran").read_text(), ran)
        self.ok("validate", "--check", "b", "--run-code")
        self.assertNotEqual((self.dir / "ran").read_text(), ran)

    def test_a_constant_is_not_good_enough_for_a_device(self):
        self.write("constant.toml", 'kind = "constant"\n'
                   'inputs = ["temperature"]\n')
        self.write("ramp.toml", ramp(seed=11))
        self.write("q.toml", 'name = "q"\n[[run]]\nname = "ramp"\n'
                   'purpose = "ramp"\nscenario = "ramp.toml"\n'
                   '[[training]]\nname = "t"\nscenario = "ramp.toml"\n'
                   '[training.overrides]\nseed = 21\n')
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
        with subprocess.Popen(
                [str(PROGRAM), "validate", "cmd:/usr/bin/python3 slow.py",
                 *arguments, "--bundle", "b"], cwd=self.dir, text=True,
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE) as asked:
            while asked.poll() is None and not (self.dir / "asked").exists():
                time.sleep(0.05)
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
        self.ok("validate", "--check", "b", "--run-code")

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
        self.ok("validate", "--check", "b", "--run-code")
