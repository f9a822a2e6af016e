# SPDX-License-Identifier: MIT
"""The site of the documentation, of the build that the program comes from."""

import html
import re
import unittest

import pytest

from program import PROGRAM, ROOT, class_folder, said

BUILD = PROGRAM.parent


# What stands for it in test.sh: tests/scripts/docs_test.py follows the links of
# the pages and finds every picture of the gallery on one of them;
# tests/python/examples_test.py finds the docstrings that Python's reference is
# made of. That Doxygen and Sphinx read all of it without a warning, the
# reference of C++, and the way from the front page to every page are tested
# only here.
@pytest.mark.deep
@unittest.skipUnless((BUILD / "python/beamgyro/__init__.py").exists(),
                     "the program does not stand in its build")
class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = class_folder(cls, "site ")
        said(ROOT / "scripts/docs.sh", BUILD, cls.dir)
        cls.site = cls.dir / "html"

    def words(self, page):
        """The text of a page, without tags."""
        text = (self.site / page).read_text()
        body = text[text.index('role="main"'):]
        return " ".join(html.unescape(
            re.sub("<[^>]+>", " ", body)).replace("\uf0c1", "").split())

    def test_every_page_of_the_documentation_is_there(self):
        pages = [page for page in (ROOT / "docs").rglob("*.md")
                 if "site" not in page.parts]
        self.assertGreater(len(pages), 40)
        for page in pages:
            name = page.relative_to(ROOT).with_suffix(".html")
            self.assertTrue((self.site / name).exists())

    def test_links_within_the_site_lead_to_files(self):
        for page in self.site.rglob("*.html"):
            text = page.read_text()
            for link in re.findall(r'(?:href|src)="([^"#]+)', text):
                if re.match(r"\w+:", link):
                    continue
                self.assertTrue((page.parent / link).exists())

    def test_every_page_is_reached_from_the_front_page(self):
        seen, waiting = set(), [self.site / "index.html"]
        while waiting:
            page = waiting.pop()
            if page in seen:
                continue
            seen.add(page)
            waiting += [(page.parent / link).resolve() for link in
                        re.findall(r'<a [^>]*href="([^"#:]+\.html)',
                                   page.read_text())]
        pages = {page for page in self.site.rglob("*.html")
                 if page.name != "search.html"}  # by the form of each page
        self.assertEqual(sorted(pages - seen), [])

    def test_nothing_is_loaded_from_elsewhere(self):
        for page in self.site.rglob("*.html"):
            text = page.read_text()
            self.assertEqual(
                re.findall(r'(?:src="|<link[^>]*href=")(?:https?:)?//'
                           r'[^"]*', text), [])

    def test_the_notebooks_were_run_and_show_what_they_draw(self):
        for notebook in (ROOT / "examples/python").glob("*.ipynb"):
            page = (self.site / f"notebooks/{notebook.stem}.html").read_text()
            self.assertIn(f"_images/{notebook.stem}_", page)
            self.assertIn("<b>Checks</b>", page)

    def test_the_reference_of_python_has_every_public_name(self):
        init = (BUILD / "python/beamgyro/__init__.py").read_text()
        public = re.findall(r'"(\w+)"',
                            init.split("__all__ = [")[1].split("]")[0])
        self.assertGreater(len(public), 10)
        page = (self.site / "python.html").read_text()
        for name in public:
            if name != "__version__":
                self.assertIn(f'id="beamgyro.{name}"', page)
        for name in ("_accessor.RecordingAccessor.plot", "plots.plot",
                     "plots.plot_allan"):
            self.assertIn(f'id="beamgyro.{name}"', page)

    def test_the_reference_of_cpp_has_every_public_header(self):
        headers = sorted((ROOT / "include/beamgyro").glob("*.h"))
        self.assertGreater(len(headers), 10)
        for header in headers:
            text = self.words(f"cpp/{header.stem}.html")
            declared = re.findall(r"^(class|struct) (\w+) (?:final )?\{",
                                  header.read_text(), re.MULTILINE)
            for kind, name in declared:
                self.assertIn(f"{kind} {name} ", text)
        self.assertIn("Computes the steady state at beam temperatures",
                      self.words("cpp/device.html"))
        self.assertNotIn("Private", self.words("cpp/device.html"))

    def test_the_gallery_has_every_picture_of_plot(self):
        gallery = (self.site / "gallery.html").read_text()
        pictures = sorted((ROOT / "docs/pictures").glob("plot_*.png"))
        self.assertGreater(len(pictures), 3)
        for picture in pictures:
            self.assertIn(f"_images/{picture.name}", gallery)
            self.assertTrue((self.site / "_images" / picture.name).exists())
