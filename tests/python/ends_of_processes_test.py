# SPDX-License-Identifier: MIT
"""Processes that end while work goes on, or after work has failed."""

import sys

import pytest

import program


def ended(folder, text):
    """The status and the output of a Python process."""
    answer = program.ended(
        sys.executable, "-c", text, program.SCENARIOS / "warm_up.toml",
        cwd=folder, allowed=(0, 130))
    return answer.returncode, answer.stdout, answer.stderr


INTERRUPTED = """
import beamgyro as bg, os, signal, sys, threading, time
run = bg.run(sys.argv[1], set={"duration_s": 20})
def slow(signals):
    for _ in range(SECONDS * 100):
        time.sleep(0.01)
    print("answered")
    return signals.rate
threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    bg.compensate(slow, run)
except KeyboardInterrupt:
    print("interrupted")
"""


def test_the_end_waits_for_a_function_that_still_answers(tmp_path):
    status, output, errors = ended(tmp_path,
                                   INTERRUPTED.replace("SECONDS", "7"))
    assert (status, output, errors) == (0, "interrupted\nanswered\n", "")


def test_another_interrupt_ends_the_process(tmp_path):
    text = INTERRUPTED.replace("SECONDS", "100") + """
again = threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT))
again.daemon = True
again.start()
"""
    status, output, _ = ended(tmp_path, text)
    assert (status, output) == (130, "interrupted\n")


def test_a_run_of_a_daemon_thread_is_stopped(tmp_path):
    status, output, errors = ended(tmp_path, """
import beamgyro as bg, sys, threading, time
threading.Thread(target=lambda: bg.run(sys.argv[1], fidelity="carrier"),
                 daemon=True).start()
time.sleep(0.5)
print("done")
""")
    assert (status, output) == (0, "done\n"), errors


@pytest.mark.parametrize("size", [3000, 20000, 100000])
def test_a_file_that_cannot_be_written_leaves_a_process_that_ends(tmp_path,
                                                                  size):
    status, output, errors = ended(tmp_path, f"""
import beamgyro as bg, os, resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
bg.run_to_file(sys.argv[1], "good.h5", set={{"duration_s": 2}})
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))
for name in ("run.h5", "run.csv"):
    try:
        bg.run_to_file(sys.argv[1], name)
    except RuntimeError as error:
        print(error)
    bg.open_recording("good.h5")  # other files are not concerned
print(os.listdir("."))
""")
    lines = output.splitlines()
    assert status == 0, errors
    assert len(lines) == 3 and lines[-1] == "['good.h5']"
    for line in lines[:-1]:
        assert line.startswith("run.") and line.endswith("File too large")


def test_a_child_ends_while_its_parent_works(tmp_path):
    status, output, errors = ended(tmp_path, """
import beamgyro as bg, os, sys, threading, time
threading.Thread(target=lambda: bg.run(sys.argv[1], fidelity="carrier"),
                 daemon=True).start()
time.sleep(0.5)
child = os.fork()
if child == 0:
    sys.exit(7)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
""")
    assert (status, output) == (0, "7\n"), errors
