#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions of hours are judged, exported and compared in memory that does not depend on their length.

A session of 20 s in emulated time is extended: the ticks of a whole number of strokes are repeated, with continued
numbers and times, up to hours. So every stroke has a reference in the 20 s.
"""
import csv
import hashlib
import json
import pathlib
import struct
import sys

import numpy as np
import soundfile

import tacto
from play_test import write_grating, write_strokes

RATE_HZ = 2000
CYCLE = 2 * RATE_HZ * 2  # ticks of write_strokes' two seconds, twice
HOURS = 0.25 if tacto.SANITIZED else 2.5
MOST_MB = 96  # a block of 25 s of rows, its spectra, 10,000 strokes and their text
TICK = np.dtype([("ns", "<u4"), ("encoder", "<i4"), ("drive", "<f4"), ("flags", "<u4"), ("lateness", "<i4")])


def sealed(kind, payload):
    check = hashlib.sha256(bytes([kind]) + struct.pack("<I", len(payload)) + payload).digest()[:8]
    return struct.pack("<IB3xI", 0x31534354, kind, len(payload)) + check + payload


def blocks_of(data):
    at = 0
    while at < len(data):
        kind, size = data[at + 4], int.from_bytes(data[at + 8:at + 12], "little")
        yield kind, data[at + 20:at + 20 + size]
        at += 20 + size


def ticks_block(first, ticks):
    ticks = ticks.copy()
    ticks["ns"] = np.arange(len(ticks)) * (1_000_000_000 // RATE_HZ)
    return sealed(1, struct.pack("<QqI", first, first * 1_000_000_000 // RATE_HZ, len(ticks)) + ticks.tobytes())


def write_long(source, target, hours):
    """The session's commands and first 4 s, then the next 4 s repeated."""
    data = pathlib.Path(source).read_bytes()
    ticks = np.concatenate([np.frombuffer(p[20:], TICK) for kind, p in blocks_of(data) if kind == 1])
    begin, cycle = ticks[:CYCLE], ticks[CYCLE:2 * CYCLE]
    count = CYCLE
    with open(target, "wb") as out:
        for kind, payload in blocks_of(data):
            if kind in (0, 2):
                out.write(sealed(kind, payload))
        for at in range(0, CYCLE, 4000):
            out.write(ticks_block(at, begin[at:at + 4000]))
        while count < hours * 3600 * RATE_HZ:
            for at in range(0, CYCLE, 4000):
                out.write(ticks_block(count + at, cycle[at:at + 4000]))
            count += CYCLE
        out.write(sealed(5, struct.pack("<QQQ", count, 0, 0)))
    return count


def write_short():
    write_grating()
    write_strokes(20)
    tacto.run("play", "oak", "-d", "sim:", "--finger-path", "path.csv", "--time", "20s", "--gain", "0.5mm/N", "-o", "short")


def judged_in_little_memory():
    write_short()
    tacto.run("session", "short", "--strokes", "short.csv")
    count = write_long("short.session", "long.session", HOURS)
    minutes = tacto.peak_mb("session", "short")
    peak = tacto.peak_mb("session", "long", "--strokes", "long.csv", "-o", "long.wav")
    print(f"{count} ticks, {HOURS} hours: peak of {peak:.1f} MB; 20 s: {minutes:.1f} MB")
    assert tacto.SANITIZED or peak < MOST_MB, peak
    wav = soundfile.info("long.wav")
    assert (wav.frames, wav.samplerate, wav.channels) == (count, RATE_HZ, 2)
    with open("short.csv", newline="") as short, open("long.csv", newline="") as long:
        of_short, strokes = list(csv.DictReader(short)), list(csv.DictReader(long))
    assert len(strokes) == 2 * (count // CYCLE) * 2
    # Each is one of four of the short session (the repeated ones from its fifth on). Differences: the position in a
    # block (5e-4 of the target: JudgedBlocks), and the counts at the seams, one count of 10 um beside a period of 1 mm.
    for i, stroke in enumerate(strokes[8:-1]):  # the last one has no turn at its end
        same = of_short[4 + i % 4]
        assert abs(float(stroke["predicted_error_db"]) - float(same["predicted_error_db"])) < 0.2, (stroke, same)
        for key in ("target_rms_m", "predicted_rms_m"):
            assert abs(float(stroke[key]) / float(same[key]) - 1) < 2e-3, (key, stroke, same)
        assert abs(float(stroke["to_s"]) - float(stroke["from_s"]) - float(same["to_s"]) + float(same["from_s"])) < 0.01
    _, said = tacto.run("session", "long", "--json")
    assert ("strokes are shown" in said) == (len(strokes) > 10000), said


def compared_and_told():
    write_short()
    write_long("short.session", "long.session", HOURS)
    peak = tacto.peak_mb("compare", "long.session", "oak")
    print(f"compared: peak of {peak:.1f} MB")
    assert tacto.SANITIZED or peak < MOST_MB, peak
    whole, one = tacto.run_json("compare", "long.session", "oak"), tacto.run_json("compare", "short.session", "oak")
    assert abs(whole["error_db"] - one["error_db"]) < 0.5, (whole, one)


def a_stroke_without_an_end():
    """A finger that never reverses: increasing counts for the whole session. One stroke, judged, but too long to
    compare."""
    write_short()
    count = write_long("short.session", "still.session", HOURS)
    data = pathlib.Path("still.session").read_bytes()
    number = 0
    with open("still.session", "wb") as out:
        for kind, payload in blocks_of(data):
            if kind == 1:
                ticks = np.frombuffer(payload[20:], TICK).copy()
                ticks["encoder"] = 4000 + (np.arange(number, number + len(ticks)) * 8 // 1000)  # 16 um/s
                number += len(ticks)
                payload = payload[:20] + ticks.tobytes()
            out.write(sealed(kind, payload))
    report = tacto.run_json("session", "still")
    peak = tacto.peak_mb("session", "still")
    stroke, = report["strokes"]
    print(f"one stroke of {stroke['to_s'] - stroke['from_s']:.0f} s: peak of {peak:.1f} MB")
    assert stroke["to_s"] - stroke["from_s"] > 0.99 * count / RATE_HZ
    assert tacto.SANITIZED or peak < MOST_MB, peak
    _, said = tacto.run("compare", "still.session", "oak", code=5)
    # With sanitizers the session is shorter.
    assert ("without a reversal" if count > 1 << 22 else "no band in common") in said, said


def a_stop_of_days():
    """A computer that sleeps for 23 days during playback: the strokes end there, and the time between is not
    interpolated."""
    write_short()
    count = write_long("short.session", "slept.session", 30 / 3600)
    data = pathlib.Path("slept.session").read_bytes()
    with open("slept.session", "wb") as out:
        for kind, payload in blocks_of(data):
            if kind == 1 and int.from_bytes(payload[:8], "little") >= count // 2:
                payload = payload[:8] + struct.pack("<q", int.from_bytes(payload[8:16], "little") + 2_000_000 * 10**9) + payload[16:]
            out.write(sealed(kind, payload))
    peak = tacto.peak_mb("session", "slept")
    print(f"a stop of 23 days: peak of {peak:.1f} MB")
    assert tacto.SANITIZED or peak < MOST_MB, peak
    report = json.loads(tacto.run("session", "slept", "--json")[0])
    strokes = report["strokes"]
    assert report["stroke_count"] == len(strokes) and any(s["from_s"] > 2e6 for s in strokes), report
    assert all(s["to_s"] - s["from_s"] < 2 and s["predicted_error_db"] < -15 for s in strokes), strokes
    _, said = tacto.run("session", "slept", "-o", "slept.wav", code=5)
    assert "interpolated" in said and not pathlib.Path("slept.wav").exists(), said
    pathlib.Path("mine.csv").write_text("my,own\n1,2\n")
    tacto.run("session", "slept", "--strokes", "mine.csv", code=2)
    assert pathlib.Path("mine.csv").read_text().startswith("my,own")


if __name__ == "__main__":
    for test in (judged_in_little_memory, compared_and_told, a_stroke_without_an_end, a_stop_of_days):
        if len(sys.argv) > 1 and test.__name__ not in sys.argv[1:]:
            continue
        tacto.in_folder(test)
