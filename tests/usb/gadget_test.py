#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The gadget on a kernel: what the host's kernel reports of it at each speed; its life cycle and its refusals."""
import json
import os
import pathlib
import sys

import numpy as np
import soundfile

import tacto
import virtual_machine

SPEEDS = {"full": ("12", 64), "high": ("480", 512), "super": ("5000", 1024)}


def run(script, timeout_s):
    tacto.run("record", "-d", "sim:surface=E,seed=3", "-o", "source", "--time", "2s")
    results = pathlib.Path("results")
    results.mkdir()
    said = virtual_machine.run(script, results.resolve(), timeout_s, TACTOGRAPH=tacto.COMMAND, GADGET=os.environ["GADGET"],
                               SOURCE=pathlib.Path("source").resolve(), KERNEL=virtual_machine.KERNEL)
    print(said, (results / "gadget.log").read_text(), sep="\n")
    return results


def frames_of(name):
    return soundfile.read(name, dtype="int32", always_2d=True)[0]


def seen_at_each_speed():
    results = run("enumeration.sh", 150)
    found = [row for row in json.loads((results / "scan.json").read_text())["devices"] if row["uri"].startswith("usb:")]
    assert len(found) == 1 and found[0]["serial"] == "at-high", found
    assert found[0]["name"] == "replay of source" and found[0]["channels"] == 4, found
    source = frames_of("source.wav")
    for name, (speed, packet) in SPEEDS.items():
        lines = (results / f"{name}.txt").read_text().splitlines()
        wanted = ["idVendor 1209", "idProduct 0001", f"serial at-{name}", f"speed {speed}", "bNumConfigurations 1",
                  "bInterfaceClass ff", "bInterfaceSubClass 54", "bInterfaceProtocol 01", "bNumEndpoints 02",
                  "interface tactograph wire 1", f"endpoint in Bulk {packet}", f"endpoint out Bulk {packet}"]
        assert sorted(lines) == sorted(wanted), (lines, wanted)
        got = frames_of(results / f"{name}.wav")
        assert got.shape == (10000, 4) and np.array_equal(got, source[:10000]), f"{name} speed: other codes"


def lives_and_refuses():
    run("life.sh", 200)


if __name__ == "__main__":
    try:
        for test in (seen_at_each_speed, lives_and_refuses):
            tacto.in_folder(test)
    except virtual_machine.GuestFailed as failed:
        sys.exit(f"FAILED: {failed}")
