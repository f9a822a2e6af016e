# SPDX-License-Identifier: MIT
"""The pictures of `validate --figures`."""

import json
import os
import struct

from program import SCENARIOS, ProgramTest

ARGUMENTS = ["validate", SCENARIOS / "models/cubic.toml", "--device",
             SCENARIOS / "devices/nominal.toml", "--figures", "my figures"]


class ValidationFigures(ProgramTest):
    def test_every_figure_is_a_picture_for_slides(self):
        self.ended(*ARGUMENTS, allowed=(0, 3))
        folder = self.dir / "my figures"
        result = json.loads((folder / "result.json").read_text())
        names = {f"{figure['id']}.png" for figure in result["figures"]}
        self.assertGreaterEqual(len(names), 12)
        self.assertEqual({file.name for file in folder.iterdir()},
                         {*names, "result.json"})
        for name in names:
            head = (folder / name).read_bytes()[:24]
            self.assertEqual(struct.unpack(">II", head[16:]), (1600, 900), name)

    def test_a_script_that_fails_is_quoted(self):
        broken = self.dir / "modules"
        broken.mkdir()
        (broken / "matplotlib.py").write_text("raise ImportError('none here')")
        answer = self.ended(*ARGUMENTS,
                            env={**os.environ, "PYTHONPATH": str(broken)},
                            allowed=(1,))
        self.assertIn("none here", answer.stderr)
        self.assertIn("python3-matplotlib", answer.stderr)
