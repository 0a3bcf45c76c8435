#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command as a whole: help, JSON, exit codes, completion, and a session in files."""
import json
import pathlib
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


def closed_outputs_get_nothing():
    """The files that are opened must not take the numbers of stdout and stderr, or words land among the frames."""
    def in_shell(redirected, *arguments):
        return subprocess.run(["bash", "-c", f'exec {redirected}; exec "$@"', "-", tacto.COMMAND, *arguments]).returncode
    tacto.run("record", "-d", "sim:seed=1", "-o", "open", "--time", "0.3s")
    for name, redirected in (("closed", "0<&- 1>&- 2>&-"), ("full", "1>/dev/null 2>/dev/full")):
        code = in_shell(redirected, "record", "-d", "sim:paced=1,seed=1", "-o", name, "--time", "0.3s")
        assert code == 0, (name, code)
        tacto.run("validate", name)
        assert pathlib.Path(f"{name}.wav").read_bytes() == pathlib.Path("open.wav").read_bytes(), name
        assert in_shell(redirected, "validate", name) == 0
        assert in_shell(redirected, "info", "nowhere") == 3


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
                 a_full_output_is_an_error, closed_outputs_get_nothing, bash_completes):
        tacto.in_folder(test)
