# SPDX-License-Identifier: MIT
"""The pictures of the pages are not older than what they are made of."""

import pathlib
import shutil
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
# pylint: disable-next=wrong-import-position
import pictures  # noqa: E402


class Pictures(unittest.TestCase):
    def test_none_is_older_than_its_sources(self):
        self.assertEqual(pictures.old(), [], "run scripts/pictures.py")

    def test_every_picture_has_a_maker(self):
        made = {path for _, patterns, _ in pictures.MAKERS.values()
                for path in pictures.matching(patterns, pictures.PICTURES)}
        there = {path for path in pictures.PICTURES.iterdir()
                 if path.suffix in (".png", ".svg")}
        self.assertGreater(len(there), 12)
        self.assertEqual(there, made)

    def test_a_changed_source_and_a_changed_picture_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for part in ("docs/pictures", "scripts", "python", "scenarios",
                         "specs", "validation/page", "examples/python"):
                shutil.copytree(ROOT / part, root / part)
            with mock.patch.multiple(
                    pictures, ROOT=root, PICTURES=root / "docs/pictures",
                    RECORD=root / "docs/pictures/sources.json"):
                self.assertEqual(pictures.old(), [])
                page = root / "validation/page/page.html"
                page.write_text(page.read_text().replace("<h2>", "<h3>"))
                self.assertEqual(pictures.old(), ["report"])
                style = root / "python/beamgyro/plots/style.py"
                style.write_text("# A comment.\n" + style.read_text())
                self.assertEqual(pictures.old(), ["report"])
                style.write_text(style.read_text().replace(
                    "WIDTH = 8.0", "WIDTH = 9.0"))
                self.assertEqual(pictures.old(), ["gallery", "report", "demo"])
                picture = root / "docs/pictures/gyro.svg"
                picture.write_text(picture.read_text() + " ")
                self.assertEqual(pictures.old(),
                                 ["diagrams", "gallery", "report", "demo"])
