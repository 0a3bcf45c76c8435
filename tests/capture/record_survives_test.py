#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A recording survives kill -9 at 50 random times, a full disk, and a stop by signal."""
import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import time

import numpy as np
import soundfile

import tacto
from measured import measured, not_measured

KILLS = 12 if tacto.SANITIZED else 50
DEVICE = "sim:surface=flat,noise=off,paced=1,strokes=100"


def reference():
    """The frames of the whole recording, at full speed: equal parameters give equal frames, paced or not."""
    tacto.run("record", "-d", DEVICE.replace("paced=1", "paced=0"), "-o", "reference", "--time", "10s")
    return soundfile.read("reference.wav", dtype="int32", always_2d=True)[0]


def start(name, *options, **more):
    process = subprocess.Popen([tacto.COMMAND, "record", "-d", DEVICE, "-o", name, "--time", "10s", *options],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)
    while process.poll() is None and not pathlib.Path(f"{name}.wav").exists():
        time.sleep(0.001)
    return process


def frames_on_disk(name):
    """Read as another program would: only whole frames behind the header of 104 bytes."""
    return max(0, os.path.getsize(f"{name}.wav") - 104) // 16


def marked(name, process):
    """Waits until a mark is on the disk: its frame is the device's own count shortly before the kill."""
    os.kill(process.pid, signal.SIGUSR1)
    for _ in range(30_000):
        if '"mark"' in pathlib.Path(f"{name}.events.jsonl").read_text():
            return
        time.sleep(0.001)
    raise AssertionError(f"{name}: no mark on the disk after 30 s")


def killed_at_random_moments():
    """Half of the kills come after a mark, whose frame says how far the device was."""
    wanted, moments = reference(), random.Random(1)
    lost = []
    for k in range(KILLS):
        name = f"k{k}"
        process = start(name)
        time.sleep(moments.uniform(0.02, 0.5))
        if k % 2:
            marked(name, process)
        before = frames_on_disk(name)
        os.kill(process.pid, signal.SIGKILL)
        process.communicate()
        report = tacto.run_json("recover", name)
        tacto.run("validate", name)
        frames = soundfile.read(f"{name}.wav", dtype="int32", always_2d=True)[0]
        assert report["frames"] == len(frames) >= before, (report, before)
        assert np.array_equal(frames, wanted[:len(frames)]), f"{name}: other frames than were recorded"
        assert not pathlib.Path(f"{name}.events.jsonl").exists()
        lost += [mark["frame"] - len(frames) for mark in json.loads(pathlib.Path(f"{name}.json").read_text()).get("marks", [])]
    print(f"{KILLS} kills: at most {max(lost)} of the frames before the mark were not on the disk")
    assert len(lost) == KILLS // 2 and max(lost) <= 0, lost  # frames are written before the marks behind them
    measured("record_survives.kills", KILLS)
    measured("record_survives.lost_most_frames", max(lost))


def stopped_by_signal_and_marked():
    process = start("s")
    time.sleep(0.3)
    os.kill(process.pid, signal.SIGUSR1)
    time.sleep(0.2)
    os.kill(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert process.returncode == 0, (out, err)
    side = json.loads(pathlib.Path("s.json").read_text())
    assert len(side["marks"]) == 1 and 0 < side["marks"][0]["frame"] <= side["data"]["frames"], side["marks"]
    tacto.run("validate", "s")


def expect_full(name, process, most_bytes):
    out, err = process.communicate(timeout=120)
    assert process.returncode == 7, (process.returncode, out, err)
    tacto.run("validate", name)
    side = json.loads(pathlib.Path(f"{name}.json").read_text())
    assert side["ended"], side
    frames = side["data"]["frames"]
    size = os.path.getsize(f"{name}.wav")
    assert frames * 16 > 0.8 * most_bytes and size <= most_bytes, (frames, size)
    print(f"full: {frames} frames kept, ended: {side['ended']}")
    return frames, size


def fast(name, **more):
    """As fast as the physics can be computed: 8 MB are 50 s of recording."""
    return subprocess.Popen([tacto.COMMAND, "record", "-d", "sim:surface=flat,rate=100kHz", "--strokes", "1000", "-o", name],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)


def on_a_full_file_system():
    """A file system of 8 MB, if mounting is permitted; otherwise this is reported, and only the next test covers a full
    disk."""
    folder = pathlib.Path("small")
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8m", "tmpfs", str(folder)], capture_output=True,
                             text=True)
    if mounted.returncode != 0:
        print(f"no file system of 8 MB could be mounted ({mounted.stderr.strip()}): a size limit of 8 MB is tested alone")
        not_measured("record_survives.full_*", "no file system of 8 MB")
        return
    try:
        frames, size = expect_full("small/oak", fast("small/oak"), 8 << 20)
        measured("record_survives.full_frames", frames)
        measured("record_survives.full_mb", 1e-6 * size)
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def at_a_size_limit():
    """RLIMIT_FSIZE: writing beyond 8 MB fails as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (8 << 20, 8 << 20))
    expect_full("oak", fast("oak", preexec_fn=limit), 8 << 20)


def memory_does_not_grow():
    """60 s at 10 kHz against 0.1 s: the same blocks of memory. With sanitizers memory is not judged, so they run 10
    s."""
    most_s = 10 if tacto.SANITIZED else 60
    short, long = (tacto.peak_mb("record", "-d", "sim:surface=flat", "-o", f"m{time_s}", "--time", f"{time_s}s")
                   for time_s in (0.1, most_s))
    tacto.expect_little_memory(f"{most_s} s against 0.1 s", long, short, most=16)


def takes_count_up_and_are_listed():
    for subject in ("S01", "S01", "S02"):
        tacto.run("record", "-d", "sim:", "--time", "50ms", "--template", "{subject}_{surface}_{take}", "--subject",
                  subject, "--surface", "oak")
    pathlib.Path("other.json").write_text("{}")
    listed = tacto.run_json("list", ".")["list"]
    assert [(row["subject"], row["take"], row["name"]) for row in listed] == [
        ("S01", 1, "S01_oak_1"), ("S01", 2, "S01_oak_2"), ("S02", 1, "S02_oak_1")], listed
    assert "S01_oak_2" in tacto.run("list")[0]
    # A removed mark does not change the numbers of others, and its number is not used again.
    for ending in (".wav", ".json"):
        pathlib.Path("S01_oak_1" + ending).unlink()
    tacto.run("record", "-d", "sim:", "--time", "50ms", "--template", "{subject}_{surface}_{take}", "--subject", "S01", "--surface", "oak")
    tacto.run("record", "-d", "sim:", "--time", "50ms", "-o", "plain")
    listed = tacto.run_json("list", ".")["list"]
    assert [(row.get("take"), row["name"]) for row in listed] == [
        (None, "plain"), (2, "S01_oak_2"), (3, "S01_oak_3"), (1, "S02_oak_1")], listed


if __name__ == "__main__":
    for test in (killed_at_random_moments, stopped_by_signal_and_marked, on_a_full_file_system, at_a_size_limit,
                 memory_does_not_grow, takes_count_up_and_are_listed):
        tacto.in_folder(test)
