#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Devices, hands and scenes with force patches on the command line: described, validated, and refused where a tray plays."""
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "end-to-end"))
from tacto import run, run_json

REFUSAL = "this scene has force patches, which a tray cannot play"
MALFORMED, UNSUITABLE = 4, 5
LAYERS = [{"type": "grooves", "profile": "square", "period_m": 0.001, "kappa_n": 1,
           "depth_m": {"value": 0.0002, "slider": {"from": 0, "to": 0.001}}},
          {"type": "damper", "damping_n_s_per_m": 5}]
PATCH = {"name": "wood", "place": {"x_m": 0, "y_m": 0}, "size": {"width_m": 0.1, "height_m": 0.05}, "layers": LAYERS}
SCENE = {"kind": "scene", "version": "1.0", "patches": [PATCH]}


def presets_are_described(folder):
    device = run_json("info", "sandpaper-1990", cwd=folder)
    assert device["kind"] == "device" and [axis["axis"] for axis in device["axes"]] == ["x", "y"], device
    assert all(axis["viscous_n_s_per_m"] == 1.17 for axis in device["axes"]), device
    assert "ours" in device["notes"], device
    for name, damping in (("minsky-tangential", 3), ("minsky-radial", 10)):
        hand = run_json("info", name, cwd=folder)
        assert (hand["kind"], hand["damping_n_s_per_m"], hand["stiffness_n_per_m"], hand["mass_kg"]) == ("hand", damping, 400, 0.8)
    valid = run_json("validate", "sandpaper-1990", "minsky-radial", "minsky-tangential", cwd=folder)
    assert valid["valid"] is True and [file["kind"] for file in valid["files"]] == ["device", "hand", "hand"], valid


def a_scene_is_described_and_validated(folder):
    (folder / "bench.scene.json").write_text(json.dumps(SCENE))
    said = run_json("info", "bench", cwd=folder)
    patch = said["patches"][0]
    assert "layers" not in said and patch["patch"] == "wood" and patch["combine"] == "topmost", said
    assert [layer["type"] for layer in patch["layers"]] == ["grooves", "damper"], patch
    assert patch["layers"][0]["filter"] == "auto" and patch["layers"][0]["depth_m"] == 0.0002, patch
    assert said["sliders"] == [{"patch": "wood", "layer": 0, "member": "depth_m", "value": 0.0002, "from": 0, "to": 0.001}], said
    words, _ = run("info", "bench", cwd=folder)
    assert "wood" in words and "grooves" in words and "depth_m" in words, words
    assert run_json("validate", "bench", cwd=folder)["valid"] is True
    sand = {"type": "noise", "period_m": 0.003, "octaves": 6, "roughness": 0.5, "seed": 123456789, "depth_m": 1e-4, "kappa_n": 1}
    (folder / "sand.scene.json").write_text(json.dumps(SCENE | {"patches": [SCENE["patches"][0] | {"layers": [sand]}]}))
    words, _ = run("info", "sand", cwd=folder)
    assert "123456789" in words, words  # all digits: with four, it is another texture
    wrong = json.loads(json.dumps(SCENE))
    wrong["patches"][0]["layers"][1]["type"] = "dampr"
    (folder / "wrong.scene.json").write_text(json.dumps(wrong))
    words, _ = run("validate", "wrong", code=MALFORMED, cwd=folder)
    assert "wrong.scene.json#/patches/0/layers/1/type" in words and "did you mean 'damper'?" in words, words


def a_tray_does_not_play_it(folder):
    tray = {"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 0.001}
    (folder / "bench.scene.json").write_text(json.dumps(SCENE))
    (folder / "both.scene.json").write_text(json.dumps({**SCENE, "layers": [tray]}))
    (folder / "path.csv").write_text("time (s),position (m)\n0,0\n1,0.01\n")
    for scene in ("bench", "both"):
        for arguments in (("render", scene, "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o", "x.wav"),
                          ("explain", scene), ("trade", scene)):
            _, said = run(*arguments, code=UNSUITABLE, cwd=folder)
            assert said.count("\n") == 1 and REFUSAL in said and f"{scene}.scene.json#/patches" in said, (arguments, said)
    assert not list(folder.glob("x*"))


def main():
    for check in (presets_are_described, a_scene_is_described_and_validated, a_tray_does_not_play_it):
        with tempfile.TemporaryDirectory() as folder:
            check(pathlib.Path(folder))


if __name__ == "__main__":
    main()
