#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A recording over the kernel's USB, with libusb on one side and the gadget on the other, and a drive in the other
direction at the same time: nothing is lost or changed. The device plays a recording made here; the guest's recording
must be equal to the bit.
"""
import json
import os
import pathlib
import sys

import numpy as np
import soundfile

import tacto
import virtual_machine

TIME_S = int(os.environ["TACTO_USB_SECONDS"])


def frames_of(name):
    return soundfile.read(name, dtype="int32", always_2d=True)[0]


def recorded_bit_for_bit():
    tacto.run("record", "-d", "sim:surface=E,strokes=40,seed=3", "-o", "source", "--time", f"{TIME_S + 2}s")
    results = pathlib.Path("results")
    results.mkdir()
    said = virtual_machine.run("recording.sh", results.resolve(), timeout_s=TIME_S + 150, GADGET=os.environ["GADGET"],
                               USB_LINK=os.environ["USB_LINK"], SOURCE=pathlib.Path("source").resolve(),
                               SECONDS_WANTED=TIME_S)
    print(said)
    source, got = frames_of("source.wav"), frames_of(results / "oak.wav")
    assert got.shape == (TIME_S * 10000, 4), got.shape
    assert np.array_equal(got, source[:len(got)]), "other codes than the device had"
    side = json.loads((results / "oak.json").read_text())
    assert not side.get("gaps") and not side.get("ended"), side
    tacto.run("validate", results / "oak")
    print(f"{len(got)} frames of {got.shape[1]} channels, the same to the bit")


if __name__ == "__main__":
    try:
        tacto.in_folder(recorded_bit_for_bit)
    except virtual_machine.GuestFailed as failed:
        sys.exit(f"FAILED: {failed}")
