#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""verdict.py LOGS STAGE... : the tests of ./bootstrap test --all that failed, passed only at the second try, were skipped, or
judged nothing. Reads ctest's output from LOGS/STAGE.log."""
import pathlib
import re
import sys

# The line of a second try has no "6/11" at its beginning.
LINE = re.compile(r"^ *(?:\d+/\d+ +)?Test +#\d+: (\S+) \.*.*?(Passed|Failed|Skipped|Timeout|Exception|Not Run)")
RUN = re.compile(r"^== tests \((\S+)\)")  # a stage may run a test in several builds
NOT_JUDGED = re.compile(r"not judged: .*")


def read(text):
    """{(build, test): [results of its tries]}, and the sentences about what was not judged."""
    tries, build = {}, ""
    for line in text.splitlines():
        if run := RUN.match(line):
            build = run[1]
        elif found := LINE.match(line):
            tries.setdefault((build, found[1]), []).append(found[2])
    return tries, NOT_JUDGED.findall(text)


def report(logs, stages):
    lists = {"failed": [], "passed only at the second try": [], "skipped": [], "not judged": []}
    for stage in stages:
        tries, sentences = read((logs / f"{stage}.log").read_text(errors="replace"))
        for (_, test), results in tries.items():
            if results[-1] == "Skipped":
                lists["skipped"].append(f"{stage}: {test}")
            elif results[-1] != "Passed":
                lists["failed"].append(f"{stage}: {test} ({results[-1]})")
            elif len(results) > 1:
                lists["passed only at the second try"].append(f"{stage}: {test}")
        lists["not judged"] += [f"{stage}: {sentence.removeprefix('not judged: ')}" for sentence in sentences]
    for name, entries in lists.items():
        print(f"\n{name}: {len(entries) or 'none'}")
        print("".join(f"  {entry}\n" for entry in entries), end="")


if __name__ == "__main__":
    report(pathlib.Path(sys.argv[1]), sys.argv[2:])
