#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A long list is in --json in full, and like warnings are one line."""
import json
import pathlib
import subprocess

import tacto

STROKES = 24


def printed(*arguments, code=0):
    """All lines that a user sees on stdout and stderr."""
    done = subprocess.run([tacto.COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=600)
    assert done.returncode == code, (arguments, done)
    return (done.stdout + done.stderr).splitlines()


def make_strokes():
    tacto.run("record", "-d", f"sim:surface=C,speed=50mm/s,seed=1,strokes={STROKES},length=20mm", "--time", "15s", "-o", "many")


def json_has_what_the_lines_leave_out():
    make_strokes()
    tacto.run("spatial", "many", "-o", "t")
    textures = sorted(str(path) for path in pathlib.Path(".").glob("t-*.texture.json"))
    lines = printed("describe", *textures, "-o", "d.csv")
    assert "--json" in lines[-1] and "not shown" in lines[-1], lines
    full = tacto.run_json("describe", *textures, "-o", "e.csv")
    assert len(full["textures"]) == len(textures)


def like_warnings_are_one_line():
    make_strokes()
    asked = ["spatial", "many", "--grid", "200um", "-o", "coarse"]
    said = [line for line in tacto.run(*asked)[1].splitlines() if "warning" in line]
    assert len(said) == 1 and f"of {STROKES} similar ones" in said[0] and "worst" in said[0], said
    out, err = tacto.run(*asked, "--force", "--json")
    warnings = json.loads(out)["warnings"]
    assert len(warnings) == STROKES and err.count("warning") == 1, (warnings, err)


if __name__ == "__main__":
    for test in (json_has_what_the_lines_leave_out, like_warnings_are_one_line):
        tacto.in_folder(test)
