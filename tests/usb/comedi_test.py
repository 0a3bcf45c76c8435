#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recording from a data acquisition card, and playing on it: libcomedi on the kernel's module comedi_test, whose inputs are
computed. Its sawtooth must be that of its formula in each frame; lost samples, another program and another rate must be
reported. What is played comes back at the input of the same number (waveform_ai_insn_read() of the module).
"""
import json
import pathlib
import sys

import numpy as np
import soundfile

import tacto
import virtual_machine
from play_test import write_grating

AMPLITUDE_UV, PERIOD_US, MOST = 1_000_000, 100_000, 65535  # the defaults of drivers/comedi/drivers/comedi_test.c


def wiring(name, inputs, rate_hz=10000, **other):
    text = json.dumps({"kind": "wiring", "version": "1.0", "name": name, "card": "/dev/comedi0", "rate_hz": rate_hz, "inputs": inputs, **other})
    pathlib.Path("wirings", f"{name}.wiring.json").write_text(text)


def wired(number, quantity, volts=10, **other):
    return {"input": number, "quantity": quantity, "range_v": [-volts, volts], "reference": "ground", **other}


def make_wirings():
    pathlib.Path("wirings").mkdir()
    wiring("saw", [wired(0, "tangential_force", volts=5, per_volt=2.0), wired(1, "position", per_volt=0.004, at_zero_volt=0.02)])
    wiring("fast", [wired(0, "signal", name=f"s{i}", per_volt=1) for i in range(4)], rate_hz=20000)
    loop = [{"input": 0, "quantity": "position", "range_v": [-10, 10], "reference": "ground", "per_volt": 1e-4}]
    wiring("loop", loop, output={"output": 0, "range_v": [-10, 10]}, transducer="wiertlewski2011")
    write_grating("wirings/oak")
    wiring("none", [wired(0, "signal", per_volt=1)], card="/dev/comedi15")


def sawtooth(time_us, span_v):
    """fake_sawtooth() of the module, as its source has it: integers."""
    amplitude = MOST * AMPLITUDE_UV // (span_v * 1_000_000)
    value = time_us % PERIOD_US * (2 * amplitude) // PERIOD_US + MOST // 2
    return np.where(value < amplitude, 0, np.minimum(value - amplitude, MOST))


def codes_of(name):
    """The card's codes: left-justified in 32 bits, and signed, in the file."""
    stored = soundfile.read(name, dtype="int32", always_2d=True)[0]
    assert not np.any(stored & 0xFFFF)
    return (stored.astype(np.int64) >> 16) + 32768


def follows_the_formula(codes, scan_us, span_v):
    """The phase is unknown; one of the period's microseconds has to explain all frames."""
    times = np.arange(len(codes)) * scan_us
    fits = [start for start in range(PERIOD_US) if sawtooth(np.array([start]), span_v)[0] == codes[0]]
    return any(np.array_equal(sawtooth(start + times, span_v), codes) for start in fits)


def sidecar(results, name):
    return json.loads((results / f"{name}.json").read_text())


def error_of(results, name):
    return json.loads((results / f"{name}.err").read_text().strip().splitlines()[-1])


def a_card_records(results):
    side, codes = sidecar(results, "saw"), codes_of(results / "saw.wav")
    assert codes.shape == (20000, 2) and not side.get("gaps") and not side.get("warnings"), side
    assert follows_the_formula(codes[:, 0], 100, 10), codes[:20]
    assert len(np.unique(codes[:, 1])) == 2, "input 1 is a square wave"
    force, position = side["channels"]
    volts = -5 + codes[:, 0] * 10 / MOST
    stored = soundfile.read(results / "saw.wav", dtype="int32", always_2d=True)[0]
    assert np.allclose(stored[:, 0] * force["scale"] + force["offset"], 2 * volts, rtol=0, atol=1e-12) and force["unit"] == "N", force
    low = position["scale"] * float(stored[:, 1].min()) + position["offset"]
    assert abs(low - (0.02 - 0.004)) < 0.004 * 20 / MOST, low  # -1 V, within a code
    tacto.run("validate", results / "saw")


def another_rate_is_reported(results):
    side = sidecar(results, "fast")
    assert abs(side["sample_rate_hz"] - 1e9 / 52000) < 1e-6 and len(side["warnings"]) == 1, side
    assert follows_the_formula(codes_of(results / "fast.wav")[:, 0], 52, 20)


def lost_samples_end_the_recording(results):
    assert (results / "stopped.code").read_text().strip() == "8", (results / "stopped.err").read_text()
    side, codes = sidecar(results, "stopped"), codes_of(results / "stopped.wav")
    assert side["ended"] and len(codes) > 10000 and follows_the_formula(codes[:, 0], 100, 10), side
    tacto.run("validate", results / "stopped")


def what_was_written_is_read_back(results):
    """The session replays to the bit, and each tick's count is the code that the tick before has written. The emulated
    machine may be too slow for the clock: then the playback has ended in a fault, and the ticks before it are judged."""
    code, said = ((results / f"looped.{end}").read_text().strip() for end in ("code", "err"))
    print("loop:", code, said)
    assert code in ("0", "8"), said
    assert tacto.run_json("replay", results / "looped")["same_to_the_bit"]
    tacto.run("session", results / "looped", "-o", "looped.csv")
    table = np.genfromtxt("looped.csv", delimiter=",", names=True)
    codes = np.round((table["drive_v"] + 10) * MOST / 20)
    assert len(codes) > 100 and np.ptp(codes) > 20, (len(codes), np.ptp(codes))
    assert np.array_equal(table["encoder_count"][1:], codes[:-1] - 32768)
    playing = next(row for row in json.loads((results / "loop_doctor.json").read_text())["checks"] if row["check"] == "playing")
    assert playing["state"] == "warning" and "ticks per second" in playing["found"], playing
    print("doctor:", playing["found"])


def refusals(results):
    for name, code in (("second", 8), ("none", 3)):
        error = error_of(results, name)
        assert error["exit_code"] == code and error["remedy"], error


def recorded():
    make_wirings()
    results = pathlib.Path("results")
    results.mkdir()
    print(virtual_machine.run("comedi.sh", results.resolve(), 150, TACTOGRAPH=tacto.COMMAND, WIRINGS=pathlib.Path("wirings").resolve()))
    doctor = json.loads((results / "doctor.json").read_text())
    assert doctor["can_record"] and [row["channel"] for row in doctor["wiring"]] == ["tangential_force", "position"], doctor
    assert "comedi_test" in json.dumps(doctor["checks"]), "the driver is not named"
    a_card_records(results)
    another_rate_is_reported(results)
    lost_samples_end_the_recording(results)
    what_was_written_is_read_back(results)
    refusals(results)


if __name__ == "__main__":
    try:
        tacto.in_folder(recorded)
    except virtual_machine.GuestFailed as failed:
        sys.exit(f"FAILED: {failed}")
