#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command as a whole: help, JSON, exit codes, completion, and a session in files."""
import json
import subprocess

import tacto

VERBS = ["import", "record", "info", "validate", "spatial", "spectrogram", "render", "demo"]


def every_verb_helps_with_an_example():
    listing, _ = tacto.run("--help")
    for verb in VERBS:
        assert verb in listing
        text, _ = tacto.run(verb, "--help")
        assert f"tactograph {verb}" in text and "Example" in text and "--json" in text, text
    assert "tactograph 0." in tacto.run("--version")[0]


def words_that_are_no_verbs_are_refused():
    for arguments in ([], ["carve"], ["info"], ["info", "--frob"]):
        _, err = tacto.run(*arguments, code=2)
        assert err.startswith("tactograph: "), err


def json_goes_to_stdout_alone():
    out, _ = tacto.run("record", "-d", "sim:surface=B,speed=50mm/s,seed=2", "--time", "1s", "-o", "b", "--json")
    assert json.loads(out)["frames"] == 10000
    spatial = tacto.run_json("spatial", "b", "-o", "b")
    assert spatial["textures"], spatial
    for name in ("b", "b.texture.json" if len(spatial["textures"]) == 1 else "b-01.texture.json"):
        assert tacto.run_json("info", name)
    assert tacto.run_json("info", "wiertlewski2011")["kind"] == "transducer"


def a_full_output_is_an_error():
    with open("/dev/full", "w") as full:
        done = subprocess.run([tacto.COMMAND, "info", "wiertlewski2011"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 7 and "stdout" in done.stderr, done


def bash_completes():
    script, _ = tacto.run("completion")
    probe = script + """
complete_words() { COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tactograph 2>/dev/null; echo "${COMPREPLY[*]}"; }
complete_words tactograph sp
complete_words tactograph render --tra
"""
    said = subprocess.run(["bash", "-c", probe], capture_output=True, text=True, check=True).stdout.split("\n")
    assert said[0].split() == ["spatial", "spectrogram"], said
    assert said[1].split() == ["--transducer"], said


if __name__ == "__main__":
    for test in (every_verb_helps_with_an_example, words_that_are_no_verbs_are_refused, json_goes_to_stdout_alone,
                 a_full_output_is_an_error, bash_completes):
        tacto.in_folder(test)
