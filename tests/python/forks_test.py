# SPDX-License-Identifier: MIT
"""Children of a process of Python, and what comes from another one."""

import pickle
import sys

import pytest

import beamgyro as bg
import program
from beamgyro import _core

FORKS = """
import os, pathlib, signal, sys, threading
import beamgyro as bg

bg.run_to_file(sys.argv[1], "run.h5", set={"duration_s": 2000})
run = bg.open_recording("run.h5")
ended = threading.Event()

def read_and_write(name):
    while not ended.is_set():
        bg.open_recording("run.h5")
        run.beamgyro.save(name)

threads = [threading.Thread(target=read_and_write, args=[f"copy_{k}.h5"])
           for k in range(2)]
for thread in threads:
    thread.start()
hung = 0
for _ in range(60):
    child = os.fork()
    if child == 0:
        signal.alarm(PATIENCE)  # ends what hangs
        bg.open_recording("run.h5")
        os._exit(0)
    hung += os.waitpid(child, 0)[1] != 0
ended.set()
for thread in threads:
    thread.join()
print(hung)
"""


def test_a_child_reads_although_another_thread_was_within_hdf5(tmp_path):
    said = program.said(
        sys.executable, "-W", "ignore", "-c",
        FORKS.replace("PATIENCE", str(program.PATIENCE)),
        program.SCENARIOS / "warm_up.toml", cwd=tmp_path)
    assert said == "0\n"


def build_library(path):
    program.said("cc", "-shared", "-fPIC", f"-I{program.ROOT}/include",
                 program.ROOT / "examples/plugins/cubic.c", "-o", path, "-lm")


def test_unpickling_starts_no_command_and_loads_no_library(tmp_path):
    library = tmp_path / "cubic.so"
    build_library(library)
    run = bg.run(program.SCENARIOS / "warm_up.toml", set={"duration_s": 20})
    made = bg.Compensator(library)
    before = bg.compensate(made, run)
    pickled = pickle.dumps(made)
    library.write_text("no library")  # to load it would fail
    twin = pickle.loads(pickled)
    with pytest.raises(ValueError, match="cubic.so"):
        assert twin.name
    build_library(library)
    assert twin.name == "cubic.so"
    assert bg.compensate(pickle.loads(pickled), run).equals(before)


@pytest.mark.parametrize("call", [
    lambda: _core.compensate(None, None),
    lambda: _core.features(["temperature"], None),
    lambda: _core.Recording.__new__(_core.Recording).arrays(),
    lambda: _core.RateCompensator.__new__(_core.RateCompensator).name,
    lambda: _core.Compensator.__new__(_core.Compensator).text,
    lambda: _core.Campaign.__new__(_core.Campaign).name,
    lambda: _core.Set.__new__(_core.Set).runs,
    lambda: _core.Device(),
])
def test_what_is_no_object_is_refused_by_the_compiled_part(call):
    with pytest.raises(TypeError):
        call()
