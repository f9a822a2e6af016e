# SPDX-License-Identifier: MIT
"""Every method through the same commands: `train`, `compensate`, `validate`,
on a simulated scenario and on an imported log."""

import tomllib

import numpy as np

from program import SCENARIOS, ProgramTest, by_name, ramp

MODELS = SCENARIOS / "models"

LOG_MAP = """\
[time]
column = "t"
unit = "s"

[gyro]
column = "V"
unit = "V"
offset = 2.5
scale_deg_per_s = 80

[temperature]
column = "T"
unit = "degC"

[true_rate]
column = "w"
unit = "deg/s"
"""

# Kinds that a cubic drift suits, and those that cannot follow it.
EXACT = {"polynomial", "px4", "ardupilot", "spline", "fuzzy"}


def turning(text, rates=(-60, -30, 0, 30, 60), hold=40, until=4000):
    """Steps between two samples of 1 Hz, so that no sample falls on one."""
    steps = ", ".join(f"[{hold * k + 0.5 * (k > 0)}, {rates[k % len(rates)]}]"
                      for k in range(until // hold))
    return f"{text}\n[rate]\nsteps = [{steps}]\n"


def log(T, rate=0):
    """CSV of a gyro of 12.5 mV/(deg/s), one sample a second."""
    lines = ["t,V,T,w"]
    for k, here in enumerate(T):
        w = rate * ((k // 37) % 5 - 2)
        bias = 0.2 + 0.01 * here - 1e-4 * here**2 + 2e-6 * here**3
        lines.append(f"{k},{2.5 + 0.0125 * (w + bias):.9f},{here:.3f},{w}")
    return "\n".join(lines) + "\n"


def soaks(seed):
    """Scenario text of four soaks and ramps of 0.8 K/min between them."""
    time, points = 0, []
    for T in [-30, -6, 18, 42]:
        points += [[time, T], [time + 4000, T]]
        time += 4000 + 1800
    return ramp(seconds=time - 1800, seed=seed, rate_Hz=0.2).replace(
        f"points = [[0, -30], [{time - 1800}, 40]]", f"points = {points}")


def takes_soaks(table):
    return "steady_K_per_min" in table.get("rows", {})


class Methods(ProgramTest):
    def models(self):
        for path in sorted(MODELS.glob("*.toml")):
            text = path.read_text()
            # Fewer starts and epochs, a bin for every plateau: the same code.
            for line in ["restarts = 8", "restarts = 4", "restarts = 2"]:
                text = text.replace(line, "restarts = 1")
            for line in ["max_epochs = 20000", "max_epochs = 5000",
                         "max_epochs = 300", "max_epochs = 150"]:
                text = text.replace(line, "max_epochs = 40")
            yield path.stem, self.write(f"{path.stem}.toml", text), \
                tomllib.loads(text)

    def train(self, name, model, run="train.h5", held_out="held_out.h5"):
        text = self.ok("train", run, "--model", model, "--held-out", held_out,
                       "-o", f"{name}.json")
        return text, self.json(f"{name}.json")

    def rms(self, name, run):
        """Of the error of 60 s means of the compensated and the raw rate."""
        self.ok("compensate", f"{name}.json", run, "-o", "out.h5")
        out = self.signals("out.h5")
        whole = len(out["time"]) // 60 * 60
        errors = [(out[column] - out["true_rate"])[:whole].reshape(-1, 60)
                  .mean(axis=1) for column in ["compensated_rate", "rate"]]
        return [float(np.sqrt(np.mean(error**2))) for error in errors]

    def test_every_shipped_method_on_a_scenario(self):
        # A scale factor shows in a run that turns.
        self.run_scenario("train", text=turning(ramp(seed=3)))
        self.run_scenario("held_out", text=ramp(low=40, high=-30, seed=4))
        self.run_scenario("test", text=turning(ramp(low=-25, high=35, seed=5)))
        self.run_scenario("soaks", text=soaks(6))
        self.run_scenario("other_soaks", text=soaks(7))
        kinds = set()
        for name, model, table in self.models():
            text, stored = self.train(name, model, *(
                ["soaks.h5", "other_soaks.h5"] if takes_soaks(table) else []))
            kinds.add(table["kind"])
            self.assertEqual(stored["format_version"], 2)
            self.assertIn(stored["training"]["method"], text)
            self.assertEqual("scale_factor" in stored, "scale_factor" in table)
            left, raw = self.rms(name, "test.h5")
            if name == "none":
                self.assertEqual(left, raw)
            else:
                self.assertLess(left, raw)
            verdict, answer = self.validated(f"{name}.json", "test.h5")
            self.assertEqual(verdict["verdict"] == "pass",
                             answer.returncode == 0)
            self.assertTrue(by_name(verdict["checks"])["finite"]["passed"])
        self.assertEqual(kinds - {"auto"},
                         {"none", "constant", "polynomial", "table", "spline",
                          "px4", "ardupilot", "thermistor", "fuzzy",
                          "radial_basis", "resonances", "bp"})

    def test_every_kind_on_an_imported_log(self):
        self.write("map.toml", LOG_MAP)
        up = np.linspace(-30, 40, 2400)
        for name, T, rate in [("train", up, 0), ("held_out", 0.99 * up[::-1], 0),
                              ("test", up[::-1] * 0.9, 20)]:
            self.write("log.csv", log(T, rate))
            self.ok("import", "log.csv", "--map", "map.toml", "-o",
                    f"{name}.h5")
        for name, model, table in self.models():
            asks_for_loops = any(
                name.startswith(("drive_", "quadrature"))
                for name in table.get("inputs", []))
            if "scale_factor" in table or asks_for_loops:
                continue  # asks for a rate table, or for the loops
            if takes_soaks(table):
                continue
            self.train(name, model)
            left, raw = self.rms(name, "test.h5")
            if table["kind"] in EXACT and name != "linear":
                self.assertLess(left, 0.02 * raw)
            answer = self.beamgyro("validate", f"{name}.json", "test.h5")
            if name in ("none", "constant"):
                self.assertIn("\nFAIL: The compensator", answer.stdout)
                self.assertIn("Of no use", answer.stdout)
                self.assertNotIn("Not met", answer.stdout)
            elif name == "output_and_temperature":
                self.assertIn("\nFAIL: ", answer.stdout)
            elif table["kind"] != "bp" or name == "rate_penalty":
                self.assertIn("\nPASS: ", answer.stdout)

    def test_a_rate_penalty_keeps_the_rate_of_a_network_on_the_output(self):
        self.run_scenario("train", text=ramp(seed=3))
        self.run_scenario("held_out", text=ramp(low=40, high=-30, seed=4))
        self.run_scenario("test", text=turning(ramp(low=-25, high=35, seed=5)))
        self.run_scenario("small", text=turning(
            ramp(low=-25, high=35, seed=6), rates=(-2, -1, 0, 1, 2)))
        for name, keeps in [("output_and_temperature", False),
                            ("rate_penalty", True)]:
            text, stored = self.train(name, MODELS / f"{name}.toml")
            self.assertIn("feels the rate and training was at rest",
                          " ".join(stored["training"]["warnings"]))
            answer = self.beamgyro("validate", f"{name}.json", "test.h5",
                                   "small.h5", "--json", f"{name}.v.json")
            self.assertEqual(answer.returncode, 0 if keeps else 3)
            said = self.json(f"{name}.v.json")
            self.assertEqual(said["verdict"], "pass" if keeps else "fail")
            checks = {one["name"]: one["passed"] for one in said["checks"]}
            for check in "jacobian", "injection":
                self.assertIs(checks[check], keeps)

    def test_the_scale_factor_is_corrected(self):
        """A readout whose scale factor is 1 % high, over temperature."""
        rate = np.repeat([-100, -50, 0, 50, 100], 60)
        T, w = [], []
        for soak in [-20, 0, 20, 40]:
            T += [soak] * 600
            w += [*rate, *rate]
        lines = ["t,V,T,w"] + [
            f"{k},{2.5 + 0.0125 * (0.3 + (1.01 + 1e-4 * here) * turn):.9f},"
            f"{here},{turn}" for k, (here, turn) in enumerate(zip(T, w))]
        self.write("map.toml", LOG_MAP)
        self.write("log.csv", "\n".join(lines) + "\n")
        self.ok("import", "log.csv", "--map", "map.toml", "-o", "train.h5")
        self.write("m.toml", 'kind = "constant"\n[scale_factor]\n')
        self.ok("train", "train.h5", "--model", "m.toml", "-o", "c.json")
        stored = self.json("c.json")
        np.testing.assert_allclose(stored["scale_factor"]["values"],
                                   [1.008, 1.01, 1.012, 1.014], atol=1e-6)
        self.fails_as_seen("c.json", "train.h5")
        left, raw = self.rms("c", "train.h5")
        self.assertLess(left, 1e-4 * raw)
