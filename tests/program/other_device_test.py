# SPDX-License-Identifier: MIT
"""What `validate` says of a compensator on a device that it was not made for."""

from program import CUBIC, SCENARIOS, ProgramTest, ramp

NOTE = "of another device than the one that the compensator was trained on"
CAMPAIGN = """\
name = "tiny"
device = "device.toml"
devices = 6
seed = 5

[split]
train = 0.6
validation = 0
test = 0.4

[tolerances]
"readout.quadrature_trim_deg_per_s" = { normal = { mean = 0, sigma = 50 } }

[[run]]
name = "sweep"
scenario = "sweep.toml"
"""
LONGER = ("--set", "beam.length_m=0.0401")


class OtherDevice(ProgramTest):
    def notes(self, *words):
        """The warnings about another device, which text and JSON have."""
        verdict, answer = self.validated(*words)
        found = [text for text in verdict["warnings"] if NOTE in text]
        said = [line for line in (answer.stdout + answer.stderr).splitlines()
                if NOTE in line]
        self.assertEqual(len(said), len(found), answer.stdout + answer.stderr)
        return found

    def test_a_recording_of_another_device_is_noted(self):
        self.cubic_of_a_ramp("ramp")
        self.run_scenario("test", text=ramp(seed=5))
        self.run_scenario("other", *LONGER, text=ramp(seed=6))
        self.run_scenario("third", "--set", "beam.length_m=0.0402",
                          text=ramp(seed=7))
        self.assertEqual(self.notes("c.json", "test.h5"), [])
        self.assertEqual(self.notes("c.json", "test.h5", "other.h5"),
                         [f"other.h5: {NOTE}; a curve is that of one device"])
        [note] = self.notes("c.json", "other.h5", "third.h5")
        self.assertTrue(note.startswith("other.h5 and 1 more: "), note)
        # What was trained on two of them is no curve of one.
        self.train_on("ramp.h5", "other.h5", to="two.json")
        self.assertNotIn("device_sha256", self.json("two.json")["training"])
        self.assertEqual(self.notes("two.json", "third.h5"), [])
        # Nothing is known of a log.
        self.run_scenario("log", text=ramp(seed=8))
        self.ok("run", "log.toml", "-o", "log.csv")
        self.assertEqual(self.notes("c.json", "log.csv"), [])

    def test_replaced_keys_and_those_of_a_file_make_one_device(self):
        text = (self.dir / "device.toml").read_text()
        self.assertEqual(text.count("length_m = 0.040\n"), 1)
        self.run_scenario("set", *LONGER, "--set", "noise.enabled=false",
                          text=ramp(seed=8))
        self.cubic_of_a_ramp("ramp")
        self.write("device.toml", "# Mine.\n" + text.replace(
            "length_m = 0.040\n", "length_m = 0.0401  # longer\n"))
        self.run_scenario("own", text=ramp(seed=5))
        self.assertEqual(len(self.notes("c.json", "own.h5")), 1)
        self.train_on("set.h5", to="set.json")
        self.assertEqual(self.notes("set.json", "own.h5"), [])

    def test_a_simulated_device_is_noted(self):
        self.cubic_of_a_ramp("ramp")
        self.write("q.toml", 'name = "q"\n[[run]]\n'
                   'name = "ramp"\npurpose = "ramp"\nscenario = "test.toml"\n')
        self.write("test.toml", ramp(seconds=1500, seed=5))
        for device, count in [("device.toml", 0),
                              (SCENARIOS / "devices/hard_pzt.toml", 1)]:
            self.assertEqual(len(self.notes(
                "c.json", "--device", device, "--qualification", "q.toml")),
                count)

    def test_of_a_set_one_device_is_not_another(self):
        self.write("sweep.toml", ramp(rate_Hz=0.2))
        self.write("campaign.toml", CAMPAIGN)
        self.ok("generate", "campaign.toml", "-o", "set")
        self.write("model.toml", CUBIC)
        self.ok("train", "set", "--device", 1, "--model", "model.toml", "-o",
                "one.json")
        self.assertEqual(self.notes("one.json", "set", "--device", 1), [])
        self.assertEqual(len(self.notes("one.json", "set", "--device", 2)), 1)
        self.ok("train", "set", "--model", "model.toml", "-o", "all.json")
        self.assertEqual(self.notes("all.json", "set"), [])
