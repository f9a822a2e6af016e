# SPDX-License-Identifier: MIT
"""Recordings that are damaged or that somebody else made."""

import random

import h5py
import numpy as np

from program import ProgramTest, ramp
from sets import Set


class Damage(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=ramp(seconds=400))
        self.train_on("run.h5")

    def readers(self, name):
        return [["info", name],
                ["train", name, "--model", "model.toml", "-o", "d.json"],
                ["compensate", "c.json", name, "-o", "out.h5"],
                ["validate", "c.json", name],
                ["allan", name]]

    def test_no_flipped_bit_is_accepted_crashes_or_hangs(self):
        whole = (self.dir / "run.h5").read_bytes()
        readers = self.readers("damaged.h5")
        draw = random.Random(1)
        for k in range(320):
            damaged = bytearray(whole)
            # Half of them among what is no value, which HDF5 interprets.
            place = draw.randrange(len(whole) if k % 2 else 12000)
            damaged[place] ^= 1 << draw.randrange(8)
            self.write("damaged.h5", bytes(damaged))
            answer = self.ended(*readers[k % len(readers)], allowed=(2,))
            self.assertIn("damaged.h5: ", answer.stderr)
            self.assertIn("is damaged", answer.stderr)

    def test_a_changed_file_is_read_with_a_warning(self):
        with h5py.File(self.dir / "run.h5", "r+") as file:
            file["rate"][...] += 1.0
        for command in self.readers("run.h5"):
            answer = self.ended(*command, allowed=(0, 3))
            self.assertEqual(answer.stderr.count("run.h5: has no checksum"), 1)
        self.assertNotIn("checksum", self.beamgyro("info", "out.h5").stderr)


class SetFiles(Set):
    def prepare(self):
        super().prepare()
        self.generate("set")

    def test_no_flipped_bit_in_a_file_of_a_set_changes_what_info_says(self):
        name = "set/ramp_00000.h5"
        whole = (self.dir / name).read_bytes()
        self.assertEqual(self.beamgyro("info", name).stderr, "")
        draw = random.Random(2)
        for k in range(60):
            damaged = bytearray(whole)
            damaged[draw.randrange(len(whole))] ^= 1 << draw.randrange(8)
            self.write(name, bytes(damaged))
            self.rejected("info", name if k % 2 else "set",
                          says=[name, "holds other bytes"])

    def test_a_view_with_a_damaged_heap_is_refused_at_once(self):
        whole = (self.dir / "set/ramp.nc").read_bytes()
        heap = whole.index(b"GCOL")
        for place in [heap + 6, heap + 8, heap + 9, heap + 16, heap + 24,
                      heap + 25]:
            for bit in range(8):
                damaged = bytearray(whole)
                damaged[place] ^= 1 << bit
                self.write("view.nc", bytes(damaged))
                self.rejected("info", "view.nc", says="view of other files")

    def test_a_file_outside_of_its_set_is_read_with_a_warning(self):
        text = self.ok("info", "set/ramp_00000.h5")
        (self.dir / "set/ramp_00000.h5").rename(self.dir / "lone.h5")
        answer = self.ended("info", "lone.h5")
        self.assertEqual(answer.stdout.partition("\n")[2],
                         text.partition("\n")[2])
        self.assertIn("lone.h5: is in no set", answer.stderr)


class Units(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=ramp(seconds=400))

    def restate(self, name, units, scale=1.0, offset=0.0):
        with h5py.File(self.dir / "run.h5", "r+") as file:
            file[name][...] = file[name][()] * scale + offset
            file[name].attrs["units"] = np.bytes_(units)

    def trained(self):
        self.train_on("run.h5")
        self.ok("compensate", "c.json", "run.h5", "-o", "out.h5")
        with h5py.File(self.dir / "out.h5") as file:
            return {name: (file[name].attrs["units"], file[name][()])
                    for name in file if name != "meta"}

    def test_values_in_other_units_give_the_same_result(self):
        before = self.trained()
        radian = np.pi / 180
        self.restate("rate", "rad/s", radian)
        self.restate("quadrature", "rad/s", radian)
        self.restate("true_rate", "deg/h", 3600)
        self.restate("temperature", "K", 1, 273.15)
        self.restate("true_board_temperature", "degF", 1.8, 32)
        self.restate("output", "mV", 1e3)
        self.restate("drive_frequency", "kHz", 1e-3)
        self.restate("time", "ms", 1e3)
        after = self.trained()
        self.assertEqual(set(after), set(before))
        for name, (units, values) in before.items():
            self.assertEqual(after[name][0], units, name)
            np.testing.assert_allclose(after[name][1], values, rtol=1e-9,
                                       atol=1e-9, err_msg=name)

    def test_a_unit_that_is_not_known_is_refused(self):
        whole = (self.dir / "run.h5").read_bytes()
        for name in self.signals("run.h5"):
            self.restate(name, "furlong")
            self.rejected("info", "run.h5", says=[
                "run.h5: ", f"{name}: the unit 'furlong'", "expected"])
            self.write("run.h5", whole)
        self.ok("info", "run.h5")
