#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo: the commands that its page shows make its files; the page needs no other files and is said to be simulated."""
import html.parser
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import time
import urllib.parse

import tacto
from measured import measured


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.pictures = [], 0

    def handle_starttag(self, tag, attributes):
        self.pictures += tag in ("img", "svg")
        self.links += [v for k, v in attributes if k in ("src", "href") and not v.startswith(("data:", "#"))]


def error_db(stem):
    details = json.loads(pathlib.Path(f"{stem}.results.json").read_text())["details"]
    return next(row["error_db"] for row in details["fidelity"] if row["tray"] == "ideal")


def demo_makes_its_page():
    report = tacto.run_json("demo", "-o", "shown")
    assert report["simulated"] and len(report["commands"]) == 21, report
    for name in "ABCDE":
        print(f"{name}: displacement error {error_db(f'shown/{name}'):.1f} dB")
        measured(f"demo.error_{name.lower()}_db", error_db(f"shown/{name}"))
        assert error_db(f"shown/{name}") < -40
        tacto.run("validate", *(f"shown/{name}.{ending}" for ending in ("json", "texture.json", "results.json")))
    page_text = pathlib.Path("shown/index.html").read_text()
    megabytes = pathlib.Path("shown/index.html").stat().st_size / 1e6
    print(f"the page: {megabytes:.2f} MB")
    assert megabytes < 3 and "\u2026" not in urllib.parse.unquote(page_text), "all titles are whole"
    page = Page()
    page.feed(page_text)
    assert page.pictures >= 10 and not page.links, page.links
    assert not re.search(r"https?://(?!www\.w3\.org)", page_text)
    for command in report["commands"]:
        assert html.escape(command, quote=True).replace("&#x27;", "'") in page_text.replace("&#39;", "'"), command


def the_commands_by_hand_make_the_same_files():
    commands = tacto.run_json("demo", "-o", "shown")["commands"]
    os.rename("shown", "first")
    for command in commands:
        program, *words = shlex.split(command)
        assert program == "tactograph"
        tacto.run(*words)
    made = sorted(path.name for path in pathlib.Path("shown").iterdir())
    assert made == sorted(path.name for path in pathlib.Path("first").iterdir() if path.name != "index.html")
    for name in made:  # all others contain the time at which they were made
        if name.endswith((".wav", ".png")):
            assert pathlib.Path("shown", name).read_bytes() == pathlib.Path("first", name).read_bytes(), name


def demo_may_be_repeated():
    tacto.run("demo", "-o", "two words")
    tacto.run("demo", "-o", "two words")


def ctrl_c_in_its_first_recording_ends_it():
    """`record` takes Ctrl-C as the end of its recording; the demo must not go on with a recording that is too short."""
    process = subprocess.Popen([tacto.COMMAND, "demo", "-o", "stopped"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not pathlib.Path("stopped/A.wav").exists() and process.poll() is None:
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    process.communicate()
    assert process.returncode == -signal.SIGINT, process.returncode
    assert not pathlib.Path("stopped/index.html").exists()


if __name__ == "__main__":
    for test in (demo_makes_its_page, the_commands_by_hand_make_the_same_files, demo_may_be_repeated,
                 ctrl_c_in_its_first_recording_ends_it):
        tacto.in_folder(test)
