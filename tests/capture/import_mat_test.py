#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`import` of MATLAB files that SciPy and h5py write: the numbers are the same to the bit; a file that was cut is refused."""
import json
import pathlib
import random
import shlex

import h5py
import numpy as np
import scipy.io
import scipy.sparse
import tacto

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE = 2, 3, 4, 5
ROWS = 2000


def variables():
    rng = np.random.default_rng(1)
    return {
        "data": {"force": rng.normal(0, 0.1, ROWS), "encoder": {"count": np.arange(ROWS, dtype=np.int16).reshape(-1, 1)}},
        "t_s": np.arange(ROWS) / 10_000, "acc": rng.normal(size=(ROWS, 3)),
        "wide": rng.normal(size=(2, ROWS)).astype(np.float32), "touch": rng.random(ROWS) > 0.5,
        "ticks": np.arange(ROWS, dtype=np.int64) + 2**53 - ROWS, "beyond": np.arange(ROWS, dtype=np.int64) + 2**53,
        "short_one": np.arange(5.0), "z": rng.normal(size=ROWS) * 1j, "sparse_one": scipy.sparse.eye(5).tocsc(),
        "cells": np.array([1, "a"], dtype=object), "words": "text", "nothing": np.zeros((0, 3)), "one": 3.0, "cube": np.zeros((3, 3, 3)),
    }


def stored(name):
    return tacto.soundfile.read(f"{name}.wav", dtype="float64", always_2d=True)[0]


def numbers_are_those_of_scipy():
    made = variables()
    asked = {"tangential_force": ("data.force*1N", made["data"]["force"]), "position": ("data.encoder.count*1um", made["data"]["encoder"]["count"]),
             "acceleration": ("acc(:,2)*1g", made["acc"][:, 1]), "displacement": ("wide(2,:)*1um", made["wide"][1]),
             "signal": ("touch", made["touch"]), "ticks:signal": ("ticks", made["ticks"])}
    for compressed in (False, True):
        scipy.io.savemat("trial.mat", made, do_compression=compressed)
        channels = [part for name, (text, _) in asked.items() for part in ("--channel", f"{name}={text}")]
        printed = tacto.run_json("import", "trial.mat", "-o", "oak", "--force", "--time-column", "t_s", *channels)
        assert printed["sample_rate_hz"] == 10_000 and printed["frames"] == ROWS and printed["gaps"] == 0, printed
        for k, (_, values) in enumerate(asked.values()):
            assert np.array_equal(stored("oak")[:, k], np.ravel(values).astype(float)), (compressed, k)
        header = json.loads(pathlib.Path("oak.json").read_text())
        assert header["channels"][1]["scale"] == 1e-6, header["channels"][1]


def without_options_it_lists():
    scipy.io.savemat("trial.mat", variables())
    printed = tacto.run_json("import", "trial.mat")
    arrays = {row["name"]: row for row in printed["arrays"]}
    assert arrays["data.encoder.count"]["class"] == "int16" and arrays["data.encoder.count"]["size"] == f"{ROWS}x1", arrays
    assert arrays["touch"]["class"] == "logical" and arrays["z"]["not_imported"] and not arrays["acc"]["not_imported"], arrays
    tacto.run(*shlex.split(printed["next"])[1:])
    assert pathlib.Path("trial.wav").exists(), printed
    tacto.run("import", "trial.mat", "-o", "x", code=USAGE)
    tacto.run("import", "nothing.mat", code=NOT_FOUND)


def each_refusal_names_its_array():
    scipy.io.savemat("trial.mat", variables())
    for name in ("z", "sparse_one", "cells", "words", "nothing", "one", "cube"):
        _, said = tacto.run("import", "trial.mat", "-o", "x", "--rate", "1kHz", "--channel", f"tangential_force={name}*1N", code=UNSUITABLE)
        assert f"trial.mat: {name}:" in said and said.count("\n") == 1, said
    _, said = tacto.run("import", "trial.mat", "-o", "x", "--rate", "1kHz", "--channel", "signal=beyond", code=UNSUITABLE)
    assert "sample 1" in said, said
    lengths = ["--channel", "tangential_force=data.force*1N", "--channel", "signal=short_one"]
    _, said = tacto.run("import", "trial.mat", "-o", "x", "--rate", "1kHz", *lengths, code=UNSUITABLE)
    assert "short_one" in said, said
    tacto.run("import", "trial.mat", "-o", "x", "--rate", "1kHz", "--channel", "tangential_force=acc*1N", code=USAGE)
    assert not list(pathlib.Path(".").glob("x.*"))


def nan_is_refused_or_becomes_a_gap():
    force_n = np.random.default_rng(2).normal(0, 0.1, ROWS)
    force_n[[500, 501]] = np.nan
    scipy.io.savemat("holes.mat", {"f": force_n})
    words = ["import", "holes.mat", "-o", "x", "--rate", "1kHz", "--channel", "tangential_force=f*1N"]
    _, said = tacto.run(*words, code=MALFORMED)
    assert "sample 500" in said and not pathlib.Path("x.wav").exists(), said
    printed = tacto.run_json(*words, "--mask-outliers")
    assert (printed["frames"], printed["gaps"]) == (ROWS - 2, 1), printed
    assert np.array_equal(stored("x")[:, 0], np.delete(force_n, [500, 501]))


def a_cut_file_is_never_silently_short():
    """Between two variables a file may be cut unnoticed, as it does not state how many it has; here the last one is asked for."""
    rng = np.random.default_rng(3)
    for compressed in (False, True):
        scipy.io.savemat("whole.mat", {"a": rng.normal(size=300), "s": {"f": rng.normal(size=300)}}, do_compression=compressed)
        refuse_all_cuts("whole.mat", "s.f")
    write_73("whole73.mat", rng.normal(size=300))
    refuse_all_cuts("whole73.mat", "data.force")


def refuse_all_cuts(name, column):
    whole = pathlib.Path(name).read_bytes()
    words = ["-o", "x", "--rate", "1kHz", "--channel", f"tangential_force={column}*1N"]
    tacto.run("import", name, *words, "--force")
    for length in random.Random(4).sample(range(130, len(whole)), 200):
        pathlib.Path("cut.mat").write_bytes(whole[:length])
        done = tacto.subprocess.run([tacto.COMMAND, "import", "cut.mat", *words, "--force"], capture_output=True, text=True)
        assert done.returncode in (USAGE, MALFORMED) and done.stderr.count("\n") == 1, (name, length, done)


HEAD_73 = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM"


def set_class(item, name):
    """MATLAB's attribute: text of a type that ends with zero, without the zero."""
    kind = h5py.h5t.C_S1.copy()
    kind.set_size(len(name))
    text = h5py.h5a.create(item.id, b"MATLAB_class", kind, h5py.h5s.create(h5py.h5s.SCALAR))
    text.write(np.array(name.encode()), mtype=kind)


def write_73(path, force_n, fields=True):
    """A file of version 7.3 as MATLAB writes it: HDF5 behind a block of 512 bytes, a struct as a group."""
    with h5py.File(path, "w", userblock_size=512) as file:
        data = file.create_group("data")
        set_class(data, "struct")
        names = np.empty(2, dtype=object)
        names[:] = [np.array([letter.encode() for letter in name], dtype="S1") for name in ("force", "count")]
        if fields:
            data.attrs.create("MATLAB_fields", names, dtype=h5py.vlen_dtype(np.dtype("S1")))
        for name, kind, values in (("force", "double", force_n), ("count", "int32", np.arange(force_n.size, dtype=np.int32))):
            data[name] = values.reshape(1, -1)
            set_class(data[name], kind)
    with open(path, "r+b") as file:
        file.write(HEAD_73)


def version_7_3():
    force_n = np.random.default_rng(5).normal(0, 0.1, ROWS)
    write_73("new.mat", force_n)
    tacto.run("import", "new.mat", "-o", "new", "--rate", "10kHz", "--channel", "tangential_force=data.force*1N", "--channel", "position=data.count*1um")
    assert np.array_equal(stored("new"), np.column_stack([force_n, np.arange(ROWS)]))
    write_73("strange.mat", force_n, fields=False)  # matio leaves out one of its fields
    _, said = tacto.run("import", "strange.mat", "-o", "x", "--rate", "10kHz", "--channel", "position=data.count*1um", code=MALFORMED)
    assert "data" in said, said


def a_class_that_matlab_would_not_write_is_not_empty():
    """h5py pads a text with zeros where MATLAB does not, and other programs write no class."""
    with h5py.File("other.mat", "w", userblock_size=512) as file:
        for name in ("padded", "none"):
            file[name] = np.arange(300.0).reshape(1, -1)
        file["padded"].attrs["MATLAB_class"] = np.bytes_("double")
        file["void"] = np.zeros(2, dtype=np.uint64)
        set_class(file["void"], "double")
        file["void"].attrs["MATLAB_empty"] = np.uint8(1)
    with open("other.mat", "r+b") as file:
        file.write(HEAD_73)
    refusals = {row["name"]: row["not_imported"] for row in tacto.run_json("import", "other.mat")["arrays"]}
    assert refusals["none"] and refusals["none"] != refusals["void"], refusals
    assert refusals["padded"] in ("", refusals["none"]), refusals


def a_class_that_cannot_hold_its_numbers_is_refused():
    """matio would cut 1.75 to 1 where a class int16 is stored as doubles; it converts where no number changes."""
    rows = 300
    stored_as = {"cut": ("int16", np.float64), "wrapped": ("uint8", np.int16), "signed": ("uint16", np.int16), "rounded": ("double", np.int64),
                 "short": ("single", np.float64), "widened": ("double", np.int32), "up": ("int16", np.uint8), "same": ("int16", np.int16)}
    with h5py.File("classes.mat", "w", userblock_size=512) as file:
        for name, (matlab, kind) in stored_as.items():
            file[name] = (np.arange(rows) * 1.75 % 120).astype(kind).reshape(1, -1)
            set_class(file[name], matlab)
    with open("classes.mat", "r+b") as file:
        file.write(HEAD_73)
    listed = {row["name"]: row["not_imported"] for row in tacto.run_json("import", "classes.mat")["arrays"]}
    kept = {"widened", "up", "same"}
    assert {name for name, refusal in listed.items() if not refusal} == kept, listed
    words = ["import", "classes.mat", "--rate", "1kHz", "-o", "x", "--force", "--channel"]
    for name, (_, kind) in stored_as.items():
        tacto.run(*words, f"signal={name}", code=0 if name in kept else UNSUITABLE)
        if name in kept:
            assert np.array_equal(stored("x")[:, 0], (np.arange(rows) * 1.75 % 120).astype(kind)), name


def a_cut_name_of_matlab_is_no_table():
    for text in (b"MATLAB 5.0", b"1,2\n3,4\n", b""):
        pathlib.Path("small.mat").write_bytes(text)
        error = tacto.error_of("import", "small.mat", code=MALFORMED)
        assert error["where"] == "small.mat" and "MATLAB" in error["what"], error


def files_of_octave():
    for version in ("-v6", "-v7"):  # both are version 5 of the format, the second compressed
        octave = f"data.force = sin(1:{ROWS})'; data.count = int16(1:{ROWS}); save('{version}', 'octave.mat', 'data');"
        tacto.subprocess.run(["octave-cli", "--norc", "--eval", octave], check=True, capture_output=True)
        tacto.run("import", "octave.mat", "-o", "o", "--force", "--rate", "10kHz", "--channel", "tangential_force=data.force*1N", "--channel",
                  "position=data.count*1um")
        values = scipy.io.loadmat("octave.mat")["data"][0, 0]
        assert np.array_equal(stored("o"), np.column_stack([values["force"].ravel(), np.arange(1, ROWS + 1)]))


if __name__ == "__main__":
    for test in (numbers_are_those_of_scipy, without_options_it_lists, each_refusal_names_its_array, nan_is_refused_or_becomes_a_gap,
                 a_cut_file_is_never_silently_short, version_7_3, a_class_that_cannot_hold_its_numbers_is_refused, a_cut_name_of_matlab_is_no_table, a_class_that_matlab_would_not_write_is_not_empty, files_of_octave):
        tacto.in_folder(test)
