#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command on a serial port: tactograph-gadget serves an emulated board on a pseudo-terminal, as a program of its own.

A recording over the line equals the one of the same emulation in the process, bit for bit; what damages it becomes gaps
with their counts. Usage: tty_command_test.py TACTOGRAPH-GADGET FAULTY-GADGET
"""
import contextlib
import fcntl
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import soundfile

import tacto

GADGET, FAULTY = sys.argv[1:3]
USAGE, NOT_FOUND, UNSUITABLE, OTHER_VERSION, CANNOT_WRITE, DEVICE = 2, 3, 5, 6, 7, 8
BOARD = "sim:surface=E,speed=50mm/s,seed=3,strokes=2,rate=2kHz"


@contextlib.contextmanager
def board(name, uri, *faults):
    """The port `name`, for as long as the block runs. The link to it is made when the port is ready."""
    program = [FAULTY, *faults] if faults else [GADGET]
    served = subprocess.Popen([*program, "--pty", name, "--board", uri], stderr=subprocess.PIPE, text=True)
    latest = time.monotonic() + 60
    while not os.path.islink(name):
        assert served.poll() is None and time.monotonic() < latest, served.communicate()
        time.sleep(0.01)
    try:
        yield
    finally:
        served.terminate()
        _, said = served.communicate(timeout=60)
    assert served.returncode == 0, said
    assert not os.path.islink(name)


def codes(name):
    return soundfile.read(f"{name}.wav", dtype="int32", always_2d=True)[0]


def header(name):
    return json.loads(pathlib.Path(f"{name}.json").read_text())


def a_recording_equals_the_emulation():
    with board("cable", BOARD):
        tacto.run("record", "-d", "tty:cable", "--time", "1.5s", "-o", "wired")
        report = tacto.run_json("doctor", "-d", "tty:cable,baud=3000000")
    tacto.run("record", "-d", BOARD, "--time", "1.5s", "-o", "here")
    assert len(codes("wired")) >= 3000 and not header("wired").get("gaps"), header("wired")
    assert np.array_equal(codes("wired")[:3000], codes("here")[:3000])
    assert header("wired")["channels"] == header("here")["channels"]
    assert report["can_record"], report
    assert report["next"].split()[:2] == ["tactograph", "calibrate"] or "tty:cable,baud=3000000" in report["next"], report


def damage_is_a_gap():
    """The frames of each gap are missing, and all others are those of the emulation."""
    for name, fault in (("corrupt", "corrupt-every=20"), ("cut", "truncate-every=20"), ("lost", "drop-every=20")):
        with board(name, BOARD, fault):
            tacto.run("record", "-d", f"tty:{name}", "--time", "1s", "-o", name + "-refused", code=DEVICE)
            tacto.run("record", "-d", f"tty:{name}", "--time", "1s", "-o", name, "--allow-gaps")
        got, gaps = codes(name), header(name)["gaps"]
        assert sum(gap["count"] for gap in gaps) >= 5 * 16, gaps
        present = np.ones(len(got) + sum(gap["count"] for gap in gaps), bool)
        for gap in gaps:
            present[gap["device_sequence"] - gap["count"]:gap["device_sequence"]] = False
        assert np.count_nonzero(present) == len(got)
        wanted = codes("here")[:len(present)]
        assert np.array_equal(got, wanted[present[:len(wanted)]]), fault


def an_unplugged_board_keeps_what_came():
    with board("pulled", BOARD, "unplug-after=60"):
        _, error = tacto.run("record", "-d", "tty:pulled", "--time", "5s", "-o", "pulled", code=DEVICE)
    assert "unplugged" in error, error
    got = codes("pulled")
    assert 0 < len(got) < 10000 and np.array_equal(got, codes("here")[:len(got)]), len(got)


def refused(code, *arguments, says=()):
    _, error = tacto.run("record", "--time", "1s", "-o", "none", "-d", *arguments, code=code)
    assert all(word in error for word in says), error
    assert not pathlib.Path("none.wav").exists() and not pathlib.Path("none.json").exists()


def what_cannot_be_recorded_is_refused():
    # 4 channels in messages of 16 frames: 18.5 bytes a frame; 0.9 * 11520 / 18.5 = 560.4, 0.9 * 300000 / 18.5 = 14594.
    with board("slow", "sim:surface=E"):
        refused(UNSUITABLE, "tty:slow,baud=115200", says=["560 Hz"])
        other = os.open("slow", os.O_RDWR | os.O_NOCTTY)
        fcntl.flock(other, fcntl.LOCK_EX)
        refused(DEVICE, "tty:slow", says=["another program", f"(process {os.getpid()})"])
        os.close(other)
        tacto.run("record", "--time", "0.1s", "-o", "fast", "-d", "tty:slow,baud=3000000")
        again = subprocess.run([GADGET, "--pty", "slow"], capture_output=True, text=True, timeout=60)
        assert again.returncode == CANNOT_WRITE, again
    with board("newer", BOARD, "version=2.0"):
        refused(OTHER_VERSION, "tty:newer", says=["2.0"])
    with board("minor", BOARD, "version=1.4"):
        said = tacto.run("record", "-d", "tty:minor", "--time", "0.5s", "-o", "minor")[1]
        assert sum("tty:minor" in line and "1.4" in line for line in said.splitlines()) == 1, said
    refused(NOT_FOUND, "tty:absent", says=["absent"])
    refused(USAGE, "tty:absent,baud=12345", says=["115200"])
    refused(USAGE, "tty:here.wav", says=["here.wav"])
    absent = json.loads(tacto.run("doctor", "-d", "tty:absent", "--json", code=DEVICE)[0])
    states = {row["check"]: row["state"] for row in absent["checks"]}
    assert states["device"] == "FAILS" and states["permission"] == "skipped", absent


def another_program_is_shown_by_its_bytes():
    main, port = os.openpty()
    arduino = subprocess.Popen(["sh", "-c", "while sleep 0.02; do echo temp 21; done"], stdout=main)
    try:
        refused(DEVICE, f"tty:{os.ttyname(port)}", says=["temp 21"])
    finally:
        arduino.terminate()
        arduino.wait()


def test():
    for step in (a_recording_equals_the_emulation, damage_is_a_gap, an_unplugged_board_keeps_what_came,
                 what_cannot_be_recorded_is_refused, another_program_is_shown_by_its_bytes):
        step()


tacto.in_folder(test)
