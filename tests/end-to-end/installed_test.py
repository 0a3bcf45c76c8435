#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the packages contain, without making them: manual pages, documents with working links, udev rules, the Python
package.

usage: installed_test.py CMAKE BUILD-FOLDER
"""
import pathlib
import re
import subprocess
import sys

import tacto

CMAKE, BUILD = sys.argv[1:]


def install(component):
    subprocess.run([CMAKE, "--install", BUILD, "--component", component, "--prefix", "usr"], check=True, capture_output=True)
    return pathlib.Path("usr/share/doc") / component


def dead_links(folder):
    for document in folder.rglob("*.md"):
        for link in re.findall(r"\]\(([^)#\s]+)", document.read_text()):
            if "://" not in link and not (document.parent / link).exists():
                yield f"{document.relative_to(folder)}: {link}"


def documents_and_pages_are_installed():
    documents = install("tactograph")
    for name in ("README.md", "analysis/GUIDE.md", "playback/daemon/CONTROL.md", "firmware-host/RIG.md",
                 "firmware-host/core/WIRE.md", "data-schema/SESSION.md", "data-schema/octave/read_tactograph.m",
                 "tactographd.json"):
        assert (documents / name).is_file(), name
    assert not list(dead_links(documents)), list(dead_links(documents))
    pages = {page.name for page in pathlib.Path("usr/share/man").rglob("*.gz")}
    assert {"tactograph.1.gz", "tactograph-play.1.gz", "tactograph-units.7.gz", "tactographd.8.gz",
            "tactograph-gadget.8.gz"} <= pages, pages


# A key of a rule is matched with ==, or set with = or +=.
def udev_rules_are_installed():
    install("tactograph")
    rules = {file.name: file.read_text() for file in pathlib.Path("usr/lib/udev/rules.d").iterdir()}
    assert set(rules) == {"60-tactograph.rules", "61-tactograph-latency.rules", "62-tactograph-serial.rules"}, set(rules)
    for name, text in rules.items():
        lines = [line for line in text.splitlines() if not line.startswith("#")]
        for line in lines:
            assert all(re.fullmatch(r'[A-Z]+(\{\w+\})?(==|=|\+=)"[^"]+"', pair) for pair in line.split(", ")), (name, line)
    assert 'ENV{ID_MM_DEVICE_IGNORE}="1"' in rules["62-tactograph-serial.rules"]


def the_python_package_is_installed_with_its_readme():
    assert "tactograph.Daemon" in (install("python3-tactograph") / "README.md").read_text()
    package = pathlib.Path("usr/lib/python3/dist-packages/tactograph")
    assert {file.suffix for file in package.rglob("*")} == {".py"} and (package / "daemon.py").is_file()


if __name__ == "__main__":
    for test in (documents_and_pages_are_installed, udev_rules_are_installed, the_python_package_is_installed_with_its_readme):
        tacto.in_folder(test)
