# SPDX-License-Identifier: MIT
"""The form of the documentation: width of lines, links, diagrams."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
WIDTH = 100

ROOMS = ["cli", "compensation", "config", "dataset", "parallel", "random",
         "report", "sensitivity", "sim", "validation"]

PAGES = [*ROOT.glob("*.md"), *sorted(ROOT.glob("docs/**/*.md")),
         *sorted(ROOT.glob("bench/*.md")),
         *sorted(ROOT.glob("python/**/*.md")),
         *[page for room in ROOMS for page in ROOT.glob(f"{room}/**/*.md")]]


def anchors(text):
    """Anchors of the headings of a page, as GitHub makes them."""
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
            for heading in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


class Docs(unittest.TestCase):
    def test_lines_are_no_wider_than_100_columns(self):
        self.assertGreater(len(PAGES), 20)
        for page in PAGES:
            wide = [number for number, line in
                    enumerate(page.read_text().splitlines(), 1)
                    if len(line) > WIDTH]
            self.assertEqual(wide, [])

    def test_links_lead_to_files_and_headings(self):
        for page in PAGES:
            text = page.read_text()
            for link in re.findall(r"\]\(([^)\s]+)\)", text):
                path, _, anchor = link.partition("#")
                target = page.parent / path if path else page
                if link.startswith(("http:", "https:")):
                    continue
                self.assertTrue(target.exists())
                if anchor:
                    self.assertIn(anchor, anchors(target.read_text()))

    def test_the_pages_show_every_picture_of_plot(self):
        shown = {name for page in PAGES for name in re.findall(
            r"!\[[^\]]+\]\([^)]*/(plot_\w+\.png)\)", page.read_text())}
        pictures = {path.name for path in
                    (ROOT / "docs/pictures").glob("plot_*.png")}
        self.assertGreater(len(pictures), 3)
        self.assertEqual(shown, pictures)

    def test_pages_named_in_the_sources_exist(self):
        files = [path for folder in (*ROOMS, "scenarios", "tests", "scripts",
                                     "bench")
                 for path in sorted((ROOT / folder).rglob("*"))
                 if path.suffix in (".h", ".cpp", ".c", ".py", ".sh", ".toml",
                                    ".c99", ".txt")]
        self.assertGreater(len(files), 300)
        for path in files:
            for page in re.findall(r"\b(?:docs|bench)/[a-z_/]+\.md\b",
                                   path.read_text(errors="replace")):
                self.assertTrue((ROOT / page).exists())

    def test_the_diagrams_are_those_of_the_script(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, ROOT / "scripts/diagrams.py",
                            folder], check=True)
            drawn = sorted(pathlib.Path(folder).glob("*.svg"))
            self.assertEqual(len(drawn), 3)
            for path in drawn:
                self.assertEqual(
                    path.read_text(),
                    (ROOT / "docs/pictures" / path.name).read_text())

    def test_the_tutorials_need_no_more_than_the_first_command_installs(self):
        """What `scripts/setup.sh demo` leaves is what a tutorial imports."""
        setup = (ROOT / "scripts/setup.sh").read_text()
        installed = setup.split("build=(")[1].split(")")[0].split()
        pages = [ROOT / "README.md", *sorted(
            (ROOT / "docs/tutorials").glob("*.md"))]
        named = set()
        for page in pages:
            named |= set(re.findall(r"^(?:import|from) (\w+)",
                                    page.read_text(), re.MULTILINE))
            named |= set(re.findall(r'engine="(\w+)"', page.read_text()))
        self.assertIn("xarray", named)
        own = {"beamgyro", "arrays"}  # arrays.py is written by the tutorial
        missing = {name for name in named - own - sys.stdlib_module_names
                   if f"python3-{name}" not in installed}
        self.assertEqual(missing, set())
