"""Sums JUnit reports of ctest and pytest into one line; exits with 1 unless all is well.

A report that is missing or holds no test counts as one failure: its test run never came to an end.
"""

import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree


def outcome(case):
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    skipped = case.find("skipped")
    if skipped is None:
        return "passed"
    # ctest says "skipped" of a program that it did not find, too; only a test's own wish to be skipped is one.
    not_run = case.get("status") == "notrun" and not skipped.get("message", "").startswith("SKIP_")
    return "failed" if not_run else "skipped"


def count(report):
    try:
        cases = list(ElementTree.parse(report).iter("testcase"))
    except (OSError, ElementTree.ParseError) as error:
        print(f"{report}: {error}")
        return Counter(failed=1)
    if not cases:
        print(f"{report}: no tests")
        return Counter(failed=1)
    total = Counter(outcome(case) for case in cases)
    print(f"{Path(report).stem}: {total['passed']} passed, {total['failed']} failed, {total['skipped']} skipped")
    for case in cases:
        if outcome(case) == "failed":
            print(f"    failed: {case.get('name')}")
    return total


total = sum((count(report) for report in sys.argv[1:]), Counter())
print(f"{total['passed']} passed, {total['failed']} failed, {total['skipped']} skipped")
sys.exit(1 if total["failed"] else 0)
