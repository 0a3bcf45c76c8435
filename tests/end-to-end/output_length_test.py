#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Output is whole in a pipe; on a terminal long tables stop and say so; like warnings are one line."""
import contextlib
import fcntl
import json
import os
import pathlib
import pty
import re
import struct
import subprocess
import termios

import tacto

STROKES = 24


def printed(*arguments, code=0):
    """All lines that a user sees on stdout and stderr."""
    done = subprocess.run([tacto.COMMAND, *map(str, arguments)], capture_output=True, text=True, timeout=600)
    assert done.returncode == code, (arguments, done)
    return (done.stdout + done.stderr).splitlines()


def make_strokes():
    tacto.run("record", "-d", f"sim:surface=C,speed=50mm/s,seed=1,strokes={STROKES},length=20mm", "--time", "15s", "-o", "many")


def on_a_terminal(rows, columns, *arguments):
    """The lines that the command prints on a terminal of that size; stderr goes elsewhere."""
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    process = subprocess.Popen([tacto.COMMAND, *map(str, arguments)], stdout=its, stderr=subprocess.DEVNULL)
    os.close(its)
    shown = b""
    with contextlib.suppress(OSError):  # EIO: the process has closed the terminal
        while piece := os.read(ours, 65536):
            shown += piece
    os.close(ours)
    assert process.wait(timeout=600) == 0, shown
    return shown.decode().replace("\r", "").splitlines()


def rows_shown(lines, stems):
    """How many of the stems stand in the lines."""
    return sum(any(re.search(rf"\b{re.escape(stem)}\b", line) for line in lines) for stem in stems)


def a_pipe_has_all_and_a_terminal_what_fits():
    make_strokes()
    tacto.run("spatial", "many", "-o", "t")
    textures = sorted(str(path) for path in pathlib.Path(".").glob("t-*.texture.json"))
    stems = [pathlib.Path(name).name.removesuffix(".texture.json") for name in textures]
    assert len(stems) >= 20, stems
    listed = ["list", "."]
    assert rows_shown(printed(*listed), stems) == len(stems)
    lines = on_a_terminal(16, 200, *listed)
    assert len(lines) <= 15 and 5 <= rows_shown(lines, stems) < len(stems), lines
    more = re.search(r"and (\d+) more rows", "\n".join(lines))
    whole = on_a_terminal(16, 200, *listed, "--rows", "all")
    assert more and "--rows all" in lines[-1] and rows_shown(whole, stems) == len(stems), lines
    assert rows_shown(on_a_terminal(16, 200, *listed, "--rows", "3"), stems) <= 3 and rows_shown(printed(*listed, "--rows", "3"), stems) <= 3
    for wrong in ("0", "some", "-1", "1.5", "99999999999"):
        printed(*listed, "--rows", wrong, code=2)


def no_column_and_no_word_is_lost_where_a_table_is_too_wide():
    make_strokes()
    tacto.run("spatial", "many", "-o", "t", "--stroke", "1")
    told = tacto.run_json("info", "many")["strokes"]
    wide, narrow = on_a_terminal(1000, 250, "info", "many"), on_a_terminal(1000, 60, "info", "many")
    assert max(map(len, narrow)) <= 60 and len(narrow) > len(wide), narrow
    words = lambda lines: sorted(set(" ".join(lines[lines.index("strokes"):]).split()))
    missing = set(words(wide)) - set(words(narrow))
    assert not missing and len(told) > 2, missing


def like_warnings_are_one_line():
    make_strokes()
    asked = ["spatial", "many", "--grid", "200um", "-o", "coarse"]
    said = [line for line in tacto.run(*asked)[1].splitlines() if "warning" in line]
    assert len(said) == 1 and f"of {STROKES} similar ones" in said[0] and "worst" in said[0], said
    out, err = tacto.run(*asked, "--force", "--json")
    warnings = json.loads(out)["warnings"]
    assert len(warnings) == STROKES and err.count("warning") == 1, (warnings, err)


if __name__ == "__main__":
    for test in (a_pipe_has_all_and_a_terminal_what_fits, no_column_and_no_word_is_lost_where_a_table_is_too_wide,
                 like_warnings_are_one_line):
        tacto.in_folder(test)
