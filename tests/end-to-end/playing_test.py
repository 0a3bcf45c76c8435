#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How a user plays: the forms of the gain, the finger's path, Ctrl-C, the pace, and a finger off the texture."""
import json
import pathlib
import signal
import subprocess

import numpy as np
import soundfile

import tacto
from play_test import write_grating


def write_path(text, name="path.csv"):
    pathlib.Path(name).write_text(text)


def report_of(verb, *arguments):
    """The report of play or render with one texture and one path."""
    rest = ("-d", "sim:", "-o", "out") if verb == "play" else ("--transducer", "wiertlewski2011", "--force", "-o", "out.wav")
    pathlib.Path("out.session").unlink(missing_ok=True)
    return tacto.run_json(verb, *arguments, "--finger-path", "path.csv", *rest)


def play_prints_the_power_that_its_band_keeps():
    write_grating()
    for seconds, enough in ((0.4, True), (8, False)):
        write_path(f"time_s,position_mm\n0,4\n{seconds},20\n")
        pathlib.Path("out.session").unlink(missing_ok=True)
        played = tacto.run_json("play", "oak", "--finger-path", "path.csv", "-d", "sim:", "-o", "out")
        printed = tacto.run_json("session", "out")
        assert played["power_kept_percent"] == printed["power_kept_percent"] and played["mean_speed_mps"] == printed["mean_speed_mps"], (played, printed)
        assert np.isclose(played["mean_speed_mps"], 0.016 / seconds, rtol=0.05), played
        assert (played["power_kept_percent"] >= 90) == enough, played


def a_gain_is_a_factor_or_a_displacement_for_force():
    write_grating()
    write_path("time_s,position_mm\n0,4\n0.5,20\n")
    layers = [{"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": -4e-4}]
    pathlib.Path("s.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": layers}))
    for verb in ("play", "render"):
        peaks = set()
        for text in ("0.5x", "50%", "0.5mm/N", "500um/N"):
            report = report_of(verb, "oak", "--gain", text)
            assert np.isclose(report["gain_m_per_n"], 5e-4, rtol=1e-12) and np.isclose(report["gain_times_default"], 0.5, rtol=1e-12), report
            peaks.add(round(report["drive_peak_v"], 9))
        assert len(peaks) == 1, peaks
        assert "gain_times_default" not in report_of(verb, "oak")
        scene = report_of(verb, "s", "--gain", "50%")
        assert np.isclose(scene["gain_m_per_n"], -2e-4, rtol=1e-12) and scene["inverts_texture"], scene
        rest = ("--finger-path", "path.csv") + (("-d", "sim:", "-o", "no") if verb == "play" else ("--transducer", "wiertlewski2011", "-o", "no.wav"))
        for what, gain in (("oak", "0.5"), ("oak", "0.5N"), ("oak", "inf%"), ("s", "1mm/N")):
            error = json.loads(tacto.run(verb, what, f"--gain={gain}", *rest, "--json", code=2)[1])
            assert "2x" in error["what"] + error["remedy"], error
    # What a refusal names, fits; in both forms it is the same gain. The default is that in the texture's file.
    side = json.loads(pathlib.Path("oak.texture.json").read_text())
    pathlib.Path("oak.texture.json").write_text(json.dumps({**side, "playback_gain": {"gain_m_per_n": 2e-4}}))
    for verb in ("play", "render"):
        rest = ("--finger-path", "path.csv") + (("-d", "sim:", "-o", "big") if verb == "play" else ("--transducer", "wiertlewski2011", "-o", "big.wav"))
        remedy = json.loads(tacto.run(verb, "oak", "--gain", "9mm/N", *rest, "--json", code=5)[1])["remedy"]
        plain, factor = remedy.split("fits is ")[1].split(";")[0].rstrip(")").split(" (")
        gains = [report_of(verb, "oak", "--gain", text)["gain_m_per_n"] for text in (plain, factor)]
        assert abs(gains[0] / gains[1] - 1) < 2e-3, remedy  # each is rounded to four digits
        assert np.isclose(gains[1], 2e-4 * float(factor[:-1]), rtol=1e-12), remedy
    # fidelity judges what it plays: with the gain in the texture's file.
    judged = tacto.run_json("fidelity", "oak", "-d", "sim:hysteresis=0", "--speed", "50mm/s")
    assert judged["gain_m_per_n"] == 2e-4 and judged["fidelity"][0]["error_db"] < -40, judged


def a_path_has_units_and_is_repeated():
    write_grating()
    write_path("time_s,position_m\n0,0.004\n0.5,0.03\n")
    as_si = report_of("play", "oak", "--gain", "0.5mm/N")
    ticks = {}
    for name, text in (("mm", "time (ms),position (mm)\n0,4\n500,30\n"), ("si", "time_s,position_m\n0,0.004\n0.5,0.03\n")):
        write_path(text)
        report = report_of("play", "oak", "--gain", "0.5mm/N")
        assert report["ticks"] == as_si["ticks"], (name, report)
        tacto.run("session", "out", "--force", "-o", f"{name}.csv")
        ticks[name] = np.genfromtxt(f"{name}.csv", delimiter=",", names=True)
        report_of("render", "oak", "--gain", "0.5mm/N")
        pathlib.Path("out.wav").rename(f"{name}.wav")
    np.testing.assert_array_equal(ticks["mm"]["encoder_count"], ticks["si"]["encoder_count"])
    np.testing.assert_allclose(soundfile.read("mm.wav")[0], soundfile.read("si.wav")[0], atol=1e-6)
    for verb in ("play", "render"):
        once = report_of(verb, "oak", "--gain", "0.5mm/N")
        thrice = report_of(verb, "oak", "--gain", "0.5mm/N", "--repeat", "3")
        seconds = [report["played_s" if verb == "play" else "duration_s"] for report in (once, thrice)]
        assert abs(seconds[1] - seconds[0] - 1.0) < 0.02, (verb, seconds)  # steps of 10 ms of play
        write = ("-d", "sim:", "-o", "none") if verb == "play" else ("--transducer", "wiertlewski2011", "-o", "none.wav")
        for wrong in ("0", "1.5", "-1"):
            tacto.run(verb, "oak", "--finger-path", "path.csv", f"--repeat={wrong}", *write, code=2)
    tacto.run("play", "oak", "-d", "sim:", "--repeat", "3", "-o", "none", code=2)  # without a path
    report_of("play", "oak", "--gain", "0.5mm/N", "--repeat", "3")
    strokes = tacto.run_json("session", "out")["strokes"]
    assert [np.sign(s["to_m"] - s["from_m"]) for s in strokes] == [1, -1, 1], strokes


def ctrl_c_ends_a_playback_whole():
    write_grating()
    for how in (signal.SIGINT, signal.SIGTERM):
        command = [tacto.COMMAND, "play", "oak", "-d", "sim:paced=1", "--gain", "0.5mm/N", "--time", "60s", "-o", how.name, "--json", "--progress"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as playing:
            while "playing" not in (line := playing.stderr.readline()):  # its progress
                assert line, "it ended before it played"
            playing.send_signal(how)
            out, err = playing.communicate(timeout=60)
        assert playing.returncode == 0, (how, err)
        report = json.loads(out)
        assert 0 < report["played_s"] < 50 and report["lost_ticks"] == 0, report
        assert tacto.run_json("replay", how.name)["same_to_the_bit"]
        tacto.run("validate", f"{how.name}.session")
        tacto.run("session", how.name, "-o", "ticks.csv", "--force")
        ticks = np.genfromtxt("ticks.csv", delimiter=",", names=True)
        assert len(ticks) == report["ticks"] and np.all(ticks["drive_v"][-20:] == 0), "the drive did not fall to zero"


def the_pace_is_reported():
    write_grating()
    report = tacto.run_json("play", "oak", "-d", "sim:", "--time", "1s", "--gain", "0.5mm/N", "-o", "fast")
    assert report["times_real_time"] > 0 and "paced=1" in report["pace"], report
    paced = tacto.run_json("play", "oak", "-d", "sim:paced=1", "--time", "0.3s", "--gain", "0.5mm/N", "-o", "paced")
    assert {"times_real_time", "pace"}.isdisjoint(paced), paced


def a_finger_off_the_texture_is_reported():
    """The path is straight, so its time off the texture is its length off the texture."""
    write_grating(length_m=0.02)
    warned = lambda report: [w for w in report.get("warnings", []) if "off the texture" in w]
    for to_mm, percent in ((21, 100 / 21), (25, 20), (40, 50)):
        write_path(f"time_s,position_mm\n0,0\n1,{to_mm}\n")
        played = report_of("play", "oak", "--gain", "0.2mm/N")
        # Half a tick, and 10 ms of play at each end.
        assert abs(played["off_texture_percent"] - percent) < 2, (to_mm, played)
        rendered = report_of("render", "oak", "--gain", "0.2mm/N")
        assert abs(100 * rendered["samples_outside_texture"] / 10000 - percent) < 0.1, (to_mm, rendered)
        for report in (played, rendered):
            found = warned(report)
            assert len(found) == (percent > 10), (to_mm, report)
            assert not found or (f"{percent:.0f} %" in found[0] and "--at" in found[0] and "--ends" in found[0]), found
    for report in (report_of("play", "oak", "--gain", "0.2mm/N", "--ends", "mirror"), report_of("render", "oak", "--gain", "0.2mm/N", "--ends", "loop")):
        assert not warned(report), report
    # A texture that the finger never reaches has its own warning.
    silent = tacto.run_json("play", "oak", "-d", "sim:", "--finger-path", "path.csv", "--at", "1m", "-o", "silent")
    assert silent["off_texture_percent"] == 100 and not warned(silent) and "nothing was played" in silent["warnings"][0], silent


TESTS = [play_prints_the_power_that_its_band_keeps, a_gain_is_a_factor_or_a_displacement_for_force, a_path_has_units_and_is_repeated, ctrl_c_ends_a_playback_whole,
         the_pace_is_reported, a_finger_off_the_texture_is_reported]

if __name__ == "__main__":
    for test in TESTS:
        tacto.in_folder(test)
