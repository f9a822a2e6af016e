# SPDX-License-Identifier: MIT
"""`beamgyro live`: a gyro behind standard input and output."""

import math
import select
import struct
import subprocess
import sys

import numpy as np

from program import PATIENCE, PROGRAM, SCENARIOS, ProgramTest

sys.path.insert(0, str(PROGRAM.parent / "python"))
import beamgyro as bg  # noqa: E402

NOMINAL = SCENARIOS / "devices/nominal.toml"
NAMES = "time,rate,ambient_temperature\n"
SHOWN = ("output", "rate", "temperature", "drive_frequency", "drive_voltage",
         "quadrature")
# Lines that are no samples, each with words of its warning.
FAULTS = [("1,2\n", "input:4: 2 cells; expected 3"),
          ("1,2,3,4\n", "4 cells; expected 3"),
          ("1,x,25\n", 'rate is "x"; expected a number'),
          ("1,,25\n", 'rate is ""; expected a number'),
          ("1,2;5,25\n", 'rate is "2;5"'),
          ("x,2,25\n", 'time is "x"'),
          ("1,1e999,25\n", "rate"),
          ("1,0x10,25\n", 'rate is "0x10"'),
          ("nan,2,25\n", "time is nan"),
          ("inf,2,25\n", "time is inf"),
          ("1,nan,25\n", "rate is nan"),
          ("1,-inf,25\n", "rate is -inf"),
          ("1,2,nan\n", "ambient_temperature is nan"),
          ("1,1e5,25\n", "a rate"),
          ("1,2,151\n", "the ambient temperature"),
          ("1,2,298.15\n", "the ambient temperature"),
          ("1,2,-101\n", "the ambient temperature"),
          ("0.1,2,25\n", "time 0.1 does not follow 0.1"),
          ("0,2,25\n", "time 0 does not follow 0.1"),
          ("-5,2,25\n", "time -5 does not follow"),
          ("1e9,2,25\n", "duration"),
          ("\0\xff\n", "1 cell"),
          ("1 2 25\n", "1 cell; expected 3"),
          ("1;2;25\n", "1 cell; expected 3"),
          ("1,2,25,\n", "4 cells; expected 3"),
          (",,\n", 'time is ""'),
          ('1,"2",25\n', "rate is"),
          ("1,+-2,25\n", 'rate is "+-2"'),
          ("1,1_000,25\n", 'rate is "1_000"'),
          ("1,2e,25\n", 'rate is "2e"'),
          ("1,true,25\n", 'rate is "true"'),
          ("1,2,25 degC\n", 'ambient_temperature is "25 degC"'),
          ("1e400,2,25\n", "time"),
          ("1,1e308,25\n", "a rate"),
          ("1,-10001,25\n", "a rate"),
          ("1,2,-1e308\n", "the ambient temperature"),
          ("1" * 70000 + "\n", "a line of more than")]


def table(text):
    names, *lines = text.splitlines()
    rows = [[float(cell) for cell in line.split(",")] for line in lines]
    return names.split(","), np.array(rows).reshape(len(lines), -1)


class Live(ProgramTest):

    def live(self, given, *options):
        return self.beamgyro("live", NOMINAL, *options, given=given)

    def answered(self, given, *options):
        result = self.live(given, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def test_it_is_the_gyro_of_python(self):
        rates = 20 * np.sin(np.arange(100) / 7)
        lines = "".join(f"{k / 50!r},{rate!r},{20 + k / 100!r}\n"
                        for k, rate in enumerate(rates.tolist()))
        for linear in (False, True):
            names, rows = table(self.answered(
                NAMES + lines, "--seed", 3, *["--linear"] * linear))
            self.assertEqual(names, ["time", "status", *SHOWN])
            gyro = bg.Device(NOMINAL).start(seed=3, rate=rates[0],
                                            ambient=20.0)
            before = (rates[0], 20.0)
            for k, row in enumerate(rows):
                now = (rates[k], 20 + k / 100)
                if k > 0:
                    rate, ambient = zip(before, now) if linear else now
                    gyro.step(dt=k / 50 - (k - 1) / 50, rate=rate,
                              ambient=ambient)
                before = now
                self.assertEqual(row[0], k / 50)
                self.assertEqual(row[2:].tolist(), [
                    getattr(gyro.now(), name) for name in SHOWN])

    def test_each_line_is_answered_at_once(self):
        process = subprocess.Popen(
            [PROGRAM, "live", NOMINAL], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, text=True, bufsize=1)
        with process:
            process.stdin.write(NAMES)
            self.assertIn("time,status", process.stdout.readline())
            for k in range(20):
                process.stdin.write(f"{k / 10},1,25\n")
                ready, _, _ = select.select([process.stdout], [], [], PATIENCE)
                self.assertTrue(ready)
                cells = process.stdout.readline().split(",")
                self.assertEqual(float(cells[0]), k / 10)
            process.stdin.close()
            self.assertEqual(process.wait(PATIENCE), 0)

    def test_a_bad_line_is_answered_nan_and_changes_nothing(self):
        good = ["0,1,25\n", "0.1,2,25\n", "0.2,3,25\n"]
        expected = self.answered(NAMES + "".join(good)).splitlines()
        for bad, words in FAULTS:
            with self.subTest(bad[:20]):
                result = self.live(NAMES + "".join([*good[:2], bad, good[2]]))
                self.assertEqual(result.returncode, 0)
                lines = result.stdout.splitlines()
                self.assertEqual([*lines[:3], *lines[4:]], expected)
                self.assertEqual(set(lines[3].split(",")), {"nan"})
                self.assertIn(words, result.stderr)
                self.assertIn("1 of 4 samples are answered nan", result.stderr)

    def test_a_first_line_that_is_bad_and_one_that_is_cut_off(self):
        result = self.live(NAMES + "0,x,25\n\n0,1,25\n0.1,2,2")
        self.assertEqual(result.returncode, 0)
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), 4)
        self.assertEqual(set(lines[1].split(",")), {"nan"})
        self.assertEqual(float(lines[2].split(",")[0]), 0)
        self.assertEqual(set(lines[3].split(",")), {"nan"})
        self.assertIn("may be cut off", result.stderr)

    def test_names_that_cannot_be_right(self):
        for names, words in [
                ("time,speed\n", 'column "speed" is no input'),
                ("rate\n", "no column time"),
                ("time,rate,rate\n", "column rate is there twice"),
                ("time,rate,true_rate\n", "column rate is there twice"),
                ("time,rate [rad/s]\n", "in rad/s; expected degree/s"),
                ("time [ms],rate\n", "in ms; expected s"),
                ("time,rate,\n", 'column ""')]:
            with self.subTest(names):
                self.rejected("live", NOMINAL, given=names + "0,1\n",
                              says=["standard input:1", words])

    def test_options_that_cannot_be_right(self):
        for options, words in [
                (["--noise-rate-Hz", "-1"], "noise"),
                (["--temperature-degC", "200"], "degC"),
                (["--age-hours", "-1"], "age"),
                (["--seed", "x"], "--seed x"),
                (["--set", "beam.length=1"], "beam.length")]:
            with self.subTest(options):
                self.rejected("live", NOMINAL, *options, given=NAMES,
                              says=[words])
        self.rejected("live", SCENARIOS / "rest.toml", given=NAMES,
                      says=["is a scenario"])

    def test_binary_is_the_same(self):
        rows = [(k / 10, 3.0 * k, 25.0) for k in range(30)]
        rows[7] = (math.nan, 1.0, 25.0)
        text = NAMES + "".join(f"{t!r},{r!r},{T!r}\n" for t, r, T in rows)
        given = NAMES.encode() + b"".join(
            struct.pack("<3d", *row) for row in rows)
        bytes_of = subprocess.run(
            [PROGRAM, "live", NOMINAL, "--binary", "--truth"], input=given,
            capture_output=True, timeout=PATIENCE, check=True)
        names, _, numbers = bytes_of.stdout.partition(b"\n")
        found = np.frombuffer(numbers, "<f8").reshape(len(rows), -1)
        header, expected = table(self.answered(text, "--truth"))
        self.assertEqual(names.decode().split(","), header)
        np.testing.assert_array_equal(found, expected)
        cut = subprocess.run(
            [PROGRAM, "live", NOMINAL, "--binary"], input=given[:-5],
            capture_output=True, timeout=PATIENCE, check=True)
        self.assertIn(b"cut off", cut.stderr)
        last = np.frombuffer(cut.stdout.partition(b"\n")[2], "<f8")[-8:]
        self.assertTrue(np.isnan(last).all())

    def test_a_pipeline_of_sensor_and_compensator(self):
        self.cubic_of_a_ramp("run")
        lines = NAMES + "".join(f"{k / 10},0,30\n" for k in range(50))
        lines += "x,0,30\n" + "5.0,0,30\n"
        live = subprocess.Popen([PROGRAM, "live", NOMINAL],
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)
        compensated = subprocess.Popen(
            [PROGRAM, "compensate", "c.json", "--stream"], stdin=live.stdout,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=self.dir)
        live.stdout.close()
        with live, compensated:
            live.stdin.write(lines.encode())
            live.stdin.close()
            answers = compensated.stdout.read().decode().splitlines()
            self.assertEqual(compensated.wait(PATIENCE), 0)
            self.assertEqual(live.wait(PATIENCE), 0)
        answers = [line.split(",")[0] for line in answers]
        numbers = [float(a) for a in answers if a != "compensated_rate"]
        self.assertEqual(len(numbers), 52)
        self.assertTrue(math.isnan(numbers[50]))
        self.assertTrue(all(math.isfinite(n) for n in numbers[:50]))
        self.assertTrue(math.isfinite(numbers[51]))
