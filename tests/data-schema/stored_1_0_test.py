#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that version 0.1.0 wrote in November 2026 (formats 1.0, spectrogram 1.1) are still read, replayed and rendered.

`stored_1_0/README.md` describes how they were made. The session's replay must be the same to the bit, because it
contains all inputs. The rendered drive depends on Fourier transforms, whose last bit differs between processors: 1e-5
of its peak is about eighty roundings of single precision.
"""
import json
import pathlib
import shutil
import sys
import tempfile

import numpy as np
import soundfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "end-to-end"))
from tacto import run, run_json

STORED = pathlib.Path(__file__).resolve().parent / "stored_1_0"
DOCUMENTS = {
    "ridge.json": "recording", "ridge.texture.json": "texture", "pair.scene.json": "scene", "play.session": "session",
    "ridge.nc": "spectrogram", "ridge.formants.json": "formants", "ridge.descriptions.json": "descriptions",
    "ridge.results.json": "results", "bender.transducer.json": "transducer", "sim-1.calibration.json": "calibration",
}


def every_document_is_valid(folder):
    for name, kind in DOCUMENTS.items():
        answer = run_json("validate", name, cwd=folder)
        assert answer["valid"] is True, (name, answer)
        assert answer["files"][0]["kind"] == kind, (name, answer)
        run("info", name, cwd=folder)


def a_changed_sample_is_found(folder):
    """Checks this test: `validate` must not accept everything."""
    wav = folder / "ridge.texture.wav"
    kept = wav.read_bytes()
    wav.write_bytes(kept[:-4] + bytes([kept[-4] ^ 1]) + kept[-3:])
    run("validate", "ridge.texture.json", code=4, cwd=folder)
    wav.write_bytes(kept)


def recording_becomes_the_texture(folder):
    run("spatial", "ridge", "-o", "again", cwd=folder)
    stored, _ = soundfile.read(folder / "ridge.texture.wav")
    again, _ = soundfile.read(folder / "again.texture.wav")
    assert len(stored) == len(again)
    assert np.max(np.abs(stored - again)) < 1e-5 * np.max(np.abs(stored))


def session_replays_to_the_bit(folder):
    answer = run_json("replay", "play", cwd=folder)
    assert answer["same_to_the_bit"] is True and answer["ticks_compared"] == 901, answer
    assert run_json("session", "play", cwd=folder)["stroke_count"] == 1


def scene_renders_the_drive(folder):
    run("render", "pair", "--finger-path", "path.csv", "--transducer", "bender.transducer.json", "--rate", "5kHz",
        "-o", "again.wav", cwd=folder)
    stored, _ = soundfile.read(folder / "drive.wav")
    again, _ = soundfile.read(folder / "again.wav")
    assert len(stored) == len(again)
    assert np.max(np.abs(stored - again)) < 1e-5 * np.max(np.abs(stored))


def a_newer_major_version_is_refused(folder):
    for name in ("ridge.json", "ridge.texture.json", "pair.scene.json", "bender.transducer.json"):
        path = folder / f"new-{name}"
        document = json.loads((folder / name).read_text())
        document["version"] = "2.0"
        path.write_text(json.dumps(document))
        run("info", path.name, code=6, cwd=folder)


def main():
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "stored"
        shutil.copytree(STORED, folder)
        for check in (every_document_is_valid, a_changed_sample_is_found, recording_becomes_the_texture,
                      session_replays_to_the_bit, scene_renders_the_drive, a_newer_major_version_is_refused):
            check(folder)
            print(f"{check.__name__}: passed")


main()
