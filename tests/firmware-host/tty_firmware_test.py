#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The firmware of the board stm32f405 in QEMU, through its USART: scan, record, play, replay.

The emulated chip counts its own frames (the codes of the two analogue channels contain the tick), so that each frame is
checked. Losses and bits are judged, never time. Usage: tty_firmware_test.py stm32f405.elf
"""
import contextlib
import os
import re
import subprocess
import sys

import numpy as np
import soundfile

import tacto

IMAGE = sys.argv[1]


@contextlib.contextmanager
def board():
    """The path of the board's serial port."""
    qemu = subprocess.Popen(["qemu-system-arm", "-M", "netduinoplus2", "-display", "none", "-monitor", "none", "-serial", "pty",
                             "-kernel", IMAGE], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        for line in qemu.stdout:
            if found := re.search(r"redirected to (/dev/pts/\d+)", line):
                held = os.open(found[1], os.O_RDWR | os.O_NOCTTY)  # QEMU looks for a reopened port once a second only
                yield found[1]
                os.close(held)
                break
        else:
            raise AssertionError("QEMU names no port")
        assert qemu.poll() is None
    finally:
        qemu.terminate()
        qemu.wait(timeout=60)


def every_frame_comes(port):
    tacto.run("record", "-d", f"tty:{port}", "--time", "2s", "-o", "counted")
    codes = soundfile.read("counted.wav", dtype="int32", always_2d=True)[0]
    ticks = codes[:, 1].view(np.uint32) >> 12
    assert len(codes) >= 4000 and np.all(np.diff(ticks) == 1), codes[:20]
    assert np.all((codes[:, 2].view(np.uint32) >> 12) == (~ticks & 0xFFFFF))
    at = ticks.astype(np.int64) * 20 % 60000
    assert np.array_equal(codes[:, 0], np.where(at < 30000, at, 60000 - at))


def a_texture_replays(port):
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "1s", "-o", "oak")
    tacto.run("spatial", "oak", "-o", "oak", "--stroke", "1")
    played = tacto.run_json("play", "oak", "-d", f"tty:{port}", "--transducer", "wiertlewski2011", "--rate", "2kHz", "--gain", "0.1mm/N",
                            "--interpolation", "sinc", "--time", "1s", "-o", "first")
    print(played)
    assert played["lost_ticks"] == 0 and played["ticks"] >= 2000, played
    assert tacto.run_json("replay", "first")["same_to_the_bit"]


def test():
    with board() as port:
        print(tacto.run("doctor", "-d", f"tty:{port}")[0])
        every_frame_comes(port)
        a_texture_replays(port)


tacto.in_folder(test)
