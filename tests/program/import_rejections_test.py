# SPDX-License-Identifier: MIT
"""Logs and maps that `import` refuses."""

import re

from bench_log import BENCH, table
from program import ProgramTest
from rejections import Rejections, row

IMPORT = "import log.csv --map map.toml -o r.h5"
HEAD = "t,w,T\n0,1,25\n"
COMMA = BENCH.replace("[time]", 'decimal = ","\ndelimiter = ";"\n[time]')
ISO = 'time.format = "iso"'
NO_MARKERS = re.compile(r"^(?!.*missing_markers)", re.DOTALL)
# 91 K in 4 s: ns typed for us.
FAST = table("t,w,T", ((10**6 * k, 0.1, -40 + 91 * k / 4000) for k in range(4001)))


def log(text, *says, bench=BENCH, **options):
    return row(IMPORT, *says, files={"log.csv": text, "map.toml": bench},
               name=str(text)[-80:], **options)


def line(text, *says):
    return log(HEAD + text, *says)


def log_map(old, new, *says):
    assert old in BENCH, old
    return row(IMPORT, *says, name=new or f"no {old}", files={
        "log.csv": HEAD + "10,1,25\n", "map.toml": BENCH.replace(old, new)})


class Logs(Rejections):
    table = [
        # Files without rows, and of other kinds
        log("", "log.csv:1:1"), log("\n\n", "log.csv:2:1"),
        log("t,w,T\n", "0 of 0 rows"), log(HEAD, "1 of 1 rows"),
        log("0,1,25\n1,1,25\n", "header = false"),
        log(b"ULog\x01\x12\x35\0\0", "a ULog file of PX4"),
        log(b"t,w,T\n0,\0", "log.csv:2:3: a NUL"),
        log(b"\x89HDF\r\n\x1a\n\0", "needs no import"),
        log(b"PK\x03\x04\0", "exported as CSV"),
        log(b"\x1f\x8b\x08\0", "gzip"),
        log(HEAD.encode("utf-16"), "UTF-16"),
        # Rows that are not as the map says
        line("10,x,25\n", "log.csv:3:4: 'x' is not a number"),
        line("10,1\n", "log.csv:3:5: 2 cells; expected 3"),
        line("10,1,25,4\n", "log.csv:3:10: 4 cells"),
        line("-1,1,25\n", "log.csv:3:1: the time goes back"),
        line("10,inf,25\n", "log.csv:3:4: 'inf' is infinite"),
        line("10,1,298.15\n", "log.csv:3:6: '298.15' is 298.15", "degC", "map.toml:11:8"),
        line("10,30000,25\n", "log.csv:3:4", "deg/s"),
        line("10,\"1,25\n", "log.csv:3:4: a quote"),
        # Advice that fits the cell
        *[row(IMPORT, "log.csv:3:", advice, NO_MARKERS, files={"log.csv": HEAD + cells},
              name=cells) for cells, advice in [
            ("2026-03-05T14:00:00,1,25\n", ISO), ("14:00:00,1,25\n", ISO),
            ("05.03.2026,1,25\n", ISO), ('10,"0,5",25\n', 'decimal = "," in the map'),
            ("10,1,25degC\n", "its unit is stated by the map")]],
        line("10,--,25\n", "log.csv:3:", "missing_markers"),
        log("t;w;T\n0;1.5;25\n", 'decimal = "." in the map', bench=COMMA),
        log("t;w;T\n0;2.548,866;25\n", "2548,866, without marks of thousands",
            bench=COMMA),
        log("t;w;T\n0;1.000,5;25\n", "is not a number", bench=COMMA),
        log(FAST, "log.csv:", "the temperature changes by 0.5",
            "K at such rates in the 4 s of the log, is that right?",
            'map.toml:3:8: time.unit = "ns", "us" makes it 4000 s',
            'rules.fast_temperature = "keep"', bench=BENCH.replace('"ms"', '"ns"')),
        # Maps
        log_map('"w"', '"W1"', "map.toml:6:10", '"w"?', "t, w, T"),
        log_map('"w"', "4", "log.csv has 3 columns"),
        log_map('unit = "deg/s"\n', "", "gyro.unit: missing"),
        log_map('"deg/s"', '"dps"', "gyro.unit", '"dps"', '"deg/s"'),
        log_map('"degC"', '"counts"', "temperature.scale_K: missing"),
        log_map("[gyro]", "[gyros]", "gyro"),
        log_map("[time]", "delimeter = ','\n[time]", "delimiter"),
        log_map("at_rest", "at_rets", "at_rest"),
        row(f"{IMPORT} --axis z", "--axis"),
        # Files
        row("import gone.csv --map map.toml -o r.h5", "gone.csv"),
        row("import log.csv --map gone.toml -o r.h5", "gone.toml"),
        row("import log.csv --map log.csv -o r.h5", "not TOML"),
        row("import . --map map.toml -o r.h5", "cannot read"),
        row("import log.csv --map map.toml -o r.txt", ".h5 or .csv"),
        row("import log.csv --map map.toml -o gone/r.h5", "gone"),
    ]

    def prepare(self):
        super().prepare()
        self.write("log.csv", HEAD + "10,1,25\n")
        self.write("map.toml", BENCH)


class Accepted(ProgramTest):
    def test_a_fast_temperature_that_is_meant(self):
        self.write("log.csv", FAST)
        for bench in [BENCH.replace('"ms"', '"ns"') + '[rules]\nfast_temperature = "keep"\n',
                      BENCH.replace('"ms"', '"us"')]:
            self.write("map.toml", bench)
            self.ok(*IMPORT.split())
