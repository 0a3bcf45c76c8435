#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The next command that `import` prints works with any channels; masked outliers are read correctly by it."""
import pathlib
import subprocess

import numpy as np

import tacto

RATE = ["--rate", "10kHz"]
N = 12000


def table(name="in.csv", spoilt=()):
    """A finger moves 40 mm at 40 mm/s over ridges of 1 mm; the force of some rows has lost its exponent."""
    t = np.arange(N) / 1e4
    x = np.clip(t - 0.1, 0, 1) * 40
    f = 0.1 * np.sin(2 * np.pi * x) + 0.01 * np.sin(2 * np.pi * 7.3 * x + 1)
    f[list(spoilt)] = 4581.0
    np.savetxt(name, np.column_stack([f, f * 3, x]), fmt="%.9g", delimiter=",", header="f,a,x", comments="")
    return name


def next_of(name, *channels):
    report = tacto.run_json("import", table(), "-o", name, *RATE, *(word for one in channels for word in ("--channel", one)))
    # As pasted into a shell.
    line = report["next"].replace("tactograph", tacto.COMMAND, 1)
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True)
    assert done.returncode == 0, (report["next"], done.stderr)
    return report["next"]


def the_next_command_works():
    x, f = "position=x*1mm", "tangential_force=f*1N"
    assert next_of("both", f, x) == "tactograph spatial both -o both"
    assert next_of("acc", "acceleration=a*1g", x) == "tactograph spatial acc --channel acceleration -o acc"
    assert next_of("labelled", "left one:tangential_force=f*1N", x) == \
        "tactograph spatial labelled --channel 'left one' -o labelled"
    assert next_of("two", "net_force=f*1N", "acceleration=a*1g", x).endswith(
        "--channel net_force -o two  # or --channel acceleration")
    axes = [f"{name}:acceleration={column}*1g" for name, column in (("ax", "a"), ("ay", "f"), ("az", "2"))]
    assert next_of("axes", *axes, x) == "tactograph spatial axes --channel acceleration:dft321 -o axes  # or --channel ax, ay, az"
    assert next_of("force-and-axes", "net_force=f*1N", *axes, x).endswith(
        "--channel net_force -o force-and-axes  # or --channel acceleration:dft321, ax, ay, az")
    assert next_of("two-axes", *axes[:2], x).endswith("--channel ax -o two-axes  # or --channel ay")
    assert next_of("a'b c", f, x) == "tactograph spatial 'a'\\''b c' -o 'a'\\''b c'"
    assert next_of("placeless", f) == "tactograph info placeless"
    assert next_of("normal", "normal_force=f*1N", x) == "tactograph info normal"


def a_short_profile_gets_a_window_that_fits():
    for samples in (12, 40, 300):
        np.savetxt("profile.csv", np.sin(np.arange(samples)), header="h", comments="")
        report = tacto.run_json("import", "profile.csv", "-o", f"profile-{samples}", "--pitch", "10um", "--channel", "height=h*1um")
        done = subprocess.run(["bash", "-c", report["next"].replace("tactograph", tacto.COMMAND, 1)], capture_output=True, text=True)
        assert done.returncode == 0 and "spectrogram" in report["next"], (report["next"], done.stderr)


def a_unit_against_the_heading_is_warned_of():
    pathlib.Path("heads.csv").write_text("force_n,position_mm\n" + "".join(f"{0.1 * (i % 7)},{i * 0.01}\n" for i in range(2000)))
    force = ["--channel", "tangential_force=force_n"]
    for scale, warned in (("", 0), ("*1mm", 0), ("*1000um", 0), ("*1um", 1)):
        report = tacto.run_json("import", "heads.csv", "-o", f"head{scale[1:]}", *RATE, *force, "--channel", f"position=position_mm{scale}")
        about = [one for one in report.get("warnings", []) if "'position_mm'" in one and "mm" in one]
        assert len(about) == warned, (scale, report)


def masked_outliers_leave_the_texture():
    """Two rows of 12,000 are wrong: with the mask, the longest texture equals that of the correct table there."""
    channels = ["--channel", "tangential_force=f*1N", "--channel", "position=x*1mm"]
    tacto.run("import", table("sound.csv"), "-o", "sound", *RATE, *channels)
    spoilt = table("spoilt.csv", spoilt=(2100, 9100))
    report = tacto.run_json("import", spoilt, "-o", "spoilt", *RATE, *channels)
    assert report["gaps"] == 0 and "--mask-outliers" in report["outliers"], report
    report = tacto.run_json("import", spoilt, "-o", "masked", "--mask-outliers", *RATE, *channels)
    assert report["gaps"] == 2 and report["frames"] == N - 2 and "2 rows" in report["outliers"], report
    assert any("line 2102" in one and "line 9102" in one for one in report["warnings"]), report["warnings"]
    tacto.run("validate", "masked")
    assert tacto.run_json("info", "masked")["missing_frames"] == 2
    tacto.run("spatial", "sound", "-o", "sound")
    repeated = tacto.run_json("spatial", "spoilt", "-o", "spoilt").get("warnings", [])
    assert any("tangential_force: 2 of 12000 samples" in one for one in repeated), repeated
    strokes = tacto.run_json("spatial", "masked", "-o", "masked")["textures"]
    longest = max(strokes, key=lambda row: row["length_m"])
    place, values, side = tacto.texture(str(pathlib.Path(longest["file"])).removesuffix(".texture.json"))
    whole_place, whole, whole_side = tacto.texture("sound")
    shift = round((side["source_origin_m"] - whole_side["source_origin_m"]) / side["pitch_m"])
    edge = 5000  # 5 mm: there the band-pass of 15 Hz (2.7 mm here) depends on the different ends
    error = values[edge:-edge] - whole[shift + edge:shift + len(values) - edge]
    print(f"longest texture {longest['length_m'] * 1e3:.1f} mm; error {20 * np.log10(tacto.rms(error) / tacto.rms(whole)):.0f} dB")
    # A wrong sample would be 4581 N among 0.1 N. The rest is the effect of the filter's ends: -30 dB allowed.
    assert tacto.rms(error) < 10 ** (-30 / 20) * tacto.rms(whole), tacto.rms(error) / tacto.rms(whole)


def real_outliers_are_masked():
    dirty = tacto.DATA / "dirty" / "T1.csv"
    if not dirty.exists():
        print("skipped: no real data")
        return
    report = tacto.run_json("import", dirty, "-o", "t1", "--mask-outliers", "--rate", "1kHz", "--channel", "acceleration=acc*1m/s^2",
                          "--channel", "normal_force=normal_force_N*1N", "--channel", "speed=speed_mm_s*1mm/s")
    assert report["frames"] == 9997 and report["gaps"] == 3, report
    speed = next(row for row in report["channels"] if row["name"] == "speed")
    assert 0.014 < speed["smallest"] and speed["largest"] < 0.3, speed
    tacto.run("validate", "t1")
    tacto.run("spatial", "t1", "--channel", "acceleration", "-o", "t1")


if __name__ == "__main__":
    for test in (the_next_command_works, a_short_profile_gets_a_window_that_fits, masked_outliers_leave_the_texture, a_unit_against_the_heading_is_warned_of, real_outliers_are_masked):
        tacto.in_folder(test)
