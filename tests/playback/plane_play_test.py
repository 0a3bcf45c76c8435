#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`play`, `session` and `replay` of a scene of springs and dampers on sim:planar: the same forces as `render`, and again to the bit."""
import pathlib

import numpy as np

import tacto
from plane_render_test import KNOTS, UNSUITABLE, USAGE, damper, grooves, noise, patch, sampled_loop, spring, write_hand, write_line, write_path, write_scene
from tacto import run, run_json

DEVICE_FAILED = 8


def table(name):
    return np.genfromtxt(name, delimiter=",", names=True)


def play(scene, device, name, *options, **how):
    return run_json("play", scene, "-d", device, "-o", name, *options, **how)


def a_played_scene_has_the_forces_of_render():
    write_scene("bench", patch(layers=[spring(60), damper(2)]), patch(name="ice", x_m=0.02, width_m=0.02, order=1, angle_deg=20, layers=[spring(20, 0.01, 0)]))
    write_path("path.csv", KNOTS)
    for hand, uri in (((), "sim:planar"), (("--hand", "minsky-radial"), "sim:planar,device=sandpaper-1990,hand=minsky-radial")):
        name = f"played{len(hand)}"
        report = play("bench.scene.json", uri, name, "--finger-path", "path.csv", "--onset", "0s")
        assert report["lost_ticks"] == 0 and report["ticks"] > 8000 and "simulated" in report, report
        again = run_json("replay", name)
        assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
        said = run_json("session", name, "-o", f"{name}.csv")
        assert [axis["axis"] for axis in said["axes"]] == ["x", "y"] and said["ticks"] == report["ticks"], said
        assert [event["event"] for event in said["events"]] == ["armed", "playing", "idle"], said
        run("render", "bench.scene.json", "--finger-path", "path.csv", "--device", "sandpaper-1990", *hand, "-o", "f.csv", "--force")
        played, rendered = table(f"{name}.csv"), table("f.csv")
        rows = 8000
        for axis in "xy":
            # A place at the border of a count may be rounded to the other one: one encoder step.
            assert np.abs(played[f"{axis}_m"][:rows] - rendered[f"{axis}_m"][:rows]).max() < 1.6e-5
            # Single precision of the rate, 6e-8 of 4 N; with a hand two roundings of a place may differ: 0.04 m/s x 2 N s/m.
            assert np.abs(played[f"force_{axis}_n"][:rows] - rendered[f"force_{axis}_n"][:rows]).max() < (0.1 if hand else 1e-6)
        assert played["playing"][:rows].all() and not played["fault"].any()
        assert played["force_x_n"][-1] == 0 and played["playing"][-1] == 0


def surfaces_replay_to_the_bit():
    write_scene("surfaces", patch(angle_deg=10, layers=[grooves("square", 0.002, 1e-4, 1, direction_deg=-30), spring(5), noise(0.003, 1e-4, 0.5, octaves=6, seed=9)]),
                patch(name="more", combine="add", layers=[grooves("triangle", 0.001, 5e-5, 0.5, direction_deg=90)]))
    write_path("path.csv", KNOTS)
    for uri, hand in (("sim:planar", ()), ("sim:planar,device=sandpaper-1990,hand=minsky-radial", ("--hand", "minsky-radial"))):
        name = f"surfaces{len(hand)}"
        report = play("surfaces.scene.json", uri, name, "--finger-path", "path.csv", "--onset", "0s")
        again = run_json("replay", name)
        assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
    run("session", "surfaces0", "-o", "surfaces.csv")
    run("render", "surfaces.scene.json", "--finger-path", "path.csv", "--device", "sandpaper-1990", "-o", "f.csv")
    played, rendered = table("surfaces.csv"), table("f.csv")
    # A place at the border of a count may be rounded to the other one: 10 um on at most 10 kN/m of two layers; but most are the same.
    for axis in "xy":
        difference = np.abs(played[f"force_{axis}_n"][:8000] - rendered[f"force_{axis}_n"][:8000])
        assert np.mean(difference < 1e-6) > 0.99 and difference.max() < 0.1, (np.mean(difference < 1e-6), difference.max())


def a_hand_on_sim_planar_is_scipys_loop():
    rate, knots = 1000, {"time_s": np.linspace(0, 3, 13)}
    knots["x_m"] = np.array([0.02, 0.02, -0.02, 0.02, -0.02, -0.02, 0.02, 0.01, -0.01, 0.02, 0.02, -0.02, 0.0])
    write_path("swing.csv", knots)
    write_hand("mine", 0.8, 3, 400)
    write_line("line")
    write_scene("bench", patch(layers=[spring(300), damper(2)]))
    play("bench.scene.json", "sim:planar,device=line,hand=mine", "swing", "--finger-path", "swing.csv", "--onset", "0s")
    assert run_json("replay", "swing")["same_to_the_bit"] is True
    run("session", "swing", "-o", "swing.csv.out.csv")
    run("render", "bench.scene.json", "--finger-path", "swing.csv", "--device", "line", "--hand", "mine", "-o", "r.csv")
    hand = table("r.csv")["hand_x_m"]
    found = table("swing.csv.out.csv")["x_m"][:len(hand)]
    worst = np.abs(sampled_loop(hand, rate, 0.9, 4.17, 400, 300, 2, 0) - found).max()
    print(f"  sim:planar: within {worst:.2g} m of SciPy's loop")
    assert worst < 1e-6 * 0.02, worst


def wrong_uses_are_refused():
    write_path("path.csv", KNOTS)
    write_scene("bench", patch(layers=[spring(10)]))
    write_scene("heavy", patch(layers=[{"type": "mass", "mass_kg": 1}]))

    def refused(code, word, *arguments):
        _, err = run(*arguments, code=code)
        assert word in err and not list(pathlib.Path().glob("x*")), (word, err)

    refused(UNSUITABLE, "heavy.scene.json#/patches/0/layers/0/type", "play", "heavy.scene.json", "-d", "sim:planar", "-o", "x")
    refused(UNSUITABLE, "axes", "play", "bench.scene.json", "-d", "sim:", "-o", "x")
    refused(UNSUITABLE, "texture", "play", "oak", "-d", "sim:planar", "-o", "x")
    refused(USAGE, "--gain", "play", "bench.scene.json", "-d", "sim:planar", "--gain", "1mm/N", "-o", "x")
    refused(USAGE, "sim:planar", "play", "bench.scene.json", "-d", "sim:planar,hnad=a", "-o", "x")
    refused(UNSUITABLE, "rate", "play", "bench.scene.json", "-d", "sim:planar", "--rate", "333Hz", "-o", "x")
    write_path("wide.csv", {**KNOTS, "x_m": 10 * KNOTS["x_m"]})
    refused(UNSUITABLE, "travel", "play", "bench.scene.json", "-d", "sim:planar", "--finger-path", "wide.csv", "-o", "x")
    refused(UNSUITABLE, "record", "record", "-d", "sim:planar", "--time", "1s", "-o", "x")
    play("bench.scene.json", "sim:planar", "done", "--time", "0.1s")
    refused(UNSUITABLE, "strokes", "session", "done", "--strokes", "x.csv")
    refused(USAGE, ".csv", "session", "done", "-o", "x.wav")
    refused(UNSUITABLE, "forces", "compare", "done.session", "done.session")
    said = run_json("info", "done.session")
    assert [axis["axis"] for axis in said["axes"]] == ["x", "y"] and "transducer" not in said, said
    assert run_json("validate", "done.session")["valid"] is True


def a_jump_of_the_encoder_ends_in_a_fault():
    write_path("jump.csv", {"time_s": [0, 0.5, 0.501, 1], "x_m": [0, 0, 0.09, 0.09], "y_m": [0, 0, 0, 0]})
    write_scene("bench", patch(layers=[spring(10)]))
    report = play("bench.scene.json", "sim:planar", "jumped", "--finger-path", "jump.csv", code=DEVICE_FAILED)
    assert "jumped" in report["fault"], report
    assert run_json("replay", "jumped")["same_to_the_bit"] is True
    run("session", "jumped", "-o", "jumped.csv")
    assert table("jumped.csv")["fault"].any() and table("jumped.csv")["force_x_n"][-1] == 0


if __name__ == "__main__":
    for test in (a_played_scene_has_the_forces_of_render, surfaces_replay_to_the_bit, a_hand_on_sim_planar_is_scipys_loop, wrong_uses_are_refused, a_jump_of_the_encoder_ends_in_a_fault):
        tacto.in_folder(test)
