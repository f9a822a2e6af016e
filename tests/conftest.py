# SPDX-License-Identifier: MIT
"""How the tests are shared out to workers, and where their folders stand."""

import os
import pathlib
import tempfile

import pytest

MEMORY = pathlib.Path("/dev/shm")
NEEDED = 2 << 30  # bytes: several times what the largest test writes


def pytest_configure():
    """Let folders of tests stand in memory where it has the room: the program
    waits for the disk after each file that it writes, and no test cuts the
    power. TMPDIR chooses another place; tmp_path, which pytest keeps for three
    sessions, stays on the disk."""
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
