#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports by the command against NumPy's and soundfile's reading of the same files."""
import json
import os
import pathlib

import numpy as np
import soundfile

import tacto
from measured import measured

HEADERS = {"latin-1": "Größe [µm];Kraft", "utf-8": "Größe [µm];Kraft", "utf-8-sig": "Größe [µm];Kraft"}


def imported(name):
    samples, rate = soundfile.read(f"{name}.wav", dtype="float64", always_2d=True)
    side = json.loads(pathlib.Path(f"{name}.json").read_text())
    assert rate == round(side["sample_rate_hz"])
    return samples, side


def table(rows=5000, columns=3):
    values = np.random.default_rng(1).normal(size=(rows, columns)) * 10.0 ** np.arange(-3, columns - 3)
    return np.array([[float(f"{v:.9g}") for v in row] for row in values])


def same_numbers_in_every_delimiter():
    values = table()
    for delimiter, name in ((",", "comma"), (";", "semicolon"), ("\t", "tab")):
        for end in ("\n", "\r\n"):
            text = end.join(delimiter.join(f"{v:.9g}" for v in row) for row in values) + end
            pathlib.Path("in.csv").write_bytes(text.encode())
            wanted = np.loadtxt("in.csv", delimiter=delimiter)
            tacto.run("import", "in.csv", "-o", name, "--force", "--rate", "2kHz", "--channel", "a:signal=1",
                      "--channel", "b:signal=3", "--channel", "c:signal=2")
            samples, side = imported(name)
            assert np.array_equal(samples, wanted[:, [0, 2, 1]]), name
            assert side["sample_rate_hz"] == 2000 and side["data"]["format"] == "float64"


def headers_of_all_encodings_and_decimal_commas():
    values = table(columns=2)
    body = "".join(f"{a:.9g};{b:.9g}\r\n".replace(".", ",") for a, b in values)
    for encoding, header in HEADERS.items():
        pathlib.Path("in.csv").write_bytes((header + "\r\n" + body).encode(encoding))
        wanted = np.loadtxt("in.csv", delimiter=";", skiprows=1, encoding=encoding,
                            converters=lambda text: float(text.replace(",", ".")))
        tacto.run("import", "in.csv", "-o", "out", "--force", "--rate", "1kHz",
                  "--channel", "position=Größe [µm]*1µm", "--channel", "tangential_force=Kraft*1mN")
        samples, side = imported("out")
        assert np.array_equal(samples, wanted), encoding
        assert side["channels"][0]["source"] == "Größe [µm]", side["channels"][0]
        assert (side["channels"][0]["scale"], side["channels"][1]["scale"]) == (1e-6, 1e-3)


def numpy_and_quoted_exports():
    values = table()
    np.savetxt("in.csv", values, delimiter=",", header="f,x,y")  # NumPy's header is a comment
    tacto.run("import", "in.csv", "-o", "savetxt", "--rate", "1kHz", "--channel", "signal=2")
    assert np.array_equal(imported("savetxt")[0][:, 0], np.loadtxt("in.csv", delimiter=",")[:, 1])
    quoted = '"f","x, y"\n' + "".join(f'"{a:.9g}","{b:.9g}"\n' for a, b, _ in values)
    pathlib.Path("in.csv").write_text(quoted)
    tacto.run("import", "in.csv", "-o", "quoted", "--rate", "1kHz", "--channel", "signal=x, y")
    assert np.array_equal(imported("quoted")[0][:, 0], values[:, 1])


def sound_files_of_all_kinds():
    mono = np.clip(table(columns=1)[:, 0] * 200, -0.99, 0.99)
    for suffix, subtype, bits in (("wav", "PCM_16", 16), ("wav", "PCM_24", 24), ("wav", "PCM_U8", 8),
                                  ("wav", "PCM_32", 32), ("flac", "PCM_16", 16), ("aiff", "PCM_24", 24)):
        soundfile.write(f"in.{suffix}", mono, 44100, subtype=subtype)
        codes = soundfile.read(f"in.{suffix}", dtype="int32")[0] >> (32 - bits)
        tacto.run("import", f"in.{suffix}", "-o", "out", "--force")
        samples, side = imported("out")
        assert np.array_equal(samples[:, 0], codes), (suffix, subtype)
        assert side["channels"][0]["scale"] == 2.0 ** (1 - bits) and side["channels"][0]["quantity"] == "signal"
        assert side["sample_rate_hz"] == 44100
    for suffix, subtype in (("wav", "FLOAT"), ("wav", "DOUBLE"), ("ogg", "VORBIS"), ("wav", "ULAW")):
        soundfile.write(f"in.{suffix}", mono, 44100, subtype=subtype)
        wanted = soundfile.read(f"in.{suffix}", dtype="float64")[0]
        tacto.run("import", f"in.{suffix}", "-o", "out", "--force")
        samples, side = imported("out")
        assert np.array_equal(samples[:, 0], wanted), (suffix, subtype)
        assert side["channels"][0]["scale"] == 1


def physical_values_and_derived_positions():
    values = np.abs(table(columns=2)) + 1
    np.savetxt("in.csv", values, delimiter=",", header="v,f", comments="", fmt="%.9g")
    loaded = np.loadtxt("in.csv", delimiter=",", skiprows=1)
    tacto.run("import", "in.csv", "-o", "out", "--rate", "1kHz", "--channel", "speed=v*-2+1mm/s")
    samples, side = imported("out")
    speed = loaded[:, 0] * side["channels"][0]["scale"] + side["channels"][0]["offset"]
    assert np.allclose(speed, loaded[:, 0] * -2e-3 + 1e-3, rtol=1e-15)
    wanted = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 1e-3)])
    # Two sums of 5000 terms, each rounded to 1.1e-16 of its value.
    assert np.max(np.abs(samples[:, 1] - wanted)) < 5000 * 2.2e-16 * np.max(np.abs(wanted))
    assert "integrated" in side["channels"][1]["derivation"]


def machines_get_json_and_people_are_told_what_next():
    pathlib.Path("in.csv").write_text("f,x\n1,2\n3,4\n")
    options = ["import", "in.csv", "-o", "out", "--rate", "1kHz", "--channel", "tangential_force=f*1N",
               "--channel", "position=x*1mm"]
    report = tacto.run_json(*options)
    assert report["frames"] == 2 and report["files"] == ["out.wav", "out.json"], report
    assert report["channels"][1] == {"name": "position", "quantity": "position", "unit": "m", "smallest": 0.002,
                                     "largest": 0.004, "scale": 0.001, "offset": 0.0, "from": "x"}, report
    assert "tactograph spatial out -o out" in tacto.run(*options, "--force")[0]
    assert "45%" in tacto.error_of(*options, "--force", "--humidity", "45", code=2)["what"]


def long_tables_need_no_more_memory_than_short_ones():
    rows = 1_500_000
    pathlib.Path("short.csv").write_text("t,f,x\n0,1,2\n0.0001,2,3\n0.0002,1,4\n")
    with open("long.csv", "w") as file:
        file.write("t,f,x\n")
        for i in range(0, rows, 1000):
            file.write("".join(f"{k / 10000:.4f},{(k * 7919 % 10007) / 1e4:.10f},{k % 40000}\n" for k in range(i, i + 1000)))
    options = ["-o", "out", "--force", "--time-column", "t*1s", "--channel", "tangential_force=f*1N",
               "--channel", "position=x*1um"]
    short, long = tacto.peak_mb("import", "short.csv", *options), tacto.peak_mb("import", "long.csv", *options)
    measured("import_oracle.peak_of_3_rows_mb", short)
    measured("import_oracle.peak_of_1500000_rows_mb", long)
    tacto.expect_little_memory(f"{rows} rows ({os.path.getsize('long.csv') / 1e6:.0f} MB) against 3", long, short)
    assert imported("out")[1]["data"]["frames"] == rows


if __name__ == "__main__":
    for test in (same_numbers_in_every_delimiter, headers_of_all_encodings_and_decimal_commas,
                 numpy_and_quoted_exports, sound_files_of_all_kinds, physical_values_and_derived_positions,
                 machines_get_json_and_people_are_told_what_next, long_tables_need_no_more_memory_than_short_ones):
        tacto.in_folder(test)
