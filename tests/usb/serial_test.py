#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Serial ports on a real kernel's USB: the firmware of the board stm32f405 behind QEMU's FTDI adapter (the guest's ftdi_sio),
and the gadget behind a port of the class ACM (cdc_acm). Frames and bits are judged, never time.
Usage: serial_test.py stm32f405.elf
"""
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import soundfile

import tacto
import virtual_machine

sys.path.append(str(pathlib.Path(__file__).parents[1] / "firmware-host"))
from tty_firmware_test import DEVICE, RATE_HZ, is_every_frame_true, make_texture

IMAGE = pathlib.Path(sys.argv[1])
SECONDS = 3


def frames_of(name):
    return soundfile.read(name, dtype="int32", always_2d=True)[0]


def code(results, name):
    return int((results / f"{name}.code").read_text())


def said(results, name):
    return json.loads((results / f"{name}.out").read_text())


def board_and_adapter():
    """The image's USART as a socket, and QEMU's options that put an adapter in front of it."""
    uart = pathlib.Path("uart").resolve()
    board = subprocess.Popen(["qemu-system-arm", "-M", "netduinoplus2", "-display", "none", "-monitor", "none",
                              "-serial", f"unix:{uart},server=on,wait=off", "-kernel", str(IMAGE)], stdin=subprocess.DEVNULL)
    while not uart.exists():
        assert board.poll() is None, "QEMU with the board ended"
        time.sleep(0.01)
    return board, ["-device", "qemu-xhci", "-chardev", f"socket,id=uart,path={uart}", "-device", "usb-serial,chardev=uart"]


def real_devices(results, name):
    return {row["uri"]: row["name"] for row in said(results, name)["devices"] if row["uri"].startswith(("tty:", "usb:"))}


def the_firmware_behind_an_adapter(results):
    """Each frame is true, and each that is missing is in a gap. None is missing unless this computer is too slow: the board has
    a clock of its own."""
    assert real_devices(results, "ftdi_scan") == {"tty:/dev/ttyUSB0": "stm32f405"}, "scan greets other ports than those on USB, or does not find it"
    assert said(results, "ftdi_doctor")["can_record"], said(results, "ftdi_doctor")
    assert code(results, "ftdi_record") in (0, DEVICE), (results / "ftdi_record.err").read_text()
    ticks = is_every_frame_true(frames_of(results / "ftdi.wav"))
    lost = np.diff(ticks.astype(np.int64), prepend=0) - 1
    gaps = json.loads((results / "ftdi.json").read_text()).get("gaps", [])
    assert np.all(lost >= 0) and lost.sum() == sum(gap["count"] for gap in gaps), (lost.sum(), gaps)
    if code(results, "ftdi_record") == 0:
        assert lost.sum() == 0 and len(ticks) >= SECONDS * RATE_HZ, (lost.sum(), len(ticks))
    else:
        print(f"not judged: this computer is too slow for the adapter: {lost.sum()} of {ticks[-1]} frames lost in each of three attempts")
    assert code(results, "ftdi_play") in (0, DEVICE), (results / "ftdi_play.err").read_text()
    assert tacto.run_json("replay", results / "played")["same_to_the_bit"]
    print(f"ftdi_sio: {len(ticks)} frames, {lost.sum()} lost; play ended with {code(results, 'ftdi_play')}")


def the_gadget_behind_an_acm_port(results):
    assert real_devices(results, "both_scan") == {"tty:/dev/ttyACM0": "replay of source", "tty:/dev/ttyUSB0": "stm32f405"}
    for name in ("acm_doctor", "acm_record"):
        assert code(results, name) == 0, (results / f"{name}.err").read_text()
    got = frames_of(results / "acm.wav")
    assert got.shape == (10000, 4) and np.array_equal(got, frames_of("source.wav")[:10000]), "other codes than the board has sent"
    tacto.run("validate", results / "acm")
    assert code(results, "acm_identify") == 0, (results / "acm_identify.err").read_text()
    found = said(results, "acm_identify")
    resonance = next(row for row in found["parameters"] if row["parameter"] == "resonance_hz")
    # As in identify_test.py, whose transducer this is: three half widths of a 95 % interval.
    assert found["verdict"] == "fits" and abs(resonance["value"] - 547.66824) < 1.5 * (resonance["high_of_95"] - resonance["low_of_95"]), resonance
    print(f"cdc_acm: {len(got)} frames of {got.shape[1]} channels, the same to the bit")


def in_guest():
    tacto.run("record", "-d", "sim:surface=E,seed=3", "-o", "source", "--time", "2s")
    for folder in ("results", "textures"):
        pathlib.Path(folder).mkdir()
    make_texture()
    for path in pathlib.Path().glob("oak.*"):
        path.rename(pathlib.Path("textures") / path)
    board, devices = board_and_adapter()
    try:
        print(virtual_machine.run("serial.sh", pathlib.Path("results").resolve(), 400, devices, TACTOGRAPH=tacto.COMMAND, GADGET=os.environ["GADGET"],
                                  SOURCE=pathlib.Path("source").resolve(), TEXTURES=pathlib.Path("textures").resolve(), SECONDS_WANTED=SECONDS))
        assert board.poll() is None, "QEMU with the board ended"
    finally:
        board.kill()
        board.wait()
    results = pathlib.Path("results")
    assert (results / "drivers").read_text() == "ftdi_sio\ncdc_acm\n", "the kernel names other drivers"
    the_firmware_behind_an_adapter(results)
    the_gadget_behind_an_acm_port(results)


if __name__ == "__main__":
    try:
        tacto.in_folder(in_guest)
    except virtual_machine.GuestFailed as failed:
        sys.exit(f"FAILED: {failed}")
