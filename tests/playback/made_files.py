# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures and paths written by hand as data-schema/schemas defines them, and runs of the command."""
import hashlib
import json
import os
import pathlib
import subprocess

import numpy as np
import soundfile
import tacto

COMMAND = os.environ["TACTOGRAPH"]
PITCH_M = 1e-6


def write_texture(stem: pathlib.Path, force_n: np.ndarray, **changed) -> None:
    wav = stem.with_name(stem.name + ".texture.wav")
    soundfile.write(wav, force_n.astype(np.float32), round(1 / PITCH_M), subtype="FLOAT")
    sidecar = {
        "kind": "texture",
        "version": "1.0",
        "data": {
            "file": wav.name,
            "sha256": hashlib.sha256(wav.read_bytes()).hexdigest(),
            "samples": len(force_n),
        },
        "pitch_m": PITCH_M,
        "quantity": "tangential_force",
        "unit": "N",
        "direction": 1,
        "source_origin_m": 0.0,
    }
    sidecar.update(changed)
    stem.with_name(stem.name + ".texture.json").write_text(json.dumps(sidecar))


def write_path(file: pathlib.Path, time_s, position_m) -> None:
    rows = [f"{t!r},{x!r}" for t, x in zip(map(float, time_s), map(float, position_m))]
    file.write_text("time_s,position_m\n" + "\n".join(rows) + "\n")


def run(*arguments) -> subprocess.CompletedProcess:
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)
    done.stderr = tacto.unwrapped(done.stderr)
    return done


def report_of(*arguments) -> dict:
    again = ["--force"] if arguments[0] == "render" else []
    done = run(*arguments, *again, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def samples(file: pathlib.Path) -> np.ndarray:
    return soundfile.read(file, dtype="float64")[0]
