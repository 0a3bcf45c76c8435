#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Each number of a transducer's file at extreme values, through the verbs that use a transducer: it is refused by name
or, with --implausible, all resulting numbers are finite."""
import concurrent.futures
import json
import pathlib
import re
import subprocess

import numpy as np
import soundfile

import run_daemon
import tacto

PRESET = json.loads((pathlib.Path(__file__).parents[2] / "data-schema/presets/wiertlewski2011.transducer.json").read_text())
EXTRAS = {"second_mode": {"frequency_hz": 2000.0, "damping_ratio": 0.02, "zero_hz": 1900.0, "zero_damping_ratio": 0.02},
          "hysteresis": {"thresholds_v": [0, 1, 2], "weights": [0.9, 0.1, 0.1]}}
MEMBERS = [(name,) for name, value in PRESET.items() if isinstance(value, float | int) and name != "converter_bits"]
MEMBERS += [("reconstruction_cutoff_hz",)] + [("second_mode", name) for name in EXTRAS["second_mode"]]
VALUES = (1e-300, 1e-9, 1e9, 1e300)
NOT_FINITE = re.compile(r"\b(nan|inf|infinity)\b", re.IGNORECASE)


def write_transducer(name, path, value):
    transducer = json.loads(json.dumps({**PRESET, "name": name, **({path[0]: EXTRAS[path[0]]} if len(path) > 1 else {})}))
    (transducer if len(path) == 1 else transducer[path[0]])[path[-1]] = value
    pathlib.Path(f"{name}.transducer.json").write_text(json.dumps(transducer))


def run(*arguments):
    done = subprocess.run([tacto.COMMAND, *arguments], capture_output=True, text=True, timeout=120)
    assert done.returncode >= 0, (arguments, done)
    assert not NOT_FINITE.search(done.stdout) and not NOT_FINITE.search(done.stderr), (arguments, done)
    return done


def refuse_constant(text):
    raise AssertionError(f"{text} in JSON")


def commands_with(name):
    """The commands, each with the file that it writes, if any."""
    return [(["render", "oak", "--finger-path", "path.csv", "--transducer", name, "--over-limit", "clip", "-o", f"{name}.wav", "--displacement",
              f"{name}-tray.wav", "--json"], [f"{name}.wav", f"{name}-tray.wav"]),
            (["explain", "oak", "--transducer", name, "--json"], []),
            (["play", "oak", "-d", "sim:", "--transducer", name, "--time", "0.05s", "-o", f"{name}-played", "--json"], [])]


def one_number(index, path, value):
    """Whether it was refused as implausible, and how many commands accepted it with --implausible."""
    name, member = f"odd{index}", path[-1]
    write_transducer(name, path, value)
    validated, described = run("validate", name), run("info", name, "--json")
    implausible = validated.returncode != 0
    assert not implausible or member in validated.stdout + validated.stderr or "together give" in validated.stdout, (member, validated)
    assert described.returncode == 0 or member in described.stderr or "together give" in described.stderr, described
    took = 0
    for command, files in commands_with(name):
        plain = run(*command)
        assert not implausible or plain.returncode == 5 and ("/".join(path) in plain.stderr or "together give" in plain.stderr), (command, plain)
        assert plain.returncode != 0 or all(np.all(np.isfinite(soundfile.read(file)[0])) for file in files), command
        if not implausible:
            continue
        insisted = run(*command, "--implausible")
        if insisted.returncode != 0:
            continue
        took += 1
        json.loads(insisted.stdout, parse_constant=refuse_constant)
        assert all(np.all(np.isfinite(soundfile.read(file)[0])) for file in files), command
    return implausible, took


def extreme_numbers_of_a_transducer():
    run_daemon.prepare_files()
    sweep = [(i, path, value) for i, (path, value) in enumerate((p, v) for p in MEMBERS for v in VALUES)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda one: one_number(*one), sweep))
    for (_, path, value), (implausible, _) in zip(sweep, results):
        assert implausible or value not in (1e-300, 1e300), (path, value)
    print(f"{len(sweep)} numbers of {len(MEMBERS)} members: {sum(r[0] for r in results)} refused; "
          f"{sum(r[1] for r in results)} commands went on with --implausible")


def what_was_found():
    """The four numbers of issue 14, item 9."""
    run_daemon.prepare_files()
    for member, value in (("actuator_scale", 1e308), ("actuator_scale", 1e-300), ("mass_kg", 1e-12), ("flexure_stiffness_n_per_m", 2.0**31)):
        write_transducer("odd", (member,), value)
        refused = run("render", "oak", "--finger-path", "path.csv", "--transducer", "odd", "-o", "drive.wav")
        assert refused.returncode == 5 and f"#/{member}: {member} is {value:g}" in refused.stderr, refused
        assert "--implausible" in refused.stderr, refused
        assert not pathlib.Path("drive.wav").exists()
    tacto.run("record", "-d", "sim:surface=C", "--time", "1s", "-o", "taken")
    side = json.loads(pathlib.Path("taken.json").read_text())
    side["data"].pop("numbers_sha256")
    side["transducer"]["flexure_stiffness_n_per_m"] = 2.0**31
    pathlib.Path("taken.json").write_text(json.dumps(side))
    _, said = tacto.run("spatial", "taken", "-o", "made", code=5)
    assert "flexure_stiffness_n_per_m" in said and "2.14748e+09" in said and "--equalise" in said, said
    tacto.run("spatial", "taken", "-o", "made", "--equalise", "off")
    out, _ = tacto.run("validate", "taken", code=4)
    assert "flexure_stiffness_n_per_m" in out, out


if __name__ == "__main__":
    for test in (what_was_found, extreme_numbers_of_a_transducer):
        tacto.in_folder(test)
