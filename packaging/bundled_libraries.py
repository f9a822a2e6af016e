# SPDX-License-Identifier: MIT
"""Puts the libraries that a wheel needs into it, under names of its own.

Another name matters: the HDF5 of this wheel and that of another package would
share a name in one process, and HDF5 ends a process whose headers and library
differ.
"""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess

FOLDER = "beamgyro.libs"
HERE = pathlib.Path(__file__).resolve().parent
# What every Linux has that the tag is for (PEP 600, manylinux_2_36).
OF_THE_SYSTEM = re.compile(
    r"(linux-vdso|ld-linux-x86-64|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s))\.so")
CURL = "libcurl.so.4"
TRIED = (2, 36)  # the C library of Debian 12; an older one was not tried
COMMON = "/usr/share/common-licenses/"


def bundle(staged, folder):
    """Adds the libraries to the files of a wheel; returns its platform."""
    data = next(staged.glob("*.data"))
    module = next(staged.glob("beamgyro/_core*.so"))
    program = data / "scripts/beamgyro"
    libraries = dict(sorted(needed_by([module, program],
                                      stand_in(folder)).items()))
    target = staged / FOLDER
    target.mkdir()
    names = {name: own_name(name, path) for name, path in libraries.items()}
    for name, path in libraries.items():
        copy = target / names[name]
        shutil.copyfile(path, copy)
        copy.chmod(0o755)
        subprocess.run(["strip", "--strip-unneeded", copy], check=True)
        subprocess.run(["patchelf", "--set-soname", names[name], copy],
                       check=True)
        change(copy, names, "$ORIGIN")
    change(module, names, f"$ORIGIN/../{FOLDER}")
    # From bin/ to the packages of the environment, and of Debian's Python.
    change(program, names, ":".join(
        f"$ORIGIN/../lib/python3.11/{kind}-packages/{FOLDER}"
        for kind in ("site", "dist")))
    add_licences(libraries, names,
                 next(staged.glob("*.dist-info")) / "licenses")
    return f"manylinux_{glibc([module, program, *target.iterdir()])}_x86_64"


def needed_by(files, curl):
    """The libraries below programs by name, with curl's stand-in."""
    found = {}
    waiting = [str(file) for file in files]
    while waiting:
        file = waiting.pop()
        places = dict(re.findall(r"^\s*(\S+) => (/\S+)",
                                 said("ldd", file), re.MULTILINE))
        for name in said("patchelf", "--print-needed", file).split():
            if OF_THE_SYSTEM.match(name) or name in found:
                continue
            found[name] = curl if name == CURL else \
                pathlib.Path(places[name]).resolve()
            waiting.append(str(found[name]))
    return found


def stand_in(folder):
    """Instead of libcurl, which brings 28 libraries of networks along."""
    library = folder / CURL
    subprocess.run(
        [os.environ.get("CC", "cc"), "-shared", "-fPIC", "-O2", "-nostdlib",
         f"-Wl,--version-script={HERE / 'no_curl.map'}", f"-Wl,-soname,{CURL}",
         "-Wl,--build-id=none", HERE / "no_curl.c", "-o", library], check=True)
    return library


def own_name(name, path):
    """As auditwheel does: the name, and what the file is."""
    stem, _, version = name.partition(".so")
    kind = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
    return f"{stem}-{kind}.so{version}"


def change(file, names, run_path):
    """Lets a file ask for the libraries by their names here."""
    # One call each: patchelf 0.14 mixes up the values of several options.
    replaced = [["--replace-needed", name, names[name]]
                for name in said("patchelf", "--print-needed", file).split()
                if name in names]
    for words in [*replaced, ["--force-rpath", "--set-rpath", run_path]]:
        subprocess.run(["patchelf", *words, file], check=True)


def add_licences(libraries, names, folder):
    """The licence of each library and of each header-only one, as Debian states
    it, and a list of the libraries."""
    rows = ["Libraries in this wheel, from Debian 12. The licence of each, and of "
            "the header-only\nlibraries of THIRD_PARTY.md, stands beside this "
            "list.\n\n"]
    packages = set(header_only())
    for name, path in libraries.items():
        if name == CURL:
            rows.append(f"{names[name]}: of beamgyro, MIT: refuses every call "
                        "that HDF5 makes to libcurl\n")
            continue
        package = package_of(path)
        version = said("dpkg-query", "-W", "-f", "${Version}", package)
        packages.add(package.partition(":")[0])
        rows.append(f"{names[name]}: {package.partition(':')[0]} {version}\n")
    (folder / "LIBRARIES.txt").write_text("".join(rows))
    for package in sorted(packages):
        stated = pathlib.Path(f"/usr/share/doc/{package}/copyright")
        shutil.copyfile(stated, folder / f"{package}.copyright")
        for common in re.findall(COMMON + r"([\w.+-]*\w)",
                                 stated.read_text(errors="replace")):
            shutil.copyfile(COMMON + common, folder / f"{common}.licence")


def header_only():
    """The packages of THIRD_PARTY.md whose code the module holds."""
    first = (HERE.parent / "THIRD_PARTY.md").read_text().split(
        "Shared libraries")[0]
    return [package for package in
            re.findall(r"^\|[^|]+\| (\S+) \|", first, re.MULTILINE)
            if package != "Debian"]


def package_of(path):
    """The Debian package of a file; dpkg may know /lib without /usr."""
    for place in (str(path), str(path).removeprefix("/usr")):
        answer = subprocess.run(["dpkg-query", "-S", place], text=True,
                                capture_output=True, check=False)
        if answer.returncode == 0:
            return answer.stdout.split(": ")[0].split(",")[0]
    raise SystemExit(f"wheel: {path}: belongs to no Debian package")


def glibc(files):
    """The newest C library that a file asks for, as a tag has it, and at least
    the one that was tried."""
    versions = [tuple(map(int, version.split("."))) for file in files
                for version in re.findall(r"GLIBC_(\d+\.\d+)",
                                          said("readelf", "-V", file))]
    return "_".join(map(str, max(TRIED, *versions)))


def said(*command):
    """What a command prints."""
    return subprocess.run(command, text=True, check=True,
                          stdout=subprocess.PIPE).stdout
