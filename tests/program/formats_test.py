# SPDX-License-Identifier: MIT
"""Compares docs/reference/ with what the program reads and writes."""

import re
import tomllib

import h5py

from pages import page, rows, section
from program import CUBIC, ROOT, ProgramTest, commands, ramp

def keys(table, prefix=""):
    """Dotted keys of a TOML table."""
    for key, value in table.items():
        if isinstance(value, dict):
            name = "NAME" if prefix == "spurious_mode." else key
            yield from keys(value, f"{prefix}{name}.")
        else:
            yield prefix + key


def keys_of_runs(table):
    """Keys of a campaign or a qualification as their pages write them."""
    for key, value in table.items():
        if key == "tolerances":
            yield 'tolerances."KEY"'
        elif key == "spurious_modes":  # of distributions
            yield from (f"{key}.{part}" for part in value)
        elif isinstance(value, list):
            for entry in value:
                yield from (f'{key}.vary."KEY"' if part == "vary"
                            else f"{key}.{part}" for part in entry)
        else:
            yield from keys({key: value})


SIGNALS = {"rate": "deg_per_s", "cross_rate.x": "deg_per_s",
           "cross_rate.y": "deg_per_s", "acceleration.x": "g",
           "acceleration.y": "g", "acceleration.z": "g"}


def scenario_keys():
    """Keys of the page, with those of SIGNAL spelt out for each signal."""
    for key in rows(page("scenario_file")):
        if key.startswith("SIGNAL."):
            yield from (key.replace("SIGNAL", signal).replace("UNIT", unit)
                        for signal, unit in SIGNALS.items())
        elif key not in SIGNALS:
            yield key


# What the second log of a map has, too.
JOINABLE = {"delimiter", "decimal", "header", "header_line", "skip_rows",
            "comment_prefixes", "missing_markers", "filter", "time", "rules",
            "temperature", "drive_frequency", "drive_voltage", "quadrature",
            "true_rate"}
STATED_RATE = {"true_rate.at_rest", "true_rate.constant_deg_per_s"}


def map_keys():
    """Keys of the page, with those of AXIS spelt out for each axis."""
    for key in rows(page("log_map")):
        yield from (key.replace("AXIS", axis) for axis in
                    ("xyz" if "AXIS" in key else "-"))
        if key.split(".")[0] in JOINABLE and key not in STATED_RATE:
            yield f"join.{key}"


def documented_keys(name):
    return {"scenario_file": scenario_keys, "log_map": map_keys}.get(
        name, lambda: rows(page(name)))()


def shipped(pattern):
    for path in sorted((ROOT / "scenarios").glob(pattern)):
        yield path, tomllib.loads(path.read_text())


class Formats(ProgramTest):
    def test_every_command_has_a_section(self):
        sections = re.findall(r"^## (\w+)$", page("commands"), re.MULTILINE)
        self.assertEqual(sorted(sections), sorted(commands()))

    def test_every_option_of_every_command_is_on_the_page(self):
        for command in commands():
            text = section(page("commands"), command)
            described = set(re.findall(r"^- `(--[A-Za-z-]+)", text,
                                       re.MULTILINE))
            named = set(re.findall(r"(?<![\w-])(--[A-Za-z-]+)", "\n".join(
                re.findall(r"^    beamgyro .*", text, re.MULTILINE))))
            offered = set(re.findall(r"^  (?:-\w, )?(--[A-Za-z-]+)",
                                     self.ok(command, "--help"), re.MULTILINE))
            self.assertEqual(described, offered - {
                "--help", "--output", "--quiet", "--version"})
            self.assertEqual(named - described, set())
            if "--output" in offered:  # described once for all commands
                self.assertIn(" -o ", text)

    def test_columns_of_characterise(self):
        self.ok("characterise", "device.toml", "-o", "c.csv",
                "--beam-temperature", 25)
        header = self.text("c.csv").splitlines()[0]
        text = section(page("commands"), "characterise")
        listed = re.findall(r"^\| (`.*?`) \|", text, re.MULTILINE)
        self.assertEqual(",".join(re.findall("`(.*?)`", ",".join(listed))),
                         header)

    def test_every_equation_that_the_code_cites_is_in_the_model(self):
        model = (ROOT / "docs/model.md").read_text()
        label = re.compile(r"equations? \(([1-6]\.[0-9]+)\)")
        for path in sorted(ROOT.glob("sim/**/*.h")):
            for cited in label.findall(path.read_text()):
                self.assertIn(f"({cited})", model)

    def test_every_shipped_key_is_documented(self):
        for pattern, name in [("[!q]*.toml", "scenario_file"),
                              ("qualification/*.toml", "scenario_file"),
                              ("devices/*.toml", "device_file"),
                              ("models/*.toml", "model_file"),
                              ("population/*.toml", "model_file"),
                              ("maps/*.toml", "log_map"),
                              ("campaigns/*.toml", "campaign_file"),
                              ("qualification.toml", "qualification_file")]:
            documented = set(documented_keys(name))
            stated = keys_of_runs if name in (
                "campaign_file", "qualification_file") else keys
            for path, table in shipped(pattern):
                for key in stated(table):
                    self.assertIn(key, documented, path.name)

    def test_every_key_of_the_shipped_specifications_is_documented(self):
        documented = set(rows(page("specification_file")))
        for path in sorted((ROOT / "specs").glob("*.toml")):
            table = tomllib.loads(path.read_text())
            relative = table.pop("limits_relative_to", {}).values()
            limits = [table.pop("limits", {}), *relative]
            keys_here = {*table, *(key for part in limits
                                   for limit in part.values() for key in limit)}
            self.assertEqual(keys_here - documented, set())

    def test_every_device_key_without_a_default_is_required(self):
        text = (ROOT / "scenarios/devices/nominal.toml").read_text()
        optional = {name for name, rest in rows(page("device_file")).items()
                    if "default" in rest or "optional" in rest}
        table = None
        for line in text.splitlines():
            if match := re.match(r"\[(.+)\]", line):
                table = match[1]
            elif match := re.match(r"(\w+) =", line):
                key = f"{table}.{match[1]}"
                self.write("d.toml", text.replace(line + "\n", "", 1)
                           if text.count(line + "\n") == 1 else
                           self.without(text, table, line))
                if key in optional:
                    self.ok("characterise", "d.toml", "-o", "c.csv",
                            "--beam-temperature", 25)
                else:
                    self.rejected("characterise", "d.toml", "-o", "e.csv",
                                  says=key)

    def without(self, text, table, line):
        head, tail = text.split(f"[{table}]", 1)
        return f"{head}[{table}]" + tail.replace(line + "\n", "", 1)

    def test_optional_device_keys_are_accepted(self):
        self.ok("characterise", ROOT / "scenarios/devices/nominal.toml", "-o",
                "c.csv", "--beam-temperature", 25, "--set",
                "beam.angular_gain=0.9", "--set",
                "thermal.oven={set_point_degC=65, max_power_W=3, "
                "proportional_W_per_K=1, integral_time_s=60}")

    def test_optional_noise_and_channel_keys_are_known_to_the_program(self):
        optional = [key for key, rest in rows(page("device_file")).items()
                    if key.startswith("loop_channels.")
                    or key.startswith("noise.turn_on_") and "optional" in rest]
        self.assertEqual(len(optional), 12)
        for key in optional:
            value = "true" if key == "loop_channels.noise" else "0.001"
            self.ok("characterise", ROOT / "scenarios/devices/nominal.toml",
                    "-o", "c.csv", "--beam-temperature", 25,
                    "--set", f"{key}={value}")

    def test_scenario_keys_are_known_to_the_program(self):
        scenario = ROOT / "scenarios/warm_up.toml"
        for key in scenario_keys():
            answer = self.ended("run", scenario, "-o", "r.h5", "--set",
                                f"{key}=[]", allowed=(2,))
            self.assertNotIn("unknown key", answer.stderr)

    def test_map_keys_are_known_to_the_program(self):
        base = {"time.column": '"t"', "time.unit": '"s"',
                "gyro.column": '"w"', "gyro.unit": '"deg/s"',
                "temperature.column": '"T"', "temperature.unit": '"degC"'}
        self.write("log.csv", "t,w,T\n0,1,25\n1,1,25\n")
        second = {"join.max_gap_s": "1", "join.time.column": '"t"',
                  "join.time.unit": '"s"', "join.drive_voltage.column": '"w"',
                  "join.drive_voltage.unit": '"V"'}
        for whole_key in map_keys():
            key = whole_key.removeprefix("join.")
            joined = "join." if key != whole_key else ""
            if whole_key == "join.max_gap_s":
                key, joined = whole_key, ""
            table = key.rpartition(".")[0]
            text = dict(base)
            if table.startswith("gyro."):  # an axis in place of the one gyro
                text = {k: v for k, v in text.items() if "gyro" not in k}
            if table and table != "join" and "." not in table.removeprefix("gyro.") \
                    and table != "rules":
                text.setdefault(f"{table}.column", '"w"')
            if key == "time.rate_Hz":
                text["time.unit"] = '"index"'
            if key in ("time.format", "time.date_column"):
                del text["time.unit"]
                text["time.format"] = '"iso"'
            if key in ("true_rate.at_rest", "true_rate.constant_deg_per_s"):
                del text["true_rate.column"]
            if table in ("gyro", "gyro.x", "gyro.y", "gyro.z", "temperature",
                         "quadrature", "true_rate"):
                if "scale" in key or "wrap" in key or "offset_degC" in key:
                    text[f"{table}.unit"] = '"counts"'
                    text[f"{table}.scale_K"] = "1"
                text.setdefault(f"{table}.unit", '"deg/s"')
            if table == "temperature.thermistor":  # no linear keys beside it
                text["temperature.unit"] = '"V"'
                text[f"{table}.beta_K"] = "3950"
                text[f"{table}.resistance_25_ohm"] = "1e4"
                text[f"{table}.series_ohm"] = text[f"{table}.full_scale"] = "1e4"
                text[f"{table}.side"] = '"ground"'
            text[key] = "{}"
            if joined:
                text = {**{k: v for k, v in base.items() if "temp" not in k},
                        **second, **{joined + k: v for k, v in text.items()
                                     if not k.startswith("gyro")}}
            elif table == "join":
                text = {**text, **{k: v for k, v in second.items()
                                   if k not in text}}
            self.write("m.toml", "".join(f"{name} = {value}\n"
                                         for name, value in text.items()))
            message = self.rejected("import", "log.csv", "--map", "m.toml",
                                    "--join", "log.csv", "-o", "r.h5",
                                    says=f": {whole_key}: ")
            self.assertNotIn("unknown key", message)
            self.assertNotIn("not used together", message)

    def test_the_example_map_holds_every_table(self):
        example = dict(shipped("maps/example.toml"))
        table, = example.values()
        documented = {key.split(".")[0] for key in map_keys()}
        self.assertEqual(set(table) | {"join"}, documented)
        two, = dict(shipped("maps/two_logs.toml")).values()
        self.assertIn("join", two)

    def test_the_recording_holds_what_the_page_lists(self):
        self.cubic_of_a_ramp("run")
        self.ok("run", "run.toml", "--seed", 4, "-o", "more.h5")
        self.train_on("run.h5", "more.h5")
        self.ok("compensate", "c.json", "run.h5", "-o", "out.h5")
        documented = rows(page("recording").split("\n## ")[0])
        with h5py.File(self.dir / "out.h5") as file:
            found = set(file) - {"meta"} | set(file.attrs)
            always = {name for name, rest in documented.items()
                      if "optional" not in rest}
            self.assertEqual(found, always)
            self.assertEqual(set(file["meta"]),
                             {"scenario", "device", "overrides"})
            for name, variable in file.items():
                if name == "meta":
                    continue
                units, role = documented[name].split(" |")[:2]
                self.assertEqual(variable.attrs["units"].decode(), units)
                self.assertEqual(variable.attrs["role"].decode(), role.strip())

    def test_the_compensator_holds_what_the_page_lists(self):
        steps = ", ".join(f"[{40 * k}, {30 * (k % 5 - 2)}]" for k in range(100))
        self.run_scenario("run", text=f"{ramp()}\n[rate]\nsteps = [{steps}]\n")
        text = page("compensator_file")
        documented = rows(text.split("\n## ")[0])
        training = section(text, "Training")
        optional = {name for name, rest in documented.items()
                    if rest.startswith("only with")}
        self.assertEqual(optional, {"scale_factor", "population", "sigma",
                                    "sigma_not_known", "straight_lines"})
        self.ok("run", "run.toml", "--seed", 4, "-o", "more.h5")
        for text, runs, left_out in [
                (CUBIC, ["run.h5"], {"scale_factor", "population", "sigma"}),
                (CUBIC, ["run.h5", "more.h5"],
                 {"scale_factor", "population", "sigma_not_known"}),
                (CUBIC + "[scale_factor]\n", ["run.h5", "more.h5"],
                 {"population", "sigma_not_known"})]:
            left_out = left_out | {"straight_lines"}  # of ramps
            answer = self.train_on(*runs, model=text)
            self.assertEqual(set(answer), set(documented) - left_out)
            self.assertEqual(set(answer["training"]), set(rows(training)))

    def test_parameters_of_every_kind_are_listed(self):
        self.run_scenario("run", text=ramp())
        self.run_scenario("held_out", text=ramp(seed=9))
        text = section(page("compensator_file"), "Parameters")
        listed = dict(re.findall(r'^- kind "(\w+)": ([^-]*?)\.$', text,
                                 re.MULTILINE))
        self.assertIn("bp", listed)
        for kind, parameters in listed.items():
            answer = self.train_on(
                "run.h5", "--held-out", "held_out.h5",
                model=f'kind = "{kind}"\ninputs = ["temperature"]\n'
                + ("[bp]\nhidden = [2]\nrestarts = 1\nmax_epochs = 9\n"
                   if kind == "bp" else ""))
            self.assertEqual(answer["kind"], kind)
            names = set(re.findall(r"`(\w+)`", parameters))
            self.assertEqual(set(answer["parameters"]), names)

    def test_model_keys_are_known_to_the_program(self):
        self.run_scenario("run", text=ramp())
        for key in rows(page("model_file")):
            table = key.rpartition(".")[0]
            kind = table if table not in ("", "rows", "scale_factor") \
                else "polynomial"
            if key == "population":  # a file, of the kind that asks for it
                kind = "adapted"
            inputs = ["temperature", "quadrature"][:1 + (kind == "resonances")]
            text = {"kind": f'"{kind}"', "inputs": str(inputs)}
            if kind == "bp":
                text["bp.hidden"] = "[2]"
            if key in ("bp.learning_rate", "bp.momentum"):
                text["bp.trainer"] = '"incremental"'
            text[key] = "{}"
            self.write("m.toml", "".join(f"{name} = {value}\n"
                                         for name, value in text.items()))
            message = self.rejected("train", "run.h5", "--model", "m.toml",
                                    "-o", "c.json",
                                    says=key.rpartition(".")[2])
            self.assertNotIn("unknown key", message)
