# SPDX-License-Identifier: MIT
"""What foreign code starts ends with it, whatever it does to get away."""

import os
import pathlib
import shlex
import signal
import subprocess
import time

from program import (IDENTITY, PATIENCE, PROGRAM, ROOT, SCENARIO, ProgramTest,
                     processes, said, without_landlock)

# Isolated code cannot leave its session.
ISOLATED_OR_NOT = (None, without_landlock)

# A process that leaves its group and its session, and whose parent ends.
STRAYING = """\
import os, sys, time

def stray():
    if os.fork() == 0:
        try:
            os.setsid()  # which isolated code may not do
        except PermissionError:
            pass
        if os.fork() == 0:
            for descriptor in range(3):
                os.close(descriptor)
            time.sleep(1000)
        os._exit(0)
    os.wait()

stray()
"""

STRAYING_LIBRARY = """\
#include <sys/wait.h>
#include <unistd.h>

#define beamgyro_plugin_reset cubic_reset
#include "EXAMPLE"
#undef beamgyro_plugin_reset

int beamgyro_plugin_reset(void* instance, double period) {
  const pid_t child = fork();
  if (child == 0) {
    setsid();
    if (fork() == 0) sleep(1000);
    _exit(0);
  }
  waitpid(child, NULL, 0);
  return cubic_reset(instance, period);
}
"""

# Four processes of 200 MB, none of which is too large alone.
SPREADING = """\
import os, time
for _ in range(4):
    if os.fork() == 0:
        kept = b"x" * 200_000_000
        break
time.sleep(1000)
"""


class LeftBehind(ProgramTest):
    def prepare(self):
        super().prepare()
        self.run_scenario("run", text=SCENARIO.replace("= 600", "= 20"))
        self.write("straying.py", STRAYING + IDENTITY)
        self.write("hanging.py", STRAYING + "time.sleep(1000)\n")
        self.write("spreading.py", SPREADING)
        (self.dir / "folders").mkdir()

    def environment(self):
        return os.environ | {"TMPDIR": str(self.dir / "folders")}

    def nothing_is_left(self, word):
        """Whether no process has the word in its command line after a while."""
        for _ in range(10 * PATIENCE):
            if not processes(word):
                return True
            time.sleep(0.1)
        return False

    def script(self, name):
        """A command whose script is at a place of this test alone."""
        return f"cmd:/usr/bin/python3 {shlex.quote(str(self.dir / name))}"

    def test_what_a_command_started_ends_with_it(self):
        for first in ISOLATED_OR_NOT:
            self.ok("compensate", self.script("straying.py"), "run.h5", "-o",
                    "out.h5", env=self.environment(), preexec_fn=first)
            self.assertEqual(processes(str(self.dir / "straying.py")), [])
            self.assertEqual(list((self.dir / "folders").iterdir()), [])

    def test_what_a_library_started_ends_with_it(self):
        example = ROOT / "examples/plugins/cubic.c"
        self.write("straying.c", STRAYING_LIBRARY.replace("EXAMPLE",
                                                          str(example)))
        said("cc", "-shared", "-fPIC", f"-I{ROOT}/include", "straying.c", "-o",
             "straying.so", "-lm", cwd=self.dir)
        for first in ISOLATED_OR_NOT:
            self.ok("compensate", "./straying.so", "run.h5", "-o", "out.h5",
                    preexec_fn=first)
            self.assertEqual(processes(str(self.dir / "straying.so")), [])

    def test_a_killed_program_leaves_nothing(self):
        for by in (signal.SIGKILL, signal.SIGTERM):
            with subprocess.Popen(
                    [str(PROGRAM), "compensate", self.script("hanging.py"),
                     "run.h5", "-o", "out.h5"], cwd=self.dir,
                    stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                    env=self.environment()) as process:
                # The command, and what strayed from it.
                while len(self.of_script("hanging.py")) < 2:
                    self.assertIsNone(process.poll())
                    time.sleep(0.05)
                process.send_signal(by)
            self.assertTrue(self.nothing_is_left(str(self.dir / "hanging.py")))
            for _ in range(10 * PATIENCE):
                if not list((self.dir / "folders").iterdir()):
                    break
                time.sleep(0.1)
            self.assertEqual(list((self.dir / "folders").iterdir()), [])

    def of_script(self, name):
        """The processes that run a script, without those that name it."""
        return [process for process in processes(str(self.dir / name))
                if pathlib.Path(f"/proc/{process}/cmdline").read_bytes()
                .startswith(b"/usr/bin/python3")]

    def test_memory_is_that_of_all_processes_together(self):
        found, _ = self.validated(self.script("spreading.py"), "run.h5",
                                  "--memory-GiB", "0.5", "--timeout-s", PATIENCE)
        self.assertEqual(found["verdict"], "fail")
        self.assertIn("ran out of memory", self.text("v.json"))
        self.assertEqual(processes(str(self.dir / "spreading.py")), [])
