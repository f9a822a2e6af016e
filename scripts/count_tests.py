#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Prints "PASSED FAILED SKIPPED" of a JUnit report; names what was skipped."""

import sys
import xml.etree.ElementTree


def outcome(case):
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    skipped = case.find("skipped")
    if skipped is None:
        return "passed"
    # CTest also files a test whose program is missing under "skipped".
    said = skipped.get("message") or ""
    meant = skipped.get("type") == "pytest.skip" or said.startswith(
        ("SKIP", "Disabled"))
    return "skipped" if meant else "failed"


def main():
    cases = list(xml.etree.ElementTree.parse(sys.argv[1]).iter("testcase"))
    if not cases:
        sys.exit(f"{sys.argv[1]}: no test was run")
    outcomes = [outcome(case) for case in cases]
    for case, how in zip(cases, outcomes):
        if how == "skipped":
            why = case.findtext("system-out") or case.find("skipped").get(
                "message")
            print(f"skipped: {case.get('name')}: {why.strip()}",
                  file=sys.stderr)
    print(*(outcomes.count(how) for how in ("passed", "failed", "skipped")))


if __name__ == "__main__":
    main()
