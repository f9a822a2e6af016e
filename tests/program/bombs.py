# SPDX-License-Identifier: MIT
"""Files of less than a megabyte that claim, nest or inflate to much more.

Each function writes one into a folder, which has a recording run.h5, a set
set/, a compensator c.json, a scenario ramp.toml and a campaign campaign.toml.
"""

import functools
import hashlib
import itertools
import json
import random
import shutil
import struct
import zlib

import h5py
import numpy as np

from sets import manifest_line

MOST_BYTES = 1_000_000
INFLATED = 300_000_000  # bytes of 300 kB
SHARD = "ramp_00000.h5"


@functools.cache
def zeros(count):
    """So many zero bytes, deflated; never more than a megabyte in memory."""
    packing = zlib.compressobj(9)
    block, parts = bytes(1 << 20), []
    for left in range(count, 0, -len(block)):
        parts.append(packing.compress(block[:left]))
    return b"".join(parts) + packing.flush()


class Recordings:
    """Recordings that somebody has changed with HDF5."""

    def __init__(self, folder):
        self.folder = folder
        self.whole = (folder / "run.h5").read_bytes()
        self.whole = self.whole[:self.whole.rfind(b"\nSHA-256")]

    def opened(self, name, **how):
        (self.folder / name).write_bytes(self.whole)
        return h5py.File(self.folder / name, "r+", **how)

    def replaced(self, name, make, variable="rate"):
        """A recording one variable of which `make(file)` makes anew."""
        with self.opened(name) as file:
            said = dict(file[variable].attrs)
            del file[variable]
            made = make(file)
            for key in ("units", "long_name", "role"):
                if made is not None and key in said:
                    made.attrs[key] = said[key]

    def all(self):
        self.inflating()
        self.claiming()
        self.leading_elsewhere()
        self.crowded()
        self.driver_information("driver.h5")

    def inflating(self):
        packed = zeros(INFLATED)
        for name, variable in [("inflates.h5", "rate"),
                               ("inflates_time.h5", "time")]:
            def one_chunk(file, variable=variable):
                made = file.create_dataset(variable, (INFLATED // 8,), "<f8",
                                           chunks=(INFLATED // 8,),
                                           compression="gzip")
                made.id.write_direct_chunk((0,), packed)
                return made
            self.replaced(name, one_chunk, variable)

        def twice(file):
            properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            properties.set_chunk((INFLATED // 8,))
            properties.set_deflate(9)
            properties.set_deflate(9)
            made = h5py.h5d.create(file.id, b"rate", h5py.h5t.IEEE_F64LE,
                                   h5py.h5s.create_simple((INFLATED // 8,)),
                                   properties)
            made.write_direct_chunk((0,), zlib.compress(packed, 9))
            return h5py.Dataset(made)
        self.replaced("inflates_twice.h5", twice)

        with self.opened("inflates_text.h5") as file:
            del file["meta/scenario"]
            kind = h5py.h5t.C_S1.copy()
            kind.set_size(INFLATED)
            properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            properties.set_chunk((1,))
            properties.set_deflate(9)
            made = h5py.h5d.create(file.id, b"meta/scenario", kind,
                                   h5py.h5s.create_simple((1,)), properties)
            made.write_direct_chunk((0,), zeros(INFLATED))

    def claiming(self):
        huge = 10**12
        for name, options in [
                ("claims_chunks.h5", {"chunks": (1000,)}),
                ("claims_packed.h5", {"chunks": (1000,),
                                      "compression": "gzip"}),
                ("claims_filled.h5", {"chunks": (1 << 20,), "fillvalue": 1.0})]:
            for variable in ("time", "rate"):
                self.replaced(f"{variable}_{name}",
                              lambda file, v=variable, o=options:
                              file.create_dataset(v, (huge,), "<f8", **o),
                              variable)

        def contiguous(file):
            properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            properties.set_alloc_time(h5py.h5d.ALLOC_TIME_LATE)
            return h5py.Dataset(h5py.h5d.create(
                file.id, b"rate", h5py.h5t.IEEE_F64LE,
                h5py.h5s.create_simple((huge,)), properties))
        self.replaced("claims_contiguous.h5", contiguous)
        self.replaced("dimensions.h5", lambda file: file.create_dataset(
            "rate", (4,) * 32, "<f8", chunks=(1,) * 32))

    def leading_elsewhere(self):
        def virtual(file):
            layout = h5py.VirtualLayout((10**12,), "<f8")
            layout[:] = h5py.VirtualSource("/dev/zero", "x", (10**12,))
            return file.create_virtual_dataset("rate", layout)
        self.replaced("virtual.h5", virtual)
        self.replaced("external.h5", lambda file: file.create_dataset(
            "rate", (1000,), "<f8", external=[("/dev/zero", 0, 8000)]))

        def link(file):
            file["rate"] = h5py.SoftLink("/rate")
        self.replaced("loop.h5", link)

        def far_link(file):
            file["rate"] = h5py.ExternalLink("/dev/zero", "/rate")
        self.replaced("far.h5", far_link)
        with self.opened("cycle.h5") as file:
            file["meta/again"] = file["/"]
            file["again"] = file["meta"]

    def crowded(self):
        with self.opened("variables.h5") as file:
            for k in range(2000):
                file[f"x{k}"] = h5py.SoftLink("/rate")
        with self.opened("same_variable.h5") as file:
            for k in range(2000):
                file[f"x{k}"] = file["rate"]
        self.lengthened("same_long_variable.h5", 8000, 4000)
        self.lengthened("long_variables.h5", 130_000, 0, 100)
        self.lengthened("long.h5", 2_600_000)
        with self.opened("attributes.h5") as file:
            for k in range(5):
                file["rate"].attrs[f"x{k}"] = np.zeros(60_000, np.uint8)
        with self.opened("long_name.h5") as file:
            file["n" * 60_000] = file["rate"]
        with self.opened("texts.h5") as file:
            del file["meta/scenario"]
            file["meta/scenario"] = "x" * 100_000  # of variable length

    def lengthened(self, name, samples, names=0, variables=0):
        """Constants over so many samples, with so many more names for the rate
        and so many more variables; rate, temperature and true rate alone."""
        with self.opened(name) as file:
            kept = ("time", "status", "rate", "temperature", "true_rate")
            for variable in sorted(set(file) - {"meta"}):
                old = file[variable]
                said = {key: old.attrs[key]
                        for key in ("units", "long_name", "role")}
                values = (np.arange(samples) / 10. if variable == "time" else
                          np.full(samples, old[0]))
                del file[variable]
                if variable in kept:
                    self.constant(file, variable, values, said)
                if variable == "rate":
                    for k in range(variables):
                        self.constant(file, f"x{k}", values, said)
            for k in range(names):
                file[f"x{k}"] = file["rate"]
            file["meta/padding"] = np.frombuffer(
                random.Random(1).randbytes(190_000), np.uint8)

    @staticmethod
    def constant(file, name, values, said):
        made = file.create_dataset(
            name, data=values, chunks=(min(len(values), 1 << 19),),
            compression="gzip", compression_opts=9, shuffle=True)
        for key, text in said.items():
            made.attrs[key] = text

    def driver_information(self, name):
        """A superblock of version 0 that names a block of 4 GiB."""
        data = bytearray(self.whole)
        block = struct.pack("<B3xI8s", 0, 0xFFFFFEF0, b"NCSAmult") + bytes(64)
        data[40:56] = struct.pack("<QQ", len(data) + len(block), len(data))
        (self.folder / name).write_bytes(data + block)


def mend_manifest(place, change=lambda record: None):
    """Sums of a changed set that are right."""
    text = b""
    for record in map(json.loads, (place / "manifest.jsonl").open()):
        if record.get("file") == SHARD:
            data = (place / SHARD).read_bytes()
            record |= {"bytes": len(data),
                       "sha256": hashlib.sha256(data).hexdigest()}
        elif "sha256_before" in record:
            record["sha256_before"] = hashlib.sha256(text).hexdigest()
        change(record)
        text += manifest_line(record)
    (place / "manifest.jsonl").write_bytes(text)


def sets(folder):
    """Sets whose file or manifest claims too much."""
    def copied(name):
        return shutil.copytree(folder / "set", folder / name)

    packed = zeros(INFLATED)
    for name, make in {
            "set_claims": lambda file, v: file.create_dataset(
                v, (2, 10**12), "<f4", chunks=(1, 1000)),
            "set_devices": lambda file, v: file.create_dataset(
                v, (10**12, 120), "<f4", chunks=(1, 120)),
            "set_inflates": lambda file, v: file.create_dataset(
                v, (2, INFLATED // 4), "<f4", chunks=(1, INFLATED // 4),
                compression="gzip")}.items():
        place = copied(name)
        with h5py.File(place / SHARD, "r+") as file:
            for variable in ("rate", "temperature"):
                said = dict(file[variable].attrs)
                del file[variable]
                made = make(file, variable)
                for key in ("units", "long_name", "role"):
                    if key in said:
                        made.attrs[key] = said[key]
            if name == "set_inflates":
                file["rate"].id.write_direct_chunk((0, 0), packed)
        mend_manifest(place)
    for name, key, value in [("manifest_devices", "devices", 10**12),
                             ("manifest_bytes", "bytes", 10**18),
                             ("manifest_file", "file", "x" * 200_000)]:
        def change(record, key=key, value=value):
            if key in record:
                record[key] = value
        mend_manifest(copied(name), change)
    for name, text in {"manifest_deep": "[" * 900_000,
                       "manifest_lines": "{}\n" * 300_000,
                       "manifest_number": '{"a": ' + "9" * 900_000}.items():
        (copied(name) / "manifest.jsonl").write_text(text)


def json_files(folder):
    whole = (folder / "c.json").read_text().rstrip()
    for name, text in {
            "deep": "[" * 900_000,
            "deep_objects": '{"a":' * 180_000,
            "deep_inside": whole[:-1] + ',"x":' + "[" * 400_000,
            "number": '{"filetype":' + "1" * 900_000 + "}",
            "exponent": whole[:-1] + ',"x":1e' + "9" * 900_000 + "}",
            "text": '{"filetype":"' + "\\u0000" * 150_000 + '"}',
            "keys": "{" + ",".join(f'"{k}":1' for k in range(80_000)) + "}",
            "list": whole[:-1] + ',"x":[' + "1," * 400_000 + "1]}"}.items():
        (folder / f"{name}.json").write_text(text)
    changed = json.loads(whole)
    for key, value in list(changed.items()):
        if isinstance(value, list):
            changed[key] = value * 50_000
    (folder / "coefficients.json").write_text(json.dumps(changed)[:MOST_BYTES])


def toml_files(folder):
    scenario = (folder / "ramp.toml").read_text()
    campaign = (folder / "campaign.toml").read_text()

    def one_line(key, value, text):
        lines = [f"{key} = {value}" if line.startswith(f"{key} =") else line
                 for line in text.splitlines()]
        return "\n".join(lines) + "\n"

    head = campaign[:campaign.index("[tolerances]")]

    def runs(count, more="", scenario="rest.toml"):
        return head + "".join(
            f'[[run]]\nname = "r{k}"\nscenario = "{scenario}"\n{more}'
            for k in range(count))

    for name, text in {
            "deep": "x = " + "[" * 900_000,
            "tables": "x = " + "{a=" * 250_000,
            "dots": "a" + ".a" * 400_000 + " = 1",
            "headers": "".join(f"[t{k}]\n" for k in range(90_000)),
            "arrays": "[[a]]\n" * 150_000,
            "digits": "x = " + "1" * 900_000,
            "text": 'name = "' + "x" * 900_000 + '"',
            "names": "".join(f"k{k} = 1\n" for k in range(70_000)),
            "long": one_line("duration_s", "1e15", scenario),
            "fast": one_line("output_rate_Hz", "1e15", scenario),
            "points": scenario.replace(
                "points = [[0, 0], [60, 10]]", "points = [" + ",".join(
                    f"[{k},{k % 9}]" for k in range(70_000)) + "]"),
            "runs": runs(15_000),
            "varied_runs": runs(8_000, "ambient_offset_K = "
                                "{uniform = {low = -5, high = 5}}\n"),
            "long_runs": runs(30, scenario="toml_points.toml"),
            "choices": head + '[tolerances]\n"patches.offset_m" = {discrete = '
                       "{values = [" + ",".join(["1e-6"] * 180_000) + "]}}\n"
                       + runs(1).removeprefix(head),
            "varied": runs(1, "[run.vary]\n" '"ambient.constant_degC" = '
                           "{discrete = {values = ["
                           + "1,2,3,4,5,6,7," * 43_000 + "]}}\n"),
            "devices": one_line("devices", "1_000_000_000_000", campaign),
            "per_file": one_line("devices_per_file", "1_000_000_000_000",
                                 campaign)}.items():
        (folder / f"toml_{name}.toml").write_text(text)


def logs(folder):
    for name, text in {
            "columns": ",".join(f"c{k}" for k in range(130_000)) + "\n1,2,3\n",
            "empty_columns": "," * 900_000 + "\n1,2,3\n",
            "line": "t,w,T\n" + "1" * 900_000,
            "quotes": 't,w,T\n"' + "\n" * 900_000,
            "empty_lines": "t,w,T\n" + "\n" * 900_000,
            "zeros": "t,w,T\n" + "\0" * 900_000,
            "far": "t,w,T\n0,0,0\n1e300,0,0\n",
            "dates": "t,w,T\n" + "9999-12-31T23:59:59Z,0,0\n" * 30_000,
            "letters": "t,w,T\n" + "\xe4" * 400_000}.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")


def make_all(folder):
    """Writes all bombs; returns their names by the kind of what they are."""
    before = {path.name for path in folder.iterdir()}
    Recordings(folder).all()
    sets(folder)
    json_files(folder)
    toml_files(folder)
    logs(folder)
    made = sorted(path for path in folder.iterdir() if path.name not in before)
    kinds = {}
    for kind, paths in itertools.groupby(
            sorted(made, key=lambda path: path.suffix),
            key=lambda path: path.suffix or "set"):
        kinds[kind.lstrip(".")] = [path.name for path in paths]
    return kinds
