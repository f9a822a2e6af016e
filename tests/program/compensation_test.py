# SPDX-License-Identifier: MIT
"""`train`, `compensate`, `validate` and `allan` of the shipped program."""

import math

import h5py
import numpy as np

from program import CUBIC, NETWORK, ProgramTest, by_name, ramp

# Frequency data of the NBS 14 set and its published deviations (NIST SP 1065).
NBS14 = [892, 809, 823, 798, 671, 644, 883, 903, 677]


class Compensation(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("train", text=ramp(seed=3))
        self.run_scenario("held_out", text=ramp(low=40, high=-30, seed=4))
        self.run_scenario("test", text=ramp(low=-25, high=35, seed=5))
        self.write("cubic.toml", CUBIC)
        self.write("bp.toml", NETWORK)

    def train(self, name, model, *arguments):
        return self.ok("train", "train.h5", "--model", model, "-o",
                       f"{name}.json", *arguments)

    def test_train_prints_in_sample_and_held_out_residuals(self):
        text = self.train("cubic", "cubic.toml", "--held-out", "held_out.h5")
        self.assertIn("held", text.lower())
        stored = self.json("cubic.json")
        self.assertEqual(stored["filetype"], "beamgyro-compensator")
        self.assertEqual(stored["inputs"], ["temperature"])
        self.assertIn("baseline", stored)

    def test_the_cubic_is_the_least_squares_cubic_of_the_block_means(self):
        """In-sample rms of our cubic is that of numpy's, on the same blocks."""
        self.train("cubic", "cubic.toml")
        self.ok("compensate", "cubic.json", "train.h5", "-o", "out.h5")
        run = self.signals("out.h5")
        whole = len(run["time"]) // 60 * 60
        temperature, rate, residual = (
            run[name][:whole].reshape(-1, 60).mean(axis=1)
            for name in ["temperature", "rate", "compensated_rate"])
        fit = np.polynomial.Polynomial.fit(temperature, rate, 3)
        best = np.sqrt(np.mean((rate - fit(temperature)) ** 2))
        ours = np.sqrt(np.mean(residual ** 2))
        self.assertAlmostEqual(ours / best, 1, delta=0.02)

    def test_a_rate_of_zero_is_no_drift(self):
        with h5py.File(self.dir / "train.h5", "r+") as file:
            file["rate"][...] = 0
        self.rejected("train", "train.h5", "--model", "cubic.toml", "-o",
                      "zero.json", says=["so that there is no drift to fit"])
        self.assertFalse((self.dir / "zero.json").exists())

    def test_same_bytes_again_and_other_weights_for_another_seed(self):
        for name, seed in [("a", 1), ("b", 1), ("c", 2)]:
            self.train(name, "bp.toml", "--held-out", "held_out.h5", "--seed",
                       seed)
        first, again, other = ((self.dir / f"{name}.json").read_bytes()
                               for name in "abc")
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_threads_that_the_system_does_not_grant_are_fewer_threads(self):
        """Of restarts, folds and batches."""
        self.write("bp.toml", NETWORK.replace("restarts = 1", "restarts = 3"))
        arguments = ["--model", "bp.toml", "--held-out", "held_out.h5",
                     "--seed", 1]
        self.ok("train", "train.h5", *arguments, "-o", "free.json")
        self.alone("train", "train.h5", *arguments, "-o", "alone.json")
        self.assertSameBytes("alone.json", "free.json")

    def test_compensate_copies_the_recording_and_adds_rate_and_sigma(self):
        self.train("cubic", "cubic.toml", "--held-out", "held_out.h5",
                   "--held-out", "test.h5")
        self.ok("compensate", "cubic.json", "test.h5", "-o", "out.h5")
        self.ok("compensate", "cubic.json", "test.h5", "-o", "again.h5")
        self.assertSameBytes("out.h5", "again.h5")
        with h5py.File(self.dir / "test.h5") as before, \
                h5py.File(self.dir / "out.h5") as after:
            self.assertEqual(set(after), {*before, "compensated_rate",
                                          "compensated_rate_sigma"})
            for name in before:
                if name != "meta":
                    np.testing.assert_array_equal(before[name][()],
                                                  after[name][()])
            for name in before["meta"]:
                self.assertEqual(before["meta"][name][()],
                                 after["meta"][name][()])
            added = after["compensated_rate"]
            self.assertEqual(added.attrs["units"], b"degree/s")
            self.assertEqual(added.dims[0][0].name, "/time")
            self.assertLess(np.nanstd(added[()]), np.nanstd(after["rate"][()]))

    def test_validate_scores_what_compensate_writes(self):
        self.train("cubic", "cubic.toml")
        table = self.ok("validate", "cubic.json", "test.h5", "--json", "v.json")
        self.assertIn("test", table)
        metrics = by_name(self.json("v.json")["metrics"])
        self.ok("compensate", "cubic.json", "test.h5", "-o", "out.h5")
        out = self.signals("out.h5")
        error = out["compensated_rate"] - out["true_rate"]
        # 66 blocks and a last one of 40 samples, which counts as a block.
        blocks = np.array([error[k:k + 60].mean() for k in range(0, 4000, 60)])
        for name, expected in [("sigma", blocks.std()), ("pp", np.ptp(blocks)),
                               ("mean", blocks.mean())]:
            found = metrics[f"residual_{name}_deg_per_s"]["after"]["value"]
            self.assertTrue(math.isclose(expected, found, rel_tol=1e-6),
                            (name, expected, found))

    def test_a_network_that_cancels_the_rate_is_named_so(self):
        self.write("cancel.toml", NETWORK.replace(
            '["temperature"]', '["output", "temperature"]'))
        self.train("cancel", "cancel.toml", "--held-out", "held_out.h5")
        self.train("bp", "bp.toml", "--held-out", "held_out.h5")
        turning = ramp(seed=6) + "[rate]\nsteps = [" + ", ".join(
            f"[{60 * k}, {(k % 5) - 2}]" for k in range(66)) + "]\n"
        self.run_scenario("turning", text=turning)
        answer = self.ended("validate", "cancel.json", "turning.h5",
                            allowed=(3,))
        self.assertRegex(answer.stdout, r"\nFAIL: (?s:.*)Not met: jacobian,\s+injection")
        self.assertIn("\nPASS: ", self.ok("validate", "bp.json", "turning.h5"))

    def test_allan_of_the_nbs14_set(self):
        self.write("series.csv", "".join(f"{value}\n" for value in NBS14))
        self.ok("allan", "series.csv", "--rate-Hz", 1, "--json", "a.json")
        answer = self.json("a.json")
        found = {(kind, point["tau_s"]): point["deviation"]
                 for kind in ["adev", "oadev"] for point in answer[kind]}
        for key, value in [(("adev", 1), 91.22945), (("adev", 2), 115.8082),
                           (("oadev", 2), 85.95287)]:
            self.assertAlmostEqual(found[key] / value, 1, delta=1e-6)

    def test_allan_reads_named_columns_and_recordings(self):
        self.write("named.csv", "x,y\n" + "".join(
            f"0,{value}\n" for value in NBS14))
        text = self.ok("allan", "named.csv", "--dataset", "y", "--rate-Hz", 1)
        self.assertIn("91.229", text)
        self.assertIn("tau", self.ok("allan", "test.h5").lower())
