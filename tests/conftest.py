# SPDX-License-Identifier: MIT
"""How the tests are shared out to workers, and where their folders stand."""

import os
import pathlib
import tempfile

import pytest

MEMORY = pathlib.Path("/dev/shm")
NEEDED = 2 << 30  # bytes: several times what the largest test writes
# Where isolated commands may find programs (docs/reference/plugins.md).
SYSTEM = ("/usr/", "/bin", "/sbin", "/opt/")


def pytest_configure():
    """Let folders of tests stand in memory where it has the room: the program
    waits for the disk after each file that it writes, and no test cuts the
    power. TMPDIR chooses another place; tmp_path, which pytest keeps for three
    sessions, stays on the disk. Commands of tests name programs of the system,
    whatever a user has before them in PATH."""
    os.environ["PATH"] = os.pathsep.join(
        folder for folder in os.environ["PATH"].split(os.pathsep)
        if folder.startswith(SYSTEM))
    if "TMPDIR" in os.environ or not os.access(MEMORY, os.W_OK):
        return
    state = os.statvfs(MEMORY)
    if (state.f_bavail * state.f_frsize >= NEEDED
            and not state.f_flag & os.ST_NOEXEC):
        os.environ.setdefault("PYTEST_DEBUG_TEMPROOT", tempfile.gettempdir())
        tempfile.tempdir = os.environ["TMPDIR"] = str(MEMORY)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items):
    """Start what is marked `early` before all else."""
    items.sort(key=lambda item: item.get_closest_marker("early") is None)


@pytest.hookimpl(optionalhook=True, tryfirst=True)
def pytest_xdist_make_scheduler(config, log):
    """Keep the tests of a class on one worker, for they share a set-up, and let
    any worker take a test that is in no class."""
    from xdist.scheduler import LoadScopeScheduling

    class ByClass(LoadScopeScheduling):
        def _split_scope(self, nodeid):
            path, *names = nodeid.partition("[")[0].split("::")
            return f"{path}::{names[0]}" if len(names) > 1 else nodeid
    return ByClass(config, log)
