#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings that `tactograph spatial` must refuse, warn about, or combine."""
import json
import pathlib

import numpy as np
import soundfile

import tacto

USAGE, UNSUITABLE = 2, 5
RATE_HZ = 10000


def surface(x_m):
    return sum(0.02 * np.sin(2 * np.pi * 1e3 * (1 + 0.31 * k) * x_m + 2.1 * k * k) for k in range(16))


def stroke(from_m, to_m, speed_mps=0.05, rest_s=0.5):
    t = np.arange(int(abs(to_m - from_m) / speed_mps * RATE_HZ) + 1) / RATE_HZ
    return np.concatenate([np.full(int(rest_s * RATE_HZ), from_m), from_m + np.sign(to_m - from_m) * speed_mps * t])


def import_columns(name, rate="10kHz", **channels):
    """channels: name -> (quantity, unit, values); the position in um counts."""
    columns = [values for _, _, values in channels.values()]
    np.savetxt(f"{name}.csv", np.column_stack(columns), delimiter=",", fmt="%.12g", comments="", header=",".join(channels))
    words = []
    for column, (quantity, unit, _) in channels.items():
        words += ["--channel", f"{quantity}={column}*{unit}"]
    tacto.run("import", f"{name}.csv", "-o", name, "--rate", rate, *words)


def touch(name, x_m, force_n, unit="1N"):
    counts = np.round(x_m * 1e6)
    import_columns(name, force=("tangential_force", unit, force_n), count=("position", "1um", counts))


def a_jump_of_the_encoder_is_refused_with_its_sample():
    x = np.concatenate([stroke(0.01, 0.055), np.full(RATE_HZ // 2, 0.055)])
    force = surface(x)
    at = RATE_HZ // 2 + 4000
    jumped = x.copy()
    jumped[at:] += 1.0
    touch("jump", jumped, force)
    _, said = tacto.run("spatial", "jump", "-o", "t", code=UNSUITABLE)
    assert f"sample {at}, at 0.9 s" in said, said
    assert not list(pathlib.Path(".").glob("*.texture.*"))
    _, said = tacto.run("spatial", "jump", "-o", "t", "--from", "0.6s", "--to", "1.2s", code=UNSUITABLE)
    assert f"sample {at}" in said, said
    rows = tacto.run_json("spatial", "jump", "--list")["position_jumps"]
    assert [(row["sample"], round(row["step_m"], 3)) for row in rows] == [(at, 1.0)], rows
    # The part before it is a texture, as it would be without it.
    tacto.run("spatial", "jump", "-o", "before", "--from", "0.55s", "--to", "0.85s")
    touch("whole", x, force)
    tacto.run("spatial", "whole", "-o", "same", "--from", "0.55s", "--to", "0.85s")
    one, other = (soundfile.read(f"{name}.texture.wav", dtype="float64")[0] for name in ("before", "same"))
    np.testing.assert_allclose(one, other, atol=1e-6)
    tacto.run("validate", "before")


def other_strokes_survive_a_jump():
    x = np.concatenate([stroke(0.01, 0.04), stroke(0.04, 0.01), stroke(0.01, 0.04), np.full(RATE_HZ // 2, 0.04)])
    jumped = x.copy()
    at = len(stroke(0.01, 0.04)) + RATE_HZ // 2 + 3000  # half way back
    jumped[at:] -= 0.3
    touch("jump", jumped, surface(x))
    out, said = tacto.run("spatial", "jump", "-o", "t")
    assert f"sample {at}" in said, said
    made = sorted(path.name for path in pathlib.Path(".").glob("t*.texture.json"))
    assert len(made) == 2, made
    for name in made:
        length_m = json.loads(pathlib.Path(name).read_text())["data"]["samples"] * 1e-6
        assert abs(length_m - 0.03) < 1e-3, (name, length_m)
        tacto.run("validate", name)


def positions_that_are_held_or_coarse_do_not_jump():
    """A slow encoder's position, held over 100 samples, and slips of 2 mm at 1 kHz."""
    x = np.concatenate([stroke(0.01, 0.05, rest_s=0.2), np.full(RATE_HZ // 5, 0.05)])
    held = x[np.arange(len(x)) // 100 * 100]
    touch("held", held, surface(x))
    assert "position_jumps" not in tacto.run_json("spatial", "held", "--list")
    t = np.arange(3000)
    slips = 0.01 + 0.002 * (t // 200)
    import_columns("slips", "1kHz", force=("tangential_force", "1N", surface(slips)),
                   count=("position", "1um", np.round(slips * 1e6)))
    assert "position_jumps" not in tacto.run_json("spatial", "slips", "--list", "--from", "0s", "--to", "3s")


def forces_that_single_precision_cannot_hold_are_refused():
    x = np.concatenate([stroke(0.01, 0.03), np.full(RATE_HZ // 2, 0.03)])
    for name, size, words in (("large", 1e39, "above the 3.4e38"), ("small", 1e-310, "all values would be nearly 0")):
        touch(name, x, size * surface(x) / 0.02)
        _, said = tacto.run("spatial", name, "-o", "t", code=UNSUITABLE)
        assert words in said, said
        assert not list(pathlib.Path(".").glob("t*.texture.*"))
    touch("fits", x, 1e30 * surface(x))
    tacto.run("spatial", "fits", "-o", "t")
    tacto.run("validate", "t")


def the_one_channel_that_can_be_a_texture_is_taken():
    x = np.concatenate([stroke(0.01, 0.03), np.full(RATE_HZ // 2, 0.03)])
    count, press = ("position", "1um", np.round(x * 1e6)), ("normal_force", "1N", 0.5 + 0 * x)
    import_columns("one", shake=("acceleration", "1m/s^2", surface(x)), press=press, count=count)
    _, said = tacto.run("spatial", "one", "-o", "one")
    assert "tangential_force" in said and "acceleration" in said, said
    assert json.loads(pathlib.Path("one.texture.json").read_text())["quantity"] == "acceleration"
    import_columns("two", shake=("acceleration", "1m/s^2", surface(x)), tray=("displacement", "1um", surface(x)), count=count)
    _, said = tacto.run("spatial", "two", "-o", "two", code=UNSUITABLE)
    assert "acceleration" in said and "displacement" in said and "--channel" in said, said
    tacto.run("spatial", "two", "-o", "two", "--channel", "displacement")
    import_columns("none", press=press, count=count)
    _, said = tacto.run("spatial", "none", "-o", "none", code=UNSUITABLE)
    assert "channel" in said, said


def takes_in_several_recordings_are_averaged():
    """Noise of the mean of three takes is smaller by the root of their number; the mean names its recordings."""
    random = np.random.default_rng(1)
    x = np.concatenate([stroke(0.01, 0.03), stroke(0.03, 0.01), np.full(RATE_HZ // 2, 0.01)])
    for n in (1, 2, 3):
        touch(f"take{n}", x, surface(x) + 0.02 * random.standard_normal(len(x)))
    report = tacto.run_json("spatial", "take1", "take2", "take3", "--average", "-o", "mean")
    assert [(row["recording"], row["strokes_averaged"]) for row in report["takes"]] == [(f"take{n}", 2) for n in (1, 2, 3)]
    assert [row["strokes"] for row in report["averages"]] == [3, 3], report
    side = json.loads(pathlib.Path("mean-forward.texture.json").read_text())
    assert [row["recording"] for row in side["average"]["strokes"]] == ["take1.json", "take2.json", "take3.json"]
    assert all(len(row["recording_sha256"]) == 64 for row in side["average"]["strokes"])
    assert side["source"]["recording"] == "take1.json, take2.json, take3.json"
    tacto.run("validate", "mean-forward", "mean-backward")
    _, said = tacto.run("spatial", "take1", "take2", "--average", "-o", "mean", code=USAGE)
    assert "--force" in said, said
    tacto.run("spatial", "take1", "--stroke", "1", "-o", "single")
    touch("quiet", x, surface(x))
    tacto.run("spatial", "quiet", "--stroke", "1", "-o", "exact")

    def middle_of(name):
        values = soundfile.read(f"{name}.texture.wav", dtype="float64", always_2d=True)[0][:, 0]
        origin = json.loads(pathlib.Path(f"{name}.texture.json").read_text())["source_origin_m"]
        start = int(round((0.012 - origin) * 1e6))
        return values[start:start + 15000]

    def noise_of(name):
        return np.sqrt(np.mean((middle_of(name) - middle_of("exact")) ** 2))

    ratio = noise_of("mean-forward") / noise_of("single")
    print(f"noise of three takes over that of one: {ratio:.2f}, independent noise gives {3 ** -0.5:.2f}")
    # Independent noise: 3^-1/2 = 0.577. 15 mm of noise up to 10 /mm are 300 values: each RMS is known to
    # 1 / sqrt(600), 4 %, their ratio to 6 %; three times that.
    assert abs(ratio / 3 ** -0.5 - 1) < 0.18
    # A folder gives a mean for each recording, as before.
    pathlib.Path("each").mkdir()
    tacto.run("spatial", "take1", "take2", "--average", "--both-ways", "-o", "each")
    assert sorted(path.name for path in pathlib.Path("each").glob("*.json")) == ["take1.texture.json", "take2.texture.json"]


def each_rms_names_its_band():
    x = np.concatenate([stroke(0.01, 0.05), np.full(RATE_HZ // 2, 0.05)])
    touch("oak", x, surface(x))
    assert tacto.run_json("spatial", "oak", "-o", "oak")["rms_band"] == "all samples, filtered to 15-500 Hz"
    assert tacto.run_json("info", "oak.texture.json")["rms_band"] == "all samples, filtered to 15-500 Hz"
    band = tacto.run_json("spectrogram", "oak", "-o", "table.csv")["rms_band"]
    assert "/mm" in band and "windows" in band, band
    assert "from low to high" in tacto.run_json("describe", "oak")["rms_band"]


if __name__ == "__main__":
    for test in (a_jump_of_the_encoder_is_refused_with_its_sample, other_strokes_survive_a_jump,
                 positions_that_are_held_or_coarse_do_not_jump, forces_that_single_precision_cannot_hold_are_refused,
                 the_one_channel_that_can_be_a_texture_is_taken, takes_in_several_recordings_are_averaged, each_rms_names_its_band):
        tacto.in_folder(test)
