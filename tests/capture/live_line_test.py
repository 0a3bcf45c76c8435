#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The live line and its keys on a terminal, and the strokes that the recording stores."""
import fcntl
import json
import os
import pathlib
import pty
import re
import select
import struct
import termios
import time

import tacto
from machine_stops import MachineStops

COLUMNS = 120
DEVICE = "sim:surface=flat,paced=1,strokes=20,length=25mm"  # a stroke of 20 mm takes 0.5 s, and 0.1 s of rest


def on_a_terminal(arguments, keys, columns=COLUMNS):
    """Runs the command on a terminal of its own, presses keys at times after the first line; (everything shown, exit
    code)."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.execv(tacto.COMMAND, [tacto.COMMAND, *arguments])
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    begun, line, shown = time.monotonic(), None, b""
    while True:
        now = time.monotonic()
        line = now if line is None and b"\r\x1b[K" in shown else line
        while keys and line is not None and keys[0][0] <= now - line:
            os.write(terminal, keys.pop(0)[1])
        assert now - begun < 60, shown
        if not select.select([terminal], [], [], 0.05)[0]:
            continue
        try:
            piece = os.read(terminal, 65536)
        except OSError:  # the process has closed the terminal
            piece = b""
        if not piece:
            break
        shown += piece
    return shown.decode(), os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def redrawn_marked_and_stopped():
    with MachineStops() as stops:
        shown, code = on_a_terminal(["record", "-d", DEVICE, "-o", "oak"], [(0.8, b"m"), (1.3, b"x"), (2.2, b"q")])
    assert code == 0, shown
    lines = shown.split("\r\x1b[K")[1:-1]  # before the first line is nothing, after the last the report
    for line in lines:
        first = line.split("\r\n")[0]
        assert len(first) < COLUMNS, first
        assert re.match(r"\d+\.\d s   *\d+ mm/s (ok|FASTER|SLOWER)  load \d\.\d\d N (ok|MORE|LESS)  \d+ strokes  0 lost  ", first), first
    times = [float(line.split(" s ")[0]) for line in lines]
    assert lines and times == sorted(times), times
    side = json.loads(pathlib.Path("oak.json").read_text())
    assert [mark["label"] for mark in side["marks"]] == ["mark"], side["marks"]
    assert "ended" not in side and 0 < side["marks"][0]["frame"] <= side["data"]["frames"], side
    # The first line appears some tenths of a second after the device's first frame.
    if stops.allow(0.3, "the times of the lines and of the mark"):
        assert 8 <= len(lines) <= 80 and times[-1] > 1.5, (times, shown)
        assert 0.5 < side["marks"][0]["frame"] / 1e4 < 2.5, side["marks"]
        assert side["data"]["frames"] / 1e4 < 6, side["data"]
    return side


def levels_and_clipping_are_seen_in_80_columns():
    shown, code = on_a_terminal(["record", "-d", DEVICE, "-o", "narrow", "--time", "0.6s"], [], columns=80)
    lines = [line.split("\r\n")[0] for line in shown.split("\r\x1b[K")[1:-1]]
    assert code == 0 and lines and max(map(len, lines)) < 80, shown
    assert any(re.search(r"lost  peaks \d+/\d+/\d+ %  $|lost  peaks \d+/\d+/\d+ %  \d", line) for line in lines), lines
    loud = "sim:force=sine,force_low=100Hz,force_amplitude=0.5N,paced=1"
    shown, code = on_a_terminal(["record", "-d", loud, "-o", "loud-line", "--time", "0.6s"], [], columns=80)
    assert re.search(r"\d s  CLIP tangential_force  ", shown), shown


def the_terminal_is_left_as_it_was():
    pid, terminal = pty.fork()
    if pid == 0:
        os.execv("/bin/sh", ["sh", "-c", f"stty -a; {tacto.COMMAND} record -d {DEVICE} -o twice --time 0.3s > /dev/null; echo; stty -a"])
    shown = b""
    try:
        while piece := os.read(terminal, 65536):
            shown += piece
    except OSError:
        pass
    os.waitpid(pid, 0)
    before, after = re.findall(rb"(speed .*?-extproc|speed .*?extproc)", shown, re.S)
    assert before == after, shown


def strokes_are_told_again(side):
    assert len(side["strokes"]) >= 2, side.get("strokes")
    printed = tacto.run_json("info", "oak")["strokes"]
    for stored, shown in zip(side["strokes"], printed, strict=True):
        assert shown["length_m"] == stored["length_m"] and shown["mean_speed_mps"] == stored["mean_speed_mps"]
        cut = stored is side["strokes"][-1]  # by the end of the recording
        assert abs(stored["mean_speed_mps"] - 0.05) < 0.02 and (0.005 if cut else 0.015) < stored["length_m"] < 0.021, stored
        assert shown["speed_in_band"] == (0.035 <= stored["mean_speed_mps"] <= 0.065)
        assert shown["load_in_band"] == (0.25 <= stored["mean_normal_n"] <= 0.75)
        assert stored["clipped_samples"] == 0 and stored["lost_frames"] == 0
    assert [stroke["direction"] for stroke in printed[:2]] == [1, -1]
    row = next(row for row in tacto.run_json("list", ".")["list"] if row["name"] == "oak")
    assert row["strokes"] == len(printed) and row["clipped_samples"] == 0 and row["lost_frames"] == 0
    assert abs(row["mean_speed_mps"] - sum(s["mean_speed_mps"] for s in printed) / len(printed)) < 1e-12


def loud_strokes_are_counted_as_clipped():
    tacto.run("record", "-d", "sim:surface=B,load=3N,strokes=2", "-o", "loud", "--time", "2s")
    strokes = tacto.run_json("info", "loud")["strokes"]
    assert strokes and any(stroke["clipped_samples"] > 0 for stroke in strokes), strokes
    assert not any(stroke["load_in_band"] for stroke in strokes), strokes


def what_is_missing_counts_in_the_duration():
    tacto.run("record", "-d", "sim:", "--time", "0.4s", "-o", "hole")
    side = json.loads(pathlib.Path("hole.json").read_text())
    side["data"].pop("numbers_sha256")
    side["gaps"] = [{"frame": 1000, "device_sequence": 1500, "count": 500}]
    pathlib.Path("hole.json").write_text(json.dumps(side))
    printed = tacto.run_json("record", "-d", "replay:hole", "-o", "hole2", "--allow-gaps")
    durations = [printed["duration_s"], tacto.run_json("info", "hole2")["duration_s"],
                 next(row for row in tacto.run_json("list", ".")["list"] if row["name"] == "hole2")["duration_s"]]
    assert all(abs(duration - 0.45) < 1e-9 for duration in durations), durations


def clocks_are_fitted():
    """20 s of emulated time: the clocks differ by the requested ppm, within the uncertainty of the messages' times."""
    for ppm in (0, 250, -1200):
        name = f"clock{ppm}"
        tacto.run("record", "-d", f"sim:finger=up,clock_ppm={ppm}", "-o", name, "--time", "20s")
        printed = tacto.run_json("info", name)
        assert abs(printed["clock_drift_ppm"] - ppm) <= max(1, 4 * printed["clock_drift_uncertainty_ppm"]), printed
        assert printed["clock_scatter_s"] < 5e-3, printed
    # In real time: 12 s of a device that is 3 % fast take 12 / 1.03 s.
    begun = time.monotonic()
    tacto.run("record", "-d", "sim:finger=up,clock_ppm=30000,paced=1", "-o", "wall", "--time", "12s")
    took = time.monotonic() - begun
    assert 12 / 1.03 - 0.05 < took, took
    printed = tacto.run_json("info", "wall")
    assert abs(printed["clock_drift_ppm"] - 30000) < max(30, 4 * printed["clock_drift_uncertainty_ppm"]), printed
    print(f"3 % fast, paced: found {printed['clock_drift_ppm']:.1f} +- {printed['clock_drift_uncertainty_ppm']:.1f} ppm")


def test():
    strokes_are_told_again(redrawn_marked_and_stopped())
    levels_and_clipping_are_seen_in_80_columns()
    the_terminal_is_left_as_it_was()
    loud_strokes_are_counted_as_clipped()
    what_is_missing_counts_in_the_duration()


tacto.in_folder(test)
tacto.in_folder(clocks_are_fitted)
