#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph spatial` from the user's view: names, many recordings, averages, positions of real sensors, memory."""
import json
import os
import pathlib
import shutil
import subprocess

import numpy as np
import soundfile

import tacto
from measured import measured

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE = 2, 3, 4, 5
RATE_HZ = 10000


def surface(x_m):
    """Lines at 1 to 6 /mm with different phases, in N."""
    return sum(0.02 * np.sin(2 * np.pi * 1e3 * (1 + 0.31 * k) * x_m + 2.1 * k * k) for k in range(16))


def stroke(from_m, to_m, speed_mps):
    """Positions of a stroke with half a second of rest before it; it starts and stops within 50 ms."""
    ramp_s, way = 0.05, abs(to_m - from_m)
    whole_s = way / speed_mps + ramp_s
    t = np.arange(int(whole_s * RATE_HZ)) / RATE_HZ
    speed = speed_mps * np.clip(np.minimum(t, whole_s - t) / ramp_s, 0, 1)
    moved = np.cumsum(speed)
    return np.concatenate([np.full(RATE_HZ // 2, from_m), from_m + (to_m - from_m) * moved / moved[-1]])


def import_touch(name, position_m, force_n, normal_n=None, counts=None, unit="1m"):
    """A recording of these numbers through the CSV import; `counts` replace the position if they are given."""
    columns = {"force": force_n, "position": position_m if counts is None else counts}
    channels = ["--channel", "tangential_force=force*1N", "--channel", f"position=position*{unit}"]
    if normal_n is not None:
        columns["normal"] = normal_n
        channels += ["--channel", "normal_force=normal*1N"]
    np.savetxt(f"{name}.csv", np.column_stack(list(columns.values())), delimiter=",", fmt="%.12g", comments="",
               header=",".join(columns))
    tacto.run("import", f"{name}.csv", "-o", name, "--rate", "10kHz", *channels)


def forth_and_back(pairs, noise_n=0.0, offsets_m=None, seed=1):
    """(position, force) of strokes from 10 to 30 mm and back; in stroke i the surface is shifted by offsets_m[i]."""
    random = np.random.default_rng(seed)
    positions, forces = [], []
    for i in range(2 * pairs):
        x = stroke(0.01, 0.03, 0.05) if i % 2 == 0 else stroke(0.03, 0.01, 0.04)
        positions.append(x)
        forces.append(surface(x + (0 if offsets_m is None else offsets_m[i])) + noise_n * random.standard_normal(len(x)))
    positions.append(np.full(RATE_HZ // 2, positions[-1][-1]))
    forces.append(np.full(RATE_HZ // 2, forces[-1][-1]))
    return np.concatenate(positions), np.concatenate(forces)


def nothing_is_replaced_in_silence():
    import_touch("oak", *forth_and_back(1))
    tacto.run("spatial", "oak", "-o", "oak")
    before = pathlib.Path("oak-01.texture.wav").stat().st_mtime_ns
    _, said = tacto.run("spatial", "oak", "-o", "oak", code=USAGE)
    assert "oak-01.texture.json" in said and "--force" in said, said
    assert pathlib.Path("oak-01.texture.wav").stat().st_mtime_ns == before
    _, said = tacto.run("spatial", "oak", "-o", "oak", "--force")
    assert "oak-01.texture.json" not in said, said
    _, said = tacto.run("spatial", "oak", "-o", "oak", "--stroke", "1")
    assert "oak-02.texture.json" in said, said


def many_recordings_go_on_past_one_that_fails():
    for i, name in enumerate(["ash", "elm", "oak"]):
        import_touch(name, *forth_and_back(1, seed=i))
    import_touch("still", np.full(20000, 0.01), np.zeros(20000))
    tacto.run("spatial", "ash", "-o", "ash", "--stroke", "1")
    shutil.copy("elm.json", "torn.json")  # its samples are elm's, and elm is a valid recording
    pathlib.Path("torn.json").write_text("{")
    os.mkdir("made")
    names = sorted(str(path) for path in pathlib.Path(".").glob("*.json"))
    done = subprocess.run([tacto.COMMAND, "spatial", *names, "--jobs", "2", "-o", "made/", "--json"],
                          capture_output=True, text=True)
    report = json.loads(done.stdout)
    assert report["done"] == 3 and [pathlib.Path(r["recording"]).name for r in report["recordings"]] == ["ash", "elm", "oak"]
    assert report["skipped"] == ["ash.texture.json (texture)"], report["skipped"]
    assert [row["recording"] for row in report["unsuitable"]] == ["still"], report
    assert len(report["failed"]) == 1 and "torn.json" in report["failed"][0], report
    assert done.returncode == MALFORMED, done.returncode  # a finger at rest is no failure
    assert "still" in done.stderr and "torn" in done.stderr and "skipped" in done.stderr
    made = sorted(path.name for path in pathlib.Path("made").glob("*.texture.wav"))
    assert made == [f"{name}-0{n}.texture.wav" for name in ("ash", "elm", "oak") for n in (1, 2)], made
    # A recording gives the same textures alone and together with others.
    tacto.run("spatial", "elm", "-o", "alone")
    assert pathlib.Path("alone-02.texture.wav").read_bytes() == pathlib.Path("made/elm-02.texture.wav").read_bytes()
    tacto.run("spatial", "ash", "elm", "-o", "made/{}-fine", "--grid", "0.5um", "--stroke", "2")
    assert pathlib.Path("made/elm-fine.texture.json").exists()
    _, said = tacto.run("spatial", "ash", "elm", "-o", "one", code=USAGE)
    assert "one/" in said and "{}" in said, said
    assert [row["texture"] for row in tacto.run_json("describe", "made/")["textures"]] == sorted(
        path.name.removesuffix(".texture.json") for path in pathlib.Path("made").glob("*.texture.json"))
    os.mkdir("empty")
    tacto.run("describe", "empty", code=UNSUITABLE)
    tacto.run("info", "empty", code=NOT_FOUND)
    tacto.run("spatial", "ash", "elm", "-o", "made", "--force")  # a folder without its slash
    said = tacto.run("spatial", "made/ash-01", code=UNSUITABLE)[1]
    assert "texture" in said, said
    tacto.run("spatial", "ash.texture.json", "elm.csv", code=UNSUITABLE)


def recordings_that_do_not_belong_together_are_not_averaged():
    """Different surfaces, measured with simulated, and the same samples by another name: refused, with both names."""
    for name, kind in (("one", "C"), ("two", "C"), ("other", "D")):
        tacto.run("record", "-d", f"sim:surface={kind},seed={len(name)}{ord(name[0])}", "--time", "2s", "-o", name)
    position_m, force_n = forth_and_back(1)
    import_touch("real", position_m, force_n)
    average = ("spatial", "one", "two", "--average", "--both-ways", "-o", "mean")
    simulated = json.loads(pathlib.Path("one.json").read_text())["simulated"]
    tacto.run(*average)
    mean = json.loads(pathlib.Path("mean.texture.json").read_text())
    assert mean["source"]["recording"] == "one.json, two.json" or mean["source"]["recording"] == "one, two", mean["source"]
    assert mean["surface"].startswith("C") and ";" not in mean["surface"] and simulated in mean["simulated"], mean

    mixed = ("spatial", "one", "other", "real", "--average", "--both-ways", "-o", "mixed")
    for recordings in (("one", "other"), ("one", "real"), ("real", "one")):
        said = tacto.run("spatial", *recordings, "--average", "--both-ways", "-o", "mixed", code=UNSUITABLE)[1]
        assert all(name in said for name in recordings) and "--mix" in said, said
    assert not list(pathlib.Path().glob("mixed*"))
    tacto.run(*mixed, "--mix")
    mean = json.loads(pathlib.Path("mixed.texture.json").read_text())
    surfaces = [json.loads(pathlib.Path(f"{name}.json").read_text())["surface"] for name in ("one", "other")]
    assert mean["surface"] == "; ".join(surfaces) and simulated in mean["simulated"], mean
    assert {stroke["recording"].removesuffix(".json") for stroke in mean["average"]["strokes"]} == {"one", "other", "real"}, mean["average"]

    for ending in ("json", "wav"):
        pathlib.Path(f"soft.{ending}").symlink_to(f"one.{ending}")
        pathlib.Path(f"hard.{ending}").hardlink_to(f"one.{ending}")
        shutil.copy(f"one.{ending}", f"copy.{ending}")
    for again, code in (("soft", UNSUITABLE), ("hard", UNSUITABLE), ("copy", UNSUITABLE), ("./one.json", USAGE), (pathlib.Path("one").absolute(), USAGE)):
        for mix in ((), ("--mix",)):
            said = tacto.run("spatial", "one", again, "--average", "-o", "twice", *mix, code=code)[1]
            assert "one" in said and str(again) in said, said
    assert not list(pathlib.Path().glob("twice*"))


def averages_keep_the_spread():
    pairs, noise_n = 8, 0.05
    import_touch("oak", *forth_and_back(pairs, noise_n))
    report = tacto.run_json("spatial", "oak", "--average", "-o", "mean", "--filter", "none")
    assert [row["direction"] for row in report["averages"]] == [1, -1]
    for name, direction in (("mean-forward", 1), ("mean-backward", -1)):
        samples, rate = soundfile.read(f"{name}.texture.wav")
        side = json.loads(pathlib.Path(f"{name}.texture.json").read_text())
        assert rate == 1e6 and samples.shape[1] == 2 and side["direction"] == direction
        assert [channel["name"] for channel in side["channels"]] == ["mean", "standard_deviation"]
        assert len(side["average"]["strokes"]) == pairs and side["average"]["counts"][0]["strokes"] >= pairs // 2
        x = np.arange(len(samples)) * 1e-6
        inside = (x > 2e-3) & (x < x[-1] - 2e-3)
        spread = tacto.rms(samples[inside, 1])
        # The noise is white in time. S_f keeps most of it between its samples: 5 um apart at 50 mm/s on a grid of 1 um.
        assert 0.6 * noise_n < spread < 1.05 * noise_n, spread
        error = tacto.rms((samples[:, 0] - surface(side["source_origin_m"] + x))[inside])
        assert abs(error / (spread / np.sqrt(pairs)) - 1) < 0.1, (error, spread)
        tacto.run("validate", f"{name}.texture.json")
        info = tacto.run_json("info", f"{name}.texture.json")
        assert info["averaged_strokes"] == pairs and info["aligned_by"] == "position" and info["spread_rms_n"] > 0
    one = tacto.run_json("spatial", "oak", "--average", "--both-ways", "-o", "all", "--filter", "none")["averages"]
    assert len(one) == 1 and one[0]["strokes"] == 2 * pairs and one[0]["file"] == "all.texture.json"
    tacto.run("spectrogram", "all", "-o", "all.nc")


def strokes_that_slipped_are_aligned_by_correlation():
    offsets_m = np.array([0, 0, 40e-6, -25e-6, -120e-6, 75e-6, 210.5e-6, 10.25e-6])
    import_touch("oak", *forth_and_back(4, 0.005, offsets_m))
    blurred, sharp = ({row["direction"]: row for row in tacto.run_json(
        "spatial", "oak", "--average", "--align", align, "-o", align)["averages"]} for align in ("position", "correlation"))
    for direction, first in ((1, 0), (-1, 1)):
        shifts = np.array([row["shift_m"] for row in sharp[direction]["averaged"]])
        wanted = offsets_m[first::2] - offsets_m[first]
        assert np.max(np.abs(shifts - wanted)) < 0.5e-6, (shifts, wanted)
        # The rest is noise, and the last 2 mm, where each stroke stops on another part of the surface: its force has
        # another level there, which makes the band-pass ring.
        assert sharp[direction]["spread_rms_n"] < 0.2 * blurred[direction]["spread_rms_n"]
        assert all(row["correlation"] > 0.95 for row in sharp[direction]["averaged"][1:])
    _, said = tacto.run("spatial", "oak", "--average", "--align", "correlation", "--align-range", "60um", "-o", "narrow")
    assert "60 um" in said, said
    tacto.run("spatial", "oak", "--align", "correlation", code=USAGE)


def a_counter_that_ran_over_is_put_right():
    x, force = forth_and_back(1)
    counts = np.round(x / 0.5e-6)
    import_touch("whole", x, force, counts=counts, unit="0.5um")
    import_touch("wrapped", x, force, counts=(counts + 15000) % 65536, unit="0.5um")
    listed = tacto.run_json("spatial", "wrapped", "--list")
    assert listed["counter_bits"] == 16 and listed["counter_wraps"] == 2, listed
    for name in ("whole", "wrapped"):
        _, said = tacto.run("spatial", name, "-o", name)
        assert ("overflowed 1 time" in said) == (name == "wrapped"), said
    for n in (1, 2):
        _, wanted, _ = tacto.texture(f"whole-0{n}")
        _, given, side = tacto.texture(f"wrapped-0{n}")
        np.testing.assert_allclose(given, wanted, atol=1e-9)
        assert side["source"]["counter_bits"] == 16 and side["source"]["counter_wraps"] == 1
    assert soundfile.read("wrapped.wav")[0][:, 1].max() < 65536  # raw data are not changed


def a_noisy_lvdt_gives_the_same_texture():
    """3 um of noise at 50 mm/s (5 um per sample), so that every eighth step goes back. Compared with the true
    position's."""
    x, force = forth_and_back(1)
    import_touch("true", x, force)
    import_touch("lvdt", x + 3e-6 * np.random.default_rng(5).standard_normal(len(x)), force)
    tacto.run("spatial", "true", "-o", "true")
    report = tacto.run_json("spatial", "lvdt", "-o", "lvdt")
    assert len(report["textures"]) == 2 and abs(report["position_noise_m"] - 3e-6) < 0.15e-6, report
    for n in (1, 2):
        (given, wanted), side = both_at(3e-3, f"lvdt-0{n}", f"true-0{n}")
        moved_m = side["source"]["position_moved_m"]
        assert 9e-6 < moved_m <= 19e-6, moved_m  # the largest of thousands of noise values, at most 6 sigma
        error = tacto.rms(given - wanted) / tacto.rms(wanted)
        print(f"noisy LVDT, stroke {n}: {error:.2%} of the RMS, positions moved by up to {moved_m * 1e6:.1f} um")
        # 3 um at 3.4 /mm, the mean of the lines, are 6.4 %; an average over 500 samples reduces that to a tenth.
        assert error < 0.01


def both_at(margin_m, *names):
    """The values of two textures in their common range, `margin_m` from their ends, and the first one's sidecar."""
    textures = [tacto.texture(name) for name in names]
    firsts = [round(side["source_origin_m"] * 1e6) for _, _, side in textures]
    begin, end = max(firsts), min(first + len(values) for first, (_, values, _) in zip(firsts, textures))
    margin = round(margin_m * 1e6)
    return [values[begin + margin - first:end - margin - first] for first, (_, values, _) in zip(firsts, textures)], textures[0][2]


def bands_and_methods_are_chosen():
    import_touch("oak", *forth_and_back(1))
    made = {}
    for method in ("hermite", "sinc"):
        tacto.run("spatial", "oak", "-o", method, "--stroke", "1", "--method", method)
        _, made[method], side = tacto.texture(method)
        assert side["source"]["method"] == method
    assert 0 < tacto.rms(made["hermite"] - made["sinc"]) < 0.02 * tacto.rms(made["sinc"])
    tacto.run("spatial", "oak", "-o", "no", "--method", "swapped", code=USAGE)
    tacto.run("spatial", "oak", "-o", "space", "--stroke", "1", "--band-in", "space", "--band", "0.9/mm..2.1/mm")
    _, values, side = tacto.texture("space")
    assert side["source"]["low_per_m"] == 900 and all(point["high_per_m"] <= 2100 for point in side["valid_band"])
    power = np.abs(np.fft.rfft(values * np.hanning(len(values)))) ** 2
    k = np.fft.rfftfreq(len(values), 1e-3)
    assert power[(k < 0.8) | (k > 2.2)].sum() < 1e-3 * power.sum()
    tacto.run("validate", "space.texture.json")
    tacto.run("spatial", "oak", "-o", "no", "--band-in", "space", code=USAGE)
    tacto.run("spatial", "oak", "-o", "no", "--band-in", "space", "--band", "15Hz..500Hz", code=USAGE)


def a_way_back_is_warned_of():
    x, _ = forth_and_back(1)
    x = x[: len(stroke(0.01, 0.03, 0.05)) + RATE_HZ // 2]
    middle = len(x) // 2
    step = x[middle + 1] - x[middle]
    bumped = np.concatenate([x[:middle], x[middle] - step * np.arange(60), x[middle] + step * np.arange(-60, 0), x[middle:]])
    import_touch("bumped", np.round(bumped * 1e6) * 1e-6, surface(bumped))
    _, said = tacto.run("spatial", "bumped", "-o", "bumped")
    assert " 2 um" in said, said


def fingers_up_are_told_by_the_normal_force():
    x, force = forth_and_back(1)
    pressed = np.where(np.arange(len(x)) < len(stroke(0.01, 0.03, 0.05)), 0.8, 0.005)
    import_touch("lifted", x, force, pressed)
    out, said = tacto.run("spatial", "lifted", "-o", "lifted", "--json")
    assert "stroke 2" in said and [t["stroke"] for t in json.loads(out)["textures"]] == [1]
    import_touch("above", x, force, np.full(len(x), 0.003))
    _, said = tacto.run("spatial", "above", "-o", "above", code=UNSUITABLE)
    assert "--finger-up" in said, said


def long_recordings_need_little_memory():
    """600 s at 10 kHz, one 40 mm stroke per second, written by the definition of the format: 144 MB of samples."""
    t = np.arange(RATE_HZ) / RATE_HZ
    way = np.minimum(0.05 * (t + 0.1 * np.sin(2 * np.pi * 3.75 * t) / (2 * np.pi * 3.75)), 0.04)
    second = np.concatenate([way, 0.04 - way])
    x = np.round(np.tile(second, 300) * 1e6) * 1e-6
    force = 0.3 + 1e-5 * np.arange(len(x)) / RATE_HZ + surface(x)
    np.savetxt("short.csv", np.column_stack([force, x])[:100], delimiter=",", fmt="%.9g", header="force,x", comments="")
    tacto.run("import", "short.csv", "-o", "long", "--rate", "10kHz", "--channel", "tangential_force=force*1N",
              "--channel", "position=x*1m")
    side = json.loads(pathlib.Path("long.json").read_text())
    soundfile.write("long.wav", np.column_stack([force, x]), RATE_HZ, subtype="DOUBLE", format="RF64")
    data = pathlib.Path("long.wav")
    side["data"]["frames"] = len(x)
    side["data"]["sha256"] = subprocess.run(["sha256sum", data], capture_output=True, text=True, check=True).stdout.split()[0]
    pathlib.Path("long.json").write_text(json.dumps(side))
    idle = tacto.peak_mb("--version")
    for more in ([], ["--filter", "butterworth"]):
        peak = tacto.peak_mb("spatial", "long", "-o", "t", "--force", *more)
        measured(f"spatial.{more[-1] if more else 'fourier'}_600_s_mb", peak - idle)
        tacto.expect_little_memory(" ".join(["600 s at 10 kHz", *more]), peak, idle)
    assert len(list(pathlib.Path(".").glob("t-*.texture.wav"))) == 600


if __name__ == "__main__":
    for test in (nothing_is_replaced_in_silence, many_recordings_go_on_past_one_that_fails,
                 recordings_that_do_not_belong_together_are_not_averaged, averages_keep_the_spread,
                 strokes_that_slipped_are_aligned_by_correlation, a_counter_that_ran_over_is_put_right,
                 a_noisy_lvdt_gives_the_same_texture, bands_and_methods_are_chosen, a_way_back_is_warned_of, fingers_up_are_told_by_the_normal_force,
                 long_recordings_need_little_memory):
        tacto.in_folder(test)
