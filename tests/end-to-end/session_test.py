#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of a session: one time in all its tables, positions, notes about ticks without a texture, damaged files."""
import json
import pathlib
import sys

import numpy as np
import xarray

import tacto
from play_test import write_grating, write_strokes


def write_way(from_m, to_m):
    pathlib.Path("way.csv").write_text(f"time_s,position_m\n0,{from_m}\n0.1,{from_m}\n0.9,{to_m}\n1,{to_m}\n")


def all_tables_share_one_time():
    """Seconds since the first tick in CSV, netCDF and strokes; also the device's clock, which began earlier."""
    write_grating()
    pathlib.Path("strokes.csv").write_text("time_s,position_m\n0,0.004\n0.8,0.034\n1,0.034\n1.8,0.004\n2,0.004\n")
    tacto.run("play", "oak", "-d", "sim:", "--finger-path", "strokes.csv", "--gain", "0.5mm/N", "-o", "timed")
    strokes = tacto.run_json("session", "timed", "-o", "timed.csv", "-o", "timed.nc")["strokes"]
    table = np.genfromtxt("timed.csv", delimiter=",", names=True)
    nc = xarray.open_dataset("timed.nc")
    assert table["time_s"][0] == 0 and table["device_time_s"][0] > 0, table[0]
    printed_s = 1e-9  # the table's last digit
    np.testing.assert_allclose(table["device_time_s"] - table["time_s"], table["device_time_s"][0], atol=2 * printed_s)
    for column, variable in (("time_s", "time"), ("device_time_s", "device_time"), ("gain", "gain")):
        np.testing.assert_allclose(table[column], nc[variable], rtol=0, atol=printed_s)
    assert nc.time.attrs["units"] == nc.device_time.attrs["units"] == "s"
    assert len(strokes) >= 2, strokes
    for stroke in strokes:
        for end in ("from", "to"):
            row = np.argmin(np.abs(table["time_s"] - stroke[f"{end}_s"]))
            assert abs(table["time_s"][row] - stroke[f"{end}_s"]) <= printed_s, stroke
            assert abs(table["position_m"][row] - stroke[f"{end}_m"]) < 1e-9, (stroke, table[row])


def a_counter_that_passes_2_to_the_31_goes_on():
    """At 1 um a count of 2^31 is 2147.48 m: the finger's path across it is one stroke, in the tables too."""
    write_grating()
    pathlib.Path("far.csv").write_text("time_s,position_m\n0,2147.47\n0.1,2147.47\n0.9,2147.5\n1,2147.5\n")
    tacto.run("play", "oak", "--ends", "loop", "-d", "sim:", "--finger-path", "far.csv", "--gain", "0.5mm/N", "-o", "far")
    strokes = tacto.run_json("session", "far", "-o", "over.csv")["strokes"]
    assert len(strokes) == 1 and abs(strokes[0]["to_m"] - 2147.5) < 2e-6 and abs(strokes[0]["from_m"] - 2147.47) < 2e-6, strokes
    table = np.genfromtxt("over.csv", delimiter=",", names=True)
    assert np.any(np.diff(table["encoder_count"]) < -2**31) and np.max(np.abs(np.diff(table["position_m"]))) < 1e-3


def where_the_device_reads_nothing_is_not_judged():
    """At 1 um a device reads a texture up to 2^29 um = 536.87 m from its zero (WIRE.md), and drives 0 V beyond. So a
    loop is not played there, and no error of it is reported."""
    write_grating()
    play = ("play", "oak", "--ends", "loop", "-d", "sim:", "--finger-path", "way.csv", "--gain", "0.5mm/N")
    reach_m = 2**29 * 1e-6
    for name, from_m, to_m, is_judged in (("near", reach_m - 0.04, reach_m - 0.01, True), ("over", reach_m - 0.02, reach_m + 0.01, False),
                                     ("beyond", reach_m + 0.01, reach_m + 0.04, False), ("far", 2146.99, 2147.02, False),
                                     ("behind", -reach_m - 0.01, -reach_m - 0.04, False)):
        write_way(from_m, to_m)
        silence = tacto.run(*play, "-o", name)[1]
        assert ("536.9 m" in silence) == (name in ("beyond", "far", "behind")), (name, silence)
        judged, said = tacto.run("session", name, "--json")
        stroke = json.loads(judged)["strokes"][0]
        assert ("target_rms_m" in stroke and stroke["target_rms_m"] != "unknown") == is_judged, (name, stroke)
        assert ("536.9 m" in said) == (not is_judged), (name, said)
        if is_judged:
            assert stroke["predicted_error_db"] < -20, stroke  # without a texture it would be 0 dB
        tacto.run("compare", f"{name}.session", "oak", code=0 if is_judged else 5)
    said = tacto.run("play", "oak", "-d", "sim:", "--at", "536.85m", "-o", "cut", code=2)[1]
    assert "within 536.9 m" in said, said


def what_stands_before_a_damage_is_the_same():
    """Cut, or with a changed bit, 1000 bytes before its end: each tick before the damage is the same, and the exit code
    reports the damage."""
    write_grating()
    write_strokes(20)  # long, so that it is written in many blocks
    tacto.run("play", "oak", "-d", "sim:", "--finger-path", "path.csv", "--time", "20s", "-o", "whole")
    whole = pathlib.Path("whole.session").read_bytes()
    flipped = bytearray(whole)
    flipped[len(whole) - 1000] ^= 1
    for name, content in (("cut", whole[:len(whole) - 1000]), ("flip", bytes(flipped))):
        pathlib.Path(f"{name}.session").write_bytes(content)
        out, said = tacto.run("replay", name, "--json", code=4)
        assert out, said
        replayed = json.loads(out)
        assert replayed["same_to_the_bit_up_to_the_damage"] and "same_to_the_bit" not in replayed, replayed
        assert "damaged_at_byte" in replayed and replayed["ticks_compared"] > 100, replayed


def nothing_felt_has_its_reason():
    write_grating()
    write_way(0.004, 0.034)
    play = ("play", "oak", "-d", "sim:", "--finger-path", "way.csv")
    report, said = tacto.run(*play, "--at", "1m", "-o", "beside", "--json")
    assert json.loads(report)["drive_peak_v"] == 0, report
    assert "4 mm to 34 mm" in said and "1 m to 1.04 m" in said, said
    assert "4 mm to 34 mm" not in tacto.run(*play, "-o", "there")[1]
    _, said = tacto.run(*play, "--contact", "5N", "-o", "light")
    assert "5 N" in said and "--contact" in said, said
    said = tacto.run("session", "beside")[1]
    assert "1 of 1 strokes" in said, said
    assert "of 1 strokes" not in tacto.run("session", "there")[1]
    write_way(0.004, 0.0044)
    tacto.run(*play, "-o", "short")
    said = tacto.run("session", "short")[1]
    assert "400 um" in said and " 5 mm" in said, said


def a_misspelling_is_not_played():
    write_grating()
    layer = {"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 5e-4}
    for wrong, nearest in (({"playback": {"energy_rms": 1}}, "energy_rms_v"), ({"layers": [{**layer, "end": "mirror"}]}, "ends")):
        scene = {"kind": "scene", "version": "1.0", "layers": [layer], **wrong}
        pathlib.Path("wrong.scene.json").write_text(json.dumps(scene))
        for arguments, code in ((("play", "wrong", "-d", "sim:", "-o", "wrong"), 4), (("validate", "wrong.scene.json"), 4)):
            out, said = tacto.run(*arguments, code=code)
            assert nearest in said + out, (arguments, out, said)
    newer = {"kind": "scene", "version": "1.9", "layers": [layer], "playback": {"softness": 1}}
    pathlib.Path("newer.scene.json").write_text(json.dumps(newer))
    assert "softness" in tacto.run("play", "newer", "-d", "sim:", "-o", "newer", code=5)[1]
    pathlib.Path("newer.scene.json").write_text(json.dumps({**newer, "playback": {}, "light": "dim"}))
    tacto.run("play", "newer", "-d", "sim:", "--time", "0.1s", "-o", "newer")


def a_newer_version_is_said_once():
    """Scene, texture and transducer of a newer minor version play with one warning each: the file, the version, the
    ignored members."""
    write_grating()
    write_way(0.004, 0.034)
    layer = {"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 5e-4}
    pathlib.Path("s.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": [layer]}))
    preset = pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json"
    pathlib.Path("mine.transducer.json").write_text(preset.read_text())

    def add_newer(file, **extra):
        body = {**json.loads(pathlib.Path(file).read_text()), "version": "1.9", **extra}
        pathlib.Path(file).write_text(json.dumps(body))

    newer = {}
    for file, names, extra in ((None, "", {}), ("s.scene.json", "layers/0/warmth, light", {"light": "dim", "layers": [{**layer, "warmth": 3}]}),
                               ("oak.texture.json", "humidity_map", {"humidity_map": [1]}), ("mine.transducer.json", "colour", {"colour": "red"})):
        if file:
            newer[file] = names
            add_newer(file, **extra)
        for number, verb in enumerate((["explain", "s", "--transducer", "mine"], ["play", "s", "-d", "sim:", "--time", "0.1s", "--transducer", "mine"],
                                       ["render", "s", "--finger-path", "way.csv", "--transducer", "mine", "-o", f"drive{len(newer)}.wav"])):
            said = tacto.run(*verb, *(["-o", f"n{len(newer)}"] if number == 1 else []))[1]
            lines = [line for line in said.splitlines() if "newer than this program's" in line]
            assert len(lines) == len(newer), (verb, said)
            for name, passed_over in newer.items():
                printed = [line for line in lines if name.split(".")[0] in line and "1.9" in line and f"ignored: {passed_over}" in line]
                assert len(printed) == 1, (name, lines)


def a_rate_that_leaves_the_resonance_in_is_named():
    """At 1.4 kHz the band ends at 400 Hz (2/7 of the rate), below the transducer's resonance: the remedy names 1750 Hz,
    which plays."""
    write_grating()
    play = ("play", "oak", "-d", "sim:", "--time", "0.1s", "--gain", "3.1mm/N")
    said = tacto.run(*play, "--rate", "1.4kHz", "-o", "cut", code=5)[1]
    assert "400 Hz" in said and "1400 " in said and "1750 " in said, said
    tacto.run(*play, "--rate", "1.75kHz", "-o", "whole")


def a_table_named_twice():
    write_grating()
    tacto.run("play", "oak", "-d", "sim:", "--time", "0.2s", "-o", "one")
    for arguments in (("-o", "a.csv", "-o", "./a.csv"), ("-o", "a.csv", "--strokes", "a.csv")):
        assert "is named twice" in tacto.run("session", "one", *arguments, code=2)[1]
        assert not pathlib.Path("a.csv").exists()


if __name__ == "__main__":
    for test in (all_tables_share_one_time, a_counter_that_passes_2_to_the_31_goes_on, where_the_device_reads_nothing_is_not_judged, what_stands_before_a_damage_is_the_same,
                 nothing_felt_has_its_reason, a_misspelling_is_not_played, a_newer_version_is_said_once, a_rate_that_leaves_the_resonance_in_is_named,
                 a_table_named_twice):
        if len(sys.argv) > 1 and test.__name__ not in sys.argv[1:]:
            continue
        tacto.in_folder(test)
