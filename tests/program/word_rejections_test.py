# SPDX-License-Identifier: MIT
"""Words of the command line that are mistyped, missing or too many."""

import h5py

from program import SCENARIO, ProgramTest
from rejections import Rejections, row

RUN = "run s.toml -o a.h5"
SEED = "expected a whole number from 0 to 9223372036854775807"


class Words(Rejections):
    table = [
        # Commands and options that are not known
        row("", "see beamgyro --help"),
        row("trian", "trian", "train"),
        row("help rnu", '"rnu"', '"run"'),
        row("--verison", 'did you mean "--version"?'),
        *[row(f"run s.toml {option} a.h5", f'"{option.split("=")[0]}"',
              f'did you mean "{meant}"?') for option, meant in [
            ("--outptu", "--output"), ("--fidelty", "--fidelity"), ("--sead", "--seed"),
            ("-seed", "--seed"), ("--quite", "--quiet"), ("--Output", "--output"),
            ("--outptu=a.h5", "--output")]],
        row(f"{RUN} --frobnicate", '"--frobnicate"', "see beamgyro run --help"),
        # A long name behind one dash is no value
        row("run s.toml -output=a.h5 a.h5", '"-output"', 'did you mean "--output"?'),
        row("run s.toml -output a.h5", '"-output"', 'did you mean "--output"?'),
        row("run s.toml -o=a.h5", "expected -o a.h5"),
        row("run s.toml -out a.h5", '"-out" is -o with the value "ut"; expected -o a.h5'),
        row(f"{RUN} -quiet", 'did you mean "--quiet"?'),
        # Missing
        row("run s.toml", "--output is missing; expected beamgyro run SCENARIO.toml -o RUN.h5"),
        row("run -o a.h5", "SCENARIO.toml is missing"),
        row("run s.toml -o", "-o has no value"),
        *[row(f"run s.toml {words}", f"{name} has no value; expected {name} ")
          for words, name in [("-o --seed 3", "-o"), ("-o a.h5 --set --seed 3", "--set"),
                              ("-o a.h5 --seed=", "--seed"),
                              ("--output= --seed 3", "--output")]],
        row("train r.h5 --held-out --model m.toml -o c.json", "--held-out has no value"),
        # Empty, as a script gives it whose variable is not set
        row("run s.toml -o ''", '--output "": is empty'),
        row("plot rest.h5 -o ''", '--output "": is empty'),
        row("allan rest.h5 --json ''", '--json "": is empty'),
        row("plan p.json --picture ''", '--picture "": is empty'),
        row("info ''", "is empty"),
        row("plot rest.h5 '' -o p.png", "is empty"),
        # Too many
        row("run s.toml s2.toml -o a.h5", '"s2.toml"', "expected beamgyro run"),
        row(f"{RUN} --output b.h5", "--output is given twice"),
        row("generate s.toml -o d --strict=yes", "--strict takes no value"),
        row("export a b c d --format px4 -o fw", "expected beamgyro export"),
        # Numbers
        *[row(f"{RUN} --seed '{value}'", f"--seed {value}: {wrong}; {SEED}")
          for wrong, values in [
              ("not a whole number", ["abc", "1.5", "", "7x"]),
              ("out of range", ["99999999999999999999", "9223372036854775808", "-1"])]
          for value in values],
        row(f"{RUN} --seed=-1", "seed"),
        row("generate s.toml -o d --jobs 0",
            "--jobs 0: out of range; expected a whole number from 1 to 4096"),
        row("allan s.csv --rate-Hz fast", "--rate-Hz fast: not a number"),
        row("allan s.csv --from nan", "--from nan: not finite"),
        # Words of a list
        row(f"{RUN} --fidelity carier", "--fidelity carier: not known; expected "
            'quasistatic, envelope, carrier; did you mean "carrier"?'),
        row("train r.h5 --model m.toml -o c.json --cv day", "--cv",
            "expected run, cycle, leg"),
        # Names that do not say what is written
        row("allan rest.h5 --json b.h5",
            "--json b.h5: is the name of a file of another kind"),
        row("allan rest.h5 --json b.toml", "--json b.toml"),
    ]

    def prepare(self):
        super().prepare()
        self.write("s.toml", SCENARIO)
        self.run_scenario("rest")

    def test_no_control_character_reaches_the_terminal(self):
        evil = "\x1b]0;x\x07\x1b[2J\r\x08\x9b\u202fé"
        for command in [["info", evil], ["run", evil, "-o", "a.h5"], ["verify", evil],
                        [evil]]:
            said = self.rejected(*command)
            self.assertIn("\\x1b]0;x\\x07", said)
            self.assertIn("\u202fé", said)
            self.assertFalse(set(said) & set("\x1b\x07\r\x08\x9b"))
        self.write("series.csv", "a,\x1b[31mb\n1,2\n3,4\n")
        said = self.rejected("allan", "series.csv", "--rate-Hz", "1", "--dataset", "c",
                             says="\\x1b[31mb")
        self.assertNotIn("\x1b", said)


class Accepted(ProgramTest):
    def test_the_largest_seed_is_itself(self):
        self.write("s.toml", SCENARIO)
        self.ok("run", "s.toml", "-oa.h5", "--seed", 2**63 - 1)
        with h5py.File(self.dir / "a.h5") as file:
            self.assertEqual(file.attrs["seed"], 2**63 - 1)
