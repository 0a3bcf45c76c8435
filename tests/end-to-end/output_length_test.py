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


def on_a_terminal(rows, columns, *arguments, code=0):
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
    assert process.wait(timeout=600) == code, shown
    return shown.decode().replace("\r", "").splitlines()


def rows_shown(lines):
    """The rows of a table of strokes: they begin with a number."""
    return sum(re.match(r" +\d+ ", line) is not None for line in lines)


def a_pipe_has_all_and_a_terminal_what_fits():
    make_strokes()
    listed = ["spatial", "many", "--list"]
    strokes = len(tacto.run_json(*listed)["strokes"])
    assert strokes >= 20 and rows_shown(printed(*listed)) == strokes
    lines = on_a_terminal(16, 200, *listed)
    shown = rows_shown(lines)
    assert len(lines) <= 15 and 5 <= shown < strokes, lines
    more = re.search(r"and (\d+) more rows", "\n".join(lines))
    assert more and int(more[1]) == strokes - shown and "--rows all" in "\n".join(lines), lines
    assert rows_shown(on_a_terminal(16, 200, *listed, "--rows", "all")) == strokes
    assert rows_shown(on_a_terminal(16, 200, *listed, "--rows", "3")) == rows_shown(printed(*listed, "--rows", "3")) == 3
    for wrong in ("0", "some", "-1", "1.5", "99999999999"):
        printed(*listed, "--rows", wrong, code=2)


def no_column_and_no_value_is_lost_where_a_table_is_too_wide():
    """One row is printed below the other: the same labels and values as in the table."""
    make_strokes()
    listed = ["spatial", "many", "--list"]
    wide, narrow = (on_a_terminal(10_000, columns, *listed) for columns in (400, 60))
    table, blocks = (lines[lines.index("strokes") + 1:] for lines in (wide, narrow))
    assert max(map(len, blocks)) <= 60 < max(map(len, table)), blocks
    assert set(" ".join(table).split()) <= set(" ".join(blocks).split()), (table[:3], blocks[:20])


def what_fails_is_not_hidden():
    """The failure is the last check; a terminal of ten lines shows five rows at most."""
    checked = ["doctor", "-d", "sim:finger=up", "-o", "no/such/folder"]
    rows = tacto.run_json(*checked, code=7)["checks"]
    failed = [row["state"] == "FAILS" for row in rows]
    assert any(failed) and failed == sorted(failed, reverse=True), rows
    shown = " ".join(on_a_terminal(10, 300, *checked, code=7))
    assert "FAILS" in shown, shown


def help_fits_a_terminal():
    """Command lines of the examples stay whole, to be copied."""
    for verb in ("import", "play", "spatial"):
        lines = on_a_terminal(24, 90, verb, "--help")
        assert max(len(line) for line in lines if not line.startswith("  tactograph ")) <= 90, lines
        wide = tacto.run(verb, "--help")[0]
        assert max(map(len, wide.splitlines())) > 90 and " ".join(wide.split()) == " ".join(" ".join(lines).split()), verb


def like_warnings_are_one_line():
    make_strokes()
    asked = ["spatial", "many", "--grid", "200um", "-o", "coarse"]
    said = [line for line in tacto.run(*asked)[1].splitlines() if "warning" in line]
    assert len(said) == 1 and f"of {STROKES} similar ones" in said[0] and "worst" in said[0], said
    out, err = tacto.run(*asked, "--force", "--json")
    warnings = json.loads(out)["warnings"]
    assert len(warnings) == STROKES and err.count("warning") == 1, (warnings, err)


if __name__ == "__main__":
    for test in (a_pipe_has_all_and_a_terminal_what_fits, no_column_and_no_value_is_lost_where_a_table_is_too_wide,
                 what_fails_is_not_hidden, help_fits_a_terminal, like_warnings_are_one_line):
        tacto.in_folder(test)
