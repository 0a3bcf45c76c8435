#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`export`: the table of a recording is imported again without a difference, that of a texture has its samples; wrong use."""
import json
import pathlib
import subprocess

import numpy as np
import tacto

USAGE, NOT_FOUND, UNSUITABLE, CANNOT_WRITE = 2, 3, 5, 7


def table_of(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def a_recording_comes_back_whole():
    rng = np.random.default_rng(1)
    time_s = np.delete(np.arange(9000) / 10_000, [4000, 4001, 4002, 8500])  # two gaps, over the border of a block
    position_m, force_n = 0.04 * time_s, rng.normal(0, 0.1, time_s.size)
    np.savetxt("raw.csv", np.column_stack([time_s, force_n, position_m]), delimiter=",", header="t,f,x", comments="", fmt="%.17g")
    columns = ["--time-column", "t*1s", "--channel", "tangential_force=f*1N", "--channel", "position=x*1m"]
    tacto.run("import", "raw.csv", "-o", "oak", *columns)
    told = tacto.run_json("export", "oak")
    assert (told["rows"], told["gaps"], told["missing_frames"], told["written"]) == (8996, 2, 4, "oak.csv"), told
    assert told["columns"] == ["time_s", "tangential_force_n", "position_m"], told
    table = table_of("oak.csv")
    assert np.array_equal(table["tangential_force_n"], force_n) and np.array_equal(table["position_m"], position_m)
    assert np.allclose(table["time_s"], time_s, rtol=0, atol=1e-9)  # of its text
    tacto.run("import", "oak.csv", "-o", "again", "--time-column", "time_s*1s", "--channel",
              "tangential_force=tangential_force_n*1N", "--channel", "position=position_m*1m")
    first, second = (json.loads(pathlib.Path(f"{name}.json").read_text()) for name in ("oak", "again"))
    assert pathlib.Path("oak.wav").read_bytes() == pathlib.Path("again.wav").read_bytes() and first["gaps"] == second["gaps"]


def simulated_data_say_so_in_each_row():
    tacto.run("record", "-d", "sim:surface=C", "--time", "2s", "-o", "c")
    told = tacto.run_json("export", "c", "-o", "tables/c.csv")
    assert told["simulated"] and told["written"] == "tables/c.csv", told
    table = table_of("tables/c.csv")
    assert np.all(table["simulated"] == 1) and table.size == told["rows"]
    header = json.loads(pathlib.Path("c.json").read_text())
    codes, _ = tacto.soundfile.read("c.wav", dtype="int32", always_2d=True)
    for i, channel in enumerate(header["channels"]):
        # the numbers of the file are codes in the upper bits of 32
        values = table[f"{channel['name']}_{channel['unit'].lower()}"]
        assert np.allclose(values, codes[:, i] * channel["scale"] + channel["offset"], rtol=1e-15, atol=0), channel


def a_texture_and_an_average():
    tacto.run("record", "-d", "sim:surface=C", "--time", "5s", "-o", "c")
    tacto.run("spatial", "c", "-o", ".")
    tacto.run("spatial", "c", "--average", "-o", "mean")
    text, _ = tacto.run("export", "c-01", "-o", "-")
    pathlib.Path("piped.csv").write_text(text)
    told = tacto.run_json("export", "c-01.texture.json")
    assert told["written"] == "c-01.texture.csv" and pathlib.Path("c-01.texture.csv").read_text() == text, told
    position_m, values, _ = tacto.texture("c-01")
    table = table_of("piped.csv")
    assert np.allclose(table["position_m"], position_m, rtol=1e-11, atol=0) and np.array_equal(table["tangential_force_n"], values)
    stem = next(pathlib.Path(".").glob("mean*.texture.json")).name
    told = tacto.run_json("export", stem, "-o", "mean.csv")
    both, _ = tacto.soundfile.read(stem.replace(".json", ".wav"), dtype="float64")
    table = table_of("mean.csv")
    assert told["columns"] == ["position_m", "tangential_force_n", "spread_n"], told
    assert np.array_equal(np.column_stack([table["tangential_force_n"], table["spread_n"]]), both)


def wrong_use():
    tacto.run("record", "-d", "sim:", "--time", "0.5s", "-o", "c")
    tacto.run("export", "nothing", code=NOT_FOUND)
    tacto.run("export", "sandpaper-1990", code=UNSUITABLE)
    tacto.run("export", "c", "-o", "c.txt.wav", code=USAGE)
    tacto.run("export", "c")
    _, said = tacto.run("export", "c", code=USAGE)
    assert "--force" in said, said
    before = pathlib.Path("c.csv").read_bytes()
    tacto.run("export", "c", "--force")
    assert pathlib.Path("c.csv").read_bytes() == before
    pathlib.Path("c.csv").write_text("mine\n")
    tacto.run("export", "c", "--force", code=USAGE)
    assert pathlib.Path("c.csv").read_text() == "mine\n"
    done = subprocess.run([tacto.COMMAND, "export", "c", "-o", "-"], stdout=open("/dev/full", "w"), stderr=subprocess.PIPE, text=True)
    assert done.returncode == CANNOT_WRITE and done.stderr.count("\n") == 1, done


if __name__ == "__main__":
    for test in (a_recording_comes_back_whole, simulated_data_say_so_in_each_row, a_texture_and_an_average, wrong_use):
        tacto.in_folder(test)
