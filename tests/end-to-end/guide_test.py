#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Executes the commands of analysis/GUIDE.md, in their order and in one folder: each must exit with 0.

Indented lines are shell commands. Those of the section "A real finger" need data that are not part of the project;
without them that section is left out.
"""
import os
import pathlib
import re
import subprocess

import tacto

GUIDE = pathlib.Path(__file__).resolve().parents[2] / "analysis" / "GUIDE.md"


def scripts(text):
    """The indented lines of each section, by its title."""
    found = {}
    for section in re.split(r"^#+ ", text, flags=re.M)[1:]:
        title, *lines = section.splitlines()
        found[title] = "\n".join(line[4:] for line in lines if line.startswith("    "))
    return {title: script for title, script in found.items() if script.strip()}


def the_guide_can_be_followed():
    found = scripts(GUIDE.read_text(encoding="utf-8"))
    assert len(found) >= 5 and sum(script.count("tactograph ") for script in found.values()) >= 25, found
    environment = {**os.environ, "PATH": f"{pathlib.Path(tacto.COMMAND).parent}:{os.environ['PATH']}"}
    real = "A real finger"
    assert real in found
    if tacto.BARE_FINGER.exists():
        pathlib.Path(tacto.BARE_FINGER.name).symlink_to(tacto.BARE_FINGER)
    else:
        print(f"left out, no real data: {real}")
        del found[real]
    for title, script in found.items():
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], capture_output=True, text=True, env=environment)
        assert done.returncode == 0, f"{title}: exit {done.returncode}\n{script}\n{done.stdout}\n{done.stderr}"
    # The period of the demo's surface, 0.5 mm, is a ridge in the band that is valid over the whole stroke.
    texture = tacto.run_json("spatial", "demo/finger", "-o", "again", "--stroke", "1")["textures"][0]
    ridges = [ridge["frequency_per_m"] for ridge in tacto.run_json("formants", "again")["formants"]]
    assert any(abs(ridge - 2000) < 50 for ridge in ridges) and texture["valid_low_per_m"] < 2000 < texture["valid_high_per_m"], (ridges, texture)
    assert tacto.run_json("info", "demo/finger")["simulated"]
    for other, verdict in (("demo/E", "none"), ("demo/D", "different")):
        assert tacto.run_json("compare", other, "again")["beyond_measurement_noise"] == verdict, other


if __name__ == "__main__":
    tacto.in_folder(the_guide_can_be_followed)
