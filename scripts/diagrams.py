#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws the diagrams of docs/ as SVG: diagrams.py [DIR]

DIR is docs/pictures without the argument. Colours differ in lightness, so the
diagrams can be printed in grey. The same bytes come out on every machine.
"""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

INK, PALE, MIDDLE, DARK = "#222222", "#eef1f4", "#b9c9da", "#2b5c8a"
ACCENT = "#a84a10"


class Drawing:
    """Shapes in pixels, from the upper left corner."""

    def __init__(self, width, height, title):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" '
            f'height="{height}" viewBox="0 0 {width} {height}" '
            'font-family="DejaVu Sans, Verdana, Arial, sans-serif" '
            f'font-size="14" fill="{INK}">',
            f"<title>{title}</title>",
            "<defs>"]
        for name, colour in [("ink", INK), ("accent", ACCENT)]:
            self.parts.append(
                f'<marker id="{name}" viewBox="0 0 10 10" refX="9" refY="5" '
                'markerUnits="userSpaceOnUse" markerWidth="13" '
                'markerHeight="13" orient="auto-start-reverse">'
                f'<path d="M0 0 L10 5 L0 10 z" fill="{colour}"/></marker>')
        self.parts += ["</defs>",
                       f'<rect width="{width}" height="{height}" fill="white"/>']

    def text(self, x, y, words, anchor="middle", size=14, bold=False,
             colour=INK):
        """Lines of text; y is the base of the first."""
        weight = ' font-weight="bold"' if bold else ""
        for k, line in enumerate(words.split("\n")):
            line = line.replace("&", "&amp;").replace("<", "&lt;")
            self.parts.append(
                f'<text x="{x:g}" y="{y + k * (size + 4):g}" '
                f'text-anchor="{anchor}" font-size="{size}"{weight} '
                f'fill="{colour}">{line}</text>')

    def box(self, x, y, width, height, words="", fill=PALE, radius=4,
            bold=False, ink=INK):
        """A box about (x, y) with text in its middle."""
        self.parts.append(
            f'<rect x="{x - width / 2:g}" y="{y - height / 2:g}" '
            f'width="{width:g}" height="{height:g}" rx="{radius}" '
            f'fill="{fill}" stroke="{INK}" stroke-width="1.3"/>')
        lines = words.count("\n") + 1
        if words:
            self.text(x, y + 5 - 9 * (lines - 1), words, bold=bold, colour=ink)

    def path(self, d, colour=INK, width=1.5, dash="", arrow="", fill="none"):
        """`arrow` is "end", "both" or nothing."""
        name = "accent" if colour == ACCENT else "ink"
        more = f' stroke-dasharray="{dash}"' if dash else ""
        if arrow:
            more += f' marker-end="url(#{name})"'
        if arrow == "both":
            more += f' marker-start="url(#{name})"'
        self.parts.append(f'<path d="{d}" fill="{fill}" stroke="{colour}" '
                          f'stroke-width="{width:g}"{more}/>')

    def line(self, x1, y1, x2, y2, **style):
        self.path(f"M{x1:g} {y1:g} L{x2:g} {y2:g}", **style)

    def svg(self):
        return "\n".join([*self.parts, "</svg>"]) + "\n"


def spring(drawing, x, top, bottom):
    """A vertical zigzag."""
    step = (bottom - top) / 8
    points = [(x, top), (x, top + step)] + [
        (x + 9 * (-1) ** k, top + step * (1.5 + k)) for k in range(6)] + [
        (x, bottom - step), (x, bottom)]
    drawing.path("M" + " L".join(f"{a:g} {b:g}" for a, b in points))


def gyro_side(drawing):
    """The beam from its side, z to the right and x up."""
    left, right, y = 70, 510, 190
    span = right - left
    # The bent beam: nodes at 0.224 and 0.776 of the length, free ends.
    bent = (
        f"M{left} {y - 62} Q{left + 0.13 * span:g} {y - 14} "
        f"{left + 0.224 * span:g} {y} Q{left + span / 2:g} {y + 84} "
        f"{left + 0.776 * span:g} {y} Q{right - 0.13 * span:g} {y - 14} "
        f"{right} {y - 62}")
    drawing.box((left + right) / 2, y, span, 22, fill=MIDDLE, radius=0)
    middle = (left + right) / 2
    drawing.box(middle, y - 17, 132, 10, fill=DARK, radius=0)
    drawing.box(middle, y + 17, 132, 10, fill=DARK, radius=0)
    drawing.path(bent, colour=DARK, dash="6 4", width=1.8)
    drawing.text(middle, y - 36, "drive patch")
    drawing.text(middle, y + 66, "feedback patch")
    drawing.line(middle, y + 52, middle, y + 26, width=1)
    for share in (0.224, 0.776):
        node = left + share * span
        spring(drawing, node, y + 11, y + 88)
        drawing.line(node - 34, y + 88, node + 34, y + 88, width=2.5)
    drawing.text(left + 0.224 * span, y + 110, "mount at the\nvibration node")
    drawing.text(left + 0.776 * span, y + 110, "mount at the\nvibration node")
    drawing.text(left - 4, y - 92, "drive mode,\nmuch enlarged", "start",
                 size=12, colour=DARK)
    drawing.line(right + 6, y, right + 74, y, arrow="end")
    drawing.text(right + 66, y + 22, "z", bold=True)
    drawing.path(f"M{right + 32} {y - 21} A 10 26 0 1 1 {right + 32} {y + 21}",
                 colour=ACCENT, width=2, arrow="end")
    drawing.text(right + 38, y - 38, "rate Ω", colour=ACCENT, bold=True)
    drawing.text(middle, 40, "From the side", bold=True, size=16)


def gyro_section(drawing):
    """The section seen along +z, x up and y to the right."""
    x, y, half = 830, 200, 62
    drawing.box(x, y, 2 * half, 2 * half, fill=MIDDLE, radius=0)
    for dx, dy, wide in [(0, -1, True), (0, 1, True), (1, 0, False),
                         (-1, 0, False)]:
        drawing.box(x + dx * (half + 8), y + dy * (half + 8),
                    84 if wide else 12, 12 if wide else 84, fill=DARK, radius=0)
    drawing.text(x - 14, y - half - 24, "drive", "end")
    drawing.text(x + 12, y + half + 34, "feedback", "start")
    drawing.text(x + half + 24, y + 44, "readout", "start")
    drawing.text(x - half - 24, y + 5, "damping", "end")
    # Mount axis, drawn at 14 degrees; positive from x towards y.
    drawing.line(x - 27, y + 108, x + 33, y - 132, dash="10 3 2 3", width=1.5)
    drawing.path(f"M{x} {y - 100} A 100 100 0 0 1 {x + 25} {y - 97}", width=1.3)
    drawing.text(x + 40, y - 112, "mount axis, angle θ_m", "start")
    drawing.line(x, y, x, y - 128, arrow="end", width=1.2)
    drawing.text(x - 16, y - 120, "x", bold=True)
    drawing.line(x, y, x + 150, y, arrow="end", width=1.2)
    drawing.text(x + 156, y + 20, "y", bold=True)
    drawing.line(x, y, x, y - 46, width=4, arrow="end")
    drawing.text(x - 8, y - 30, "v_x", "end", bold=True)
    drawing.line(x, y, x - 50, y, colour=ACCENT, width=4, arrow="end")
    drawing.text(x, 40, "In section, seen along +z", bold=True, size=16)
    drawing.text(x, y + half + 76,
                 "Coriolis force  F_y = −2 m_g Ω v_x", colour=ACCENT,
                 bold=True)


def gyro():
    drawing = Drawing(1060, 400, "The gyro: beam, patches, mount and axes")
    gyro_side(drawing)
    gyro_section(drawing)
    drawing.text(
        290, 362, "The drive patch keeps the beam vibrating along x. A rate Ω "
        "about z makes\nit vibrate along y as well; the readout patch senses "
        "that.", size=13)
    return drawing.svg()


def heat_flow():
    drawing = Drawing(1000, 470, "The thermal network: nodes and heat flow")
    y = 270
    places = {"pzt": (90, y), "beam": (280, y), "mount": (480, y),
              "housing": (690, y), "board": (600, 95), "sensor": (800, 95)}
    names = {"pzt": "pzt\npatches", "board": "board\nelectronics",
             "sensor": "temperature\nsensor"}
    drawing.path(f"M280 {y + 28} C 300 {y + 130}, 640 {y + 130}, 680 {y + 28}")
    drawing.text(480, y + 122, "air gap 0.0045")
    for a, b, words, dx, dy in [
            ("pzt", "beam", "bond\n0.5", 0, -30),
            ("beam", "mount", "pins\n0.004", 0, -30),
            ("mount", "housing", "0.05", 0, -12),
            ("housing", "board", "0.12", -26, 12),
            ("housing", "sensor", "0.004", 32, 12),
            ("board", "sensor", "0.004", 0, -12)]:
        (x1, y1), (x2, y2) = places[a], places[b]
        drawing.line(x1, y1, x2, y2, width=2)
        drawing.text((x1 + x2) / 2 + dx, (y1 + y2) / 2 + dy, words)
    drawing.box(942, y, 76, 150, "ambient:\nair and\nfixture", fill=MIDDLE)
    drawing.line(690, y - 16, 904, y - 16, width=2)
    drawing.text(828, y - 26, "convection, radiation", size=12)
    drawing.line(690, y + 16, 904, y + 16, width=2)
    drawing.text(826, y + 36, "fixture 0.06")
    for name, (x, place) in places.items():
        drawing.box(x, place, 124, 56, names.get(name, name), bold=True)
    for x, top, bottom, words, dash in [
            (90, 182, 240, "loss in the ceramic\n½ωCV² tan δ", ""),
            (280, 182, 240, "loss in the beam\n½cω²A²", ""),
            (480, 182, 240, "oven, optional", "5 4")]:
        drawing.line(x, top, x, bottom, colour=ACCENT, width=3, dash=dash,
                     arrow="end")
        drawing.text(x, top - 8 - 18 * words.count("\n"), words, colour=ACCENT)
    drawing.line(470, 95, 537, 95, colour=ACCENT, width=3, arrow="end")
    drawing.text(462, 100, "electronics 0.6 W", "end", colour=ACCENT)
    drawing.text(500, 448, "Lines are conductances in W/K of the nominal unit, "
                 "arrows are sources of heat. In a stirred chamber forced "
                 "convection is added.", size=13)
    return drawing.svg()


def data_flow():
    drawing = Drawing(1120, 430, "The way of data through the program")

    def file(x, y, words, width=126):
        drawing.box(x, y, width, 44, words, fill="white")

    def command(x, y, words):
        drawing.box(x, y, 104, 40, words, fill=DARK, radius=20, bold=True,
                    ink="white")

    def flow(*points):
        drawing.path("M" + " L".join(f"{x:g} {y:g}" for x, y in points),
                     arrow="end")

    for x, words in [(85, "you write"), (270, "command"), (440, "data"),
                     (600, "command"), (760, "compensator"), (915, "command"),
                     (1045, "result")]:
        drawing.text(x, 26, words, size=13, bold=True)
    for y, words, name in [(75, "log.csv\nmap.toml", "import"),
                           (190, "device.toml\nscenario.toml", "run"),
                           (325, "campaign.toml", "generate")]:
        file(85, y, words)
        command(270, y, name)
        flow((148, y), (217, y))
    file(440, 132, "recording\nof one gyro")
    flow((322, 75), (350, 75), (350, 122), (376, 122))
    flow((322, 190), (350, 190), (350, 142), (376, 142))
    file(440, 325, "set of\nmany gyros")
    flow((322, 325), (376, 325))
    command(600, 225, "train")
    file(600, 325, "model.toml", 112)
    flow((600, 303), (600, 247))
    flow((503, 142), (535, 142), (535, 215), (551, 215))
    flow((503, 315), (535, 315), (535, 235), (551, 235))
    file(760, 225, "compensator\n.json")
    flow((652, 225), (696, 225))
    for y, name, words in [(110, "compensate", "recording,\ncompensated"),
                           (225, "validate", "scores,\nverdict"),
                           (340, "export", "C source,\nautopilot")]:
        command(915, y, name)
        file(1045, y, words, 112)
        flow((823, 225), (842, 225), (842, y), (862, y))
        flow((967, y), (988, y))
    flow((503, 122), (535, 122), (535, 60), (915, 60), (915, 90))
    drawing.text(725, 53, "other recordings", size=12)
    drawing.text(560, 405, "validate and compensate take recordings that "
                 "training has not seen; validate also takes the test devices "
                 "of a set.", size=13)
    return drawing.svg()


def main(folder):
    for draw in (gyro, heat_flow, data_flow):
        (folder / f"{draw.__name__}.svg").write_text(draw(), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) > 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) == 2
         else ROOT / "docs/pictures")
