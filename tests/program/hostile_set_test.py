# SPDX-License-Identifier: MIT
"""A set from somebody else leads to no file outside of its directory."""

import hashlib
import json
import os
import shutil

from sets import Set, manifest_line


class HostileSet(Set):
    def prepare(self):
        super().prepare()
        self.generate("set")
        (self.dir / "victim").mkdir()
        for name in ["data", "data_00000.h5", "data.nc", "head.jsonl",
                     "rest.nc"]:
            self.write(f"victim/{name}", "not theirs\n")

    def setUp(self):
        super().setUp()
        self.set = self.dir / "set"

    def forge(self, change):
        """Changes the head everywhere, with checksums that are right."""
        for name in ["manifest.jsonl", "source/head.jsonl"]:
            path = self.set / name
            text = b""
            for record in map(json.loads, path.read_text().splitlines()):
                if "filetype" in record:
                    change(record)
                elif "index" in record:
                    run = record["index"] % len(self.head["runs"])
                    record["file"] = (f"{self.head['runs'][run]}_"
                                      f"{record['file'][-8:]}")
                elif "sha256_before" in record:
                    record["sha256_before"] = hashlib.sha256(text).hexdigest()
                if "filetype" in record:
                    self.head = record
                text += manifest_line(record)
            path.write_bytes(text)

    def forge_anew(self, change):
        shutil.rmtree(self.set)
        self.generate("set")
        self.forge(change)

    def outside(self):
        return {path: path.read_bytes() for path in self.dir.rglob("*")
                if path.is_file() and self.set not in path.parents}

    def harmless(self, *arguments, status=1, says=()):
        """Nothing outside of the set changes."""
        before = self.outside()
        answer = self.ended(*arguments, allowed=(status,))
        self.assertEqual(self.outside(), before)
        self.assertSays(answer.stdout + answer.stderr, says)

    def link(self, name, target, is_directory=False):
        path = self.set / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
        path.symlink_to(target, target_is_directory=is_directory)

    def test_a_file_that_is_a_link_is_damage_and_replaced(self):
        self.link("rest_00000.h5", "../victim/data")
        self.link("rest.nc", "../victim/rest.nc")
        self.harmless("verify", "set", says="symbolic link")
        self.harmless("verify", "set", "--repair", status=0, says="repaired")
        self.assertFalse((self.set / "rest_00000.h5").is_symlink())
        self.assertIn("whole", self.ok("verify", "set"))

    def test_a_file_that_is_a_link_is_not_trained_on(self):
        self.write("model.toml", 'kind = "constant"\n')
        shutil.move(self.set / "rest_00000.h5", self.dir / "elsewhere.h5")
        self.link("rest_00000.h5", "../elsewhere.h5")
        self.harmless("train", "set", "--model", "model.toml", "-o", "c.json",
                      status=2, says="symbolic link")
        self.harmless("info", "set", status=2, says="symbolic link")

    def test_runs_that_lead_out_are_no_runs(self):
        for run in ["../victim/data", str(self.dir / "victim/data"),
                    "a/../../victim/data"]:
            self.forge_anew(lambda head: head["runs"].__setitem__(0, run))
            self.harmless("verify", "set", says="line 1 is damaged")
            self.harmless("verify", "set", "--repair",
                          says="the manifest has lost")
            self.harmless("info", "set", status=2, says="holds no set")

    def test_sources_that_lead_out_are_no_sources(self):
        for name in ["../victim/data", "source/../../victim/data",
                     str(self.dir / "victim/data")]:
            self.forge_anew(lambda head: head["sources"][-1].update(file=name))
            self.harmless("verify", "set", "--repair",
                          says="the manifest has lost")
            self.harmless("info", "set", "--device", 1, status=2,
                          says="holds no set")

    def test_a_head_that_the_campaign_does_not_plan_is_not_followed(self):
        for change in [
                {"runs": ["other", "ramp"]}, {"devices_per_file": 3}, {"seed": 6}]:
            self.forge_anew(lambda head: head.update(change))
            (self.set / "ramp_00001.h5").unlink()
            before = sorted(os.listdir(self.set))
            self.harmless("verify", "set", "--repair",
                          says="not that of the campaign")
            self.assertEqual(sorted(os.listdir(self.set)), before)

    def test_a_campaign_that_names_other_files_does_not_get_them(self):
        for name in ["../../secret.toml", str(self.dir / "secret.toml"),
                     "/dev/stdin"]:
            shutil.rmtree(self.set)
            self.generate("set")
            shutil.copy(self.dir / "device.toml", self.dir / "secret.toml")
            campaign = self.set / "source/campaign.toml"
            text = campaign.read_text().replace("device.toml", name)
            campaign.write_text(text)
            digest = hashlib.sha256(text.encode()).hexdigest()

            def change(head):
                head["campaign_sha256"] = digest
                head["sources"][0]["sha256"] = digest

            self.forge(change)
            (self.set / "rest_00000.h5").unlink()
            self.harmless("verify", "set", "--repair", says="has no copy")
            self.harmless("info", "set", "--device", 1, status=2,
                          says="has no copy")

    def test_a_lock_that_is_a_link_is_not_written_to(self):
        for make in [os.symlink, os.link]:
            for lock, *arguments in [("set.lock", "--resume"),
                                     ("1-of-2.lock", "--shard", "1/2")]:
                make(self.dir / "victim/data", self.set / lock)
                self.harmless("generate", "campaign.toml", "-o", "set",
                              *arguments, says=lock)
                (self.set / lock).unlink()

    def test_a_directory_that_is_a_link_is_not_written_to(self):
        self.link("source", "../victim", is_directory=True)
        self.harmless("verify", "set", says="symbolic link")
        self.harmless("verify", "set", "--repair", says="symbolic link")
        self.harmless("generate", "campaign.toml", "-o", "set", "--resume",
                      status=2, says="symbolic link")

    def test_a_manifest_that_is_a_link_is_not_written_to(self):
        shutil.move(self.set / "manifest.jsonl", self.dir / "victim/manifest")
        (self.set / "rest_00000.h5").unlink()
        self.link("manifest.jsonl", "../victim/manifest")
        self.harmless("generate", "campaign.toml", "-o", "set", "--resume",
                      status=2, says="symbolic link")
        self.harmless("generate", "campaign.toml", "-o", "set", "--shard",
                      "1/2", status=2, says="symbolic link")

    def test_a_file_that_claims_a_terabyte_is_not_read(self):
        tera = 1 << 40
        os.truncate(self.set / "rest_00000.h5", tera)
        self.harmless("verify", "set", says=f"has {tera} bytes; expected")
        self.harmless("info", "set", status=2, says="holds other bytes")
        os.truncate(self.set / "manifest.jsonl", tera)
        for command in [["verify", "set"], ["info", "set"],
                        ["generate", "campaign.toml", "-o", "set", "--resume"]]:
            self.harmless(*command, status=2,
                          says=["manifest.jsonl", f"has {tera} bytes; expected"])

    def test_a_copy_of_hard_links_is_gone_on_with_by_itself(self):
        text = self.text("set/manifest.jsonl").splitlines(True)
        self.write("set/manifest.jsonl", "".join(text[:4]))
        for path in self.set.glob("*_0000[2-3].h5"):
            path.unlink()
        shutil.copytree(self.set, self.dir / "copy", copy_function=os.link)
        self.harmless("generate", "campaign.toml", "-o", "set", "--resume",
                      status=0, says="whole")
