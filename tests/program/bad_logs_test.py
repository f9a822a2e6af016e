# SPDX-License-Identifier: MIT
"""`beamgyro import`: logs that are refused."""

import unittest

from bench_log import BENCH, bench_rows, table
from program import CUBIC, ProgramTest


class BadLogs(ProgramTest):
    def refused(self, log, says, bench=BENCH, *arguments):
        self.write("log.csv", log)
        self.write("map.toml", bench)
        return self.rejected("import", "log.csv", "--map", "map.toml", "-o",
                             "r.h5", *arguments, says=says)

    def test_logs_that_hold_no_rows(self):
        for log, says in [("", "log.csv:1:1"), ("\n\n", "log.csv:2:1"),
                          ("t,w,T\n", "0 of 0 rows"),
                          ("t,w,T\n0,1,25\n", "1 of 1 rows"),
                          (b"ULog\x01\x12\x35\0\0", "a ULog file of PX4"),
                          (b"t,w,T\n0,\0", "log.csv:2:3: a NUL"),
                          (b"\x89HDF\r\n\x1a\n\0", "needs no import"),
                          (b"PK\x03\x04\0", "exported as CSV"),
                          (b"\x1f\x8b\x08\0", "gzip"),
                          ("t,w,T\n0,1,25\n".encode("utf-16"), "UTF-16"),
                          ("0,1,25\n1,1,25\n", "header = false")]:
            with self.subTest(log):
                self.refused(log, says)

    def test_rows_that_are_not_as_the_map_says(self):
        head = "t,w,T\n0,1,25\n"
        for rows, says in [("10,x,25\n", "log.csv:3:4: 'x' is not a number"),
                           ("10,1\n", "log.csv:3:5: 2 cells; expected 3"),
                           ("10,1,25,4\n", "log.csv:3:10: 4 cells"),
                           ("-1,1,25\n", "log.csv:3:1: the time goes back"),
                           ("10,inf,25\n", "log.csv:3:4: 'inf' is infinite"),
                           ("10,1,298.15\n", ["log.csv:3:6: '298.15' is 298.15",
                                              "degC", "map.toml:11:8"]),
                           ("10,30000,25\n", ["log.csv:3:4", "deg/s"]),
                           ("10,\"1,25\n", "log.csv:3:4: a quote")]:
            with self.subTest(rows):
                self.refused(head + rows, says)

    def test_the_advice_fits_the_cell(self):
        head = "t,w,T\n0,1,25\n"
        for row, says in [
                ("2026-03-05T14:00:00,1,25\n", "time.format = \"iso\""),
                ("14:00:00,1,25\n", "time.format = \"iso\""),
                ("05.03.2026,1,25\n", "time.format = \"iso\""),
                ('10,"0,5",25\n', 'decimal = "," in the map'),
                ("10,1,25degC\n", "its unit is stated by the map"),
                ("10,--,25\n", "missing_markers")]:
            with self.subTest(row):
                message = self.refused(head + row, [says, "log.csv:3:"])
                self.assertEqual("missing_markers" in message,
                                 says == "missing_markers")
        comma = BENCH.replace("[time]", 'decimal = ","\ndelimiter = ";"\n'
                                        "[time]")
        self.refused("t;w;T\n0;1.5;25\n", 'decimal = "." in the map', comma)
        self.refused("t;w;T\n0;1.000,5;25\n", "is not a number", comma)

    def test_a_temperature_that_changes_too_fast_is_asked_about(self):
        """91 K in 4 s: ns typed for us."""
        log = table("t,w,T", ((10**6 * k, 0.1, -40 + 91 * k / 4000)
                              for k in range(4001)))
        said = self.refused(
            log, ["log.csv:", "the temperature changes by 0.5",
                  "K at such rates in the 4 s of the log, is that right?",
                  'map.toml:3:8: time.unit = "ns", "us" makes it 4000 s'],
            BENCH.replace('"ms"', '"ns"'))
        self.assertIn('rules.fast_temperature = "keep"', said)
        self.write("map.toml", BENCH.replace('"ms"', '"ns"') +
                   '[rules]\nfast_temperature = "keep"\n')
        self.ok("import", "log.csv", "--map", "map.toml", "-o", "r.h5")
        self.write("map.toml", BENCH.replace('"ms"', '"us"'))
        self.ok("import", "log.csv", "--map", "map.toml", "-o", "r.h5")

    def test_maps_that_do_not_fit(self):
        log = "t,w,T\n0,1,25\n10,1,25\n"
        for old, new, says in [
                ('"w"', '"W1"', ["map.toml:6:10", '"w"?', "t, w, T"]),
                ('"w"', "4", "log.csv has 3 columns"),
                ('unit = "deg/s"\n', "", "gyro.unit: missing"),
                ('"deg/s"', '"dps"', ["gyro.unit", '"dps"', '"deg/s"']),
                ('"degC"', '"counts"', "temperature.scale_K: missing"),
                ("[gyro]", "[gyros]", "gyro"),
                ("[time]", "delimeter = ','\n[time]", "delimiter"),
                ("at_rest", "at_rets", "at_rest")]:
            with self.subTest(new):
                self.refused(log, says, BENCH.replace(old, new))
        self.refused(log, "--axis", BENCH, "--axis", "z")

    def test_files_that_cannot_be_read_or_written(self):
        self.write("log.csv", "t,w,T\n0,1,25\n10,1,25\n")
        self.write("map.toml", BENCH)
        for log, mapping, output, says in [
                ("gone.csv", "map.toml", "r.h5", "gone.csv"),
                ("log.csv", "gone.toml", "r.h5", "gone.toml"),
                ("log.csv", "log.csv", "r.h5", "not TOML"),
                (".", "map.toml", "r.h5", "cannot read"),
                ("log.csv", "map.toml", "r.txt", ".h5 or .csv"),
                ("log.csv", "map.toml", "log.csv", "is read by this command"),
                ("log.csv", "map.toml", "gone/r.h5", "gone")]:
            with self.subTest((log, mapping, output)):
                self.rejected("import", log, "--map", mapping, "-o", output,
                              says=says)

    def test_without_a_true_rate_training_says_so(self):
        self.write("cubic.toml", CUBIC)
        self.write("map.toml", BENCH.split("[true_rate]")[0])
        self.write("log.csv", table("t,w,T", bench_rows()))
        self.ok("import", "log.csv", "--map", "map.toml", "-o", "blind.h5")
        self.write("map.toml", BENCH)
        self.ok("import", "log.csv", "--map", "map.toml", "-o", "run.h5")
        self.ok("train", "run.h5", "--model", "cubic.toml", "-o", "c.json")
        self.ok("compensate", "c.json", "blind.h5", "-o", "out.h5")
        self.ok("allan", "blind.h5")
        for arguments in [("train", "blind.h5", "--model", "cubic.toml", "-o",
                           "d.json"), ("validate", "c.json", "blind.h5")]:
            with self.subTest(arguments):
                self.rejected(*arguments, says=["blind.h5", "'true_rate'"])

    def test_inputs_a_log_does_not_have(self):
        self.write("m.toml", 'kind = "bp"\ninputs = ["output", "temperature"]\n'
                             "[bp]\nhidden = [2]\n")
        self.write("map.toml", BENCH)
        for name, extra in [("a", 0), ("b", 60)]:
            self.write("log.csv", table("t,w,T", bench_rows(2400 + extra)))
            self.ok("import", "log.csv", "--map", "map.toml", "-o", f"{name}.h5")
        self.rejected("train", "a.h5", "--held-out", "b.h5", "--model", "m.toml",
                      "-o", "c.json", says=["a.h5", "output"])


if __name__ == "__main__":
    unittest.main()
