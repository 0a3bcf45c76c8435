#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual pages: one for each verb, topic and program, with all that --help prints, without warnings of groff.

usage: man_pages_test.py PROGRAM... (tactographd, tactograph-gadget)
"""
import os
import pathlib
import re
import subprocess
import sys

import tacto

PROGRAMS = sys.argv[1:]


def words(text):
    """Words without the line ends and hyphens' forms by which a page and a help differ."""
    return re.sub(r"\s+", " ", text.replace("\u2010", "-"))


def shown(page):
    environment = {**os.environ, "MANWIDTH": "500", "MANROFFOPT": "", "LC_ALL": "C.UTF-8", "MAN_KEEP_FORMATTING": ""}
    done = subprocess.run(["man", "--warnings", "--no-hyphenation", "--no-justification", "-l", str(page)],
                          capture_output=True, text=True, env=environment)
    assert done.returncode == 0 and not done.stderr, (page, done.stderr)
    return words(done.stdout)


def help_lists():
    """Verbs and topics of `tactograph help`."""
    text, _ = tacto.run("help")
    before, topics = text.split("\nTopics of 'tactograph help':\n")
    return re.findall(r"^  ([a-z][a-z-]*) {2,}\S", before, re.M), re.findall(r"^  ([a-z-]+) {2,}", topics, re.M)


def expect_all_of(help_text, page, name):
    """Each option and argument with its description, the usage and each line of the closing text are in the page."""
    for line in help_text.split("\n"):
        line = re.sub(r"^Usage: ", "", line.strip())
        if line in ("Positionals:", "Example:", "Subcommands:", "Options:") or line.endswith("REQUIRED"):
            continue
        for part in filter(None, re.split(r" {2,}", line)):
            assert words(part.rstrip(":")) in page, (name, part)


def every_verb_has_its_help_in_its_page():
    verbs, _ = help_lists()
    assert len(verbs) > 30 and {"play", "design", "experiment"} <= set(verbs)
    tacto.run("man-pages", "man")
    for verb in verbs:
        page = shown(f"man/man1/tactograph-{verb}.1")
        expect_all_of(tacto.run("help", verb)[0] if verb != "experiment" else tacto.run("experiment", "fit", "--help")[0], page, verb)
    main = shown("man/man1/tactograph.1")
    missing = [verb for verb in verbs if f"tactograph-{verb}(1)" not in main]
    assert not missing, missing


def topics_and_programs_have_pages():
    _, topics = help_lists()
    assert {"devices", "sim", "files", "units", "words"} <= set(topics)
    tacto.run("man-pages", "man", *PROGRAMS)
    for topic in topics:
        expect_all_of(tacto.run("help", topic)[0], shown(f"man/man7/tactograph-{topic}.7"), topic)
    assert {p.name for p in pathlib.Path("man/man8").iterdir()} == {pathlib.Path(p).name + ".8" for p in PROGRAMS}
    for program in PROGRAMS:
        said = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
        name = pathlib.Path(program).name
        expect_all_of(said.replace(f"{name}: ", "", 1).replace("usage: ", ""), shown(f"man/man8/{name}.8"), name)


def the_kinds_of_files_are_listed():
    text, _ = tacto.run("help", "files")
    for kind, name in (("recording", "NAME.wav + NAME.json"), ("texture", "NAME.texture.wav + NAME.texture.json"),
                       ("session", "NAME.session (SESSION.md)"), ("scene", "NAME.scene.json")):
        assert re.search(rf"^  {kind} +{re.escape(name)}$", text, re.M), (kind, text)
    assert not re.search(r"[`\[\]|]", text), text


def each_page_is_found_by_its_name():
    tacto.run("man-pages", "man", *PROGRAMS)
    pages = sorted(pathlib.Path("man").glob("man*/*"))
    found = subprocess.run(["lexgrog", *map(str, pages)], capture_output=True, text=True)
    assert found.returncode == 0 and len(found.stdout.splitlines()) == len(pages), found


def what_is_no_program_of_tactograph_is_refused():
    _, said = tacto.run("man-pages", "man", "/bin/true", code=3)
    assert "/bin/true" in said, said


if __name__ == "__main__":
    for test in (every_verb_has_its_help_in_its_page, topics_and_programs_have_pages, the_kinds_of_files_are_listed,
                 each_page_is_found_by_its_name, what_is_no_program_of_tactograph_is_refused):
        tacto.in_folder(test)
