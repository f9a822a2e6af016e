#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the worked example of docs/compensation.md as it stands there."""

import json
import re
import subprocess
import unittest

from program import PROGRAM, ROOT, ProgramTest

PAGE = (ROOT / "docs/compensation.md").read_text()


class Guide(ProgramTest):
    def test_from_a_raw_log_to_firmware(self):
        script = re.search(r"```sh\n(.*?)```", PAGE, re.DOTALL)[1]
        self.assertIn("g=build/release/beamgyro\n", script)
        script = script.replace("g=build/release/beamgyro", f'g="{PROGRAM}"') \
            .replace("scenarios/ramp.toml",
                     f'"{ROOT}/scenarios/ramp.toml"').replace("$g ", '"$g" ')
        answer = subprocess.run(["bash", "-euc", script], cwd=self.dir,
                                text=True, capture_output=True, check=False,
                                timeout=300)
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn("kept bp(2,8)", answer.stdout)
        self.assertIn("verdict: keeps the rate", answer.stdout)
        self.assertIn("mine: 10000 answers equal to the last bit",
                      answer.stdout)
        training = json.loads((self.dir / "mine.json").read_text())["training"]
        crossed = training["cross_validation"]
        self.assertEqual((crossed["by"], crossed["groups"]), ("leg", 4))
        self.assertLess(crossed["rms_deg_per_s"], 0.035)
        self.assertGreater(crossed["constant_rms_deg_per_s"], 1.0)
        self.assertIn("TC_G0_X3_2", (self.dir / "firmware/mine.params")
                      .read_text())
        self.rejected("export", "mine.json", "--format", "px4", "-o",
                      "elsewhere", says=["kind bp", "--fit-cubic"])


if __name__ == "__main__":
    unittest.main()
