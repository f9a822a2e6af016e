# SPDX-License-Identifier: MIT
"""The page that `validate --report` writes, opened in headless Chromium."""

import json
import re
import shutil
import unittest

import pytest

from browser import CHROMIUM, browser
from program import PROGRAM, ROOT, SCENARIOS, ProgramTest, class_folder, ended

WIDTHS = [1280, 390]  # [px], of a desktop and of a phone
NAME = "<img src=x onerror=alert(1)><!--.toml"  # what a file may be called

# Canvases without a pixel in the colour of a series, by their figures.
BLANK = """
drawn.filter(({chart}) => {
  const {width, height} = chart.canvas;
  const pixels = chart.ctx.getImageData(0, 0, width, height).data;
  const colors = chart.data.datasets.map(({borderColor}) =>
      [1, 3, 5].map((k) => parseInt(borderColor.slice(k, k + 2), 16)));
  for (let k = 0; k < pixels.length; k += 4)
    if (pixels[k + 3] === 255 && colors.some((color) =>
        color.every((part, j) => Math.abs(part - pixels[k + j]) < 3)))
      return false;
  return true;
}).map(({figure}) => figure.id)
"""


# ReportFile writes the page in test.sh; what a browser shows of it, and whether
# its scripts run, is tested only here.
@pytest.mark.deep
@unittest.skipIf(CHROMIUM is None,
                 "needs a browser: apt-get install chromium")
class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = class_folder(cls, "a report ")
        shutil.copy(SCENARIOS / "models/cubic.toml", cls.dir / NAME)
        ended(PROGRAM, "validate", NAME, "--device",
              SCENARIOS / "devices/nominal.toml", "--spec",
              ROOT / "specs/uav.toml", "--report", "report", "--json",
              "result.json", cwd=cls.dir, allowed=(0, 3))
        cls.page = cls.dir / "report/index.html"
        cls.result = json.loads((cls.dir / "result.json").read_text())
        cls.browser = cls.enterClassContext(browser())

    def opened(self, width=1280, dark=False):
        self.browser.open(self.page, width, dark)
        return self.browser

    def test_opens_without_a_complaint_and_asks_for_nothing_else(self):
        for width in WIDTHS:
            for dark in [False, True]:
                tab = self.opened(width, dark)
                self.assertEqual(tab.complaints(), [])
                self.assertEqual(tab.requests(), [self.page.as_uri()])

    def test_draws_every_figure(self):
        self.assertGreaterEqual(len(self.result["figures"]), 12)
        for width in WIDTHS:
            for dark in [False, True]:
                tab = self.opened(width, dark)
                self.assertEqual(tab.value("drawn.length"),
                                 len(self.result["figures"]))
                self.assertEqual(tab.value(BLANK), [])

    def test_is_no_wider_than_the_screen(self):
        for width in [320, *WIDTHS, 820, 1000]:
            tab = self.opened(width)
            tab.value("document.querySelectorAll('details')"
                      ".forEach((each) => { each.open = true; })")
            self.assertLessEqual(
                tab.value("document.documentElement.scrollWidth"), width)

    def test_begins_with_the_verdict_and_shows_names_as_they_are(self):
        tab = self.opened()
        self.assertEqual(tab.value("document.querySelector('h1').innerText")
                         .split()[-1].lower(), self.result["verdict"])
        self.assertIn("<img src=x", tab.value("document.title"))
        self.assertEqual(tab.value("document.images.length"), 0)

    def test_has_a_row_for_every_metric_and_check(self):
        tab = self.opened()
        for section, rows in [("metrics", "metrics"), ("checks", "checks"),
                              ("limits", "limits")]:
            self.assertEqual(
                tab.value(f"document.querySelectorAll('#{section} tbody tr')"
                          ".length"), len(self.result[rows]), section)

    def test_has_the_numbers_behind_every_figure(self):
        tab = self.opened()
        for figure in self.result["figures"]:
            rows = tab.value(
                f"""new Promise((done) => {{
                  const table = document.querySelector(
                      "#figure-{figure['id']} .data-table");
                  table.addEventListener("toggle", () =>
                      done(table.querySelectorAll("tbody tr").length));
                  table.open = true;
                }})""")
            self.assertEqual(
                rows, sum(len(each["x"]) for each in figure["series"]))

    def test_shows_values_where_one_points(self):
        tab = self.opened()
        x, y = tab.value("""(() => {
            const {chart} = drawn[0];
            chart.canvas.scrollIntoView({behavior: "instant"});
            const box = chart.canvas.getBoundingClientRect();
            const point = chart.getDatasetMeta(0).data[2];
            return [box.left + point.x, box.top + point.y];
        })()""")
        tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        series = self.result["figures"][0]["series"][0]
        shown = tab.value("""new Promise((done) => requestAnimationFrame(() => {
            const {tooltip} = drawn[0].chart;
            done([...tooltip.title, ...tooltip.body[0].lines]);
        }))""")
        self.assertEqual(shown[0], series["name"])
        self.assertIn(f"{series['y'][2]:.4g}", shown[2])

    def test_hides_and_shows_a_series(self):
        tab = self.opened()
        shown = "drawn[0].chart.isDatasetVisible(0)"
        for expected in [False, True]:
            tab.value("document.querySelector('.legend button').click()")
            self.assertEqual(tab.value(shown), expected)

    def test_is_dark_on_a_dark_screen_and_light_on_paper(self):
        background = "getComputedStyle(document.body).backgroundColor"
        text = "drawn[0].chart.options.scales.x.title.color"
        light = self.opened()
        self.assertEqual(light.value(background), "rgb(255, 255, 255)")
        on_light = light.value(text)
        dark = self.opened(dark=True)
        self.assertNotEqual(dark.value(background), "rgb(255, 255, 255)")
        self.assertNotEqual(dark.value(text), on_light)
        dark.value("window.dispatchEvent(new Event('beforeprint'))")
        self.assertEqual(dark.value(text), on_light)

    def sheets(self, tab):
        file = self.dir / "printed.pdf"
        tab.pdf(file)
        printed = file.read_bytes()
        self.assertTrue(printed.startswith(b"%PDF"))
        return len(re.findall(rb"/Type /Page\b", printed))

    def test_prints_on_at_most_eight_sheets(self):
        sheets = self.sheets(self.opened(dark=True))
        self.assertGreater(sheets, 3)
        self.assertLessEqual(sheets, 8)

    def test_two_side_by_side_print_on_at_most_eight_sheets(self):
        device = SCENARIOS / "devices/nominal.toml"
        ended(PROGRAM, "validate", NAME, "--device", device, "--bundle",
              "alone", cwd=self.dir, allowed=(0, 3))
        ended(PROGRAM, "validate", SCENARIOS / "models/spline.toml",
              "--device", device, "--spec", ROOT / "specs/uav.toml",
              "--against", "alone/trained.json", "--report", "both",
              cwd=self.dir, allowed=(0, 3))
        self.browser.open(self.dir / "both/index.html", 1280, False)
        shown = self.browser.value(
            "document.getElementById('against').innerText")
        self.assertIn("Side by side", shown)
        self.assertLessEqual(self.sheets(self.browser), 8)

    def test_the_head_says_what_was_judged_and_can_be_signed(self):
        head = self.opened().value("document.getElementById('head').innerText")
        origin = self.result["provenance"]
        for text in [NAME, origin["device"], origin["qualification"],
                     origin["specification"], origin["beamgyro_version"],
                     origin["git_revision"], "at most 2.5 % for each limit",
                     "public seeds of the qualification", "Date", "Signature"]:
            self.assertIn(text, head)

    def test_names_metrics_in_words_with_their_unit_once(self):
        names = self.opened().value(
            "[...document.querySelectorAll('#metrics summary')]"
            ".map((each) => each.textContent)")
        self.assertEqual(len(set(names)), len(self.result["metrics"]))
        self.assertIn("Vibration rectification [°/s/g²]", names)
        for name in names:
            self.assertNotRegex(name, r"_|\bdeg|\bper\b|Hz.*Hz|ppm.*ppm")
        verdict = self.opened().value(
            "document.querySelector('.verdict').innerText")
        for metric in self.result["metrics"]:
            self.assertNotIn(metric["name"], verdict)

    def test_links_to_every_section(self):
        links = self.opened().value(
            "[...document.querySelectorAll('nav a')].map((link) =>"
            " [link.textContent, document.querySelector(link.hash)"
            ".querySelector('h2').textContent])")
        self.assertGreater(len(links), 4)
        for number, (link, heading) in enumerate(links, 1):
            self.assertEqual(link, heading)
            self.assertTrue(link.startswith(f"{number} "))


class ReportFile(ProgramTest):
    def test_is_the_same_for_the_same_inputs_and_small(self):
        device = SCENARIOS / "devices/nominal.toml"
        for name, jobs in [("one", 1), ("two", 2)]:
            self.beamgyro("validate", SCENARIOS / "models/cubic.toml",
                          "--device", device, "--report", name, "--jobs", jobs)
        page = (self.dir / "one/index.html").read_bytes()
        self.assertEqual(page, (self.dir / "two/index.html").read_bytes())
        self.assertLess(len(page), 2_000_000)
        self.assertEqual(list((self.dir / "one").iterdir()),
                         [self.dir / "one/index.html"])
