#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of verbs: at most 15 lines of 120 columns if a file is written, one line for warnings of one kind."""
import json
import pathlib
import subprocess

import tacto

STROKES = 24


def printed(*arguments, code=0):
    """All lines that a user sees on stdout and stderr."""
    done = subprocess.run([tacto.COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=600)
    assert done.returncode == code, (arguments, done)
    lines = (done.stdout + done.stderr).splitlines()
    # On a terminal the progress of long work is redrawn in place.
    return [line for line in lines if not line.rstrip().endswith(" %")]


def expect_short(*arguments, code=0):
    lines = printed(*arguments, code=code)
    widest = max(lines, key=len)
    print(f"{arguments[0]}: {len(lines)} lines, {len(widest)} columns")
    assert len(lines) <= 15 and len(widest) <= 120, (arguments, len(lines), widest)
    return lines


def make_strokes():
    tacto.run("record", "-d", f"sim:surface=C,speed=50mm/s,seed=1,strokes={STROKES},length=20mm", "--time", "15s", "-o", "many")


def verbs_beside_a_file_are_short():
    make_strokes()
    tacto.run("spatial", "many", "-o", "t")
    textures = sorted(str(path) for path in pathlib.Path(".").glob("t-*.texture.json"))
    assert len(textures) >= 20, textures
    expect_short("record", "-d", "sim:seed=3", "--strokes", "2", "-o", "two")
    expect_short("spatial", "many", "-o", "again")
    expect_short("describe", *textures, "-o", "d.csv")
    expect_short("spectrogram", *textures[:4], "-o", "s.nc")
    expect_short("sheet", *textures[:8], "-o", "s.png")
    expect_short("formants", *textures[:8], "-o", "f")
    expect_short("compare", textures[0], textures[2], "-o", "c.html")
    expect_short("fidelity", textures[0], "-d", "sim:hysteresis=0.16", "-o", "f.html")
    found = expect_short("identify", "-d", "sim:tray_sensor=on", "-o", "bench")
    assert any("verdict" in line for line in found) and any("low of 95" in line for line in found), found
    expect_short("report", ".", "-o", "r.html")
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0\n0.4,0.015\n")
    expect_short("play", textures[0], "-d", "sim:", "--finger-path", "path.csv", "--gain", "0.3mm/N", "-o", "first")
    expect_short("render", textures[0], "--path", "path.csv", "--transducer", "wiertlewski2011", "-o", "drive.wav")
    assert max(map(len, printed("list"))) <= 120 and len(printed("list")) >= 4
    assert max(map(len, printed("info", "many"))) <= 120


def a_long_warning_is_wrapped():
    make_strokes()
    # Named by its stroke, with the number of like ones: 150 columns and more.
    lines = printed("spatial", "many", "--grid", "200um", "-o", "a-project-with-a-rather-long-name-of-its-own")
    at = next(i for i, line in enumerate(lines) if line.startswith("tactograph: warning: "))
    assert max(map(len, lines)) <= 120, max(lines, key=len)
    assert lines[at + 1].startswith("    ") and len(lines[at]) > 60, lines


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
    for test in (verbs_beside_a_file_are_short, a_long_warning_is_wrapped, json_has_what_the_lines_leave_out, like_warnings_are_one_line):
        tacto.in_folder(test)
