# SPDX-License-Identifier: MIT
"""Recordings that are there twice, as parts of others, or with the noise of
others: scores on them are not those of unseen data."""

import shutil

import h5py

from program import CUBIC, ProgramTest, ramp

QUIET = "\n[noise]\nenabled = false\n"


class SeenData(ProgramTest):
    def prepare(self):
        super().prepare()
        self.write("model.toml", CUBIC)
        for name, text in [
                ("a", ramp(seed=3)), ("other", ramp(seed=4)),
                ("third", ramp(low=40, high=-30, seed=5)),
                ("shared", ramp(low=-25, high=35, seed=3)),
                ("quiet", ramp(seed=3) + QUIET),
                ("calm", ramp(low=-25, high=35, seed=3) + QUIET)]:
            self.run_scenario(name, text=text)
        shutil.copy(self.dir / "a.h5", self.dir / "copy.h5")
        shutil.copy(self.dir / "a.h5", self.dir / "renamed.h5")
        with h5py.File(self.dir / "renamed.h5", "r+") as file:
            file.attrs["comment"] = "another day"
        for name, whole, begin, end in [("part", "a", 1000, 3500),
                                        ("small", "a", 1000, 1250),
                                        ("quiet_part", "quiet", 1000, 3500)]:
            cut(self.dir / f"{whole}.h5", self.dir / f"{name}.h5", begin, end)

    def train(self, *runs):
        return "train", *runs, "--model", "model.toml", "-o", "c.json"

    def told(self, *runs):
        """The lines on shared seeds that training prints on standard error."""
        return [line for line in self.warned(*self.train(*runs)).splitlines()
                if "seed of noise" in line]

    def test_a_recording_is_trained_on_once(self):
        for again, says in [("a.h5", "same recording as a.h5"),
                            ("copy.h5", "same recording as a.h5"),
                            ("renamed.h5", "same recording as a.h5"),
                            ("part.h5", "samples are those of a.h5"),
                            ("small.h5", "samples are those of a.h5")]:
            for more in [], ["--cv", "run"], ["--cv", "cycle"], ["--cv", "leg"]:
                self.rejected(*self.train("a.h5", "other.h5", again, *more),
                              says=[f"{again}: ", says, "leave one"])
            self.rejected(*self.train(again, "a.h5"), says=[again, "a.h5"])

    def test_nor_is_one_held_out_twice_or_trained_on_too(self):
        for again in "copy.h5", "renamed.h5", "part.h5":
            self.rejected(*self.train("other.h5", "--held-out", "a.h5", again),
                          says=[again, "a.h5", "leave one"])
            self.rejected(*self.train("a.h5", "--held-out", again),
                          says=[again, "a.h5", "must be another run"])

    def test_a_verdict_knows_the_pieces_that_training_saw(self):
        self.ok(*self.train("a.h5", "other.h5"))
        for piece in "part.h5", "small.h5":
            said = self.beamgyro("validate", "c.json", piece)
            self.assertEqual(said.returncode, 3)
            self.assertIn(f"Training saw 1 of the 1 runs, so they prove "
                          f"nothing: {piece}", " ".join(said.stdout.split()))

    def test_runs_of_other_seeds_and_without_noise_stay_what_they_are(self):
        for runs in [("a.h5", "other.h5", "third.h5", "--cv", "run"),
                     ("a.h5", "other.h5", "--held-out", "third.h5"),
                     ("a.h5", "shared.h5"),  # nothing is scored as unseen
                     ("quiet.h5", "calm.h5", "--cv", "run"),
                     ("quiet.h5", "--held-out", "calm.h5"),
                     ("quiet.h5", "--held-out", "shared.h5")]:
            self.assertEqual(self.told(*runs), [])

    def test_without_noise_equal_rests_are_no_parts_but_parts_are(self):
        """Three quarters of two scenarios are the same rest, to the bit."""
        for name, high in [("up", 40), ("down", -20)]:
            self.run_scenario(name, text=ramp().replace(
                "points = [[0, -30], [4000, 40]]",
                f"points = [[0, 25], [3000, 25], [4000, {high}]]") + QUIET)
        self.assertEqual(self.told("up.h5", "down.h5", "--cv", "run"), [])
        self.rejected(*self.train("quiet.h5", "quiet_part.h5"),
                      says=["quiet_part.h5", "quiet.h5"])

    def test_a_shared_seed_is_warned_of_once(self):
        for runs in [("a.h5", "--held-out", "shared.h5"),
                     ("a.h5", "shared.h5", "--cv", "run"),
                     ("a.h5", "other.h5", "shared.h5", "--cv", "leg")]:
            [line] = self.told(*runs)
            self.assertSays(line, [
                "a.h5, shared.h5 share the seed of noise 3", "turn-on",
                "too good", "other seeds"])

    def test_a_compensator_names_the_seeds_of_its_noise(self):
        self.ok(*self.train("a.h5", "quiet.h5", "--held-out", "third.h5"))
        training = self.json("c.json")["training"]
        seeds = [file.get("seed") for file in
                 training["files"] + training["held_out_files"]]
        self.assertEqual(seeds, [3, None, 5])


def cut(whole, part, begin, end):
    """Writes samples of a recording as another one."""
    with h5py.File(whole) as source, h5py.File(part, "w") as target:
        for name, value in source.attrs.items():
            target.attrs[name] = value
        source.copy("meta", target)
        for name in source:
            if name == "meta":
                continue
            target[name] = source[name][begin:end]
            for key, value in source[name].attrs.items():
                if key not in ("REFERENCE_LIST", "DIMENSION_LIST", "CLASS",
                               "NAME"):
                    target[name].attrs[key] = value
