# SPDX-License-Identifier: MIT
"""Makes the wheel of the Python package; what pip calls, after PEP 517.

It needs the standard library, and for the build what scripts/setup.sh installs.
pip's wheel is linked with the libraries of the system. scripts/wheel.sh calls
this file to make one that holds them; see bundled_libraries.py.
"""

import argparse
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import time
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXTENSION = sysconfig.get_config_var("EXT_SUFFIX")
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"
FIRST_TIME = 315532800  # 1980-01-01, of which zip begins to count
# What an installation has beside the module, and where a wheel has it: pip puts
# `scripts` into bin/, and `data` into the prefix.
PLACES = {"lib/python3/dist-packages": "", "bin": "scripts",
          "lib/beamgyro": "data/lib/beamgyro",
          "share/beamgyro": "data/share/beamgyro"}


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None,
                metadata_directory=None):
    """Builds, and returns the name of the wheel that was written.

    `--config-settings build=DIR` takes a build that is there.
    """
    build = (config_settings or {}).get("build")
    if build is None:
        require_the_python_of_the_build()
        subprocess.run([ROOT / "scripts/build.sh", "release"], check=True)
    with tempfile.TemporaryDirectory() as folder:
        staged = staged_wheel(pathlib.Path(build or ROOT / "build/release"),
                              pathlib.Path(folder))
        platform = sysconfig.get_platform().translate({45: "_", 46: "_"})
        return packed(staged, pathlib.Path(wheel_directory), platform)


def require_the_python_of_the_build():
    """The build is for Debian's python3: said before minutes are spent."""
    answer = subprocess.run(
        ["/usr/bin/python3", "-c", "import sysconfig; "
         "print(sysconfig.get_config_var('EXT_SUFFIX'))"],
        check=False, text=True, capture_output=True)
    built = answer.stdout.strip()
    if answer.returncode == 0 and built != EXTENSION:
        raise SystemExit(
            f"beamgyro: this Python loads modules *{EXTENSION}, the build makes"
            f" *{built}; expected an environment of Debian's Python:"
            " /usr/bin/python3 -m venv --system-site-packages DIR")


# --- what a wheel holds ---

def project():
    """The table [project], with the version of the public header."""
    table = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    header = (ROOT / "include/beamgyro/version.h").read_text()
    table["version"] = ".".join(
        re.findall(r"#define BEAMGYRO_VERSION_[A-Z]+ (\d+)", header))
    return table


def staged_wheel(build, folder):
    """A directory with the files of a wheel but RECORD and WHEEL."""
    if not (build / f"python/beamgyro/_core{EXTENSION}").exists():
        raise SystemExit(f"beamgyro: {build} has no _core{EXTENSION}; expected "
                         "a build for this Python: scripts/build.sh release")
    installed = folder / "installed"
    for component in ("python", "runtime"):
        subprocess.run(["cmake", "--install", build, "--strip", "--component",
                        component, "--prefix", installed], check=True,
                       stdout=subprocess.DEVNULL)
    staged, table = folder / "wheel", project()
    name = f"{table['name']}-{table['version']}"
    for place, target in PLACES.items():
        shutil.copytree(
            installed / place,
            staged / f"{name}.data" / target if target else staged,
            ignore=shutil.ignore_patterns("__pycache__"))
    about = staged / f"{name}.dist-info"
    (about / "licenses").mkdir(parents=True)
    (about / "METADATA").write_text(metadata(table))
    for licence in ("LICENSE", "THIRD_PARTY.md"):
        shutil.copy(ROOT / licence, about / "licenses")
    return staged


def metadata(table):
    """The text of METADATA."""
    lines = ["Metadata-Version: 2.1", f"Name: {table['name']}",
             f"Version: {table['version']}", f"Summary: {table['description']}",
             f"License: {table['license']['text']}",
             "License-File: LICENSE", "License-File: THIRD_PARTY.md",
             f"Requires-Python: {table['requires-python']}",
             "Description-Content-Type: text/markdown"]
    lines += [f"Requires-Dist: {one}" for one in table["dependencies"]]
    for extra, needed in table["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}",
                  *[f'Requires-Dist: {one} ; extra == "{extra}"'
                    for one in needed]]
    return "\n".join(lines) + "\n\n" + (ROOT / "README.md").read_text()


# --- the file ---

def packed(staged, directory, platform):
    """Writes the wheel of a directory, and returns its name."""
    about = next(staged.glob("*.dist-info"))
    tag = f"{PYTHON}-{PYTHON}-{platform}"
    (about / "WHEEL").write_text(
        "Wheel-Version: 1.0\nGenerator: beamgyro\n"
        f"Root-Is-Purelib: false\nTag: {tag}\n")
    record = about / "RECORD"
    files = sorted(path for path in staged.rglob("*") if path.is_file())
    record.write_text("".join(
        [f"{path.relative_to(staged)},{digest(path)},{path.stat().st_size}\n"
         for path in files] + [f"{record.relative_to(staged)},,\n"]))
    name = f"{about.stem}-{tag}.whl"
    directory.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(directory / name, "w") as archive:
        for path in [*files, record]:
            add(archive, path, str(path.relative_to(staged)))
    return name


def digest(path):
    """As RECORD has it."""
    value = hashlib.sha256(path.read_bytes()).digest()
    return "sha256=" + base64.urlsafe_b64encode(value).decode().rstrip("=")


def add(archive, path, name):
    """One file, with the same bytes whenever and by whomever it is packed."""
    seconds = max(FIRST_TIME, int(os.environ.get("SOURCE_DATE_EPOCH",
                                                 FIRST_TIME)))
    entry = zipfile.ZipInfo(name, time.gmtime(seconds)[:6])
    runs = path.stat().st_mode & 0o100
    entry.external_attr = (0o100755 if runs else 0o100644) << 16
    entry.compress_type = zipfile.ZIP_DEFLATED
    archive.writestr(entry, path.read_bytes())


def main():
    """Makes a wheel that holds the libraries, of a build that is there."""
    from bundled_libraries import bundle
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        staged = staged_wheel(given.build.resolve(), pathlib.Path(folder))
        platform = bundle(staged, pathlib.Path(folder))
        print(given.output / packed(staged, given.output, platform))


if __name__ == "__main__":
    main()
