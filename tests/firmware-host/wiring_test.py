#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Wirings of data acquisition cards: what a file may say, and where an error is; devices comedi: without a card. The
recording itself: tests/usb/comedi_test.py.
"""
import copy
import json
import pathlib

import tacto

GOOD = {
    "kind": "wiring", "version": "1.0", "name": "oak bench", "card": "/dev/nonexistent-comedi0", "rate_hz": 10000,
    "inputs": [
        {"input": 0, "quantity": "tangential_force", "range_v": [-5, 5], "reference": "differential"},
        {"input": 2, "quantity": "position", "range_v": [-10, 10], "reference": "ground", "per_volt": 0.002, "at_zero_volt": 0.01},
    ],
    "output": {"output": 0, "range_v": [-10, 10]}, "watchdog": {"line": 2, "subdevice": 3},
    "transducer": "wiertlewski2011",
}
ENCODER = {"counter": 1, "step_m": 1e-6}

# What is changed (None removes it), where the error has to be, and the exit code.
REFUSED = [
    (("inputs", 1, "per_volt"), None, "#/inputs/1", 5),
    (("inputs", 1, "per_volt"), 0, "#/inputs/1/per_volt", 5),
    (("inputs", 1, "quantity"), "positon", "#/inputs/1/quantity", 5),
    (("inputs", 1, "range_v"), [10, -10], "#/inputs/1/range_v", 5),
    (("inputs", 1, "name"), "tangential_force", "#/inputs/1/name", 5),
    (("inputs", 1, "name"), "a\nb", "#/inputs/1/name", 5),
    (("inputs", 1, "input"), 0, "#/inputs/1/input", 5),
    (("inputs", 1, "reference"), "floating", "#/inputs/1/reference", 4),
    (("inputs", 1, "input"), -1, "#/inputs/1/input", 4),
    (("inputs", 0, "at_zero_volt"), 1, "#/inputs/0/at_zero_volt", 5),
    (("inputs",), [], "#/inputs", 4),
    (("transducer",), None, "#/inputs/0", 5),
    (("output", "range_v"), [-10, 2], "#/output/range_v", 5),
    (("output", "range_v"), [0, 10], "#/output/range_v", 5),
    (("output", "output"), -1, "#/output/output", 4),
    (("output", "limit_v"), 5, "#/output", 4),
    (("encoder",), ENCODER, "#/inputs/1/name", 5),
    (("encoder",), {**ENCODER, "step_m": 0}, "#/encoder/step_m", 4),
    (("watchdog", "line"), None, "#/watchdog", 4),
    (("transducer",), "nosuch", "nosuch", 3),
    (("rate_hz",), 0, "#/rate_hz", 4),
    (("card",), "comedi0", "#/card", 4),
    (("rate",), 1, "#/rate", 4),
    (("version",), "2.0", "bench.wiring.json", 6),
]


def write(body):
    pathlib.Path("bench.wiring.json").write_text(json.dumps(body))


def changed(path, value):
    body = copy.deepcopy(GOOD)
    at = body
    for key in path[:-1]:
        at = at[key]
    if value is None:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return body


def each_fault_has_its_place():
    for path, value, place, code in REFUSED:
        write(changed(path, value))
        error = tacto.error_of("record", "-d", "comedi:bench", "-o", "oak", "--time", "1s", code=code)
        assert place in error["where"], (path, error)
        assert not list(pathlib.Path(".").glob("oak*")), path


def described_and_valid():
    write(GOOD)
    said = tacto.run_json("info", "bench")
    inputs = said["inputs"]
    assert said["drive"].split(",")[0] == "output 0" and said["watchdog"] == "line 2 of subdevice 3" and "encoder" not in said, said
    assert [(row["input"], row["channel"], row["range_to_v"]) for row in inputs] == [(0, "tangential_force", 5), (2, "position", 10)], inputs
    assert inputs[1]["sensor"].split() == ["0.002", "m/V,", "0.01", "m", "at", "0", "V"], inputs
    tacto.run("validate", "bench")
    write(changed(("x_lab",), "7"))
    tacto.run("validate", "bench")


def no_card():
    write(GOOD)
    error = tacto.error_of("record", "-d", "comedi:bench", "-o", "oak", "--time", "1s", code=3)
    assert error["where"] == GOOD["card"] and error["remedy"], error
    tacto.error_of("record", "-d", "comedi:", "-o", "oak", code=2)
    tacto.error_of("record", "-d", "comedi:nosuch", "-o", "oak", code=3)
    checks = {row["check"]: row["state"] for row in tacto.run_json("doctor", "-d", "comedi:bench", code=8)["checks"]}
    assert checks["device"] == "FAILS" and checks["permission"] == "skipped", checks


if __name__ == "__main__":
    tacto.in_folder(each_fault_has_its_place)
    tacto.in_folder(described_and_valid)
    tacto.in_folder(no_card)
