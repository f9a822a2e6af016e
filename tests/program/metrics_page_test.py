# SPDX-License-Identifier: MIT
"""Compares docs/reference/metrics.md with the table of metrics."""

from pages import page, rows
from program import ProgramTest

PURPOSES = 12


class MetricsPage(ProgramTest):
    def test_every_metric_is_described_as_the_program_does(self):
        described = rows(page("metrics"))
        listed = set()
        for line in self.ok("validate", "--list-metrics").splitlines():
            name, unit, clause, purposes, definition = line.split("\t")
            listed.add(name)
            reads = purposes.split()
            told = ("every purpose" if len(reads) == PURPOSES
                    else ", ".join(reads))
            bracket = "; ".join(part for part in (unit, clause, told) if part)
            self.assertIn(name, described)
            start = f"({bracket}) {definition} "
            self.assertEqual(
                " ".join(described[name].split())[:len(start)], start)
            self.assertRegex(described[name][len(start):],
                             "^ *(Interval|No interval|Exact)")
        self.assertEqual({name for name in described
                          if not name.startswith("--")}, listed)
