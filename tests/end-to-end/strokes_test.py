#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""One definition of a stroke: a recording has the same strokes in record, import, recover, info, list and spatial."""
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess

import numpy as np
import soundfile

import tacto
from spatial_test import RATE_HZ, UNSUITABLE, import_touch, stroke, surface


def strokes_everywhere(name, reported=None):
    """The strokes of a recording, after checking that every verb gives the same."""
    found = tacto.run_json("spatial", name, "--list").get("strokes", [])
    stored = json.loads(pathlib.Path(f"{name}.json").read_text()).get("strokes", [])
    shown = tacto.run_json("info", name).get("strokes", [])
    row = next(row for row in tacto.run_json("list", os.path.dirname(os.path.abspath(name)))["list"] if row["name"] == os.path.basename(name))
    assert row.get("strokes", 0) == len(found) == len(stored) == len(shown), (name, row, found, stored, shown)
    for one, other, kept in zip(found, shown, stored, strict=True):
        assert one["stroke"] == other["stroke"] and one["direction"] == other["direction"] == kept["direction"], (one, other, kept)
        for key in ("length_m", "mean_speed_mps"):
            assert one[key] == other[key] == kept[key], (key, one, other, kept)
        assert one.get("normal_force_n") == other.get("mean_normal_n"), (one, other)
    if reported is not None:
        assert [s["length_m"] for s in reported.get("strokes", [])] == [s["length_m"] for s in found], (name, reported, found)
    return found


def short_gaps_do_not_end_a_stroke():
    """Six gaps of up to 4 frames (0.5 ms at 10 kHz) are interpolated; longer ones leave pieces of 5 mm."""
    tacto.run("record", "-d", "sim:surface=C,seed=1", "--time", "1s", "-o", "whole")
    tacto.run("spatial", "whole", "-o", "whole")
    codes, rate = soundfile.read("whole.wav", dtype="int32", always_2d=True)
    side = json.loads(pathlib.Path("whole.json").read_text())
    side["data"].pop("numbers_sha256")
    side.pop("strokes")
    _, force_n, stored = tacto.texture("whole")
    for name, length in (("one", 1), ("four", 4), ("five", 5)):
        starts = range(2000, 8000, 1000)
        kept = np.delete(codes, [start + i for start in starts for i in range(length)], axis=0)
        soundfile.write(f"{name}.wav", kept, rate, subtype="PCM_32")
        side["data"] |= {"file": f"{name}.wav", "frames": len(kept), "sha256": hashlib.sha256(pathlib.Path(f"{name}.wav").read_bytes()).hexdigest()}
        side["gaps"] = [{"frame": start - k * length, "device_sequence": start + length, "count": length} for k, start in enumerate(starts)]
        pathlib.Path(f"{name}.json").write_text(json.dumps(side))
        tacto.run("validate", name)
        found = tacto.run_json("record", "-d", f"replay:{name}", "-o", f"again-{name}", "--allow-gaps")["strokes"]
        if length == 5:
            assert all(row["length_m"] < 0.01 for row in found), found
            continue
        assert len(found) == 1 and found[0]["lost_frames"] == 6 * length, found
        report = tacto.run_json("spatial", name, "-o", name)
        assert len(report["textures"]) == 1 and any("interpolated" in one for one in report["warnings"]), report
        _, bridged_n, about = tacto.texture(name)
        assert about["source"]["interpolated_frames"] == 6 * length and about["source_origin_m"] == stored["source_origin_m"], about
        error_db = 20 * np.log10(tacto.rms(bridged_n - force_n) / tacto.rms(force_n))
        print(f"six gaps of {length} frames: {error_db:.1f} dB of the RMS")
        assert error_db < -40, error_db


def a_changed_scale_is_warned_of():
    """Without the checksum of its numbers, as after a change on purpose, the sidecar still has the strokes as recorded."""
    tacto.run("record", "-d", "sim:seed=1", "--time", "2s", "-o", "scaled")
    side = json.loads(pathlib.Path("scaled.json").read_text())
    side["data"].pop("numbers_sha256")
    position = next(channel for channel in side["channels"] if channel["name"] == "position")
    for scale, warned in ((1.04e-6, 0), (2e-6, 1), (0.5e-6, 1)):
        position["scale"] = scale
        pathlib.Path("scaled.json").write_text(json.dumps(side))
        warnings = tacto.run_json("spatial", "scaled", "--force", "-o", "scaled").get("warnings", [])
        assert len([one for one in warnings if "mean speed" in one]) == warned, (scale, warnings)


def recordings_have_the_same_strokes_everywhere():
    for name, device, arguments, count in (
            ("whole", "sim:seed=1", ("--time", "2s"), 2), ("cut", "sim:seed=1", ("--time", "1.4s"), 2), ("begun", "sim:seed=1", ("--time", "0.15s"), 0),
            ("five", "sim:seed=3,length=12mm", ("--strokes", "5"), 5), ("fast", "sim:speed=200mm/s,seed=4", ("--time", "3s"), None),
            ("slow", "sim:speed=3mm/s,length=15mm,seed=5", ("--strokes", "2"), 2), ("lvdt", "sim:position=lvdt,seed=6", ("--time", "3s"), None),
            ("short", "sim:length=10mm,seed=7", ("--time", "1s"), 0)):
        found = strokes_everywhere(name, tacto.run_json("record", "-d", device, *arguments, "-o", name))
        assert count is None or len(found) == count, (name, found)
    # A recording with a gap in a stroke, and one that was killed.
    side = json.loads(pathlib.Path("whole.json").read_text())
    side["data"].pop("numbers_sha256")
    side["gaps"] = [{"frame": 5000, "device_sequence": 5500, "count": 500}]
    pathlib.Path("whole.json").write_text(json.dumps(side))
    found = strokes_everywhere("gap", tacto.run_json("record", "-d", "replay:whole", "-o", "gap", "--allow-gaps"))
    assert len(found) == 3, found
    assert [s["lost_frames"] for s in tacto.run_json("info", "gap")["strokes"]] == [500, 500, 0]
    with subprocess.Popen([tacto.COMMAND, "record", "-d", "sim:paced=1,seed=8", "-o", "killed"], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as recording:
        wav = pathlib.Path("killed.wav")
        while not wav.exists() or wav.stat().st_size < 4 * 4 * 1.5 * RATE_HZ:
            assert recording.poll() is None
        recording.send_signal(signal.SIGKILL)
    tacto.run("recover", "killed")
    assert strokes_everywhere("killed")


def the_rule_is_kept():
    """5 mm; 5 % of the longest motion; a pause of 0.1 s. Half a resolution of the speed's window (20 ms) is left out."""
    cases = {"below": ([stroke(0, 0.0046, 0.05)], 0), "above": ([stroke(0, 0.0054, 0.05)], 1),
             "longest": ([stroke(0, 0.2, 0.2), stroke(0.2, 0.1912, 0.05)], 1), "twentieth": ([stroke(0, 0.2, 0.2), stroke(0.2, 0.1885, 0.05)], 2),
             "halt": ([stroke(0, 0.02, 0.05), stroke(0.02, 0.04, 0.05)[-int(0.46 * RATE_HZ) - 600:]], 1), "pause": ([stroke(0, 0.02, 0.05), stroke(0.02, 0.04, 0.05)], 2)}
    for name, (parts, count) in cases.items():
        position_m = np.concatenate([*parts, np.full(RATE_HZ // 2, parts[-1][-1])])
        import_touch(name, position_m, surface(position_m))
        assert len(strokes_everywhere(name)) == count, name
    said = json.loads(tacto.run("spatial", "below", "-o", "below", "--json", code=UNSUITABLE)[1])
    assert " 4." in said["what"] and "--from" in said["remedy"], said
    tacto.run("spatial", "below", "--from", "0.5s", "--to", "0.6s", "-o", "below")  # as the message says


def a_batch_warns_once():
    """Strokes and recordings that are too short are skipped with one warning in all; one cause gives one error."""
    os.mkdir("study")
    good = np.concatenate([stroke(0.01, 0.03, 0.05), np.full(RATE_HZ // 2, 0.03)])
    # 6 mm at 150 mm/s take less than 1/15 s.
    part = np.concatenate([stroke(0.01, 0.03, 0.05), np.full(RATE_HZ // 2, 0.03), 0.03 - 0.15 * np.arange(401) / RATE_HZ, np.full(RATE_HZ // 2, 0.03 - 0.006)])
    fast = np.concatenate([np.full(RATE_HZ // 2, 0.03), 0.03 - 0.15 * np.arange(401) / RATE_HZ, np.full(RATE_HZ // 2, 0.03 - 0.006)])
    little = np.concatenate([stroke(0, 0.003, 0.05), stroke(0.003, 0, 0.05), np.full(RATE_HZ // 2, 0.0)])
    still = np.full(2 * RATE_HZ, 0.01)
    for name, position_m in (("a-good", good), ("b-part", part), ("c-fast", fast), ("d-little", little), ("e-still", still), ("f-still", still)):
        import_touch(f"study/{name}", position_m, surface(position_m))
    tacto.run("spatial", "study/a-good", "-o", "study/other")  # a texture in the folder is no recording
    os.mkdir("made")

    def batch(*names, code):
        done = subprocess.run([tacto.COMMAND, "spatial", *names, "-o", "made/", "--force", "--json"], capture_output=True, text=True)
        assert done.returncode == code, done
        return (json.loads(done.stdout) if done.stdout else json.loads(done.stderr)), tacto.unwrapped(done.stderr).splitlines()

    report, lines = batch("study", code=0)
    assert report["done"] == 2 and report["too_short"] == ["study/b-part: stroke 2", "study/c-fast: stroke 1", "study/d-little: 2 motions"], report
    assert len(report["unsuitable"]) == 2 and "failed" not in report, report
    short = [line for line in lines if "too short" in line]
    assert len(short) == 1 and "2 strokes" in short[0] and "2 motions" in short[0] and all(name in short[0] for name in ("b-part", "c-fast", "d-little")), lines
    failed = [line for line in lines if "does not change" in line]
    assert len(failed) == 1 and "e-still" in failed[0] and "f-still" in failed[0], lines
    assert len(lines) == 2, lines
    assert {path.name for path in pathlib.Path("made").glob("*.json")} == {"a-good.texture.json", "b-part-01.texture.json"}
    # Without any texture it is an error, and its cause is stated once.
    error, lines = batch("study/e-still", "study/f-still", code=UNSUITABLE)
    assert "2 files" in error["where"] and len(lines) == 1, (error, lines)
    each = subprocess.run([tacto.COMMAND, "spatial", "study/a-good", "study/b-part", "--average", "-o", "mean-{}"], capture_output=True, text=True)
    assert each.returncode == UNSUITABLE and len(tacto.unwrapped(each.stderr).splitlines()) <= 3, each
    # Only what is too short: no failure, as long as a texture is made.
    for name in ("e-still", "f-still"):
        os.remove(f"study/{name}.json")
    report, lines = batch("study", code=0)
    assert report["done"] == 2 and "failed" not in report and len(lines) == 1, (report, lines)
    error, lines = batch("study/c-fast", "study/d-little", code=UNSUITABLE)
    assert "c-fast" in error["what"] and "d-little" in error["what"] and len(lines) == 1, (error, lines)
    # The mean of several recordings.
    shutil.copy("study/a-good.csv", "again.csv")
    import_touch("study/again", good, 0.9 * surface(good))
    _, said = tacto.run("spatial", "study/a-good", "study/again", "study/b-part", "study/c-fast", "--average", "--both-ways", "-o", "mean")
    assert len([line for line in said.splitlines() if "too short" in line]) == 1, said
    os.mkdir("empty")
    tacto.run("spatial", "empty", code=UNSUITABLE)


def columns_of_a_table_are_told_apart():
    from play_test import write_grating
    write_grating()
    pathlib.Path("path.csv").write_text("time_s,position_mm\n0,4\n0.5,30\n1,4\n")
    tacto.run("play", "oak", "-d", "sim:", "--gain", "50%", "--finger-path", "path.csv", "-o", "first")
    out, _ = tacto.run("session", "first")
    header = next(line for line in out.splitlines() if line.strip().startswith("from"))
    for column in ("from (time)", "to (time)", "from (length)", "to (length)"):
        assert header.count(column) == 1, header


TESTS = [short_gaps_do_not_end_a_stroke, a_changed_scale_is_warned_of, recordings_have_the_same_strokes_everywhere, the_rule_is_kept, a_batch_warns_once, columns_of_a_table_are_told_apart]

if __name__ == "__main__":
    for test in TESTS:
        tacto.in_folder(test)
