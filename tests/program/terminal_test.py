# SPDX-License-Identifier: MIT
"""What the program shows on a terminal of 80 columns, in a pipe, and when it is
interrupted."""

import fcntl
import os
import pty
import re
import select
import shlex
import signal
import struct
import subprocess
import termios
import time

from faults import ShimTest
from program import CUBIC, NETWORK, PATIENCE, PROGRAM, SCENARIO, ramp
from sets import write_campaign

LONG = SCENARIO.replace("= 600", "= 200000").replace("= 2\n", "= 200\n")
PATIENT = NETWORK.replace("[2]", "[12]").replace("restarts = 1",
                                                "restarts = 3") \
    .replace("max_epochs = 30", "max_epochs = 1000000\npatience = 1000000"
             "\ngoal_deg_per_s = 0").replace("levenberg_marquardt",
                                             "incremental")
CLOCK = r"\d+:\d\d:\d\d"


def seconds_of(text):
    """The first time in a text."""
    hours, minutes, seconds = re.search(CLOCK, text)[0].split(":")
    return 3600 * int(hours) + 60 * int(minutes) + int(seconds)


class Screen:
    """A terminal with a process in the foreground, and what it shows."""

    def __init__(self, command, folder, environment, columns=80):
        self.sent = b""
        self.process, self.main = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            fcntl.ioctl(0, termios.TIOCSWINSZ,
                        struct.pack("HHHH", 24, columns, 0, 0))
            os.execve(command[0], command, environment)

    def read(self, until=None):
        """Reads until something is shown, all is over or it hangs; whether the
        former was."""
        end = time.monotonic() + PATIENCE
        while (left := end - time.monotonic()) > 0:
            if until and re.search(until, self.sent.decode()):
                return True
            if not select.select([self.main], [], [], left)[0]:
                break
            try:
                part = os.read(self.main, 4096)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            self.sent += part
        return bool(until and re.search(until, self.sent.decode()))

    def type(self, text):
        os.write(self.main, text)

    def end(self):
        """Wait status of the process. Nobody may wait for one that cannot
        write to a full terminal."""
        self.read()
        status = os.waitpid(self.process, 0)[1]
        os.close(self.main)
        return status

    def frames(self):
        """Each text that the line of progress showed."""
        return [frame.split("\n")[0] for frame in
                self.sent.decode().split("\r\x1b[K")[1:] if frame]

    def lines(self, columns=80):
        """The lines that are left on the screen."""
        lines, at = [""], 0
        text = re.sub(r"\x1b\[\d+m", "", self.sent.decode())
        while text:
            if text.startswith("\x1b[K"):
                lines[-1] = lines[-1][:at]
                text = text[3:]
                continue
            c, text = text[0], text[1:]
            if c == "\r":
                at = 0
            elif c == "\n":
                lines.append("")
                at = 0
            else:
                if at == columns:  # it wraps
                    lines.append("")
                    at = 0
                lines[-1] = lines[-1][:at].ljust(at) + c + lines[-1][at + 1:]
                at += 1
        return lines


class Timed(ShimTest):
    """A test whose program takes SPEED seconds for one of processor time."""

    SHIM = "clock_shim"
    SPEED = 20

    def timed(self):
        return self.shimmed(CLOCK_SPEED=str(self.SPEED))


class Terminal(Timed):
    def screen(self, *words, columns=80):
        return self.show([str(PROGRAM), *map(str, words)], columns)

    def show(self, command, columns=80):
        screen = Screen(command, self.dir, self.timed(), columns)
        self.addCleanup(self.end, screen)
        return screen

    def end(self, screen):
        try:
            os.kill(screen.process, signal.SIGKILL)
            os.waitpid(screen.process, 0)
        except (ProcessLookupError, ChildProcessError):
            pass


class Line(Terminal):
    def watched(self, screen, frames=6):
        """Frames of the line, after which exactly one line stands there."""
        self.assertTrue(screen.read(
            rf"(\r\x1b\[K[^\r]+){{{frames},}}\r"), screen.sent)
        self.assertEqual(len(screen.lines()), 1, screen.lines())
        return screen.frames()

    def test_a_run_shows_one_line_that_fits_and_rewrites_itself(self):
        name = "a_scenario_with_a_name_that_is_longer_than_the_terminal_is_wide" \
            + "_" * 60 + ".toml"
        self.write(name, LONG)
        for columns in [80, 44]:
            screen = self.screen("run", name, "-o", f"{columns}.h5",
                                 columns=columns)
            # What is left is known after the first part of the run.
            self.assertTrue(screen.read(
                rf"\.\.\., \d+ %, {CLOCK}, {CLOCK} left"), screen.sent)
            for frame in self.watched(screen):
                self.assertLess(len(frame), columns)
            self.end(screen)

    def test_the_line_is_gone_at_the_end(self):
        self.write("s.toml", LONG.replace("200000", "3000"))
        screen = self.screen("run", "s.toml", "-o", "a.h5")
        self.assertEqual(screen.end(), 0)
        self.assertEqual(screen.lines(), [""])

    def test_the_time_left_converges(self):
        self.SPEED = 200
        self.write("s.toml", LONG.replace("200000", "7500"))
        screen = self.screen("run", "s.toml", "-o", "a.h5")
        self.assertEqual(screen.end(), 0)
        found = [re.search(rf"(\d+) %, ({CLOCK}), ({CLOCK}) left", frame)
                 for frame in screen.frames()]
        told = [(int(match[1]), seconds_of(match[2]), seconds_of(match[3]))
                for match in found if match]
        # All is simulated then; what is left is to write it.
        end = next(spent for share, spent, _ in told if share == 100)
        late = [spent + left for _, spent, left in told
                if end / 2 < spent < end]
        self.assertGreater(len(late), 5)
        for estimate in late:
            self.assertLess(abs(estimate - end), 2 + end / 6)

    def test_training_shows_restart_epoch_and_error(self):
        self.run_scenario("run", text=ramp())
        self.run_scenario("held_out", text=ramp(seed=9))
        for trainer in ["incremental", "gradient_adaptive",
                        "levenberg_marquardt"]:
            neurons, seconds = {"levenberg_marquardt": (100, 1)}.get(
                trainer, (12, 4))
            self.write("m.toml", PATIENT.replace("incremental", trainer)
                       .replace("[12]", f"[{neurons}]") +
                       f"[rows]\nseconds = {seconds}\n")
            screen = self.screen("train", "run.h5", "--model", "m.toml",
                                 "--held-out", "held_out.h5", "-o", "c.json")
            self.assertTrue(screen.read(
                rf"training c.json, {CLOCK}, restart [123]/3, epoch "
                r"\d+/1000000, rms [\d.e-]+ deg/s"), screen.sent)
            self.assertEqual(len(screen.lines()), 1)
            self.end(screen)

    def test_a_set_shows_one_line(self):
        write_campaign(self, 40000)
        screen = self.screen("generate", "campaign.toml", "-o", "set")
        for frame in self.watched(screen):
            self.assertLess(len(frame), 80)
            self.assertRegex(frame, rf"generating set, .*{CLOCK}.*\d+ of 80000")
        self.assertRegex(screen.frames()[-1], r", \d:\d\d:\d\d left, "
                         r"\d+ of 80000 runs, 0 failed")


class Interrupt(Terminal):
    def test_the_prompt_has_its_own_line_below_what_is_kept(self):
        self.write("s.toml", LONG)
        screen = self.screen("run", "s.toml", "-o", "a.h5")
        self.assertTrue(screen.read(CLOCK))
        screen.type(b"\x03")
        screen.read()
        status = screen.end()
        self.assertTrue(os.WIFSIGNALED(status))
        self.assertEqual(os.WTERMSIG(status), signal.SIGINT)
        self.assertEqual(screen.lines(), [
            "beamgyro: interrupted; a.h5 was not written", ""])
        self.assertEqual(sorted(self.files()), sorted(
            path.relative_to(self.dir) for path in
            [self.dir / "s.toml", self.dir / "device.toml"]))

    def test_it_ends_a_loop_of_the_shell(self):
        self.write("s.toml", LONG)
        loop = f"for i in 1 2 3; do {PROGRAM} run s.toml -o $i.h5; " \
               "echo went on; done; echo to the end"
        screen = self.show(["/bin/bash", "-c", loop])
        self.assertTrue(screen.read(CLOCK))
        screen.type(b"\x03")
        screen.read()
        screen.end()
        self.assertNotIn("went on", screen.sent.decode())
        self.assertNotIn("to the end", screen.sent.decode())

    def test_a_set_says_how_to_go_on_and_does(self):
        write_campaign(self, 7)
        said = self.interrupted("generate", "campaign.toml", "-o", "a set",
                                "--devices", 300, until="a set/*.h5")
        self.assertEqual(list(self.dir.glob("a set/*partial*")), [])
        self.assertIn("interrupted; a set keeps its finished files; go on with: ",
                      said)
        # The last file may have been published and not yet noted.
        noted = self.text("a set/manifest.jsonl")
        kept = {path: path.stat().st_mtime_ns
                for path in self.dir.glob("a set/*.h5") if path.name in noted}
        advice = shlex.split(said.split("go on with: beamgyro ")[1])
        self.assertIn("the set is whole", self.ok(*advice))
        for path, when in kept.items():
            self.assertEqual(path.stat().st_mtime_ns, when)

    def test_quiet_says_nothing(self):
        self.write("s.toml", LONG)
        self.assertEqual(self.interrupted(
            "run", "s.toml", "-o", "a.h5", "-q", until="*partial*",
            by=signal.SIGINT), "")

    def test_a_signal_that_was_ignored_stays_so(self):
        """nohup ignores SIGHUP, a script SIGINT in its background."""
        self.write("s.toml", LONG.replace("200000", "8000"))
        for number in signal.SIGHUP, signal.SIGINT:
            with self.working(
                    "run", "s.toml", "-o", f"{number}.h5", until="*partial*",
                    preexec_fn=lambda: signal.signal(number, signal.SIG_IGN)
                    ) as process:
                process.send_signal(number)
                self.assertEqual(process.wait(PATIENCE), 0)


class Pipe(Timed):
    SPEED = 6000  # a minute is 10 ms

    def notes(self, *words):
        """The first two lines of progress."""
        lines = []
        with subprocess.Popen(
                [str(PROGRAM), *map(str, words)], cwd=self.dir, text=True,
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE, env=self.timed()) as process:
            for line in process.stderr:
                if re.search(f", {CLOCK}", line):
                    lines.append(line)
                if len(lines) == 2:
                    break
            process.kill()
        return lines

    def test_every_long_command_writes_a_line_a_minute(self):
        self.write("s.toml", LONG)
        self.run_scenario("run", text=ramp(seconds=20000, rate_Hz=20))
        self.run_scenario("held_out", text=ramp(seed=9))
        self.write("cubic.toml", CUBIC)
        self.ok("train", "held_out.h5", "--model", "cubic.toml", "-o",
                "cubic.json")
        self.write("m.toml", PATIENT)
        self.write("map.toml", '[time]\ncolumn = "t"\nunit = "s"\n[gyro]\n'
                   'column = "w"\nunit = "deg/s"\n[temperature]\ncolumn = "T"\n'
                   'unit = "degC"\n')
        self.write("log.csv", "t,w,T\n" + "".join(
            f"{k},1.5,25\n" for k in range(200000)))
        write_campaign(self, 4000)
        for command in [
                ["run", "s.toml", "-o", "a.h5"],
                ["characterise", "device.toml", "-o", "c.csv",
                 "--beam-temperature", "-40:60:0.001"],
                ["train", "run.h5", "--model", "m.toml", "--held-out",
                 "held_out.h5", "-o", "c.json"],
                ["validate", "cubic.json", "run.h5"],
                ["compensate", "cubic.json", "run.h5", "-o", "o.h5"],
                ["allan", "run.h5"],
                ["import", "log.csv", "--map", "map.toml", "-o", "log.h5"],
                ["generate", "campaign.toml", "-o", "set"]]:
            lines = self.notes(*command)
            self.assertEqual(len(lines), 2, "too short")
            times = [seconds_of(line) for line in lines]
            self.assertGreaterEqual(times[0], 60)
            self.assertGreaterEqual(times[1], times[0] + 60)
            self.assertNotIn("\r", "".join(lines))
