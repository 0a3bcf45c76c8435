#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faults on a real kernel's USB end in the stated gap or error, within the stated time, and the recording contains
exactly the device's frames: each is compared with the recording that the device plays, at the position that follows
from the gaps.
"""
import json
import os
import pathlib
import shutil
import sys
import tempfile

import numpy as np
import soundfile

import tacto
import virtual_machine

RATE_HZ = 10000
SOURCE_S = 12
BLOCK = 32  # frames in a message at this rate
SLOW_S = 10  # additional time for an emulated machine that shares its processor
SILENCE_S = 1  # firmware-host/DECISIONS.md: a silent stream, or a device that accepts nothing
RESULTS = pathlib.Path(tempfile.mkdtemp(prefix="tacto-usb-faults-"))


def text(name):
    return (RESULTS / name).read_text()


def code(name):
    return int(text(f"{name}.code"))


def check_frames(name):
    """Checks that every frame is the device's and that the gaps account for all others; returns the sidecar."""
    assert text(f"{name}.valid").endswith("exit 0\n"), text(f"{name}.valid")
    header = json.loads(text(f"{name}.json"))
    frames = soundfile.read(RESULTS / f"{name}.wav", dtype="int32", always_2d=True)[0]
    source = soundfile.read(RESULTS / "source.wav", dtype="int32", always_2d=True)[0]
    number, missing = np.arange(len(frames)), 0
    for gap in header.get("gaps", []):
        missing += gap["count"]
        number[gap["frame"]:] += gap["count"]
        assert gap["device_sequence"] == gap["frame"] + missing, gap
    wrong = np.flatnonzero((frames != source[number % len(source)]).any(axis=1))
    assert len(wrong) == 0, f"{name}: frame {wrong[0]} of {len(frames)} is not the device's, gaps {header.get('gaps')}"
    assert len(frames) > 0.2 * RATE_HZ, (name, len(frames))
    return header


def expect(name, wanted, *words):
    said = text(f"{name}.err")
    assert code(name) == wanted, f"{name}: exit {code(name)}, wanted {wanted}\n{said}\n{text(f'{name}.out')}"
    for word in words:
        assert word in said + text(f"{name}.out"), f"{name}: '{word}' is not in\n{said}"
    return said


def expect_whole(name):
    expect(name, 0)
    assert "gaps" not in check_frames(name), name


def expect_gaps(name, least, most):
    expect(name, 8, "lost")
    gaps = check_frames(name)["gaps"]
    assert least <= len(gaps) <= most, (name, gaps)
    assert all(gap["count"] % BLOCK == 0 for gap in gaps), gaps
    return gaps


def expect_end(name, why, at_most_s=None):
    """The recording was closed with the reason, and contains the frames before it."""
    expect(name, 8, why)
    header = check_frames(name)
    assert why in header["ended"], header["ended"]
    if at_most_s is not None:
        late = float(text(f"{name}.late"))
        assert late < at_most_s + SLOW_S, f"{name}: ended {late} s after the fault"
        print(f"  {name}: '{header['ended']}' after {late:.2f} s")


def sound_device():
    scanned = json.loads(text("scan.out"))
    assert scanned["real_devices"] == 1 and scanned["devices"][0]["uri"] == "usb:serial=F1", scanned
    assert scanned["devices"][0]["serial"] == "F1" and scanned["devices"][0]["sample_rate_hz"] == RATE_HZ, scanned
    expect_whole("sound")
    assert json.loads(text("sound.json"))["device"] == "usb:serial=F1"


def who_may_have_it():
    expect_whole("first")
    expect("second", 8, "another program uses the device")
    assert code("denied") == 3 and "60-tactograph.rules" in text("denied.err"), text("denied.err")
    problem = json.loads(text("denied.out"))["devices"][0]["problem"]
    assert "this user may not open the device" in problem, problem
    expect("unnamed", 2, "usb:serial=F1, usb:serial=F2")
    expect_whole("named")
    expect("missing", 3, "no device on USB has the serial number 'F3'")


def unplugging():
    for name in ("unplugged", "unbound", "powerless"):
        expect_end(name, "the device was unplugged", 0)
    expect_whole("replugged")


def disturbances():
    """Gaps are permitted here, but all must be reported, and the recording must continue to its end."""
    for name in ("reset", "held_up"):
        expect_to_go_on(name)
    check_frames("killed")
    expect_whole("after_killed")


def expect_to_go_on(name):
    header = check_frames(name)
    lost = sum(gap["count"] for gap in header.get("gaps", []))
    expect(name, 8 if lost else 0)
    assert "ended" not in header, header
    print(f"  {name}: {lost} frames lost, in {len(header.get('gaps', []))} gaps")


def damaged_frames():
    blocks = 2 * RATE_HZ // BLOCK
    for name in ("corrupt", "dropped", "truncated"):
        gaps = expect_gaps(name, blocks // 40 - 1, blocks // 40 + 1)
        print(f"  {name}: {len(gaps)} gaps of {blocks} messages, each one message")
        assert all(gap["count"] == BLOCK for gap in gaps), gaps
    expect("allowed", 0, "lost")
    assert check_frames("allowed")["gaps"]
    expect_whole("repeated")


def odd_devices():
    expect_whole("packets")
    expect_whole("exact")  # completely full packets, followed by an empty one
    assert "did not stall" not in text("gadget.log")
    expect_to_go_on("stalled")
    expect_end("let_go", "the device was unplugged")
    expect_end("silent", "no frames were received for 1 s")
    expect("deaf", 8, "accepted no data")
    expect("newer", 6, "uses version 2.0 of the protocol", "update tactograph")


CHECKS = {"cable_faults.sh": (sound_device, who_may_have_it, unplugging, disturbances),
          "device_faults.sh": (damaged_frames, odd_devices)}


def main():
    script = sys.argv[1]
    source = "sim:surface=triangle,period=1mm,depth=0.1mm,strokes=20,seed=5"
    tacto.run("record", "-d", source, "-o", RESULTS / "source", "--time", f"{SOURCE_S}s")
    programs = {name: os.environ[name] for name in ("TACTOGRAPH", "GADGET", "FAULTY_GADGET", "USB_RESET")}
    virtual_machine.run(script, RESULTS, 1400, **programs)
    for check in CHECKS[script]:
        check()
        print(f"{check.__name__}: passed")
    shutil.rmtree(RESULTS)


if __name__ == "__main__":
    main()
