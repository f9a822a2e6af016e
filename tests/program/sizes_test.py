# SPDX-License-Identifier: MIT
"""Files that claim to be large: holes of gigabytes, numbers of megabytes."""

import os
import resource

from program import PROGRAM, ProgramTest, limit, limits, said

HUGE = 20 << 30  # bytes, which take none of the disk
LONG = 15_000_000  # letters, within what a file of JSON may have
FEW_SECONDS = limit(resource.RLIMIT_CPU, 3)  # of processor time
MEMORY = limit(resource.RLIMIT_AS, 2 << 30)


class Sizes(ProgramTest):
    def prepare(self):
        super().prepare()
        self.cubic_of_a_ramp("run")

    def make_huge(self, name):
        self.write(name, "")
        os.truncate(self.dir / name, HUGE)
        return name

    def refused(self, *arguments, says):
        words = self.rejected(*arguments, says=says, preexec_fn=MEMORY)
        self.assertLess(len(words), 5000)

    def rejected(self, *arguments, says=(), status=2, **options):
        # Without a look at the bytes of all files.
        answer = self.ended(*arguments, allowed=(status,), **options)
        self.assertSays(answer.stderr, says)
        return answer.stderr

    def test_a_compensator_of_gigabytes_is_not_read(self):
        name = self.make_huge("huge.json")
        says = [f"{name}: {HUGE} bytes; expected a compensator"]
        for command in [["validate", name, "run.h5"],
                        ["compensate", name, "run.h5", "-o", "out.h5"],
                        ["export", name, "--format", "c", "-o", "c"]]:
            self.refused(*command, says=says)
        code = ("import beamgyro\n"
                "try:\n    beamgyro.Compensator('huge.json')\n"
                "except ValueError as error:\n    print(error)\n")
        self.assertSays(
            said("/usr/bin/python3", "-c", code, cwd=self.dir,
                 preexec_fn=MEMORY, env=os.environ | {
                     "PYTHONPATH": str(PROGRAM.parent / "python")}), says)

    def test_a_result_of_gigabytes_is_not_read(self):
        name = self.make_huge("huge.json")
        self.refused("validate", "c.json", "run.h5", "--baseline-result", name,
                     says="expected the result of a validation")

    def test_a_number_or_a_text_of_megabytes_is_quoted_in_part(self):
        head = '{"filetype": '
        self.write("number.json", head + "1" * LONG + "}")
        self.write("text.json", f'{head}"{"a" * LONG}"}}')
        for name in ("number.json", "text.json"):
            self.refused("validate", name, "run.h5", says=f"{name}: ")

    def test_a_bundle_with_gigabytes_is_told_at_once(self):
        self.write("limits.toml", limits(bias_pp_deg_per_s=9))
        self.ended("validate", "c.json", "run.h5", "--spec", "limits.toml",
                   "--bundle", "b", allowed=(0, 3))
        for name in ("report.txt", "inputs/compensator/c.json"):
            self.assertTrue((self.dir / "b" / name).exists())
            self.make_huge(f"b/{name}")
            answer = self.ended("validate", "--check", "b", allowed=(1,),
                                preexec_fn=FEW_SECONDS)
            self.assertSays(answer.stdout + answer.stderr, name)
        self.make_huge("b/bundle.json")
        self.refused("validate", "--check", "b",
                     says="expected that of a bundle")
