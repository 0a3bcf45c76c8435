#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo: five surfaces back and forth, one page that needs no other files and states that it is simulated."""
import html.parser
import pathlib
import re
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


def demo_makes_its_page():
    report = tacto.run_json("demo", "-o", "shown")
    surfaces = {row["surface"]: row for row in report["surfaces"]}
    assert sorted(surfaces) == ["A", "B", "C", "D", "E"]
    for name, row in surfaces.items():
        print(f"{name}: displacement error {row['error_db']:.1f} dB, force {row['force_rms_n'] * 1e3:.1f} mN RMS")
        measured(f"demo.error_{name.lower()}_db", row["error_db"])
        assert row["error_db"] < -30 and row["force_rms_n"] > 1e-4 and row["replay_speed_mps"] != row["record_speed_mps"]
    page_text = pathlib.Path("shown/index.html").read_text()
    megabytes = pathlib.Path("shown/index.html").stat().st_size / 1e6
    print(f"the page: {megabytes:.2f} MB")
    assert megabytes < 3 and "\u2026" not in urllib.parse.unquote(page_text), "all titles are whole"
    page = Page()
    page.feed(page_text)
    assert page.pictures >= 10 and not page.links, page.links
    assert page_text.lower().count("simulated") >= 5 and not re.search(r"https?://(?!www\.w3\.org)", page_text)
    for stem in ("A", "E"):
        tacto.run("validate", f"shown/{stem}.json", f"shown/{stem}.texture.json")


def demo_may_be_repeated():
    tacto.run("demo", "-o", "twice")
    tacto.run("demo", "-o", "twice")


if __name__ == "__main__":
    for test in (demo_makes_its_page, demo_may_be_repeated):
        tacto.in_folder(test)
