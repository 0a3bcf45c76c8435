#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes tests/MEASURED.md of MEASURED.md.in and of the figures that tests print as `[measured] KEY VALUE`.

usage: measured.py BUILD [NAME...]

Runs all tests that have figures in measured.json, or the tests NAME (a test that is new has to be named once), stores the
figures there, and writes MEASURED.md. ./bootstrap measured calls it before a release; no test reads these files.

In MEASURED.md.in, {KEY} stands for a figure, {KEY:.2g} for one in a format of Python. Prose is wrapped anew; tables,
headings and indented lines are kept as they are.
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import textwrap

HERE = pathlib.Path(__file__).resolve().parent
TEMPLATE, FIGURES, DOCUMENT = HERE / "MEASURED.md.in", HERE / "measured.json", HERE / "MEASURED.md"
# What `measured.py` asks tests for: the long tables of tests/README.md. Their rows are those of the usual run.
LONG_TABLES = {"TACTO_ALL_PHASES": "1", "TACTO_COMPARE_PAIRS": "1000"}
WIDTH = 120

KEY = r"[a-z][a-z0-9_]*(?:\.[a-z0-9_]+)+"
PLACEHOLDER = re.compile(r"\{(" + KEY + r")(?::([^{}]*))?\}")
PRINTED = re.compile(r"^\[measured\] (\S+) (\S+)$", re.M)
NOT_PRINTED = re.compile(r"^\[not measured\] (\S+) ", re.M)
ENTRY = re.compile(r"^\d+/\d+ Test: ", re.M)  # of ctest's log


class Fault(Exception):
    pass


class Run:
    """What one test printed."""
    def __init__(self, entry):
        output, _, ending = entry.partition("\nOutput:\n")[2].partition("\n<end of output>\n")
        self.passed = "\nTest Passed.\n" in ending and not re.search(r"^skipped", output, re.M)  # ctest logs "passed" for both
        self.pairs = PRINTED.findall(output)
        self.left_out = NOT_PRINTED.findall(output)

    def leaves_out(self, key):
        return any(key == name or name.endswith("*") and key.startswith(name[:-1]) for name in self.left_out)


def runs_of(log):
    return {entry.split("\n")[0]: Run(entry) for entry in ENTRY.split(log)[1:]}


def figure_of(key, text):
    """A number; null for an infinite one, which the document shows as nothing (the margin of an error of zero)."""
    try:
        value = float(text)
    except ValueError:
        raise Fault(f"{key}: '{text}' is no number") from None
    if math.isnan(value):
        raise Fault(f"{key}: not a number")
    return None if math.isinf(value) else int(text) if re.fullmatch(r"-?\d+", text) else value


def shown(figures, key, form):
    """Exponents as people write them: 2e-4, not 2e-04."""
    value = figures[key]["value"]
    text = "" if value is None else format(value, form or "")
    return re.sub(r"e([+-])0*(\d*)$", lambda m: f"e{m[1].strip('+')}{m[2]}" if m[2] else "", text)


def wrapped(text):
    """Lines of a paragraph or list item are filled up to the width; other lines are kept."""
    blocks = []
    for line in text.split("\n"):
        kept = not line or line.startswith(("|", "#", "<!--", "    "))
        if not kept and not line.startswith("- ") and blocks and blocks[-1][0]:
            blocks[-1] = (True, blocks[-1][1] + " " + line.strip())
        else:
            blocks.append((not kept, line))
    return "\n".join(textwrap.fill(line, WIDTH, subsequent_indent="  " * line.startswith("- "), break_long_words=False,
                                   break_on_hyphens=False) if prose else line for prose, line in blocks)


def document_of(template, figures):
    missing = sorted({key for key, _ in PLACEHOLDER.findall(template)} - figures.keys())
    if missing:
        raise Fault("\n".join(f"{key}: MEASURED.md.in shows it, measured.json has no such figure" for key in missing))
    text = PLACEHOLDER.sub(lambda match: shown(figures, *match.groups()), template)
    if "{" in text:
        raise Fault(f"MEASURED.md.in: no placeholder: {text[text.index('{'):][:60]}")
    return wrapped(text)


def faults_of_keys(runs, figures, template):
    """Rows that are missing on one of the three sides."""
    rows = {key for key, _ in PLACEHOLDER.findall(template)}
    for name, run in runs.items():
        printed = [key for key, _ in run.pairs]
        for key in sorted(set(printed)):
            if not re.fullmatch(KEY, key):
                yield f"{key}: {name} prints it, but a key is SUBJECT.FIGURE of a-z, 0-9 and _"
            elif key not in rows:
                yield f"{key}: {name} prints it, no row of MEASURED.md.in shows it"
            if printed.count(key) > 1:
                yield f"{key}: {name} prints it {printed.count(key)} times"
            if key in figures and figures[key]["test"] != name:
                yield f"{key}: {name} prints it, by measured.json it is of {figures[key]['test']}"
    for key, row in figures.items():
        run = runs.get(row["test"])
        if run and run.passed and key not in dict(run.pairs) and not run.leaves_out(key):
            yield f"{key}: {row['test']} does not print it any more"
        if key not in rows:
            yield f"{key}: measured.json has it, no row of MEASURED.md.in shows it"


def faults_of_names(figures, template, known):
    """A test that has gone, or that has another name in the document."""
    for name in sorted({row["test"] for row in figures.values()}):
        if name not in known:
            yield f"{name}: measured.json names it, ctest knows no such test"
        if f"`{name}`" not in template:
            yield f"{name}: measured.json has its figures, MEASURED.md.in does not name it"


def faults_of(runs, figures, template, document, known):
    yield from faults_of_keys(runs, figures, template)
    yield from faults_of_names(figures, template, known)
    try:
        if document != document_of(template, figures):
            yield "MEASURED.md: not what MEASURED.md.in and measured.json make; run ./bootstrap measured"
    except Fault as fault:
        yield str(fault)


def updated(figures, runs, date):
    """The figures with those of the runs in the place of their tests' older ones."""
    for name, run in runs.items():
        if not run.passed:
            print(f"measured.py: {name}: failed or skipped, its figures are kept", file=sys.stderr)
            continue
        figures = {key: row for key, row in figures.items() if row["test"] != name or run.leaves_out(key)}
        figures |= {key: {"value": figure_of(key, text), "test": name, "date": date} for key, text in run.pairs}
    return dict(sorted(figures.items()))


def written(figures):
    return "{\n" + ",\n".join(f'"{key}": {json.dumps(row)}' for key, row in figures.items()) + "\n}\n"


def known_tests(build):
    listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    return {test["name"] for test in json.loads(listed.stdout)["tests"]}


def last_runs(build):
    return runs_of((pathlib.Path(build) / "Testing/Temporary/LastTest.log").read_text(errors="replace"))


def stored():
    return json.loads(FIGURES.read_text()) if FIGURES.exists() else {}


def run_and_store(build, names):
    names = names or sorted({row["test"] for row in stored().values()})
    subprocess.run(["ctest", "--test-dir", build, "--no-tests=error", "-V", "-R", f"^({'|'.join(names)})$"],
                   env={**os.environ, **LONG_TABLES}, stderr=subprocess.STDOUT, check=False)
    runs = last_runs(build)
    figures = updated(stored(), runs, datetime.date.today().isoformat())
    FIGURES.write_text(written(figures))
    DOCUMENT.write_text(document_of(TEMPLATE.read_text(), figures))
    return list(faults_of(runs, figures, TEMPLATE.read_text(), DOCUMENT.read_text(), known_tests(build)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", help="the build folder, e.g. build/test")
    parser.add_argument("names", nargs="*", metavar="NAME", help="run these tests instead of all that have figures")
    options = parser.parse_args()
    try:
        faults = run_and_store(options.build, options.names)
    except Fault as fault:
        faults = [str(fault)]
    print("\n".join(faults) or f"MEASURED.md: {len(stored())} figures, its rows are those of the tests", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
