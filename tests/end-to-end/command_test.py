#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command as a whole: help, JSON, exit codes, completion, and a session in files."""
import json
import os
import pathlib
import re
import subprocess

import numpy as np
import soundfile

import tacto

VERBS = ["import", "record", "info", "validate", "spatial", "spectrogram", "render", "demo"]


def every_verb_helps_with_an_example():
    listing, _ = tacto.run("--help")
    for verb in VERBS:
        assert verb in listing
        text, _ = tacto.run(verb, "--help")
        assert f"tactograph {verb}" in text and "Example" in text and "--json" in text, text
    assert "tactograph 0." in tacto.run("--version")[0]


def no_sentence_of_a_help_is_broken():
    """A line that is no row of a list is a whole paragraph: a terminal of any width wraps it."""
    def check(*names):
        text = tacto.run(*names, "--help")[0]
        for line in text.split("\n")[2:]:  # after purpose and usage
            assert not line or line.startswith(" ") or line.endswith((".", ":")), (names, line)
        parts = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.M)
        return re.findall(r"^  ([a-z]+)", parts[1], re.M) if parts else []
    verbs = set(re.findall(r"^  ([a-z-]+) ", tacto.run("--help")[0].split("\nTopics")[0], re.M)) - {"help"}
    parts = {(verb, part) for verb in verbs for part in check(verb)}
    assert ("experiment", "power") in parts, parts
    for names in parts:
        check(*names)


def words_that_are_no_verbs_are_refused():
    for arguments in ([], ["carve"], ["info"], ["info", "--frob"], ["experiment"], ["experiment", "fitt", "x.csv"]):
        _, err = tacto.run(*arguments, code=2)
        assert err.startswith("tactograph: "), err
    for arguments in ([], ["carve"]):
        said = tacto.run(*arguments, code=2)[1]
        assert all(verb in said for verb in VERBS), said


def no_default_is_shown_that_is_none():
    for verb in re.findall(r"^  ([a-z-]+) ", tacto.run("--help")[0], re.M):
        shown = tacto.run(verb, "--help")[0]
        assert not re.search(r"=\[\]|\{false\}|\{true\}|POSITIVE=0|\[1 - \d+\]=0|=\S+( m)? REQUIRED", shown), (verb, shown)


def what_is_missing_is_named():
    """With its description, among them the presets; a misspelt option is named before what it should have been."""
    assert "'--device'" in tacto.run("play", "oak", code=2)[1]
    assert "wiertlewski2011-as-printed" in tacto.run("render", "oak", "--finger-path", "p.csv", "-o", "d.wav", code=2)[1]
    said = tacto.run("play", "oak", "--devic", "sim:", code=2)[1]
    for wrong in (["record", "-d"], ["record", "-device", "sim:"], ["play", "oak", "-device", "sim:"]):
        assert "--device'" in tacto.run(*wrong, code=2)[1], wrong
    assert "'--devic'" in said and "'--device'" in said, said
    assert "--force" not in tacto.run("play", "--help")[0]  # it replaces nothing there, and is hidden


def the_next_command_can_be_run():
    """Also for a name with a space."""
    following = tacto.run_json("record", "-d", "sim:surface=B,speed=50mm/s,seed=2", "--time", "1s", "-o", "a b")["next"]
    environment = {**os.environ, "PATH": f"{pathlib.Path(tacto.COMMAND).parent}:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-c", following], capture_output=True, text=True, env=environment)
    assert done.returncode == 0 and list(pathlib.Path(".").glob("a b*.texture.json")), (following, done)


def json_goes_to_stdout_alone():
    out, _ = tacto.run("record", "-d", "sim:surface=B,speed=50mm/s,seed=2", "--time", "1s", "-o", "b", "--json")
    assert json.loads(out)["frames"] == 10000
    spatial = tacto.run_json("spatial", "b", "-o", "b")
    assert spatial["textures"], spatial
    for name in ("b", "b.texture.json" if len(spatial["textures"]) == 1 else "b-01.texture.json"):
        assert tacto.run_json("info", name)
    assert tacto.run_json("info", "wiertlewski2011")["kind"] == "transducer"


def an_emulated_finger_strokes_for_the_time_asked():
    report = tacto.run_json("record", "-d", "sim:seed=1", "--time", "8s", "-o", "long")
    # Eight strokes, and the beginning of a ninth.
    assert len(report["strokes"]) == 9 and report["times_real_time"] > 0 and f"{report['times_real_time']:.3g} times" in report["pace"], report
    assert report["device"] == "sim:seed=1", report
    tacto.run("record", "-d", "sim:seed=1,strokes=2", "--time", "8s", "-o", "two")
    two, long = (soundfile.read(f"{name}.wav", dtype="int32")[0] for name in ("two", "long"))
    assert np.array_equal(two[:18000], long[:18000])  # the same finger; both have made two strokes by then
    assert len(tacto.run_json("info", "two")["strokes"]) == 2
    assert len(tacto.run_json("record", "-d", "sim:seed=1", "--strokes", "3", "-o", "three")["strokes"]) == 3
    assert {"pace", "times_real_time"}.isdisjoint(tacto.run_json("record", "-d", "sim:seed=1,paced=1", "--time", "0.2s", "-o", "paced"))
    # A replay ends with its recording.
    assert "real time" in tacto.run("record", "-d", "replay:three", "-o", "again")[0]


def a_full_output_is_an_error():
    with open("/dev/full", "w") as full:
        done = subprocess.run([tacto.COMMAND, "info", "wiertlewski2011"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 7 and "stdout" in done.stderr, done


def closed_outputs_get_nothing():
    """Opened files must not get the descriptors of stdout and stderr; otherwise messages would be written between the
    frames."""
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


def complete(*words):
    """bash's completions of the last of the words, which bash itself splits at : and =."""
    script, _ = tacto.run("completion")
    line = " ".join(words)
    broken = [piece for word in words for piece in re.findall(r"[:=]|[^:=]+", word) or [""]]
    quoted = " ".join(f"'{piece}'" for piece in broken)
    probe = script + f"""
compopt() {{ :; }}
COMP_WORDS=({quoted}); COMP_CWORD={len(broken) - 1}; COMP_LINE='{line}'; COMP_POINT={len(line)}
_tactograph; printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    return subprocess.run(["bash", "-c", probe], capture_output=True, text=True, check=True).stdout.split()


def completion_offers_values():
    assert complete("tactograph", "ctl", "st") == ["stop", "status"]
    assert "wiertlewski2011" in complete("tactograph", "render", "oak", "--transducer", "wiert")
    assert complete("tactograph", "play", "oak", "--quality", "b") == ["balanced"]
    assert complete("tactograph", "play", "oak", "--gain", "3mm") == ["3mm/N"] and "2x" in complete("tactograph", "play", "oak", "--gain", "2")
    assert complete("tactograph", "record", "-d", "sim:surf") == ["surface=", "surface_seed="]
    assert complete("tactograph", "record", "-d", "sim:surface=C,hyst") == ["C,hysteresis="]
    assert complete("tactograph", "calibrate", "t") == ["tare"]
    assert complete("tactograph", "help", "si") == ["sim"]


def the_nearest_word_is_named():
    for arguments, word in ((["recrod"], "record"), (["spectogram"], "spectrogram"), (["record", "--tiem", "1s"], "--time"),
                            (["play", "x", "-d", "sim:", "--quality", "balnced"], "balanced"), (["ctl", "stpo"], "stop"),
                            (["record", "-d", "sim:sureface=A", "-o", "a"], "surface"), (["help", "sin"], "sim"), (["experiment", "fitt", "x.csv"], "fit")):
        _, err = tacto.run(*arguments, code=2)
        assert f"did you mean '{word}'?" in err and err.count("\n") == 1, (arguments, err)
    assert "did you mean" not in tacto.run("carve", code=2)[1]


def errors_are_json_where_the_result_is():
    pathlib.Path("torn.json").write_text("{")
    for arguments, code in ((["info", "nowhere"], 3), (["info", "torn.json"], 4), (["carve"], 2), (["info", "--frob"], 2),
                            (["record", "-d", "sim:speed=3", "-o", "a"], 2)):
        out, err = tacto.run(*arguments, "--json", code=code)
        error = json.loads(err)
        assert not out and set(error) == {"what", "where", "remedy", "exit_code"}, err
        assert error["exit_code"] == code and error["what"], error


def help_begins_with_the_usual_options():
    for verb in VERBS + ["play", "explain", "identify", "ctl", "sheet", "compare", "certify", "trade"]:
        text, _ = tacto.run(verb, "--help")
        options = text.split("\n\nExample:")[0]
        blocks = [block for block in options.split("\n\n") if re.search("^  -", block, re.M)]
        first = re.findall(r"^  -", blocks[0], re.M)
        assert 1 <= len(first) <= 10, (verb, text)
        everything = re.findall(r"^  -", options, re.M)
        if len(everything) > 10:
            assert blocks[0].startswith("Usual options:") and len(blocks) > 1, (verb, text)
    assert "hysteresis" in tacto.run("help", "sim")[0] and "um" in tacto.run("help", "units")[0]
    assert tacto.run("help", "record")[0] == tacto.run("record", "--help")[0]
    assert "sim" in tacto.run("help")[0] and all(f"\n  {verb} " in tacto.run("help")[0] for verb in VERBS)


if __name__ == "__main__":
    for test in (every_verb_helps_with_an_example, no_sentence_of_a_help_is_broken, words_that_are_no_verbs_are_refused, no_default_is_shown_that_is_none, what_is_missing_is_named, the_next_command_can_be_run, json_goes_to_stdout_alone,
                 an_emulated_finger_strokes_for_the_time_asked,
                 a_full_output_is_an_error, closed_outputs_get_nothing, bash_completes,
                 completion_offers_values, the_nearest_word_is_named, errors_are_json_where_the_result_is,
                 help_begins_with_the_usual_options):
        tacto.in_folder(test)
