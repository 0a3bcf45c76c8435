#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs that analyse textures, as a user runs them: certify, formants, sheet."""
import json
import pathlib

import numpy as np
import soundfile

import tacto

RATE = 10000


def record(name, speed_mps, hum_n=0.03, seed=0, length_m=0.08):
    """A stroke over a surface of 1.3 and 2.6 /mm with mains hum at 100 Hz, through import and spatial."""
    rng = np.random.default_rng(seed)
    t = np.arange(int((length_m / speed_mps + 0.6) * RATE)) / RATE
    speed = speed_mps * np.clip(np.minimum((t - 0.2) / 0.02, (t[-1] - 0.2 - t) / 0.02), 0, 1)
    x = np.cumsum(speed) / RATE
    force = 0.05 * np.sin(2 * np.pi * 1300 * x) + 0.03 * np.sin(2 * np.pi * 2600 * x + 1)
    force += hum_n * np.sin(2 * np.pi * 100 * t + seed) + 0.02 * rng.standard_normal(len(t))
    np.savetxt(f"{name}.csv", np.column_stack([force, np.round(x / 1e-6)]), delimiter=",", fmt="%.6f",
               header="force_N,count", comments="")
    tacto.run("import", f"{name}.csv", "-o", name, "--rate", "10kHz", "--channel", "tangential_force=force_N*1N",
              "--channel", "position=count*1um")
    tacto.run("spatial", name, "-o", name, "--stroke", "1")


def peak_at(peaks, key, value):
    found = [peak for peak in peaks if abs(peak[key] - value) < 0.02 * value]
    assert len(found) == 1, (key, value, found)
    return found[0]


def hum_across_three_speeds_is_temporal():
    for name, speed in (("slow", 0.03), ("middle", 0.05), ("fast", 0.09)):
        record(name, speed, seed=int(1000 * speed))
    before = soundfile.read("slow.texture.wav", dtype="float32")[0]
    report = tacto.run_json("certify", "slow", "middle", "fast")
    assert report["stored"] and abs(report["speed_ratio"] - 3) < 0.02
    assert peak_at(report["peaks"], "frequency_hz", 100)["verdict"] == "temporal"
    for name, speed in (("slow", 0.03), ("fast", 0.09)):
        certificate = json.loads(pathlib.Path(f"{name}.texture.json").read_text())["certificate"]
        assert certificate["textures"] == ["slow", "middle", "fast"]
        assert "temporal peaks" in tacto.run("info", f"{name}.texture.json")[0]
        hum = peak_at(certificate["peaks"], "frequency_hz", 100)
        assert hum["verdict"] == "temporal" and hum["confidence"] >= 0.95, hum
        assert abs(hum["frequency_per_m"] - 100 / speed) < 0.01 * 100 / speed
        for k in (1300, 2600):
            assert peak_at(certificate["peaks"], "frequency_per_m", k)["verdict"] == "spatial"
    np.testing.assert_array_equal(before, soundfile.read("slow.texture.wav", dtype="float32")[0])
    tacto.run("validate", "slow", "middle", "fast")


def certify_refuses_what_tells_nothing():
    record("one", 0.05)
    record("same", 0.05)
    _, said = tacto.run("certify", "one", code=2)
    assert "textures" in said, said
    _, said = tacto.run("certify", "one", "same", code=5)
    assert " 1;" in said, said
    assert "certificate" not in json.loads(pathlib.Path("one.texture.json").read_text())


def strokes_and_recordings_are_taken_alike():
    """A recording of two strokes, by its name while it has no textures, and by the textures' names after."""
    for name, speed in (("slow", 0.03), ("fast", 0.09)):
        record(name, speed, seed=int(1000 * speed))
    slow, fast = (np.loadtxt(f"{name}.csv", delimiter=",", skiprows=1) for name in ("slow", "fast"))
    fast[:, 1] = slow[-1, 1] - fast[:, 1]  # back from the end of the first one
    np.savetxt("both.csv", np.vstack([slow, fast]), delimiter=",", fmt="%.6f", header="force_N,count",
               comments="")
    tacto.run("import", "both.csv", "-o", "both", "--rate", "10kHz", "--channel", "tangential_force=force_N*1N",
              "--channel", "position=count*1um")
    _, said = tacto.run("certify", "both", code=5)
    assert "both-01" in said and "--dry-run" in said, said
    direct = tacto.run_json("certify", "both", "--dry-run")
    assert len(tacto.run_json("describe", "both")["textures"]) == 2
    assert len(tacto.run_json("formants", "both")["formants"]) > 2
    tacto.run("sheet", "both", "-o", "direct.png")
    tacto.run("spatial", "both", "-o", "both")
    stored = tacto.run_json("certify", "both")
    _, said = tacto.run("certify", "both", code=2)
    assert "certificate" in said and "--force" in said, said
    tacto.run("certify", "both", "--force")
    assert stored["stored"] and not direct["stored"]
    assert [t["texture"] for t in stored["textures"]] == ["both-01", "both-02"] == [t["texture"] for t in direct["textures"]]
    for report in (direct, stored):
        assert peak_at(report["peaks"], "frequency_hz", 100)["verdict"] == "temporal"
        for k in (1300, 2600):
            assert peak_at(report["peaks"], "frequency_per_m", k)["verdict"] == "spatial"


def formants_are_listed_stored_and_drawn():
    record("oak", 0.05, hum_n=0)
    report = tacto.run_json("formants", "oak", "-o", "oak")
    assert report["file"] == "oak.formants.json"
    frequencies = sorted(each["frequency_per_m"] for each in report["formants"])
    np.testing.assert_allclose(frequencies, [1300, 2600], rtol=2e-3)
    stored = json.loads(pathlib.Path("oak.formants.json").read_text())
    assert stored["kind"] == "formants" and len(stored["textures"][0]["formants"]) == 2
    tacto.run("validate", "oak.formants.json")
    assert "formants" in tacto.run("info", "oak.formants.json")[0]
    tacto.run("formants", "oak", "-o", "oak-formants.csv")
    tacto.run("formants", "oak", "-o", "oak-formants.csv", "--force")  # --force replaces a table by a table
    raw = pathlib.Path("raw.csv")
    raw.write_text("time,force\n0,1\n")
    for verb in ("formants", "describe", "spectrogram"):
        assert tacto.error_of(verb, "oak", "-o", "raw.csv", code=2)["where"] == "raw.csv"
        assert raw.read_text() == "time,force\n0,1\n", verb
    foreign = pathlib.Path("weather.nc")
    for content in (b"CDF\x01 of somebody's", b"no netCDF at all"):
        foreign.write_bytes(content)
        assert tacto.error_of("spectrogram", "oak", "-o", "weather.nc", code=2)["where"] == "weather.nc"
        assert foreign.read_bytes() == content
    foreign.write_bytes(b"")  # not a file of tactograph
    for _ in range(2):        # --force replaces a file of the same kind
        tacto.run("spectrogram", "oak", "-o", "weather.nc", "--force")
    for verb in ("formants", "describe"):  # a table never replaces a recording or texture
        _, said = tacto.run(verb, "oak", "-o", "oak.json", code=2)
        assert "is a recording" in said, said
        _, said = tacto.run(verb, "oak", "-o", "oak.texture.json", code=2)
        assert "is a texture" in said, said
    assert len(pathlib.Path("oak-formants.csv").read_text().splitlines()) == 3
    drawn = tacto.run_json("spectrogram", "oak", "-o", "oak.svg", "--formants")["formants"]
    listed = tacto.run_json("formants", "oak")["formants"]
    assert len(drawn) == 2 and [row["frequency_per_m"] for row in drawn] == [row["frequency_per_m"] for row in listed], drawn
    tacto.run("spectrogram", "oak", "-o", "oak.nc", "--formants", code=2)
    assert not pathlib.Path("oak.nc").exists()
    tacto.run("spectrogram", "oak", "-o", "amplitude.png", "--formants", "--scaling", "amplitude", code=2)
    assert "1.3/mm" in pathlib.Path("oak.svg").read_text()


def sheets_are_paged():
    record("oak", 0.05)
    for n in range(25):
        for kind in ("json", "wav"):
            text = pathlib.Path(f"oak.texture.{kind}").read_bytes().replace(b"oak.texture.wav", b"o%02d.texture.wav" % n)
            pathlib.Path(f"o{n:02d}.texture.{kind}").write_bytes(text)
    names = [f"o{n:02d}" for n in range(25)]
    report = tacto.run_json("sheet", *names, "-o", "woods.svg", "--window", "8mm")
    assert report["files"] == ["woods-01.svg", "woods-02.svg"], report
    first, second = (pathlib.Path(name).read_text() for name in report["files"])
    assert "page 1 of 2" in first and ">o23<" in first and ">o24<" in second and ">o24<" not in first
    tacto.run("sheet", "oak", "-o", "oak.jpg", code=2)
    tacto.run("sheet", "nothing", "-o", "x.png", code=3)


if __name__ == "__main__":
    for test in (hum_across_three_speeds_is_temporal, certify_refuses_what_tells_nothing, strokes_and_recordings_are_taken_alike,
                 formants_are_listed_stored_and_drawn, sheets_are_paged):
        tacto.in_folder(test)
