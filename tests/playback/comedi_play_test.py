#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Playing on a data acquisition card, against a FAKE libcomedi (fake_comedi.cpp, preloaded), because the kernel's
comedi_test has neither counters nor digital lines. What the fake card was printed is compared with the session, tick by
tick. tests/usb/comedi_test.py plays through the real library and kernel. Usage: comedi_play_test.py FAKE-LIBRARY
"""
import copy
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

import numpy as np
import soundfile

import tacto
from play_test import write_grating

FAKE = sys.argv[1]
USAGE, UNSUITABLE, DEVICE = 2, 5, 8
AO, COUNTER = 2, 6  # COMEDI_SUBD_AO and COMEDI_SUBD_COUNTER of comedi.h
MOST, ZERO, COUNTER_MOST = 65535, 32768, 0xFFFFFF
PRESET = json.loads((pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json").read_text())
BENCH = {
    "kind": "wiring", "version": "1.0", "name": f"fake card {os.getpid()}", "card": "/dev/fake", "rate_hz": 10000,
    "inputs": [{"input": 0, "quantity": "tangential_force", "range_v": [-10, 10], "reference": "differential"}],
    "output": {"output": 0, "range_v": [-10, 10]},
    "encoder": {"counter": 0, "step_m": 1e-6},
    "watchdog": {"line": 3},
    "transducer": "wiertlewski2011",
}


def wire(**changes):
    body = copy.deepcopy(BENCH)
    for member, value in changes.items():
        body[member] = value
    pathlib.Path("bench.wiring.json").write_text(json.dumps({member: value for member, value in body.items() if value is not None}))


def environment(**fake):
    pathlib.Path("log").unlink(missing_ok=True)
    settings = {f"FAKE_COMEDI_{name.upper()}": str(value) for name, value in fake.items()}
    return {**os.environ, "LD_PRELOAD": FAKE, "FAKE_COMEDI_LOG": "log", **settings}


def run(*arguments, **fake):
    done = subprocess.run([tacto.COMMAND, *arguments, "--json"], env=environment(**fake), capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def error_of(code, *arguments, **fake):
    """Nothing is played, and no session remains."""
    got, out, err = run("play", "oak", "-d", "comedi:bench", "-o", "none", "--time", "0.1s", *arguments, **fake)
    error = json.loads(err.strip().splitlines()[-1])
    assert got == code == error["exit_code"] and not pathlib.Path("none.session").exists(), (got, out, err)
    return error


def log():
    """(what, value) of each line."""
    return [(line.rsplit(" ", 1)[0], int(line.rsplit(" ", 1)[1])) for line in pathlib.Path("log").read_text().splitlines()]


def ticks_of(lines):
    """Counter, code at the output and level of the watchdog's line of each tick: they are written in this order."""
    words = [what for what, _ in lines]
    places = [i for i in range(len(lines) - 2) if words[i:i + 3] == ["count", "ao", "dio"]]
    return np.array([[lines[i + k][1] for k in range(3)] for i in places])


def playing(name, *arguments, **fake):
    """What `play` reports; nothing if this machine stopped for longer than the software watchdog's time (a fault), five
    times. Every session must replay."""
    for _ in range(5):
        pathlib.Path(f"{name}.session").unlink(missing_ok=True)
        code, out, err = run("play", "oak", "-d", "comedi:bench", "--at", "-1mm", "--gain", "0.5mm/N", "-o", name, *arguments, **fake)
        assert code in (0, DEVICE) and json.loads(out)["ticks"] > 0, (code, out, err)
        assert tacto.run_json("replay", name)["same_to_the_bit"]
        is_what_the_card_was_told(name)
        if code == 0:
            return json.loads(out)
        assert json.loads(out)["fault"], out
    print("not judged: in five attempts this machine stopped for longer than the watchdog's time")
    return None


def is_what_the_card_was_told(name):
    """The session's ticks are consecutive ticks of the card: each count read, and each drive written."""
    lines = log()
    pathlib.Path(f"{name}.csv").unlink(missing_ok=True)
    tacto.run("session", name, "-o", f"{name}.csv")
    table = np.genfromtxt(f"{name}.csv", delimiter=",", names=True)
    printed = ticks_of(lines)
    first = next(value for what, value in lines if what == "count")
    counts = (printed[:, 0] - first) & COUNTER_MOST
    wanted = np.stack([table["encoder_count"], np.round((table["drive_v"] + 10) * MOST / 20)], axis=1)
    pairs = np.stack([counts, printed[:, 1]], axis=1)
    starts = [i for i in range(len(pairs) - len(wanted) + 1) if np.array_equal(pairs[i], wanted[0]) and np.array_equal(pairs[i:i + len(wanted)], wanted)]
    assert starts, (len(pairs), wanted[:5], pairs[:5])
    levels = printed[starts[0]:starts[0] + len(wanted), 2]
    assert np.all(np.diff(levels) != 0), "the watchdog's line changes in each tick"


def rests(lines):
    """The last value at the output is 0 V, and nowhere is a step: the transducer's slew limit, in a tick of 2 kHz."""
    codes = np.array([value for what, value in lines if what == "ao"])
    assert codes[-1] == ZERO, codes[-20:]
    most = PRESET["slew_limit_v_per_s"] / 2000 * MOST / 20
    assert np.max(np.abs(np.diff(codes))) <= most + 1, (np.max(np.abs(np.diff(codes))), most)


def plays_what_the_encoder_reads():
    wire()
    played = playing("first", "--time", "500ms")
    lines = log()
    rests(lines)
    counts = np.array([value for what, value in lines if what == "count"])
    assert np.max(counts) > COUNTER_MOST - 1000 and np.min(counts) < 30000, "the counter has wrapped"
    if played:
        assert played["drive_peak_v"] > 0.05 and played["lost_ticks"] == 0 and played["ticks"] > 900, played
    head = tacto.run_json("session", "first")
    assert "no-watchdog" not in json.dumps(head["events"]), head["events"]


def every_end_is_at_zero():
    wire()
    for name, stop in (("interrupted", signal.SIGINT), ("terminated", signal.SIGTERM)):
        running = subprocess.Popen([tacto.COMMAND, "play", "oak", "-d", "comedi:bench", "--at", "-1mm", "--gain", "0.5mm/N", "-o", name, "--time", "60s", "--json"],
                                   env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        latest = time.monotonic() + 60
        while not (pathlib.Path("log").exists() and any(what == "ao" and abs(value - ZERO) > 50 for what, value in log_so_far())):
            assert running.poll() is None and time.monotonic() < latest, running.communicate()
            time.sleep(0.05)
        running.send_signal(stop)
        out, err = running.communicate(timeout=60)
        assert running.returncode in (0, DEVICE), (out, err)
        rests(log())
        assert tacto.run_json("replay", name)["same_to_the_bit"]
    code, _, err = run("play", "oak", "-d", "comedi:bench", "--at", "-1mm", "--gain", "0.5mm/N", "-o", "broken", "--time", "5s", fails_after=1500)
    assert code == DEVICE and "the card refuses an instruction" in err, (code, err)
    rests(log())
    assert tacto.run_json("replay", "broken")["same_to_the_bit"]
    words = [what for what, _ in log()]
    assert words[-words[::-1].index("count"):].count("dio") <= 1, "the watchdog's line rests after the failure"


def log_so_far():
    text = pathlib.Path("log").read_text()
    return [(line.rsplit(" ", 1)[0], int(line.rsplit(" ", 1)[1])) for line in text[:text.rfind("\n")].splitlines()]


def without_a_watchdog_only_on_request():
    wire(watchdog=None)
    error = error_of(UNSUITABLE)
    assert "watchdog" in error["what"] and "--no-watchdog" in error["remedy"], error
    for _ in range(5):
        pathlib.Path("bare.session").unlink(missing_ok=True)
        code, out, err = run("play", "oak", "-d", "comedi:bench", "-o", "bare", "--time", "0.2s", "--no-watchdog")
        assert code in (0, DEVICE), (out, err)
        if code == 0:
            break
    assert "watchdog" in err and not any(what == "dio" for what, _ in log()), err
    assert "--no-watchdog" in json.dumps(tacto.run_json("session", "bare")["events"])
    assert tacto.run_json("replay", "bare")["same_to_the_bit"]
    tacto.error_of("play", "oak", "-d", "sim:", "-o", "none", "--no-watchdog", code=USAGE)


def an_input_can_be_the_position():
    """The fake card's input reads its output, so that the drive moves the finger."""
    wire(encoder=None, inputs=[{"input": 0, "quantity": "position", "range_v": [-10, 10], "reference": "ground", "per_volt": 1e-4}])
    for _ in range(5):
        pathlib.Path("looped.session").unlink(missing_ok=True)
        code, out, err = run("play", "oak", "-d", "comedi:bench", "--at", "-1.1mm", "--gain", "0.5mm/N", "-o", "looped", "--time", "0.3s")
        assert code in (0, DEVICE), (out, err)
        if code == 0:
            break
    assert tacto.run_json("replay", "looped")["same_to_the_bit"]
    tacto.run("session", "looped", "-o", "looped.csv")
    table = np.genfromtxt("looped.csv", delimiter=",", names=True)
    codes = np.round((table["drive_v"] + 10) * MOST / 20)
    assert len(codes) > 100 and np.ptp(codes) > 20, (len(codes), np.ptp(codes))
    assert np.array_equal(table["encoder_count"][1:], codes[:-1] - ZERO), "each count is what the tick before has written"


def an_ni_counter_counts_all_edges():
    wire(encoder={"counter": 0, "step_m": 1e-6, "pfi_a": 8, "pfi_b": 10})
    run("play", "oak", "-d", "comedi:bench", "-o", "ni", "--time", "0.1s", driver="ni_pcimio")
    words = [what for what, _ in log()]
    assert words.index("config mode") < words.index("config arm") < words.index("count"), words[:20]
    mode = dict(log())["config mode"]
    assert mode >> 16 & 7 == 3, hex(mode)  # NI_GPCT_COUNTING_MODE_QUADRATURE_X4_BITS
    assert words.count("config source") == 2


def a_recording_has_the_counter():
    """By instructions: each frame is the next reading of the card, and a period that this machine missed is a gap."""
    wire(rate_hz=2000)
    code, out, err = run("record", "-d", "comedi:bench", "-o", "counted", "--time", "1s", "--allow-gaps")
    assert code == 0, (out, err)
    side = json.loads(pathlib.Path("counted.json").read_text())
    stored = soundfile.read("counted.wav", dtype="int32", always_2d=True)[0]
    position = side["channels"][0]
    assert (position["name"], position["unit"], position["scale"], side["sample_rate_hz"], side["clock"]) == ("position", "m", 1e-6, 2000, "host"), side
    assert len(stored) + sum(gap["count"] for gap in side.get("gaps", [])) >= 2000 and stored.shape[1] == 2, side
    readings = np.array([value for what, value in log() if what == "count"])
    counts = (readings - readings[0]) & COUNTER_MOST
    starts = [i for i in np.flatnonzero(counts == stored[0, 0]) if np.array_equal(counts[i:i + len(stored)], stored[:, 0])]
    assert starts and np.ptp(stored[:, 0]) > 15_000, (counts[:5], stored[:5])
    assert np.all(stored[:, 1] >> 16 == ZERO - 1 - 32768), "input 0 reads the output, which no device drives"
    assert not any(what in ("ao", "dio") for what, _ in log()), "a recording drives nothing"
    tacto.run("validate", "counted")
    slow = run("record", "-d", "comedi:bench", "-o", "slower", "--time", "0.2s", "--allow-gaps", takes_us=150)
    side = json.loads(pathlib.Path("slower.json").read_text())
    assert 1000 <= side["sample_rate_hz"] < 2000 and any("2000 Hz" in each for each in side["warnings"]), (slow, side)
    code, out, err = run("record", "-d", "comedi:bench", "-o", "cut", "--time", "5s", "--allow-gaps", fails_after=1500)
    assert code == DEVICE and "refuses an instruction" in err, (code, err)
    # The readings before the failure, but those of the measured rate.
    assert 1000 < len(soundfile.read("cut.wav", dtype="int32", always_2d=True)[0]) < 1500


def what_cannot_be_played_is_refused():
    for changes, place in (({"output": None}, "output"), ({"encoder": None}, "encoder"), ({"output": {"output": 5, "range_v": [-10, 10]}}, "output 5"),
                           ({"output": {"output": 0, "range_v": [-7, 7]}}, "-7 to 7"), ({"encoder": {"counter": 0, "subdevice": 0, "step_m": 1e-6}}, "subdevice 0"),
                           ({"watchdog": {"line": 8}}, "digital output 8")):
        wire(**changes)
        error = error_of(UNSUITABLE)
        assert place in error["what"], (changes, error)
    wire(output={"output": 0, "range_v": [-1, 1]})
    error = error_of(UNSUITABLE)
    assert error["where"].endswith("#/output/range_v"), error
    wire(transducer=None, inputs=[{**BENCH["inputs"][0], "per_volt": 2.0}])
    assert error_of(UNSUITABLE)["where"].endswith("#/output")
    wire()
    assert "counter" in error_of(UNSUITABLE, without=COUNTER)["what"]
    assert "output" in error_of(UNSUITABLE, without=AO)["what"]
    assert error_of(DEVICE, locked=1)["remedy"]
    assert "ticks per second" in error_of(UNSUITABLE, "--rate", "19kHz", takes_us=20)["what"]
    assert "too slow" in error_of(UNSUITABLE, takes_us=300)["what"]
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0\n1,0.01\n")
    error_of(UNSUITABLE, "--finger-path", "path.csv")


def doctor_says_the_rate():
    wire()
    code, out, err = run("doctor", "-d", "comedi:bench", takes_us=50)
    report = json.loads(out)
    playing_row = next(row for row in report["checks"] if row["check"] == "playing")
    least, most = map(float, re.match(r"([\d.e+]+) to ([\d.e+]+) ticks", playing_row["found"]).groups())
    # Four instructions of 50 us take half of the period, at most: 2500 Hz.
    assert code == 0 and report["can_record"] and least == 1000 and 1000 <= most <= 2500, (report, err)
    assert playing_row["state"] == "works" and "line 3" in report["watchdog"] and "output 0" in report["drive"] and "counter 0" in report["encoder"], report
    assert log()[-1] == ("ao", ZERO)
    wire(watchdog=None)
    rows = {row["check"]: row["state"] for row in json.loads(run("doctor", "-d", "comedi:bench")[1])["checks"]}
    assert rows["playing"] == "warning", rows
    wire(output=None)
    rows = {row["check"]: row["state"] for row in json.loads(run("doctor", "-d", "comedi:bench")[1])["checks"]}
    assert rows["playing"] == "skipped", rows
    tacto.run("validate", "bench")


def an_experiment_says_that_the_normal_force_is_unknown():
    """The card has no input for it. Its counter does not follow the cue, so no trial is delivered."""
    wire()
    tacto.run("experiment", "new", "stretch", "-o", "force", "--normal-force", "0.3N,0.8N")
    protocol, key = pathlib.Path("force.protocol.json"), pathlib.Path("force.key.json")
    changes = {"repetitions": 1, "most_attempts": 1, "levels": [-0.5, 0.5], "pace": {"from_m": 0.01, "to_m": 0.02, "speed_mps": 0.06, "strokes": 1}}
    protocol.write_text(json.dumps({**json.loads(protocol.read_text()), **changes}))
    stimuli = json.loads(key.read_text())
    key.write_text(json.dumps({**stimuli, "stimuli": [each for each in stimuli["stimuli"] if each["stretch"] in (-0.5, 0, 0.5)]}))
    checked = json.loads(run("experiment", "check", "force", "-d", "comedi:bench")[1])
    assert checked["normal_force_reported"] == "no" and any("normal force" in warning for warning in checked["warnings"]), checked
    code, _, err = run("experiment", "run", "force", "-d", "comedi:bench", "--participant", "P01", "--observer", "weber=25%")
    assert code == 0, err
    head, *rows = pathlib.Path("force-P01.trials.tsv").read_text().splitlines()
    assert [row.split("\t")[head.split("\t").index("force_within")] for row in rows] == ["unknown", "unknown"]


def test():
    write_grating()
    for step in (plays_what_the_encoder_reads, every_end_is_at_zero, without_a_watchdog_only_on_request, an_input_can_be_the_position, an_ni_counter_counts_all_edges,
                 a_recording_has_the_counter, what_cannot_be_played_is_refused, doctor_says_the_rate, an_experiment_says_that_the_normal_force_is_unknown):
        step()
        print(f"{step.__name__}: passed")


tacto.in_folder(test)
