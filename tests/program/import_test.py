# SPDX-License-Identifier: MIT
"""`beamgyro import`: logs as gyros and flight controllers write them."""

import math

import h5py
import numpy as np

from bench_log import BENCH, bench_rows, table
from program import CUBIC, SCENARIOS, ProgramTest

MAPS = SCENARIOS / "maps"


class Import(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("map.toml", BENCH)

    def read(self, name):
        """Columns, status and texts of a recording."""
        with h5py.File(self.dir / name) as file:
            texts = {key: file["meta"][key][()].decode() for key in file["meta"]}
            return self.signals(name), texts, dict(file.attrs)

    def bench(self, name="log.csv", **options):
        self.write(name, table("t,w,T", bench_rows(**options)))
        return self.imported(name, to="run.h5")

    def imported(self, log="log.csv", *options, by="map.toml", to="r.h5"):
        """What is told of a log that is read by a map."""
        return self.ok("import", log, *options, "--map", by, "-o", to)

    def test_a_bench_log_goes_through_every_command(self):
        self.assertIn("2400 rows read, 2400 kept", self.bench())
        values, texts, attributes = self.read("run.h5")
        self.assertEqual(set(values), {"time", "rate", "temperature",
                                       "true_rate", "status"})
        np.testing.assert_array_equal(values["time"], np.arange(2400))
        rows = np.array(list(bench_rows()))
        np.testing.assert_array_equal(values["rate"], rows[:, 1])
        np.testing.assert_array_equal(values["temperature"], rows[:, 2])
        self.assertFalse(values["true_rate"].any() or values["status"].any())
        self.assertEqual(texts, {"scenario": BENCH, "device": "",
                                 "overrides": ""})
        self.assertEqual(attributes["fidelity"].decode(), "imported")
        self.assertEqual(attributes["seed"], 0)

        self.assertIn("fidelity imported", self.ok("info", "run.h5"))
        self.train_on("run.h5")
        self.ok("compensate", "c.json", "run.h5", "-o", "out.h5")
        answer = self.signals("out.h5")["compensated_rate"]
        self.assertLess(np.sqrt(np.mean(answer**2)), 0.01)
        self.fails_as_seen("c.json", "run.h5")
        self.assertIn("oadev deg/s", self.ok("allan", "run.h5"))

    def test_same_bytes_again_also_from_crlf_and_other_delimiters(self):
        self.bench()
        first = (self.dir / "run.h5").read_bytes()
        self.bench()
        self.assertEqual((self.dir / "run.h5").read_bytes(), first)
        text = self.text("log.csv")
        for changed in ["\ufeff" + text.replace("\n", "\r\n"),
                        text.replace(",", "\t"), text.replace(",", " ; "),
                        text.replace("t,w,T", '"t","w","T"')]:
            self.write("log.csv", changed)
            self.imported(to="run.h5")
            self.assertEqual((self.dir / "run.h5").read_bytes(), first)

    def test_the_same_columns_as_csv(self):
        self.bench()
        self.imported(to="run.csv")
        self.assertEqual(self.text("run.csv").splitlines()[0],
                         "time,rate,temperature,status,true_rate")

    def test_a_log_of_px4(self):
        rows = [(51234567 + 4000 * k + (k % 3), 2490378, f"{0.01 * k:.8f}",
                 -0.02, 0.03, f"{40 + 0.01 * k:.4f}", 0) for k in range(50)]
        self.write("log.csv", table(
            "timestamp,device_id,x,y,z,temperature,error_count", rows))
        text = self.imported("log.csv", "--axis", "x", by=MAPS / "px4.toml")
        self.assertIn("[true_rate] at_rest = true", text)
        values, texts, _ = self.read("r.h5")
        np.testing.assert_allclose(values["rate"],
                                   np.degrees(0.01 * np.arange(50)), rtol=1e-14)
        ticks = np.array([row[0] for row in rows])
        np.testing.assert_array_equal(values["time"],
                                      (ticks - ticks[0]) / 1e6)
        self.assertEqual(texts["overrides"], "axis=x\n")
        self.assertEqual(texts["scenario"], (MAPS / "px4.toml").read_text())
        self.assertNotIn("true_rate", values)
        wrong = ["import", "log.csv", "--map", MAPS / "px4.toml", "-o", "y.h5"]
        self.rejected(*wrong, says=["px4.toml", "x, y, z", "--axis"])
        self.rejected(*wrong, "--axis", "w", says=["--axis w", "x, y, z"])

    def test_a_log_of_ardupilot(self):
        rows = [(1000000 + 2500 * (k // 2), k % 2, 0.1, 0.2,
                 -0.3 - 5 * (k % 2), 0, 0, -9.81, 31.5 + 10 * (k % 2))
                for k in range(100)]
        self.write("log.csv", table(
            "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,T", rows))
        text = self.imported("log.csv", "--axis", "z",
                             by=MAPS / "ardupilot.toml")
        self.assertIn("100 rows read, 50 kept", text)
        self.assertIn("50 filtered out, the first in line 3", text)
        values = self.signals("r.h5")
        np.testing.assert_allclose(values["rate"], math.degrees(-0.3))
        np.testing.assert_array_equal(values["temperature"], 31.5)
        np.testing.assert_allclose(np.diff(values["time"]), 0.0025)

    def test_bursts_with_wrapped_counts_and_outliers(self):
        """25 bursts of 250 samples at 50 Hz, the time stamps in whole ms with
        jitter, temperatures below 0 printed as unsigned 16-bit counts."""
        random = np.random.default_rng(4)
        rows, wild = [], {700: 0.5, 3100: -0.4, 5900: 0.6}
        for k in range(25 * 250):
            burst, sample = divmod(k, 250)
            t = 15352 + burst * 305000 + 20 * sample + random.integers(-3, 4)
            count = 300 - 110 * burst - sample % 5
            rate = 0.05 - 1e-5 * count + random.normal(0, 5e-4)
            rows.append((t, 1e-5, f"{wild.get(k, rate):.5f}", count % 65536))
        self.write("log.csv", table("time (ms),mag,gyrox rad/s,temp", rows)
                   .replace("\n", "\r\n"))
        self.write("map.toml", """\
[time]
column = "time (ms)"
unit = "ms"
[gyro.x]
column = "gyrox rad/s"
unit = "rad/s"
[temperature]
column = "temp"
unit = "counts"
wrap_bits = 16
scale_K = 0.03125
offset_degC = 25
[true_rate]
at_rest = true
[rules.outliers]
""")
        text = self.imported()
        for part in ["6250 rows read, 6247 kept", "median step 0.02 s (50 Hz)",
                     "3 outliers of the rate, the first in line 702",
                     "bursts       25", "24 gaps, the longest 300.0"]:
            self.assertIn(part, text)
        values = self.signals("r.h5")
        counts = np.array([300 - 110 * (k // 250) - k % 250 % 5
                           for k in range(6250) if k not in wild])
        np.testing.assert_array_equal(values["temperature"],
                                      25 + counts * 0.03125)
        self.assertIn("25 rows", self.ok(
            "train", "r.h5", "--model", self.write("model.toml", CUBIC), "-o",
            "c.json"))
        self.ok("compensate", "c.json", "r.h5", "-o", "out.h5")
        self.fails_as_seen("c.json", "r.h5")
        answer = self.ended("allan", "r.h5")
        # All bursts, each a stretch of its own; the outliers are missing.
        self.assertIn("25 stretches", answer.stdout)
        self.assertIn("samples used", answer.stderr)

    def test_status_and_power(self):
        text = "powered_s = [[0.5, 1], [1.5, 9]]\n" + BENCH + \
            "[status]\ncolumn = \"s\"\nvalid = [0]\nsaturated = [2]\n"
        self.write("map.toml", text)
        self.write("log.csv", table("t,w,T,s", [
            (0, 0.1, 25, 0), (500, 0.2, 25, 0), (999, 0.3, 25, 2),
            (1000, "", "", 0), (1500, 0.5, 25, 7)]))
        said = self.imported()
        self.assertIn("2 unpowered, 1 saturated, 1 not locked", said)
        values = self.signals("r.h5")
        np.testing.assert_array_equal(values["status"], [1, 0, 2, 1, 4])
        np.testing.assert_array_equal(values["rate"],
                                      [np.nan, 0.2, 0.3, np.nan, 0.5])
        self.assertFalse(values["true_rate"].any())

    def test_the_example_map_reads_the_log_it_describes(self):
        lines = (MAPS / "example.toml").read_text().splitlines()
        start = lines.index("#     # bench log 7")
        log = [line.removeprefix("#     ") for line in lines[start:start + 4]]
        log.append(log[-1].replace("0,A", "10,A", 1))
        self.write("log.csv", "\n".join(log) + "\n")
        self.imported(by=MAPS / "example.toml")
        values = self.signals("r.h5")
        self.assertEqual(set(values), {
            "time", "rate", "temperature", "drive_frequency", "drive_voltage",
            "quadrature", "status", "true_rate"})
        np.testing.assert_allclose(values["rate"], (120 - 12) * 0.0076)
        np.testing.assert_array_equal(values["temperature"],
                                      25 - 300 * 0.0078125)
        np.testing.assert_allclose(values["drive_voltage"], 0.812)

    def test_the_map_of_two_logs_reads_the_logs_it_describes(self):
        lines = (MAPS / "two_logs.toml").read_text().splitlines()
        pairs = [line.removeprefix("#").split() for line in lines[1:4]]
        self.write("gyro.csv", "\n".join(pair[0] for pair in pairs) + "\n")
        self.write("chamber.csv", "\n".join(" ".join(pair[1:])
                                            for pair in pairs) + "\n")
        said = self.imported("gyro.csv", "--join", "chamber.csv",
                             by=MAPS / "two_logs.toml")
        self.assertIn("chamber.csv: 2 rows read, 2 kept", said)
        values = self.signals("r.h5")
        np.testing.assert_allclose(values["rate"], [1, 1.04], rtol=1e-12)
        np.testing.assert_allclose(values["temperature"], [24.5, 24.5005],
                                   rtol=1e-12)

    def test_gyro_and_chamber_in_two_logs(self):
        """200 Hz against 1 Hz with a gap of 9 s: linear in between, rows in the
        gap and beyond the ends of the chamber's log dropped."""
        k = np.arange(12000)
        self.write("gyro.csv", table("t,w", zip(5 * k, k % 7)))
        seconds = [s for s in range(2, 51) if not 20 < s < 29]
        self.write("chamber.csv", table(
            "at,T", ((f"2026-03-05 14:00:{s:02d}", 20 + 0.25 * (s % 3))
                     for s in seconds)))
        self.write("map.toml", BENCH.split("[temperature]")[0] + """\
[true_rate]
at_rest = true
[join]
max_gap_s = 5
[join.time]
column = "at"
format = "iso"
zero = "2026-03-05 14:00:00"
[join.temperature]
column = "T"
unit = "degC"
""")
        said = self.imported("gyro.csv", "--join", "chamber.csv")
        values = self.signals("r.h5")
        time = 0.005 * k
        kept = (time >= 2) & (time <= 50) & ~((time > 20) & (time < 29))
        self.assertIn(f"12000 rows read, {kept.sum()} kept", said)
        self.assertIn(f"{(~kept).sum()} without a value of the joined log",
                      said)
        np.testing.assert_allclose(values["time"], time[kept] - 2, atol=1e-12)
        np.testing.assert_allclose(
            values["temperature"],
            np.interp(time[kept], seconds,
                      [20 + 0.25 * (s % 3) for s in seconds]), atol=1e-12)
        train = ["import", "gyro.csv", "--map", "map.toml", "-o", "q.h5"]
        self.rejected(*train, says=["map.toml:11:1: join", "--join LOG.csv"])
        self.change("map.toml", "14:00:00", "15:00:00")
        self.rejected(*train, "--join", "chamber.csv",
                      says=["from 0.000000 to 59.995000 s", "join.time.zero",
                            "from -3598.000000 to -3550.000000 s"])
        self.write("map.toml", BENCH)
        self.rejected(*train, "--join", "chamber.csv",
                      says=["--join chamber.csv", "no table [join]"])

    def test_a_log_without_temperature_is_for_allan(self):
        self.change("map.toml", r'\[temperature\]\ncolumn = "T"\n.*\n', "")
        self.write("log.csv", table("t,w", (row[:2] for row in bench_rows())))
        said = self.imported()
        self.assertIn("temperature  not stated by the map: allan needs none",
                      said)
        self.assertIn("oadev deg/s", self.ok("allan", "r.h5"))
        self.ok("info", "r.h5")
        self.write("map.toml", BENCH)
        self.bench()
        self.train_on("run.h5")
        for arguments in [
                ("train", "r.h5", "--model", "model.toml", "-o", "d.json"),
                ("validate", "c.json", "r.h5"),
                ("compensate", "c.json", "r.h5", "-o", "out.h5")]:
            self.rejected(*arguments, says='r.h5: input "temperature" needs '
                          "the measured column")

    def test_questions_about_the_clock(self):
        self.change("map.toml", '"ms"', '"us"')
        self.write("log.csv", table("t,w,T", ((k, 0.1, 25) for k in range(9))))
        self.assertIn("question     is that right? more than 50000 Hz",
                      self.imported())
        self.write("log.csv", table("t,w,T", ((k // 5, 0.1, 25)
                                              for k in range(50))))
        self.assertIn("is the clock of the log coarser than its rows?",
                      self.imported())

    def test_questions_about_a_gyro_at_rest(self):
        def said(rate, T=lambda k: -30 + 70 * k / 2000, step_ms=1000):
            self.write("log.csv", table("t,w,T", (
                (step_ms * k, rate(k), T(k)) for k in range(2000))))
            return self.imported()

        for rate in [lambda k: 0.1 * (k % 9), lambda k: 29 + k % 2,
                     lambda k: 900 if k == 7 else 0.1 * (k % 2)]:
            self.assertNotIn("question", said(rate))
        self.assertIn("question     can this gyro at rest read 200 to 201 deg/s? ",
                      said(lambda k: 200 + k % 2))
        self.assertRegex(said(lambda k: -40 + k % 70),
                         "can this gyro at rest read -3[67] to 2[56] deg/s?")
        self.assertIn("is the gyro connected?", said(lambda k: 0))
        self.assertIn("does the temperature sensor work?",
                      said(lambda k: k % 2, T=lambda k: 21))
        self.assertIn("83.3 days with a row each 3600 s often mean a wrong "
                      "time.unit", said(lambda k: k % 2, step_ms=3600000))

    def test_a_question_about_a_column_that_is_mostly_blank(self):
        self.write("log.csv", table("t,w,T", (
            (10 * k, 0.1 + k % 2, 25 + 0.001 * k if k % 100 == 0 else "")
            for k in range(1001))))
        said = self.imported()
        self.assertIn("1001 rows read, 11 kept", said)
        self.assertIn("question     is the temperature logged at a lower rate? "
                      "it is missing in 990 rows; [join] with its table and "
                      "--join log.csv", said)
        signal = '[temperature]\ncolumn = "T"\nunit = "degC"\n'
        clock = '[join.time]\ncolumn = "t"\nunit = "ms"\n'
        self.write("map.toml", BENCH.replace(signal, "") +
                   "[join]\nmax_gap_s = 1\n" + clock +
                   signal.replace("[", "[join."))
        said = self.imported("log.csv", "--join", "log.csv")
        self.assertIn("1001 rows read, 1001 kept", said)
        self.assertNotIn("question", said)
        values = self.signals("r.h5")
        np.testing.assert_allclose(values["temperature"],
                                   25 + 0.001 * np.arange(1001), rtol=1e-12)

    def test_one_gap(self):
        self.write("log.csv", table("t,w,T", (
            (10 * k + 1000 * (k > 4), 0.1, 25) for k in range(10))))
        self.assertIn("1 gap, the longest 1.01 s", self.imported())

    def test_a_million_rows_with_dates_and_decimal_commas(self):
        count = 10**6
        block = "".join(f"05.03.2026 {{}}:{k // 10:02d},{k % 10};0,01;-0,0"
                        f"{k % 9};{25 + k / 1e3:.3f}\n".replace(
                            f"{25 + k / 1e3:.3f}",
                            f"{25 + k / 1e3:.3f}".replace(".", ","))
                        for k in range(600))
        self.write("log.csv", "when;x;w;T\n" + "".join(
            block.replace("{}", f"{n // 60 % 24:02d}:{n % 60:02d}").replace(
                "05.03.", f"{5 + n // 1440:02d}.03.")
            for n in range(-(-count // 600))))
        self.write("map.toml", """\
decimal = ","
[time]
column = "when"
format = "%d.%m.%Y %H:%M:%S"
[gyro]
column = "w"
unit = "deg/s"
[temperature]
column = "T"
unit = "degC"
""")
        text = self.imported()
        rows = 600 * -(-count // 600)
        self.assertIn(f"{rows} rows read, {rows} kept", text)
        values = self.signals("r.h5")
        np.testing.assert_array_equal(values["time"], np.arange(rows) / 10)
