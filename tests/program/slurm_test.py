# SPDX-License-Identifier: MIT
"""scripts/slurm_generate.sh on a Slurm of its own: one node, loopback only."""

import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

import pytest

from program import PATIENCE, PROGRAM, ROOT, SCENARIOS, ended, said

SCRIPT = ROOT / "scripts/slurm_generate.sh"
SMALL = SCENARIOS / "campaigns/small.toml"
DAEMONS = ["munged", "slurmctld", "slurmd", "sbatch"]

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={controller}
SlurmdPort={daemon}
AuthType=auth/munge
AuthInfo=socket={dir}/munge.socket
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
StateSaveLocation={dir}/state
SlurmdSpoolDir={dir}/spool
SlurmctldPidFile={dir}/slurmctld.pid
SlurmdPidFile={dir}/slurmd.pid
SlurmctldLogFile={dir}/slurmctld.log
SlurmdLogFile={dir}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000
PartitionName=main Nodes={host} Default=YES State=UP
"""


def why_not():
    """Why Slurm cannot be tried here, or an empty text."""
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    missing = [name for name in DAEMONS if not shutil.which(name, path=path)]
    if missing:
        return "no Slurm here: missing " + ", ".join(missing)
    return "" if os.geteuid() == 0 else "Slurm's daemons need root"


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def test_without_a_controller_nothing_is_made(tmp_path):
    for name in "sbatch", "sinfo":  # as they end where none answers
        (tmp_path / name).write_text("#!/bin/sh\necho refused >&2\nexit 1\n")
        (tmp_path / name).chmod(0o755)
    path = f"{tmp_path}:{os.environ['PATH']}"
    answer = ended(SCRIPT, SMALL, tmp_path / "set", allowed=[2], env={
        **os.environ, "PATH": path, "BEAMGYRO": str(PROGRAM)})
    assert answer.stderr.splitlines() == [
        "slurm_generate: no controller answers sinfo; expected a Slurm cluster "
        "that runs"]
    assert not (tmp_path / "set").exists()


# generate_test.py makes the tasks of a set in test.sh; nothing there submits
# them by scripts/slurm_generate.sh.
@pytest.mark.deep
@unittest.skipIf(why_not(), why_not())
class Slurm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.dir, ignore_errors=True)
        host = socket.gethostname().split(".")[0]
        for name in ["state", "spool"]:
            (cls.dir / name).mkdir()
        (cls.dir / "slurm.conf").write_text(CONFIGURATION.format(
            host=host, dir=cls.dir, controller=free_port(), daemon=free_port()))
        key = cls.dir / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        cls.environment = {
            **os.environ, "SLURM_CONF": str(cls.dir / "slurm.conf"),
            "BEAMGYRO": str(PROGRAM),
            "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}
        cls.daemons = []
        cls.addClassCleanup(cls.stop)
        cls.daemon("munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={cls.dir}/munge.socket",
                   f"--pid-file={cls.dir}/munged.pid",
                   f"--log-file={cls.dir}/munged.log",
                   f"--seed-file={cls.dir}/munged.seed")
        cls.wait_for((cls.dir / "munge.socket").exists, "munged")
        cls.daemon("slurmctld", "-D")
        cls.daemon("slurmd", "-D", "-N", host)
        cls.wait_for(lambda: "idle" in cls.said("sinfo", "-h", "-o", "%t"),
                     "an idle node")

    @classmethod
    def daemon(cls, *command):
        log = open(cls.dir / f"{command[0]}.out", "wb")
        cls.addClassCleanup(log.close)
        cls.daemons.append(subprocess.Popen(
            command, env=cls.environment, stdin=subprocess.DEVNULL, stdout=log,
            stderr=log))

    @classmethod
    def stop(cls):
        for daemon in reversed(cls.daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    @classmethod
    def said(cls, *command):
        return subprocess.run(command, env=cls.environment, text=True,
                              check=False, capture_output=True).stdout

    @classmethod
    def wait_for(cls, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end:
                logs = "\n".join(path.read_text(errors="replace")[-2000:]
                                 for path in sorted(cls.dir.glob("*.*g")))
                raise AssertionError(f"no {what} after {PATIENCE} s: {logs}")
            time.sleep(0.2)

    def submit(self, *arguments):
        return said(SCRIPT, *arguments, env=self.environment)

    def until_no_job_is_left(self):
        self.wait_for(lambda: not self.said("squeue", "-h").strip(),
                      "empty queue")

    def reference(self, campaign):
        folder = self.dir / f"reference {campaign.stem}"
        if folder.exists():
            return folder
        said(PROGRAM, "--quiet", "generate", campaign, "-o", folder)
        return folder

    def require_same(self, folder, reference):
        def published(path):
            return {file.name: file.read_bytes() for file in path.iterdir()
                    if file.suffix in {".h5", ".nc", ".jsonl"}}
        log = "".join(path.read_text() for path in (folder / "log").iterdir())
        self.assertEqual(sorted(published(folder)),
                         sorted(published(reference)), log)
        self.assertEqual(published(folder), published(reference))

    def test_an_array_makes_the_set_and_verifies_it(self):
        folder = self.dir / "a set"
        self.assertIn("tasks 1-3 of 3", self.submit(
            SMALL, folder, "--tasks", 3, "--", "--cpus-per-task=2"))
        self.until_no_job_is_left()
        self.require_same(folder, self.reference(SMALL))
        self.assertIn("whole", (folder / "log/finish.log").read_text())
        self.assertIn("whole", self.submit(SMALL, folder, "--tasks", 3))

    def test_a_directory_may_have_what_sbatch_replaces_in_its_name(self):
        for name in ["100 %a", "b\\%j set"]:
            folder = self.dir / name
            self.submit(SMALL, folder, "--tasks", 2)
            self.until_no_job_is_left()
            self.require_same(folder, self.reference(SMALL))
            self.assertIn("whole", (folder / "log/finish.log").read_text())

    def test_every_job_gets_the_options(self):
        self.submit(SMALL, self.dir / "held", "--tasks", 2, "--", "--hold",
                    "--comment=for all")
        jobs = self.said("squeue", "-h", "-o", "%j|%k").splitlines()
        self.assertEqual(set(jobs), {"beamgyro|for all",
                                     "beamgyro-finish|for all"})
        numbers = self.said("squeue", "-h", "-o", "%A").split()
        subprocess.run(["scancel", *numbers], env=self.environment, check=True)
        self.until_no_job_is_left()

    def test_a_terminated_task_is_made_up_for(self):
        campaign = self.dir / "long.toml"
        text = SMALL.read_text().replace('"../', f'"{SCENARIOS}/')
        campaign.write_text(re.sub(r"(?m)^devices = \d+", "devices = 400",
                                   text))
        folder = self.dir / "preempted"
        self.submit(campaign, folder, "--tasks", 2)
        self.wait_for(lambda: list(folder.glob("*.h5")), "file of the set")
        array = self.said("squeue", "-h", "-o", "%A", "-t", "R").split()[0]
        subprocess.run(["scancel", "--signal=TERM", "--batch", array],
                       env=self.environment, check=True)
        self.until_no_job_is_left()
        self.require_same(folder, self.reference(campaign))
        self.assertFalse(list(folder.glob("*.partial*")))

    def test_a_campaign_that_is_missing_submits_nothing(self):
        answer = ended(SCRIPT, "missing.toml", self.dir / "none", allowed=(2,),
                       env=self.environment)
        self.assertIn("missing.toml", answer.stderr)
        self.assertEqual(self.said("squeue", "-h").strip(), "")
