#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Types the README's first session: each command must exit with 0 and print the lines that follow it.

In the README a line " $ COMMAND" is typed. The lines below it are its output, shortened: each of them must be in the
command's output, with spaces collapsed, up to an ellipsis.
"""
import os
import pathlib
import re
import subprocess

import tacto

README = pathlib.Path(__file__).resolve().parents[2] / "README.md"


def steps(text):
    """(command, expected lines) of the README's session."""
    found = []
    for line in text.split("\n"):
        if line.startswith("    $ "):
            found.append((line[6:], []))
        elif line.startswith("    ") and found and found[-1] is not None:
            found[-1][1].append(line.strip())
        elif found and found[-1] is not None:
            found.append(None)
    return [step for step in found if step]


def folded(text):
    return re.sub(r"\s+", " ", text)


def the_session_prints_what_it_says():
    found = steps(README.read_text(encoding="utf-8"))
    assert len(found) >= 5, f"the README has {len(found)} commands with output"
    assert any(expected for _, expected in found)
    environment = {**os.environ, "PATH": f"{pathlib.Path(tacto.COMMAND).parent}:{os.environ['PATH']}"}
    for command, expected in found:
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment)
        assert done.returncode == 0, (command, done.stdout, done.stderr)
        printed = folded(done.stdout + done.stderr)
        for line in expected:
            for part in filter(None, map(str.strip, line.split("..."))):
                assert folded(part) in printed, f"{command}\ndoes not print: {part}\nbut:\n{done.stdout}{done.stderr}"


if __name__ == "__main__":
    tacto.in_folder(the_session_prints_what_it_says)
