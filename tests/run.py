#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the Python tests (*_test.py) of tests/program and tests/scripts.

run.py [--junit FILE] [NAME...]; the program is $BEAMGYRO, else
build/release/beamgyro. NAME picks tests as unittest's -k does.
"""

import argparse
import pathlib
import re
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

HERE = pathlib.Path(__file__).resolve().parent


class Reported(unittest.TextTestResult):
    """Keeps one row per test, also of those that passed."""

    def __init__(self, *args):
        super().__init__(*args)
        self.rows = []
        self.start = 0.0

    def startTest(self, test):
        super().startTest(test)
        self.start = time.monotonic()

    def row(self, test, kind=None, text=""):
        self.rows.append((test.id(), time.monotonic() - self.start, kind, text))

    def addSuccess(self, test):
        super().addSuccess(test)
        self.row(test)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self.row(test, "failure", self._exc_info_to_string(err, test))

    def addError(self, test, err):
        super().addError(test, err)
        self.row(test, "error", self._exc_info_to_string(err, test))

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err is not None:
            self.row(subtest, "failure", self._exc_info_to_string(err, test))

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.row(test, "skipped", f"SKIP: {reason}")


def write_junit(rows, file):
    def printable(text):  # XML knows no other control characters
        return re.sub("[^\t\n\x20-\ud7ff\ue000-\ufffd]", "?", text)

    suite = ElementTree.Element("testsuite", name="python",
                                tests=str(len(rows)))
    for name, seconds, kind, text in rows:
        case = ElementTree.SubElement(suite, "testcase",
                                      name=printable(name),
                                      time=f"{seconds:.3f}")
        if kind:
            ElementTree.SubElement(case, kind, message=printable(text))
    ElementTree.ElementTree(suite).write(file, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--junit", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    suite = unittest.TestSuite()
    for folder in [HERE / "program", HERE / "scripts"]:
        loader = unittest.TestLoader()
        loader.testNamePatterns = [f"*{n}*" for n in arguments.names] or None
        suite.addTests(loader.discover(str(folder), pattern="*_test.py"))
    outcome = unittest.TextTestRunner(resultclass=Reported, verbosity=1).run(
        suite)
    if arguments.junit:
        write_junit(outcome.rows, arguments.junit)
    return 0 if outcome.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
