#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tests/measured.py on invented tests: what it stores, what it writes, and each fault that --check finds."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

TOOL = pathlib.Path(__file__).resolve().parents[1] / "measured.py"
TEMPLATE = "# Results\n\nOne of\ntwo: {oak.length_mm:.1f} mm, {oak.count:,} times. `oak`\n\n| ash | {ash.error:.0e} |\n\n`ash`\n"
DOCUMENT = "# Results\n\nOne of two: 2.5 mm, 12,000 times. `oak`\n\n| ash | 2e-4 |\n\n`ash`\n"
OAK = "[measured] oak.length_mm 2.49\\n[measured] oak.count 12000"
ASH = "[measured] ash.error 0.0002"


class Invented:
    """A folder with the tool, its files, and a build whose tests print what they are given."""
    def __init__(self, folder):
        self.folder, self.outputs = pathlib.Path(folder), {"oak": OAK, "ash": ASH}
        shutil.copy(TOOL, self.folder)
        self.write("MEASURED.md.in", TEMPLATE)
        assert not (faults := self.measure("--run", "oak", "ash")), faults

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def read(self, name):
        return (self.folder / name).read_text()

    def build(self, endings=()):
        self.write("CTestTestfile.cmake", "".join(
            f'add_test({name} /usr/bin/printf "{output}\\n")\n' for name, output in self.outputs.items())
            + "".join(f"set_tests_properties({name} PROPERTIES {ending})\n" for name, ending in endings))

    def measure(self, *options):
        """The faults that the tool names; its exit code says whether there are some."""
        self.build()
        done = subprocess.run([sys.executable, self.folder / TOOL.name, self.folder, *options], capture_output=True, text=True)
        faults = "" if done.stderr.startswith("MEASURED.md: ") and done.returncode == 0 else done.stderr.strip()
        assert done.returncode == (1 if faults else 0), done
        return faults

    def test_and_check(self, *endings):
        self.build(endings)
        subprocess.run(["ctest", "--test-dir", self.folder], capture_output=True, check=False)
        return self.measure("--check")


def figures_are_stored_and_the_document_written(invented):
    assert invented.read("MEASURED.md") == DOCUMENT, invented.read("MEASURED.md")
    rows = json.loads(invented.read("measured.json"))
    assert (rows["oak.count"]["value"], rows["oak.count"]["test"]) == (12000, "oak") and len(rows["ash.error"]["date"]) == 10, rows
    invented.outputs["oak"] = OAK.replace("2.49", "3.21")
    assert invented.measure("--run", "oak") == "" and "3.2 mm" in invented.read("MEASURED.md")
    invented.outputs["ash"] = ASH.replace("0.0002", "inf")
    assert invented.measure() == "" and "| ash |  |" in invented.read("MEASURED.md")


def other_figures_are_no_fault(invented):
    invented.outputs["oak"] = OAK.replace("2.49", "9.99")
    assert invented.test_and_check() == "" and invented.read("MEASURED.md") == DOCUMENT


def a_key_without_a_row(invented):
    invented.outputs["oak"] += "\\n[measured] oak.width_mm 1"
    assert invented.test_and_check() == "oak.width_mm: oak prints it, no row of MEASURED.md.in shows it"


def a_row_without_a_figure(invented):
    invented.write("MEASURED.md.in", TEMPLATE + "{oak.width_mm}\n")
    assert invented.test_and_check() == "oak.width_mm: MEASURED.md.in shows it, measured.json has no such figure"


def a_figure_without_a_row(invented):
    invented.write("MEASURED.md.in", TEMPLATE.replace("{oak.count:,}", "many"))
    faults = invented.test_and_check()
    assert "oak.count: oak prints it, no row" in faults and "oak.count: measured.json has it, no row" in faults, faults


def a_key_that_is_not_printed_any_more(invented):
    invented.outputs["oak"] = OAK.split("\\n")[0]
    assert invented.test_and_check() == "oak.count: oak does not print it any more"
    invented.outputs["oak"] += "\\n[not measured] oak.c* no sky"  # for a reason that the test names
    assert invented.test_and_check() == ""


def tests_that_fail_or_are_skipped_or_did_not_run_owe_nothing(invented):
    invented.outputs["oak"] = "skipped: no real data"
    assert invented.test_and_check() == ""
    invented.outputs["oak"] = "broken"
    assert invented.test_and_check(("oak", "WILL_FAIL TRUE")) == ""
    invented.build()
    subprocess.run(["ctest", "--test-dir", invented.folder, "-R", "ash"], capture_output=True, check=True)
    assert invented.measure("--check") == ""


def a_document_written_by_hand(invented):
    invented.write("MEASURED.md", DOCUMENT.replace("2.5", "2.6"))
    assert "MEASURED.md: not what MEASURED.md.in and measured.json make" in invented.test_and_check()


def a_key_of_another_test_or_twice(invented):
    invented.outputs["ash"] += "\\n[measured] oak.count 1"
    assert "oak.count: ash prints it, by measured.json it is of oak" in invented.test_and_check()
    invented.outputs["ash"] = ASH + "\\n" + ASH
    assert invented.test_and_check() == "ash.error: ash prints it 2 times"


def a_test_that_has_gone_or_is_not_named(invented):
    del invented.outputs["ash"]
    assert invented.test_and_check() == "ash: measured.json names it, ctest knows no such test"
    invented.outputs["ash"] = ASH
    invented.write("MEASURED.md.in", TEMPLATE.replace("`ash`", "`elm`"))
    assert "ash: measured.json has its figures, MEASURED.md.in does not name it" in invented.test_and_check()


def what_is_no_figure_or_no_placeholder(invented):
    for value, words in (("many", "'many' is no number"), ("nan", "not a number")):
        invented.outputs["ash"] = ASH.replace("0.0002", value)
        assert invented.measure("--run", "ash") == f"ash.error: {words}"
    invented.outputs["ash"] = ASH
    invented.write("MEASURED.md.in", TEMPLATE + "{Oak}\n")
    assert "no placeholder: {Oak}" in invented.test_and_check()
    invented.write("MEASURED.md.in", TEMPLATE)
    invented.outputs["ash"] += "\\n[measured] Ash 1"
    assert "Ash: ash prints it, but a key is" in invented.test_and_check()


if __name__ == "__main__":
    for test in (figures_are_stored_and_the_document_written, other_figures_are_no_fault, a_key_without_a_row,
                 a_row_without_a_figure, a_figure_without_a_row, a_key_that_is_not_printed_any_more,
                 tests_that_fail_or_are_skipped_or_did_not_run_owe_nothing, a_document_written_by_hand,
                 a_key_of_another_test_or_twice, a_test_that_has_gone_or_is_not_named, what_is_no_figure_or_no_placeholder):
        with tempfile.TemporaryDirectory(prefix="tacto-") as folder:
            test(Invented(folder))
        print(f"{test.__name__}: passed")
