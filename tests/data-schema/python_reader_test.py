#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python package against the program's own exports and the files' definition.

Numbers must be equal, not close: package and program read the same bytes by the same formulas in double precision.
"""
import csv
import hashlib
import json
import os
import pathlib
import shutil
import sys
import tempfile
import warnings

import numpy as np
import soundfile
import xarray

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS / "end-to-end"), str(TESTS.parent / "data-schema" / "python")]

import run_daemon
import tactograph
from tacto import run



def make_files():
    """A recording of the emulated device, its texture and spectrogram, and a session of it."""
    run("record", "-d", "sim:surface=triangle,length=12mm,speed=60mm/s,strokes=1,seed=3", "--time", "0.4s", "-o", "ridge", "--subject", "S01")
    run("spatial", "ridge", "-o", "ridge")
    run("spectrogram", "ridge", "-o", "ridge.nc", "--window", "4mm", "--hop", "1mm")
    pathlib.Path("slide.csv").write_text("time_s,position_m\n0,0.0005\n0.25,0.0065\n0.4,0.003\n")
    run("play", "ridge", "-d", "sim:hysteresis=0.16", "--gain", "0.5mm/N", "--interpolation", "sinc", "--finger-path", "slide.csv", "-o", "play")


def refusal(read, name, *words, **options):
    """The message of the FileProblem that reading must raise; it must contain all `words`."""
    try:
        read(name, **options)
    except tactograph.FileProblem as problem:
        missing = [word for word in words if word not in str(problem)]
        assert not missing, (str(problem), missing)
        return problem
    raise AssertionError(f"{name} was read")


def edit(path, **changed):
    document = json.loads(pathlib.Path(path).read_text())
    document["data"].pop("numbers_sha256", None)
    document.update(changed)
    pathlib.Path(path).write_text(json.dumps(document))


def recording_is_physical_and_keeps_its_gaps():
    document = json.loads(pathlib.Path("ridge.json").read_text())
    codes, _ = soundfile.read("ridge.wav", dtype="int32", always_2d=True)
    read = tactograph.read_recording("ridge", check=True)
    for column, channel in enumerate(document["channels"]):
        values = read[channel["name"]]
        assert np.array_equal(values, codes[:, column] * channel["scale"] + channel["offset"])
        assert values.attrs["units"] == channel["unit"]
    assert np.array_equal(read.time, np.arange(len(codes)) / document["sample_rate_hz"])
    assert read.attrs["subject"] == "S01" and not read.after_gap.any()

    edit("ridge.json", gaps=[{"frame": 100, "device_sequence": 105, "count": 5}, {"frame": 200, "device_sequence": 208, "count": 3}])
    assert json.loads(run("validate", "ridge.json", "--json")[0])["valid"]
    gaps = tactograph.read_recording("ridge.wav")
    assert list(np.flatnonzero(gaps.after_gap)) == [100, 200]
    assert list(gaps.sequence.values[[99, 100, 199, 200]]) == [99, 105, 204, 208]
    assert len(gaps.time) == len(read.time) and gaps.time.values[200] == 208 / document["sample_rate_hz"]


def clipping_is_masked():
    document = json.loads(pathlib.Path("ridge.json").read_text())
    codes, rate = soundfile.read("ridge.wav", dtype="int32", always_2d=True)
    codes[50:53, 0] = 2**31 - 1  # the end of the converter's range
    soundfile.write("clipped.wav", codes, rate, subtype="PCM_32")
    shutil.copy("ridge.json", "clipped.json")
    edit("clipped.json", data={**document["data"], "file": "clipped.wav", "sha256": hashlib.sha256(pathlib.Path("clipped.wav").read_bytes()).hexdigest()})
    read = tactograph.read_recording("clipped")
    assert list(np.flatnonzero(read.tangential_force_clipped)) == [50, 51, 52]


def texture_has_its_positions_and_band():
    document = json.loads(pathlib.Path("ridge.texture.json").read_text())
    read = tactograph.read_texture("ridge", check=True)
    samples, _ = soundfile.read("ridge.texture.wav")
    assert np.array_equal(read.tangential_force, samples) and read.tangential_force.attrs["units"] == "N"
    assert np.array_equal(read.position, np.arange(len(samples)) * document["pitch_m"])
    assert read.bench_position.values[0] == document["source_origin_m"]
    middle = document["valid_band"][len(document["valid_band"]) // 2]
    there = read.sel(position=middle["position_m"], method="nearest")
    assert np.isclose(there.valid_from, middle["low_per_m"], rtol=1e-9)
    assert np.isclose(there.valid_to, middle["high_per_m"], rtol=1e-9)


def average_tells_its_spread():
    run("record", "-d", "sim:surface=C,strokes=4,seed=2", "--time", "3.7s", "-o", "four")
    run("spatial", "four", "--average", "--both-ways", "-o", "mean")
    read = tactograph.read_texture("mean")
    document = json.loads(pathlib.Path("mean.texture.json").read_text())
    samples, _ = soundfile.read("mean.texture.wav")
    assert np.array_equal(read.standard_deviation, samples[:, 1])
    for count in document["average"]["counts"]:
        assert read.strokes.values[round(count["position_m"] / document["pitch_m"])] == count["strokes"]
    assert read.strokes.max() >= 2


def spectrogram_is_upright_and_loaded():
    read = tactograph.read_spectrogram("ridge")
    assert read.density.dims == ("spatial_frequency", "position") and read.known.dtype == bool
    assert np.allclose(read.density_db, 10 * np.log10(read.density.astype("float64")), atol=1e-4)  # float32 in the file
    assert read.density_db.attrs["units"] == "dB"
    with xarray.open_dataset("ridge.nc") as stored:  # in millimetres
        for name, units, factor in (("position", "m", 1e-3), ("spatial_frequency", "1/m", 1e3), ("density", "N2 m", 1e-3)):
            assert read[name].attrs["units"] == units, read[name].attrs
            assert np.allclose(read[name].transpose(*stored[name].dims), stored[name] * factor, rtol=1e-6, atol=0), name
        assert np.isclose(read.attrs["window_m"], stored.attrs["window_mm"] * 1e-3) and "window_mm" not in read.attrs
    run("spectrogram", "ridge", "--window", "5mm", "--scaling", "amplitude", "-o", "amplitudes.nc")
    amplitudes = tactograph.read_spectrogram("amplitudes")
    assert amplitudes.amplitude.attrs["units"] == "N" and amplitudes.position.attrs["units"] == "m"
    texture = tactograph.read_texture("ridge")
    assert abs(float(read.position[0]) - float(texture.position[0])) < 0.02, "the same axis as the texture's"


def the_version_is_that_of_the_program():
    assert f"tactograph {tactograph.__version__}" in run("--version")[0]


def session_equals_its_export(name):
    run("session", name, "-o", f"{name}-rows.csv")
    with open(f"{name}-rows.csv", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    read = tactograph.read_session(name)
    assert len(rows) == len(read.time) > 100
    for column in ("tick", "encoder_count", "playing", "fault", "late", "limited", "energy_limited", "gated", "touching"):
        assert [int(row[column]) for row in rows] == [int(v) for v in read[column].values], column
    for column, variable, places in (("time_s", "time", 1e-9), ("position_m", "position", 1e-9), ("device_time_s", "device_time", 1e-9)):
        assert np.allclose([float(row[column]) for row in rows], read[variable], rtol=1e-9, atol=places), column
    assert np.array_equal(np.float32([row["drive_v"] for row in rows]), read.drive)
    assert np.allclose([float(row["gain"]) for row in rows], read.gain, rtol=1e-6)
    return read


def a_stored_session_is_read():
    read = session_equals_its_export("play")
    assert read.attrs["closed"] == 1 and json.loads(read.attrs["losses"]) == []


def a_session_of_forces_equals_its_export():
    pathlib.Path("pool.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "name": "pool", "patches": [
        {"name": "pool", "place": {"x_m": -0.04, "y_m": -0.04}, "size": {"width_m": 0.06, "height_m": 0.06},
         "layers": [{"type": "spring", "stiffness_n_per_m": 50}]}]}))
    pathlib.Path("hand.csv").write_text("time_s,x_m,y_m\n0,-0.065,-0.04\n0.3,-0.03,-0.05\n")
    run("play", "pool", "-d", "sim:planar,hand=minsky-radial", "--finger-path", "hand.csv", "-o", "held")
    run("session", "held", "-o", "held.csv")
    rows = np.genfromtxt("held.csv", delimiter=",", names=True, comments="#")
    read = tactograph.read_session("held")
    assert list(read.axis.values) == ["x", "y"] and len(rows) == len(read.time) > 1000 and read.position.units == "m" and read.force.units == "N"
    for name in ("tick", "playing", "fault", "late", "limited", "rms_limited"):
        assert np.array_equal(rows[name], read[name]), name
    assert np.allclose(rows["time_s"], read.time, rtol=0, atol=1e-9)
    for axis in ("x", "y"):
        assert np.allclose(rows[f"{axis}_m"], read.position.sel(axis=axis), rtol=0, atol=1e-12)
        assert np.array_equal(np.float32(rows[f"force_{axis}_n"]), read.force.sel(axis=axis))
    assert np.ptp(read.force.values) > 0.5


def all_is_in_si_units():
    """No variable and no attribute of any reader is in millimetres; the file of a spectrogram is."""
    run("spectrogram", "ridge", "-o", "loud.nc", "--window", "4mm", "--hop", "1mm", "--scaling", "amplitude")
    for read in (tactograph.read_recording("ridge"), tactograph.read_texture("ridge"), tactograph.read_session("play"),
                 tactograph.read_spectrogram("ridge"), tactograph.read_spectrogram("loud"), tactograph.read_session("held")):
        assert read.position.units == "m", read
        units = [read[name].attrs.get("units", "") for name in read.variables]
        assert not any("mm" in unit for unit in units) and not any(name.endswith("_mm") for name in read.attrs), (units, read.attrs)


def a_session_of_the_daemon_has_its_gains():
    run_daemon.prepare_files(device="sim:paced=0")  # ticks come as fast as the daemon reads, whatever the machine does
    with run_daemon.daemon():
        client = run_daemon.Client()
        client.must(request="load", file="oak", gain_m_per_n=0.0005)
        name = pathlib.Path(client.must(request="arm")["session"])
        client.must(request="play")
        for gain in (0.5, 0.25, 2.0):
            before = client.must(request="gain", gain=gain) and client.must(request="status")["ticks"]
            while client.must(request="status")["ticks"] < before + 200:  # so that ticks lie between the commands
                pass
        assert client.must(request="status")["state"] == "playing"
        client.must(request="disarm")
        client.wait_for("idle")
    shutil.copy(name, "steered.session")
    read = session_equals_its_export("steered")
    assert read.gain.values[0] == 1 and np.isclose(read.gain.values[-1], 2.0) and len(set(read.gain.values)) >= 3


def a_session_holds_what_the_tray_sensor_measured():
    run("play", "ridge", "-d", "sim:tray_sensor=on", "--gain", "0.5mm/N", "--finger-path", "slide.csv", "-o", "sensed")
    read = session_equals_its_export("sensed")
    with open("sensed-rows.csv", newline="") as file:
        exported = [row["measured_m"] for row in csv.DictReader(line for line in file if not line.startswith("#"))]
    ticks = np.array([i for i, value in enumerate(exported) if value])
    assert len(ticks) > 500
    nearest = np.abs(read.measured_time.values[:, None] - read.time.values[ticks][None, :]).argmin(axis=0)
    assert np.allclose([float(exported[i]) for i in ticks], read.measured.values[nearest], rtol=1e-6, atol=1e-12)
    assert read.measured.attrs["units"] == "m" and np.abs(read.measured).max() > 1e-6


def a_session_that_was_cut_is_read_up_to_there():
    whole = pathlib.Path("play.session").read_bytes()
    pathlib.Path("cut.session").write_bytes(whole[:len(whole) - 40])  # the end, and part of the last ticks or event
    cut = tactograph.read_session("cut")
    assert cut.attrs["closed"] == 0 and 0 < len(cut.time) <= len(tactograph.read_session("play").time)


def what_cannot_be_read_is_named():
    refusal(tactograph.read_recording, "absent", "absent.json", "no such file", "give a stem")
    refusal(tactograph.read_texture, "ridge.json", "ridge.json.texture.json")
    shutil.copy("ridge.json", "other.json")
    edit("other.json", version="2.0")
    refusal(tactograph.read_recording, "other", "2.0", "install a newer")
    edit("other.json", version="1.0", kind="texture")
    refusal(tactograph.read_recording, "other", "texture", "recording")
    pathlib.Path("torn.json").write_text('{"kind": "reco')
    refusal(tactograph.read_recording, "torn", "torn.json", "JSON")
    damaged = bytearray(pathlib.Path("ridge.texture.wav").read_bytes())
    damaged[-2] ^= 1
    pathlib.Path("ridge.texture.wav").write_bytes(damaged)
    refusal(tactograph.read_texture, "ridge", "SHA-256", check=True)
    pathlib.Path("ridge.texture.wav").write_bytes(damaged[:-400])
    refusal(tactograph.read_texture, "ridge", "frames")
    pathlib.Path("ridge.texture.wav").unlink()
    refusal(tactograph.read_texture, "ridge", "samples are missing")
    for stroke in ("several-02", "several-01"):
        pathlib.Path(f"{stroke}.texture.json").write_text("{}")
    refusal(tactograph.read_texture, "several", "several-01, several-02")
    pathlib.Path("empty.session").write_bytes(b"")
    refusal(tactograph.read_session, "empty", "header")
    pathlib.Path("text.nc").write_text("no netCDF")
    refusal(tactograph.read_spectrogram, "text", "netCDF")


def changed_numbers_are_refused():
    for file, read, member in (("ridge.json", tactograph.read_recording, "sample_rate_hz"),
                               ("ridge.texture.json", tactograph.read_texture, "pitch_m")):
        path = pathlib.Path(file)
        whole = path.read_text()
        document = json.loads(whole)
        assert document["data"]["numbers_sha256"]
        path.write_text(json.dumps({**document, "notes": "dry", "x_bench": 7}))
        read("ridge")
        path.write_text(json.dumps({**document, member: document[member] * (1 + 1e-15)}))
        refusal(read, "ridge", "numbers", "numbers_sha256")
        path.write_text(whole)


def a_newer_minor_version_is_read_with_a_warning():
    edit("ridge.json", version="1.99", later=3)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert tactograph.read_recording("ridge").attrs["later"] == 3
    assert any("1.99" in str(warning.message) for warning in caught)


def main():
    with tempfile.TemporaryDirectory() as temporary:
        os.chdir(temporary)
        make_files()
        for check in (changed_numbers_are_refused, texture_has_its_positions_and_band, clipping_is_masked, recording_is_physical_and_keeps_its_gaps,
                      average_tells_its_spread, spectrogram_is_upright_and_loaded, the_version_is_that_of_the_program, a_stored_session_is_read,
                      a_session_of_forces_equals_its_export, all_is_in_si_units,
                      a_session_holds_what_the_tray_sensor_measured, a_session_of_the_daemon_has_its_gains, a_session_that_was_cut_is_read_up_to_there,
                      a_newer_minor_version_is_read_with_a_warning, what_cannot_be_read_is_named):
            check()
            print(f"{check.__name__}: passed")


main()
