#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of tactograph open in other programs that users have: soundfile, sox, Octave, xarray."""
import subprocess

import numpy as np
import soundfile

import tacto


def said(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def octave(script):
    return said("octave", "--no-gui", "--no-window-system", "--quiet", "--eval", script)


def recording_opens_elsewhere():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "1s", "-o", "oak")
    codes, rate = soundfile.read("oak.wav", dtype="int32")
    assert rate == 10000 and codes.shape[0] == 10000 and soundfile.info("oak.wav").subtype == "PCM_32"
    assert said("sox", "--info", "-r", "oak.wav").strip() == "10000"
    assert said("sox", "--info", "-s", "oak.wav").strip() == "10000"
    rows = octave("[x, fs] = audioread('oak.wav', 'native'); printf('%d %d %d', rows(x), fs, sum(double(x(:, 1))))").split()
    assert [int(float(r)) for r in rows] == [10000, 10000, int(codes[:, 0].astype(np.int64).sum())], rows


def texture_is_counted_in_metres():
    tacto.run("record", "-d", "sim:surface=C,speed=50mm/s,seed=1", "--time", "1s", "-o", "oak")
    tacto.run("spatial", "oak", "-o", "fine", "--stroke", "1")
    tacto.run("spatial", "oak", "-o", "coarse", "--stroke", "1", "--grid", "4um")
    assert soundfile.info("fine.texture.wav").samplerate == 1000000
    assert soundfile.info("coarse.texture.wav").samplerate == 250000
    assert float(said("sox", "--info", "-r", "fine.texture.wav")) == 1e6  # sox prints 1e+06
    assert octave("[x, fs] = audioread('fine.texture.wav'); printf('%d', fs)").strip() == "1000000"


def texture_file_is_reproducible():
    for name in ("one", "two"):
        tacto.run("record", "-d", "sim:surface=D,speed=50mm/s,seed=7", "--time", "1s", "-o", name)
    with open("one.wav", "rb") as one, open("two.wav", "rb") as two:
        assert one.read() == two.read()


if __name__ == "__main__":
    for test in (recording_opens_elsewhere, texture_is_counted_in_metres, texture_file_is_reproducible):
        tacto.in_folder(test)
