#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`record --commands`: another program sets marks with labels and ends the recording, by lines and by the Python client."""
import json
import pathlib
import subprocess
import sys

import tacto

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "data-schema/python"))
PACED = ("-d", "sim:paced=1", "--allow-gaps")


def started(*arguments):
    process = subprocess.Popen([tacto.COMMAND, "record", *arguments, "--commands", "--json"], text=True,
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert json.loads(process.stdout.readline()) == {"event": "recording"}
    return process


def asked(process, line):
    process.stdin.write(line + "\n")
    process.stdin.flush()
    return json.loads(process.stdout.readline())


def stored(name):
    return json.loads(pathlib.Path(f"{name}.json").read_text())


def marks_by_lines():
    process = started(*PACED, "-o", "oak")
    first = asked(process, "mark go left")
    wrong = asked(process, "makr x")
    assert wrong["event"] == "error" and "stop" in wrong["remedy"], wrong
    assert asked(process, "mark ")["event"] == asked(process, "start")["event"] == asked(process, "m" * 5000)["event"] == "error"
    second = asked(process, "mark Rücken")
    out, err = process.communicate("stop\nmark too late\n", timeout=600)
    report, header = json.loads(out), stored("oak")
    assert process.returncode == 0 and report["marks"] == 2, (report, err)
    assert header["marks"] == [{"frame": mark["frame"], "label": mark["label"]} for mark in (first, second)], header["marks"]
    assert [mark["label"] for mark in header["marks"]] == ["go left", "Rücken"]
    for mark in (first, second):
        lost = sum(gap["count"] for gap in header.get("gaps", []) if gap["frame"] <= mark["frame"])
        assert abs(mark["time_s"] - (mark["frame"] + lost) / header["sample_rate_hz"]) < 1e-9, mark
    assert first["frame"] < second["frame"] <= report["frames"]
    tacto.run("validate", "oak")


def it_ends_with_the_program_that_steers_it():
    process = started(*PACED, "-o", "oak")
    asked(process, "mark go")
    process.stdin.close()
    report = json.loads(process.stdout.read())
    assert process.wait(timeout=600) == 0 and report["marks"] == 1, report
    tacto.run("validate", "oak")


def a_stop_at_once_leaves_a_recording():
    done = subprocess.run([tacto.COMMAND, "record", *PACED, "-o", "oak", "--commands"], input="stop\n", text=True, capture_output=True, timeout=600)
    assert done.returncode == 0 and tacto.run_json("info", "oak")["frames"] > 0, done
    tacto.run("record", *PACED, "-o", "oak", "--commands", code=2)


def the_python_client():
    import tactograph
    with tactograph.Recorder("oak", *PACED, "--subject", "S01", command=tacto.COMMAND) as recorder:
        go = recorder.mark("go")
        try:
            recorder.mark("")
            raise AssertionError("an empty label was taken")
        except tactograph.RecorderProblem:
            pass
    header = stored("oak")
    assert recorder.report["frames"] == tacto.run_json("info", "oak")["frames"] and header["subject"] == "S01"
    assert header["marks"] == [{"frame": go["frame"], "label": "go"}], header["marks"]
    try:
        tactograph.Recorder("oak", *PACED, command=tacto.COMMAND)
        raise AssertionError("a recording was replaced")
    except tactograph.RecorderProblem as problem:
        assert problem.exit_code == 2 and "oak" in str(problem), problem
    ended = tactograph.Recorder("short", "-d", "sim:", "--time", "0.1s", command=tacto.COMMAND)
    try:
        while True:
            ended.mark("x")  # the emulated device is faster than real time
    except tactograph.RecorderProblem:
        assert ended.stop()["frames"] == tacto.run_json("info", "short")["frames"] == 1000


if __name__ == "__main__":
    for test in (marks_by_lines, it_ends_with_the_program_that_steers_it, a_stop_at_once_leaves_a_recording,
                 the_python_client):
        tacto.in_folder(test)
