#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Existing outputs: every verb refuses them, --force replaces them, but never a recording's data."""
import json
import os
import pathlib

import tacto

USAGE, UNSUITABLE, CANNOT_WRITE = 2, 5, 7
SIM = "sim:surface=C,speed=50mm/s,seed=1"


def make_inputs():
    """A recording, its texture, and a finger path."""
    tacto.run("record", "-d", SIM, "--time", "2s", "-o", "rec")
    tacto.run("spatial", "rec", "--stroke", "1", "-o", "oak")
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0.010\n0.2,0.012\n0.6,0.03\n")


def refused_then_forced(outputs, *command):
    """Runs the same command twice: the second is refused before it changes anything, and replaces with --force."""
    tacto.run(*command)
    before = {name: pathlib.Path(name).read_bytes() for name in outputs}
    error = tacto.error_of(*command, code=USAGE)
    assert error["where"] in before and "--force" in error["remedy"], error
    assert before == {name: pathlib.Path(name).read_bytes() for name in outputs}, command
    for name in outputs:
        os.utime(name, (0, 0))
    tacto.run(*command, "--force")
    for name in outputs:
        assert os.stat(name).st_mtime > 0, (name, "was not written anew")


def every_verb_keeps_what_is_there():
    make_inputs()
    render = ["render", "oak", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o"]
    refused_then_forced(["oak.nc", "oak.png", "oak.csv"], "spectrogram", "oak", "-o", "oak.nc", "-o", "oak.png", "-o", "oak.csv")
    refused_then_forced(["d.csv"], "describe", "oak", "-o", "d.csv")
    refused_then_forced(["d.descriptions.json"], "describe", "oak", "-o", "d")
    refused_then_forced(["f.formants.json"], "formants", "oak", "-o", "f")
    refused_then_forced(["twice.texture.json", "twice.texture.wav"], "transform", "oak", "-o", "twice", "--gain", "2x")
    refused_then_forced(["sheet.png"], "sheet", "oak", "-o", "sheet.png")
    refused_then_forced(["drive.wav"], *render, "drive.wav")
    refused_then_forced(["c.html", "c.results.json"], "compare", "oak", "oak", "-o", "c.html", "-o", "c.results.json")
    os.mkdir("study")
    tacto.run("spatial", "rec", "--stroke", "1", "-o", "study/oak")
    refused_then_forced(["study.html"], "report", "study", "-o", "study.html")
    tacto.run("play", "oak", "-d", "sim:", "--finger-path", "path.csv", "-o", "live")
    refused_then_forced(["s.csv", "s.wav", "s.nc", "k.csv"], "session", "live", "-o", "s.csv", "-o", "s.wav", "-o", "s.nc",
                        "--strokes", "k.csv")
    _, said = tacto.run("play", "oak", "-d", "sim:", "--force", code=USAGE)
    assert "--unfit-transducer" in said, said


def no_file_is_named_as_another_kind():
    """A table is no sound and no picture, whatever its name."""
    make_inputs()
    patch = {"name": "wall", "place": {"x_m": 0.0, "y_m": 0.0}, "size": {"width_m": 0.1, "height_m": 0.1},
             "layers": [{"type": "spring", "stiffness_n_per_m": 100, "centre_x_m": 0, "centre_y_m": 0}]}
    pathlib.Path("plane.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "patches": [patch]}))
    pathlib.Path("hand.csv").write_text("time_s,x_mm,y_mm\n0,0,0\n1,10,0\n")
    forces = ["render", "plane.scene.json", "--device", "sandpaper-1990", "--finger-path", "hand.csv", "-o"]
    before = set(os.listdir())
    for command in ([*forces, "f.wav"], ["formants", "oak", "-o", "f.png"], ["describe", "oak", "-o", "d.wav"],
                    ["spatial", "rec", "-o", "foo.wav"], ["spatial", "rec", "-o", "foo.texture.png"]):
        tacto.run(*command, code=USAGE)
        assert set(os.listdir()) == before, command
    tacto.run(*forces, "f.csv")
    tacto.run("spatial", "rec", "--stroke", "1", "-o", "foo.texture.wav")
    assert os.path.exists("foo.texture.json") and os.path.exists("f.csv")


def recordings_are_never_replaced():
    make_inputs()
    whole = pathlib.Path("rec.wav").read_bytes()
    os.rename("rec.wav", "broken-off.wav")
    pathlib.Path("broken-off.events.jsonl").write_text("{}\n")
    pathlib.Path("rec.wav").write_bytes(whole)
    tacto.run("play", "oak", "-d", "sim:", "--finger-path", "path.csv", "-o", "live")
    render = ["render", "oak", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "--force", "-o"]
    for name in ("rec.wav", "broken-off.wav", "oak.texture.wav"):
        before = pathlib.Path(name).read_bytes()
        for command in (render + [name], ["session", "live", "--force", "-o", name]):
            _, said = tacto.run(*command, code=USAGE)
            assert "recording" in said, said
        assert pathlib.Path(name).read_bytes() == before
    for verb in ("describe", "formants"):
        assert tacto.error_of(verb, "oak", "--force", "-o", "rec.json", code=USAGE)["where"] == "rec.json"
    pathlib.Path("notes.json").write_text("{torn")
    assert tacto.error_of("describe", "oak", "--force", "-o", "notes.json", code=USAGE)["where"] == "notes.json"
    assert pathlib.Path("notes.json").read_text() == "{torn"


def missing_folders_are_made_and_none_is_left_empty():
    make_inputs()
    sim = ("-d", SIM)
    for outputs, command in (
            (["{}.wav", "{}.json"], ("record", *sim, "--time", "0.2s")), (["{}.texture.json"], ("spatial", "rec", "--stroke", "1")),
            (["{}.nc", "{}.png", "{}.csv"], ("spectrogram", "oak")), (["{}.png"], ("sheet", "oak")), (["{}.csv"], ("formants", "oak")),
            (["{}.csv"], ("describe", "oak")), (["{}.results.json"], ("compare", "oak", "oak")), (["{}.html"], ("report", ".")),
            (["{}.wav"], ("render", "oak", "--finger-path", "path.csv", "--transducer", "wiertlewski2011")),
            (["{}.session"], ("play", "oak", "-d", "sim:", "--finger-path", "path.csv")),
            (["{}.wav", "{}.json"], ("import", "path.csv", "--channel", "tangential_force=position_m*1N", "--rate", "10Hz"))):
        stem = f"new/{command[0]}/name"
        several = [option for name in outputs for option in ("-o", name.format(stem))] if command[0] == "spectrogram" else ["-o", stem]
        if command[0] in ("sheet", "formants", "describe", "compare", "report", "render"):
            several = ["-o", outputs[0].format(stem)]
        said = tacto.run_json(*command, *several)
        assert all(pathlib.Path(name.format(stem)).is_file() for name in outputs), command
        if command[0] == "record":
            assert said["made_folder"] == "new/record", said
            assert "made_folder" not in tacto.run_json(*command, "-o", "new/record/other")
    pathlib.Path("broken.csv").write_text("f\n1\nbroken\n")
    for command, code in ((("import", "broken.csv", "--rate", "10Hz", "--channel", "tangential_force=f*1N"), 4),
                          (("play", "oak", "-d", "sim:", "--finger-path", "broken.csv"), 4), (("spatial", "rec", "--stroke", "99"), UNSUITABLE),
                          (("record", "-d", "sim:", "--time", "1ks", "--channel", "none"), USAGE)):
        tacto.run(*command, "-o", "none/such/name", code=code)
        assert not os.path.exists("none"), command
    said = tacto.run("record", *sim, "--time", "0.2s", "-o", "path.csv/name", code=CANNOT_WRITE)[1]
    assert "path.csv" in said, said


def a_demo_replaces_only_demos():
    os.mkdir("demo")
    for ending in ("wav", "json"):
        pathlib.Path(f"demo/C.{ending}").write_text("mine")
    _, said = tacto.run("demo", "-o", "demo", code=USAGE)
    assert "demo/C.wav" in said and pathlib.Path("demo/C.wav").read_text() == "mine", said


def one_file_by_two_spellings_is_named_twice():
    make_inputs()
    os.mkdir("x")
    os.symlink("x", "link")
    for other in ("x/../x/a.nc", "link/a.nc", "./x/a.nc", f"{os.getcwd()}/x/a.nc"):
        _, said = tacto.run("spectrogram", "oak", "-o", "x/a.nc", "-o", other, code=USAGE)
        assert "is named twice" in said and not os.path.exists("x/a.nc"), said
    _, said = tacto.run("render", "oak", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o", "x/a.wav",
                        "--displacement", "link/a.wav", code=USAGE)
    assert "outputs" in said, said
    _, said = tacto.run("compare", "oak", "oak", "-o", "x/c.html", "-o", "link/c.html", code=USAGE)
    assert "is named twice" in said, said
    _, said = tacto.run("spatial", "rec", "x/../rec", "-o", "x/", code=USAGE)
    assert "is the same recording as rec" in said, said
    table = tacto.run_json("describe", "oak", "link/../oak", "oak.texture.json")["textures"]
    assert len(table) == 1, table


if __name__ == "__main__":
    for test in (every_verb_keeps_what_is_there, no_file_is_named_as_another_kind, recordings_are_never_replaced,
                 missing_folders_are_made_and_none_is_left_empty, a_demo_replaces_only_demos,
                 one_file_by_two_spellings_is_named_twice):
        tacto.in_folder(test)
