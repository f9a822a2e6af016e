# SPDX-License-Identifier: MIT
"""`export --format c` of the shipped program, and bad input of every format."""

import math
import platform
import re
import shutil
import unittest

import numpy as np
import pytest

from exported import EVENTFUL, MODELS, WARNINGS, ExportTest, run_of
from pages import page, rows, section
from program import ended
from rejections import Rejections, row

SELF_TEST = ["net.c", "net_selftest.c", "-o", "selftest"]  # no -lm

# Rows "power-on, rate, temperature, ..." in, compensated rates out.
DRIVER = """\
#include <stdio.h>
#include "net.h"

int main(void) {{
  net_state state;
  net_sample sample;
  float rate;
  int power_on;
  while (scanf("%d", &power_on) == 1) {{
{reads}    if (power_on && net_init(&state, 1.0f) != 0) return 1;
    rate = net_step(&state, &sample);
    printf("%.9g %d\\n", (double)rate, state.clamped);
  }}
  return 0;
}}
"""

COLUMNS = {"rate": "rate_deg_per_s", "temperature": "temperature_degC",
           "quadrature": "quadrature_deg_per_s",
           "drive_frequency": "drive_frequency_change_Hz",
           "drive_voltage": "drive_voltage_V"}


@pytest.mark.early
class ExportC(ExportTest):
    def answers_to_the_last_bit(self, compiler):
        """Of every kind, as C and as C++, without a warning."""
        plain = [option for option in WARNINGS if option != "-std=c99"]
        for kind in MODELS:
            folder = self.export(kind)
            self.assertEqual({path.name for path in folder.iterdir()},
                             {"net.h", "net.c", "net_selftest.c",
                              "net_plugin.c"})
            for language in ["-std=c99"], ["-x", "c++"]:
                self.compile(folder, *plain, "-O2", *language, *SELF_TEST,
                             compiler=compiler)
                self.assertEqual(self.run_binary(folder / "selftest"),
                                 "net: 10000 answers equal to the last bit\n")

    def test_every_kind_answers_to_the_last_bit_without_a_warning(self):
        self.answers_to_the_last_bit("cc")

    # The test above stands for it, with cc; nothing in test.sh shows what clang
    # warns of or rounds otherwise.
    @pytest.mark.deep
    @unittest.skipIf(shutil.which("clang") is None, "clang missing")
    def test_every_kind_answers_to_the_last_bit_by_clang(self):
        self.answers_to_the_last_bit("clang")

    def test_damaged_parameters_and_damaged_code_are_noticed(self):
        folder = self.export("network")
        source = (folder / "net.c").read_text()
        start = source.index("{", source.index("weights_2["))
        digit = next(at for at in range(start, len(source))
                     if source[at] in "123456789")
        other = str(10 - int(source[digit])) if source[digit] != "5" else "6"
        for damaged, says in [
                (source[:digit] + other + source[digit + 1:],
                 "net: the parameters are damaged\n"),
                (source.replace("540030.06f", "540030.56f"),
                 "answers differ")]:
            self.assertNotEqual(damaged, source)
            (folder / "net.c").write_text(damaged)
            self.compile(folder, *WARNINGS, "-O2", *SELF_TEST)
            self.assertIn(says, self.run_binary(folder / "selftest", status=1))

    def test_options_that_change_bits_are_named(self):
        folder = self.export("network")
        self.compile(folder, "-O2", "-ffast-math", *SELF_TEST)
        answer = self.run_binary(folder / "selftest", status=1)
        self.assertIn("-ffp-contract=off and without -ffast-math", answer)

    @unittest.skipUnless(platform.machine() == "x86_64", "x87 is of x86")
    def test_arithmetic_in_more_than_single_precision_is_refused(self):
        folder = self.export("cubic")
        self.assertIn("net needs float arithmetic in single precision", ended(
            "gcc", "-std=c99", "-mfpmath=387", "-c", "net.c", cwd=folder,
            allowed=(1,)).stderr)

    def macro(self, folder, name):
        return re.search(f"#define net_{name} (.*)f\n",
                         (folder / "net.h").read_text())[1]

    def driver_answers(self, folder, recording):
        """Rates and clamped flags of the powered samples."""
        header = (folder / "net.h").read_text()
        columns = [name for name, field in COLUMNS.items()
                   if f"float {field};" in header]
        (folder / "driver.c").write_text(DRIVER.format(reads="".join(
            f'    if (scanf("%f", &sample.{COLUMNS[name]}) != 1) return 1;\n'
            for name in columns)))
        self.compile(folder, *WARNINGS, "-O2", "net.c", "driver.c", "-o",
                     "driver")
        reference = re.search("#define net_DRIVE_FREQUENCY (\\d+)", header)
        less = {"drive_frequency": float(reference[1]) if reference else 0}
        off = recording["status"] & 1
        values = {name: np.float32(recording[name] - less.get(name, 0))
                  for name in columns}
        rows = [f"{k == 0 or off[k - 1]:d} " + " ".join(
                    f"{values[name][k]:.9g}" for name in columns)
                for k in np.flatnonzero(off == 0)]
        answer = self.run_binary(folder / "driver", given="\n".join(rows))
        return np.loadtxt(answer.splitlines())

    def test_answers_to_a_recording_are_those_of_compensate(self):
        """The header tells the difference of singles from doubles, met over
        other samples than these."""
        for kind in MODELS:
            folder = self.export(kind)
            self.ok("compensate", f"{kind}.json", run_of(kind), "-o", "out.h5",
                    "--quiet")
            out = self.signals("out.h5")
            expected = out["compensated_rate"]
            expected = expected[~np.isnan(expected)]
            found = self.driver_answers(folder, out)
            self.assertEqual(len(found), len(expected))
            worst = np.max(np.abs(found[:, 0] - expected))
            told = float(self.macro(folder, "DIFFERENCE"))
            self.assertLess(worst, 1.5 * told)
            self.assertLessEqual(told, 1e-4)
            self.assertEqual(found[:, 1].any(), kind == "resonances")
            low, high = self.json(f"{kind}.json")["temperature_range_degC"]
            T = out["temperature"][~np.isnan(out["compensated_rate"])]
            np.testing.assert_array_equal(
                found[:, 1] != 0, (T < low - 1e-4) | (T > high + 1e-4))

    def answers_at(self, folder, temperatures):
        """Rates and clamped flags at these temperatures, and a rate of 0."""
        (folder / "driver.c").write_text(DRIVER.format(
            reads='    if (scanf("%f %f", &sample.rate_deg_per_s, '
                  "&sample.temperature_degC) != 2) return 1;\n"))
        self.compile(folder, *WARNINGS, "net.c", "driver.c", "-o", "driver")
        given = "".join(f"{k == 0:d} 0 {T}\n"
                        for k, T in enumerate(temperatures))
        lines = [line.split() for line in
                 self.run_binary(folder / "driver", given=given).splitlines()]
        return ([float(rate) for rate, _ in lines],
                "".join(flag for _, flag in lines))

    def test_clamped_is_told_and_no_number_gives_none(self):
        folder = self.export("cubic")
        low = float(self.macro(folder, "TEMPERATURE_LOWEST"))
        high = float(self.macro(folder, "TEMPERATURE_HIGHEST"))
        temperature = self.signals("train.h5")["temperature"]
        self.assertEqual(np.float32(low), np.float32(np.nanmin(temperature)))
        self.assertEqual(np.float32(high), np.float32(np.nanmax(temperature)))
        rates, flags = self.answers_at(folder, [
            low + 1, low - 20, low - 30, "nan", "inf", "-inf", 99, high + 1,
            low + 1])
        self.assertEqual(flags, "011111110")
        self.assertEqual(rates[1], rates[2])
        for rate in rates[3:6]:
            self.assertTrue(math.isnan(rate))
        self.assertEqual(rates[6], rates[7])
        self.assertEqual(rates[8], rates[0])

    def test_temperatures_that_are_no_numbers_leave_the_filters_alone(self):
        folder = self.export("3_8_1")
        before, _ = self.answers_at(folder, [20, 20, 20])
        for bad in ["nan", "inf", "-inf"]:
            rates, flags = self.answers_at(folder, [bad, 20, bad, bad, 20])
            self.assertEqual([rates[1], rates[4]], before[:2])
            self.assertEqual(flags, "10110")

    def test_what_cancels_the_rate_needs_force(self):
        """At rest the output tells the bias; a penalty keeps the rate, rates
        in training do, too."""
        at_rest = EVENTFUL[:EVENTFUL.index("[rate]")]
        self.run_scenario("rest", text=at_rest)
        self.run_scenario("rest_held_out", "--seed", 5, text=at_rest)
        model = 'kind = "bp"\ninputs = ["output", "temperature"]\n[bp]\n' \
                "hidden = [4]\nrestarts = 1\nmax_epochs = 60\n"

        def trained(name, recording, text):
            self.ok("train", f"{recording}.h5", "--held-out",
                    f"{'rest_' * (recording == 'rest')}held_out.h5", "--model",
                    self.write("m.toml", text), "-o", f"{name}.json", "--quiet")
            return f"{name}.json"
        cancels = trained("cancels", "rest", model)
        self.rejected("export", cancels, "--format", "c", "-o", "out",
                      says=["cancels.json: it cancels the rate", "--force"])
        self.assertIn("cancels the rate", self.warned(
            "export", cancels, "--format", "c", "-o", "out", "--force"))
        for ending in "hc":
            self.assertIn("/* WARNING: it cancels the rate",
                          self.text(f"out/cancels.{ending}"))
        for name, recording, text in [
                ("penalty", "rest", f"{model}rate_penalty = 100\n"),
                ("rates", "train", model)]:
            self.ok("export", trained(name, recording, text), "--format", "c",
                    "-o", "out")
        self.assertIn("feels the rate and training was at rest",
                      self.text("out/penalty.h").replace("\n  ", ""))

    def test_init_refuses_a_period_that_is_none(self):
        folder = self.export("3_8_1")
        (folder / "periods.c").write_text("""\
#include <stdio.h>
#include "net.h"

int main(void) {
  const float periods[] = {0.0f, -1.0f, 1e30f * 1e30f, 0.001f, 100.0f};
  net_state state;
  int k;
  for (k = 0; k < 5; ++k) printf("%d ", net_init(&state, periods[k]));
  return 0;
}
""")
        self.compile(folder, "net.c", "periods.c", "-o", "periods")
        self.assertEqual(self.run_binary(folder / "periods"), "-1 -1 -1 0 0 ")

    def test_same_bytes_again(self):
        for form in ["c", "px4", "ardupilot"]:
            folder = self.export("cubic", form=form)
            self.ok("export", "cubic.json", "--format", form, "-o", "again",
                    "--name", "net")
            for path in folder.iterdir():
                self.assertSameBytes(path, f"again/{path.name}")

    def test_the_name_comes_from_the_file_or_the_option(self):
        (self.dir / self.train("cubic")).rename(self.dir / "2nd gyro.v1.json")
        self.ok("export", "2nd gyro.v1.json", "--format", "c", "-o", "a/b")
        header = self.text("a/b/c_2nd_gyro_v1.h")
        self.assertIn("float c_2nd_gyro_v1_step(", header)
        for name in ["lowpass", "crc", "main", "int"]:  # as parts of names
            self.ok("export", "2nd gyro.v1.json", "--format", "c", "-o", name,
                    "--name", name)
            self.compile(self.dir / name, *WARNINGS, f"{name}.c",
                         f"{name}_selftest.c", "-o", "t")
            self.run_binary(self.dir / name / "t")


class BadExport(Rejections, ExportTest):
    table = [
        *[row(f"export {words} -o out", *says) for words, *says in [
            *[(f"{name} --format c", name) for name in ["gone.json", "broken.json",
                                                         "other.json"]],
            ("cubic.json --format rust", "rust"),
            ("cubic.json", "--format"),
            ("cubic.json --format px4 --axis w", "w"),
            *[(f"cubic.json --format {form} --instance {number}", "cubic.json",
               f"instance {number}")
              for form, number in [("px4", 4), ("ardupilot", 0), ("ardupilot", 4)]],
            (f"cubic.json --format px4 --device-id {2 ** 31}", "--device-id"),
            # Each compensator has an axis of its own.
            ("cubic.json cubic.json --format px4", "--axis", "0 axes for 2"),
            ("cubic.json cubic.json --format px4 --axis x", "1 axes for 2"),
            ("cubic.json cubic.json --format px4 --axis y,y", "y twice"),
            ("cubic.json --format px4 --axis x,y", "2 axes for 1"),
            ("cubic.json cubic.json --format c", "several compensators"),
            # Options of another format
            *[(f"cubic.json --format {form} {option} {value}", option, form)
              for form, option, value in [
                  ("c", "--axis", "x"), ("c", "--instance", 1), ("c", "--device-id", 1),
                  ("c", "--fit-cubic", ""), ("ardupilot", "--device-id", 1),
                  ("px4", "--force", "")]],
            ("cold.json --format ardupilot", "cold.json", "-70 to 80 degC")]],
        row("export cubic.json --format c", "--output"),
        # What is in the way
        row("export cubic.json --format c -o file", "file"),
        row("export cubic.json --format c -o file/below", "file"),
        row("export cubic.json --format c -o folder --name net", "net.c"),
        row("export gyro.parm --format ardupilot -o .", "is read by this command"),
    ]

    def prepare(self):
        super().prepare()
        text = (self.dir / self.train("cubic")).read_text()
        start = text.index("[", text.index('"temperature_range_degC"'))
        end = text.index("]", start)
        for name, content in [
                ("broken.json", "{"), ("other.json", '{"filetype": "other"}'),
                ("file", "x"), ("gyro.parm", text),
                ("cold.json", text[:start] + "[-71.0, 60.0" + text[end:])]:
            self.write(name, content)
        (self.dir / "folder/net.c").mkdir(parents=True)


class ExportPage(ExportTest):
    """Compares docs/reference/ with what is written."""

    def test_names_of_the_exported_code(self):
        header = (self.export("network") / "net.h").read_text()
        documented = rows(section(page("exported_code"),
                                  "Functions and constants"))
        self.assertEqual(len(documented), 18)
        for name in set(documented) - {"output_V"}:
            self.assertIn(name.replace("NAME", "net"), header)
        sample = re.search(r"typedef struct {([^}]*)} net_sample;", header)[1]
        for field in re.findall(r"float (\w+);", sample):
            self.assertIn(field, documented)

    def test_names_of_autopilot_parameters(self):
        documented = rows(page("autopilot_parameters"))
        for form, n, powers, axes, separator, at in [
                ("px4", "0", "0123", "012", "\t", 2),
                ("ardupilot", "2", "123", "XYZ", ",", 0)]:
            path, = self.export("cubic", "--instance", n, form=form) \
                .glob("net.par*")
            written = {line.split(separator)[at] for line in
                       path.read_text().splitlines() if line[0] != "#"}
            prefix = "TC_" if form == "px4" else "INS_"
            expected = set()
            for name in documented:
                if not name.startswith(prefix):
                    continue
                name = re.sub("(G|TCAL|GYR)n", rf"\g<1>{n}", name)
                for k in powers if "k_" in name else "-":
                    for axis in axes if name.endswith("_a") else "-":
                        expected.add(re.sub("k_", f"{k}_", re.sub(
                            "_a$", f"_{axis}", name)))
            self.assertEqual(written, expected)
            shutil.rmtree(path.parent)
