# SPDX-License-Identifier: MIT
"""Scenarios and devices that `run` and `characterise` refuse."""

import re

from program import SCENARIO, SCENARIOS, ProgramTest
from rejections import Rejections, row

PLACE = re.compile(r"\.(toml|csv):\d+:\d+")
NOMINAL = (SCENARIOS / "devices/nominal.toml").read_text()
RUN = "run s.toml -o out.h5"
DRIVE = "drive.voltage_limit_V=0.4"
FIDELITIES = ["quasistatic", "envelope", "carrier"]


def replaced(old, new):
    assert old in SCENARIO, old
    return SCENARIO.replace(old, new)


def scenario(old, new, *says, **options):
    """A scenario with other text, which the message has the place of."""
    return row(RUN, *says, PLACE, files={"s.toml": replaced(old, new)},
               name=new or f"no {old}", **options)


def added(text, *says):
    return row(RUN, *says, PLACE, files={"s.toml": SCENARIO + text}, name=text)


def override(change, *says, **options):
    return row([*RUN.split(), "--set", change], *says, **options)


def ambient(form, *says):
    return scenario("constant_degC = 25", form, *says)


def two_seconds(fidelity):
    return replaced("quasistatic", fidelity).replace("= 600", "= 2")


def profile(text, says):
    return row(RUN, says, name=text, files={
        "log.csv": text,
        "s.toml": replaced("constant_degC = 25", 'file = "log.csv"')})


class Scenarios(Rejections):
    table = [
        row("run missing.toml -o out.h5", "missing.toml"),
        row(RUN, "s.toml:3:10: device: ", "gone.toml", "relative to the scenario",
            name="gone.toml", files={"s.toml": replaced("device.toml", "gone.toml")}),
        override('device="gone.toml"', "--set device=", "gone.toml"),
        ambient('file = "gone.csv"', "gone.csv"),
        row("run folder.toml -o out.h5", "folder.toml"),
        # What is not TOML
        *[row(RUN, "s.toml", PLACE, files={"s.toml": text}, name=text)
          for text in ["[[[", "name = \n", "a b c\n", "x = 1 é\n", "\0\1"]],
        row(RUN, "s.toml", files={"s.toml": b"name = \"\xff\xfe\"\n"}, name="Latin-1"),
        row(RUN, "s.toml", files={"s.toml": ""}, name="empty"),
        # Keys
        scenario("duration_s", "duraton_s", "duraton_s", "duration_s"),
        scenario("[ambient]", "[ambiant]", "ambiant", "ambient"),
        row(RUN, "lenght_m", "length_m", "device.toml", PLACE, name="lenght_m",
            files={"device.toml": NOMINAL.replace("length_m", "lenght_m", 1)}),
        # Types and numbers
        scenario("duration_s = 600", 'duration_s = "long"', "duration_s", "long"),
        ambient("constant_degC = [25]", "constant_degC"),
        scenario("seed = 7", "seed = 7.5", "seed", "7.5"),
        scenario('name = "short"', "name = 1", "name"),
        *[scenario("= 600", f"= {value}", "duration_s", value.lstrip("-"))
          for value in ["nan", "inf", "-inf"]],
        *[ambient(f"points = [[0, 20], [9, {value}]]", "points")
          for value in ["nan", "inf", "-inf"]],
        *[scenario("= 600", f"= {value}", "duration_s", *shown) for value, *shown in [
            ("0", "0"), ("-5", "-5"), ("0.2",), ("1e12",), ("1e300",)]],
        row(RUN, "duration_s", PLACE, name="beside the output of another run",
            files={"out.h5": "precious", "s.toml": replaced("= 600", "= 0")}),
        scenario("output_rate_Hz = 2", "output_rate_Hz = 201",
                 "output_rate_Hz", "201", "200"),
        # Profiles
        *[ambient(form, "points") for form in [
            "points = []", "points = [[10, 20], [5, 30]]", "points = [[10, 20], [10, 30]]",
            "points = [[1, 2, 3]]", "points = [5]"]],
        added("[rate]\nsteps = [[5, 1], [4, 2]]\n", "steps"),
        added("[power]\non_s = [0, 100]\noff_s = [200]\n", "off_s"),
        added("points = [[0, 25]]\n", "constant_degC", "points"),
        scenario("constant_degC = 25\n", "", "ambient"),
        profile("", "log.csv"),
        *[profile(f"time_s,temperature_degC\n{rows}", says) for rows, says in [
            ("", "log.csv"), ("0,20\n5,21\n5,22\n", "log.csv:4"),
            ("0,20\n5,warm\n", "log.csv:3"), ("0,20\n5\n", "log.csv:3"),
            ("0,nan\n", "log.csv:2")]],
        profile("t,T\n0,20\n", "log.csv:1"),
        added("\n[cross_rate]\nz = { constant_deg_per_s = 1 }\n", "cross_rate.z"),
        added("\n[cross_rate]\nx = { constant_g = 1 }\n", "constant_deg_per_s"),
        added("\n[acceleration]\nx = 9.81\n", "acceleration.x"),
        added("\n[acceleration]\ny = { sine = { amplitude_g = 1 } }\n", "frequency_Hz"),
        added("\n[acceleration]\nz = { constant_g = inf }\n", "constant_g"),
        # Fidelities
        scenario("quasistatic", "quasi", "quasistatic"),
        *[row(RUN, "output_rate_Hz", rate, *says, name=fidelity, files={
            "s.toml": replaced("quasistatic", fidelity).replace(
                "output_rate_Hz = 2", f"output_rate_Hz = {rate}")})
          for fidelity, rate, *says in [("envelope", "2001", "2000", PLACE),
                                        ("carrier", "2500", "quarter")]],
        # On the slowest and the fastest machine: the first second is timed.
        row(RUN, "900000 s", "--yes", name="hours of a carrier", files={
            "s.toml": replaced("quasistatic", "carrier").replace("= 600", "= 900000")}),
        # Temperatures that the materials do not stand
        *[override(f"{key}={value}", key, "[-100, 150]") for key, value in [
            ("ambient.constant_degC", 151), ("ambient.constant_degC", -101),
            ("thermal.oven", "{ set_point_degC = 200, max_power_W = 3, "
             "proportional_W_per_K = 1, integral_time_s = 60 }")]],
        row(RUN, "s.toml:10:17: ambient.constant_degC", "170", name="170 degC",
            files={"s.toml": replaced("= 25", "= 170")}),
        *[override("thermal.electronics_power_W=600", "board at 1", "-100 to 150 degC",
                   "ceramic", "electronics_power_W = 600", status=1, name=fidelity,
                   files={"s.toml": replaced("quasistatic", fidelity).replace(
                       "= 600", "= 5")})
          for fidelity in FIDELITIES],
        # Overrides
        *[override(change, says) for change, says in [
            ("beam.lenght_m=0.04", "beam.length_m"), ("beam.length_m", "beam.length_m"),
            ("beam.length_m=", "beam.length_m"), ("beam.length_m=forty", "forty"),
            ("duration_s=0", "duration_s"), ("=3", "=3"),
            ("length_m=0.03", "did you mean 'beam.length_m' or 'patches.length_m'?"),
            ("air.Q=400", "'air' has inverse_Q"),
            ("temperature_sensor.bits=8", "'temperature_sensor' has "),
            ("cross_rate.z=3", "'cross_rate' has x, y")]],
        # Files of another kind
        row(RUN, "s.toml: is empty; expected a TOML file", name="nothing", files={
            "s.toml": " \n"}),
        row(RUN, "s.toml: is JSON, as compensators", name="JSON", files={
            "s.toml": '{"filetype": "x"}'}),
        # Outputs
        *[row(["run", "s.toml", "-o", output], output) for output in [
            "nowhere/out.h5", "folder.h5", "s.toml/out.h5", "out.txt"]],
        # The drive
        *[row([*RUN.split(), "--set", DRIVE, "--stop-on-unlock"], "not locked at 1",
              "drive at 0.4 V", status=1, name=fidelity,
              files={"s.toml": two_seconds(fidelity)})
          for fidelity in FIDELITIES],
    ]

    def prepare(self):
        super().prepare()
        self.write("s.toml", SCENARIO)
        for name in ["folder.toml", "folder.h5"]:
            (self.dir / name).mkdir()


def in_another_unit(change, *says):
    """A value of a device in an option of `run` and in a file of its own."""
    key, _, value = change.partition("=")
    table, name = key.split(".")
    found = re.search(rf"(?ms)^\[{table}\].*?^({name} = .*?)$", NOMINAL)
    text = NOMINAL[:found.start(1)] + f"{name} = {value}" + NOMINAL[found.end(1):]
    line = NOMINAL[:found.start(1)].count("\n") + 1
    return [
        override(change, f"{key}: ", "expected a number in", *says),
        row("characterise other.toml -o c.csv", f"other.toml:{line}:", f"{key}: ",
            *says, files={"other.toml": text}, name=change)]


class Devices(Rejections):
    table = [
        *[override(f"{key}={value}", key.split(".")[1]) for key, value in [
            ("beam.density_kg_per_m3", "-8050"), ("beam.length_m", "0"),
            ("patches.thickness_m", "-1e-4"), ("bond.thickness_m", "[1e-5, 1e-5, 1e-5]"),
            ("beam.poisson_ratio", "0.7"), ("readout.adc_bits", "0"),
            ("drive.amplitude_m", "nan")]],
        *in_another_unit("beam.length_m=40", "[0.0001, 0.5]", "40 mm is 0.04 m"),
        *in_another_unit("beam.side_m=3.0", "3 mm is 0.003 m"),
        *in_another_unit("patches.thickness_m=0.25", "0.25 mm is 0.00025 m"),
        *in_another_unit("patches.length_m=12", "12 mm is 0.012 m"),
        *[override("beam.length_m=0.009", "patches.length_m: 0.012; ",
                   "expected less than beam.length_m, which is 0.009")],
        *in_another_unit("beam.youngs_modulus_Pa=185", "185 GPa is 1.85e+11 Pa"),
        *in_another_unit("patches.youngs_modulus_Pa=61", "61 GPa is 6.1e+10 Pa"),
        *in_another_unit("bond.shear_modulus_Pa=1.5", "1.5 GPa is 1.5e+09 Pa"),
        *in_another_unit("bond.beta_step_Pa=0.45", "0.45 GPa is 4.5e+08 Pa"),
        *in_another_unit("bond.alpha_step_Pa=1000", "1000 MPa is 1e+09 Pa"),
        *in_another_unit("beam.density_kg_per_m3=8.05", "8.05 g/cm3 is 8050 kg/m3"),
        *in_another_unit("patches.density_kg_per_m3=7.75", "7.75 g/cm3 is 7750 kg/m3"),
        *in_another_unit("readout.feedback_capacitance_F=100", "100 pF is 1e-10 F"),
        *in_another_unit("patches.d31_C_per_N=-171", "-171 pC/N is -1.71e-10 C/N"),
        *in_another_unit("bond.beta_activation_J_per_mol=65", "65 kJ/mol is 65000 J/mol"),
        *in_another_unit("thermal.electronics_power_W=6e8", "[0, 1000]"),
        row(["characterise", "device.toml", "-o", "out.csv", "--set",
             'readout.mode="whole_angle"'], "mode", "open_loop"),
        row("characterise device.toml -o nowhere/out.csv", "nowhere"),
        row("characterise device.toml -o c.csv --beam-temperature 20:200:10",
            "--beam-temperature: 160 degC", "-100 to 150 degC"),
        *[row(f"characterise device.toml -o x.csv --beam-temperature={text}", text)
          for text in ["60:-40:1", "-40:60:0", "-40:60", "a:b:c", "nan", "-300",
                       "-40:60:-1"]],
        row("characterise device.toml -o x.csv --beam-temperature=-40:60:1e-9",
            "makes 1e+11 temperatures from -40 to 60 degC; expected at most 1000000"),
    ]

    def prepare(self):
        super().prepare()
        self.write("s.toml", SCENARIO)


class Accepted(ProgramTest):
    def test_a_drive_that_does_not_hold_its_amplitude(self):
        for fidelity in FIDELITIES:
            self.write("s.toml", two_seconds(fidelity))
            self.ok(*RUN.split(), "--set", DRIVE)

    def test_a_bond_without_a_step(self):
        self.write("s.toml", SCENARIO)
        self.ok(*RUN.split(), "--set", "bond.beta_step_Pa=0", "--set",
                "bond.alpha_step_Pa=0.0")
