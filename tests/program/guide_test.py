#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the commands of docs/compensation.md as they stand there."""

import json
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest

PAGE = (ROOT / "docs/compensation.md").read_text()
BLOCKS = re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)


class Guide(ProgramTest):
    def run_script(self, script):
        """What the commands print, run in the directory of the test."""
        script = script.replace("build/release/beamgyro", str(PROGRAM)) \
            .replace(" scenarios/", f' "{ROOT}"/scenarios/') \
            .replace("$g ", '"$g" ')
        answer = subprocess.run(["bash", "-euc", f'g="{PROGRAM}"\n{script}'],
                                cwd=self.dir, text=True, capture_output=True,
                                check=False, timeout=300)
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        return answer.stdout

    def json(self, name):
        return json.loads((self.dir / name).read_text())

    def test_every_block_is_run_by_a_test(self):
        self.assertEqual(len(BLOCKS), 2)

    def test_from_a_raw_log_to_firmware(self):
        self.assertIn("g=build/release/beamgyro\n", BLOCKS[0])
        said = self.run_script(BLOCKS[0])
        self.assertIn("kept bp(2,8)", said)
        self.assertIn("verdict: keeps the rate", said)
        self.assertIn("mine: 10000 answers equal to the last bit", said)
        training = self.json("mine.json")["training"]
        crossed = training["cross_validation"]
        self.assertEqual((crossed["by"], crossed["groups"]), ("leg", 4))
        self.assertLess(crossed["rms_deg_per_s"], 0.035)
        self.assertGreater(crossed["constant_rms_deg_per_s"], 1.0)
        self.assertIn("TC_G0_X3_2", (self.dir / "firmware/mine.params")
                      .read_text())
        self.check_figures(training)
        self.rejected("export", "mine.json", "--format", "px4", "-o",
                      "elsewhere", says=["kind bp", "--fit-cubic"])

    def check_figures(self, training):
        """The text gives those of the example."""
        self.ok("validate", "mine.json", "log_3.h5", "--json", "scores.json")
        run = self.json("scores.json")["runs"][0]
        unseen = {name: float(rms) for name, rms in re.findall(
            r"^(\w+): ([0-9.]+) deg/s rms over",
            "\n".join(training["choices"]), re.MULTILINE)}
        text = " ".join(PAGE.split())
        for said in [
                f"a constant leaves {unseen['constant']:.2f} deg/s rms",
                f"the cubic {unseen['cubic']:.2f}",
                f"the spline {unseen['spline']:.2f}",
                "a 2-8 network on the filtered temperatures "
                f"{training['cross_validation']['rms_deg_per_s']:.3f}",
                f"finds {run['residual']['rms_deg_per_s']:.3f} deg/s rms with "
                f"a mean of {run['residual']['mean_deg_per_s']:.3f}",
                f"{run['percent_of_cubic']:.2f} % of the cubic's variance",
                "the cubic leaves "
                f"{training['baseline_in_sample_rms_deg_per_s']:.2f} deg/s",
                "the network leaves "
                f"{training['in_sample_rms_deg_per_s']:.3f}"]:
            self.assertTrue(said in text, f"not in the text: {said}")

    def test_from_a_population_to_a_new_device(self):
        """Of forty devices, of which not all are helped by the network."""
        check = "validate network.json SET --run check"
        self.assertIn(check, BLOCKS[1])
        said = self.run_script(
            re.sub(f"({check}).*", r"\1 || [ $? = 3 ]", BLOCKS[1])
            .replace("-o SET", "--devices 40 -o SET"))
        self.assertIn("the set is whole", said)
        self.assertIn("verdict: keeps the rate", said)
        self.assertTrue(self.json("adapted.json")["training"]["choices"][0]
                        .startswith("population: population.json"))


if __name__ == "__main__":
    unittest.main()
