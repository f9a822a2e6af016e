# SPDX-License-Identifier: MIT
"""What `compensate --stream` does with lines that are no sample."""

import math
import subprocess
import sys
import time

from program import PATIENCE, PROGRAM, ROOT, ProgramTest

NAMES = "time,rate,temperature\n"
IDENTITY = f"cmd:{sys.executable} -u identity.py"
# Its answers are the rates; it reads four samples before the first answer.
LATE = """\
import sys
lines = []
for line in sys.stdin:
    lines.append(line)
    if len(lines) == 5:
        print(*[one.split(",")[1] for one in lines[1:]], sep="\\n", flush=True)
for line in lines[5:]:
    print(line.split(",")[1])
"""
# Takes off nothing; a NaN or an odd step of time would show.
LIBRARY = """\
#include <beamgyro/plugin.h>
uint32_t beamgyro_plugin_abi(void) { return BEAMGYRO_PLUGIN_ABI; }
const char* beamgyro_plugin_signals(void) { return "rate"; }
void* beamgyro_plugin_create(void) { static double it; return &it; }
int32_t beamgyro_plugin_reset(void* it, double period) {
  *(double*)it = period;
  return 0;
}
double beamgyro_plugin_step(void* it, double t, const double* v) {
  (void)t;
  return v[0] + *(double*)it - *(double*)it;
}
void beamgyro_plugin_destroy(void* it) { (void)it; }
"""
# Each with words of its warning and of its line in the summary.
FAULTS = [("1,nan,2\n", "input:3: rate is nan while powered", "not finite"),
          ("1,x,2\n", "input:3:3: 'x' is not a number", "no number"),
          ("1,1e309,2\n", "input:3:3: '1e309'", "no number"),
          ("1,2\n", "input:3: 2 cells; expected 3", "number of cells"),
          ("1,2,3,4\n", "input:3: 4 cells; expected 3", "number of cells"),
          ("0,1,2\n", "input:3: time 0 does not follow 0", "time that"),
          ("\0\xff\n", "input:3: 1 cell", "number of cells"),
          ("1" * 70000 + "\n", "input:3: a line of more than", "too long")]


class StreamFaults(ProgramTest):

    def prepare(self):
        super().prepare()
        self.cubic_of_a_ramp("run")
        self.write("identity.py",
                   "import sys\nsys.stdin.readline()\nfor line in sys.stdin:\n"
                   "    print(line.split(',')[1])\n")
        self.write("late.py", LATE)
        self.write("library.c", LIBRARY)
        subprocess.run(["cc", "-shared", "-fPIC", f"-I{ROOT}/include",
                        "library.c", "-o", "library.so"], cwd=self.dir,
                       check=True)

    def stream(self, compensator, text, *arguments, status=0):
        return self.ended("compensate", compensator, "--stream", *arguments,
                          given=text, allowed=(status,))

    def rates(self, compensator, text, *arguments):
        """The first number of each answer, and what is said of the samples."""
        answer = self.stream(compensator, text, *arguments)
        rates = [float(line.split(",")[0]) for line in answer.stdout.splitlines()
                 if not line.startswith("c")]
        return rates, answer.stderr

    def test_a_line_that_is_no_sample_is_answered_nan_and_the_rest_goes_on(self):
        whole = NAMES + "0,1,20\n2,3,20\n"
        for compensator in ["c.json", IDENTITY, "./library.so"]:
            expected, said = self.rates(compensator, whole)
            self.assertEqual(said, "")
            for line, warning, kind in FAULTS:
                rates, said = self.rates(
                    compensator, NAMES + "0,1,20\n" + line + "2,3,20\n")
                self.assertEqual([rates[0], rates[2]], expected, line[:20])
                self.assertTrue(math.isnan(rates[1]))
                self.assertEqual(len(said.splitlines()), 2, said)
                self.assertIn(warning, said.splitlines()[0])
                self.assertIn("answered nan", said.splitlines()[0])
                self.assertIn("1 of 3 samples", said.splitlines()[1])
                self.assertIn(kind, said.splitlines()[1])

    def test_each_kind_of_fault_is_warned_of_once_and_counted(self):
        text = NAMES + "".join(f"{k},1,20\n{k},2\n{k}.5,nan,20\n"
                               for k in range(100))
        rates, said = self.rates(IDENTITY, text)
        self.assertEqual(sum(map(math.isnan, rates)), 200)
        self.assertEqual(rates[::3], [1] * 100)
        *warnings, summary = said.splitlines()
        self.assertEqual(len(warnings), 2, said)
        for part in ["200 of 300 samples", "100 with another number of cells",
                     "100 with a value that is not finite"]:
            self.assertIn(part, summary)

    def test_answers_stay_in_order_where_a_command_answers_late(self):
        text = NAMES + "0,1,2\nx,2,2\n1,3,2\n2,4,2\n3,nan,2\n4,5,2\n5,6,2\n6\n"
        rates, _ = self.rates(f"cmd:{sys.executable} late.py", text)
        self.assertEqual(*[[None if math.isnan(rate) else rate for rate in some]
                           for some in [rates, [1, math.nan, 3, 4, math.nan, 5,
                                                6, math.nan]]])

    def test_the_first_samples_may_be_bad(self):
        text = NAMES + "0,x,2\n0,1,2\n1,y,2\n1,2,2\nz\n"
        for compensator in [IDENTITY, "./library.so"]:
            rates, _ = self.rates(compensator, text)
            self.assertEqual([math.isnan(rate) for rate in rates],
                             [True, False, True, False, True])
            self.assertEqual((rates[1], rates[3]), (1, 2))

    def test_a_fault_of_the_compensator_names_its_sample_in_the_stream(self):
        answer = self.stream("cmd:echo 1; echo 2; echo what; cat >/dev/null",
                             NAMES + "0,1,2\nx\n1,1,2\ny\n2,1,2\n", status=3)
        self.assertIn('"what", which is no number, to sample 4', answer.stderr)
        self.assertEqual(answer.stdout, "1\nnan\n2\nnan\n")

    def test_a_last_line_that_is_cut_off_is_not_answered_as_a_whole_one(self):
        for cut in ["0.1,2,2", "0.1,2", "0.1,"]:
            rates, said = self.rates(IDENTITY, NAMES + "0,1,25\n" + cut)
            self.assertEqual(rates[0], 1)
            self.assertTrue(math.isnan(rates[1]))
            self.assertIn("input:3: the last line has no end", said)
        self.assertEqual(self.rates(IDENTITY, NAMES + "0,1,25\n  ")[0], [1])

    def test_the_line_of_names_must_be_right(self):
        row = "0,1,2\n1,1,2\n"
        for names, says in [("rate,temperature\n", "input:1: no column time"),
                            ("time,rate,rate\n", "input:1:11: two columns"),
                            ("time,rate [parsec]\n", "input:1: rate"),
                            ("time,rate,true_rate [m,m]\n", "input:1"),
                            ("time," + "x" * 70000 + "\n", "input:1: a line")]:
            answer = self.stream("c.json", names + row, status=2)
            self.assertIn(says, answer.stderr)
            self.assertEqual(len(answer.stderr.splitlines()), 1)
            self.assertEqual(answer.stdout.count("nan"), 0)

    def test_lines_are_counted_with_the_empty_ones(self):
        self.assertIn("input:5: 1 cell;", self.rates(
            IDENTITY, NAMES + "0,1,2\n\n\n1\n2,1,2\n")[1])

    def test_a_line_without_end_takes_neither_time_nor_memory(self):
        with subprocess.Popen(
                ["/bin/sh", "-c", f"ulimit -v 1000000; exec '{PROGRAM}' "
                 "compensate c.json --stream"], cwd=self.dir, bufsize=0,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE) as program:
            begin = time.monotonic()
            program.stdin.write(NAMES.encode() + b"0,1,20\n")
            block = b"1" * 1_000_000
            for _ in range(300):
                program.stdin.write(block)
            program.stdin.write(b"\n1,1,20\n")
            out, said = program.communicate(timeout=PATIENCE)
            self.assertLess(time.monotonic() - begin, 20)
        self.assertEqual(program.returncode, 0, said)
        answers = out.decode().splitlines()
        self.assertEqual([answer.startswith("nan") for answer in answers[-3:]],
                         [False, True, False])
