# SPDX-License-Identifier: GPL-3.0-or-later
# What write_recording.cpp wrote, read by soundfile, sox and plain Python: the numbers, the checksum, the header, and that
# a second run a second later gives the same bytes.
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy
import soundfile

FRAMES, CHANNELS = 1000, 3


def written(writer, folder):
    folder.mkdir()
    environment = dict(os.environ, SOURCE_DATE_EPOCH="1709210096")
    subprocess.run([writer, folder], check=True, env=environment)
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def chunks(wav):
    at = 12
    while at + 8 <= len(wav):
        size = int.from_bytes(wav[at + 4:at + 8], "little")
        yield wav[at:at + 4].decode(), size
        at += 8 + size + size % 2
    assert at == len(wav), "the chunks don't add up to the file"


def check_header(wav, sample_bytes):
    assert wav[:4] == b"RIFF" and wav[8:12] == b"WAVE", wav[:12]
    assert int.from_bytes(wav[4:8], "little") == len(wav) - 8
    found = dict(chunks(wav))
    assert found["data"] == FRAMES * CHANNELS * sample_bytes, found
    assert "PEAK" not in found, found


def check_sidecar(files, name):
    sidecar = json.loads(files[name + ".json"])
    assert list(sidecar)[:2] == ["kind", "version"], list(sidecar)
    assert sidecar["data"]["file"] == name + ".wav"
    assert sidecar["data"]["frames"] == FRAMES
    assert sidecar["data"]["sha256"] == hashlib.sha256(files[name + ".wav"]).hexdigest()
    assert sidecar["created"] == "2024-02-29T12:34:56Z"


def check_samples(folder):
    codes = (numpy.arange(FRAMES * CHANNELS, dtype=numpy.uint32) * numpy.uint32(2654435761)).view(numpy.int32)
    codes = codes.reshape(FRAMES, CHANNELS)
    read, rate = soundfile.read(folder / "codes.wav", dtype="int32")
    assert rate == 10000 and numpy.array_equal(read, codes)
    read, rate = soundfile.read(folder / "numbers.wav", dtype="float64")
    assert rate == 10000 and numpy.array_equal(read, codes * 2.0**-40)


def check_sox(folder):
    if shutil.which("soxi") is None:
        return
    for name, bits in (("codes", "32"), ("numbers", "64")):
        path = folder / (name + ".wav")
        for flag, value in (("-r", "10000"), ("-c", "3"), ("-s", "1000"), ("-b", bits)):
            assert subprocess.check_output(["soxi", flag, path], text=True).strip() == value, (name, flag)


with tempfile.TemporaryDirectory() as root:
    first = written(sys.argv[1], pathlib.Path(root, "first"))
    time.sleep(1.1)  # a header with the time of day in it would differ by now
    second = written(sys.argv[1], pathlib.Path(root, "second"))
    assert sorted(first) == ["codes.json", "codes.wav", "numbers.json", "numbers.wav"], sorted(first)
    assert first == second, "equal input gave different files"
    check_header(first["codes.wav"], 4)
    check_header(first["numbers.wav"], 8)
    check_sidecar(first, "codes")
    check_sidecar(first, "numbers")
    check_samples(pathlib.Path(root, "first"))
    check_sox(pathlib.Path(root, "first"))
