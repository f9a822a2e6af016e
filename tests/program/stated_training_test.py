# SPDX-License-Identifier: MIT
"""What libraries state of their training, and verdicts that ask for it."""

from program import CUBIC, ROOT, ProgramTest, by_name, failed, ramp, said

NAME = 'ä "b" ??('  # to be quoted in C, and to be written otherwise


class StatedTraining(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("model.toml", CUBIC)
        self.run_scenario(NAME, text=ramp(seed=3))
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        self.ok("train", f"{NAME}.h5", "--model", "model.toml", "-o", "c.json")
        self.ok("export", "c.json", "--format", "c", "-o", "firmware", "--name",
                "gyro")
        self.build("exported", "firmware/gyro.c", "firmware/gyro_plugin.c",
                   "-std=c99", "-pedantic-errors")
        self.build("silent", ROOT / "examples/plugins/cubic.c")

    def build(self, name, *words):
        said("cc", "-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC",
             f"-I{ROOT}/include", *words, "-o", f"{name}.so", cwd=self.dir)

    def hold_out(self, library, run, *more):
        verdict, _ = self.validated(library, run, *more, allowed=(0, 3))
        return by_name(verdict["checks"])["hold_out"], verdict

    def test_an_exported_library_is_found_on_its_training_run(self):
        check, verdict = self.hold_out("./exported.so", f"{NAME}.h5")
        self.assertIs(check["passed"], False)
        self.assertIn("Training saw 1 of the 1 runs", verdict["words"])
        check, verdict = self.hold_out("./exported.so", "test.h5")
        self.assertIs(check["passed"], True)

    def test_one_that_states_nothing_fails_where_that_is_asked_for(self):
        for more, expected in [((), None), (("--require-provenance",), False)]:
            check, verdict = self.hold_out("./silent.so", "test.h5", *more)
            self.assertIs(check["passed"], expected)
            self.assertIn("names no recording that it was trained on",
                          check["words"])
            self.assertEqual("hold_out" in failed(verdict), bool(more))
        for sound in "./exported.so", "c.json":
            check, _ = self.hold_out(sound, "test.h5", "--require-provenance")
            self.assertIs(check["passed"], True)

    def test_a_bundle_keeps_what_was_asked_for(self):
        self.beamgyro("validate", "c.json", "test.h5", "--require-provenance",
                      "--bundle", "bundle")
        request = self.json("bundle/bundle.json")["request"]
        self.assertIs(request["require_provenance"], True)
        self.ok("validate", "--check", "bundle")
