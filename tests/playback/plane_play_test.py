#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`play`, `session` and `replay` of a scene of springs and dampers on sim:planar: the same forces as `render`, and again to the bit."""
import csv
import hashlib
import pathlib
import struct

import numpy as np

import tacto
from plane_render_test import KNOTS, MALFORMED, UNSUITABLE, USAGE, damper, grooves, noise, patch, sampled_loop, spring, write_hand, write_line, write_path, write_scene
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
        assert [event["event"] for event in said["events"]][:4] == ["armed", "playing", "armed", "idle"], said
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


def bodies_replay_to_the_bit():
    brick = {"type": "body", "mass_kg": 0.3, "stiffness_n_per_m": with_slider(400, 0, 800), "damping_n_s_per_m": 4, "static_friction_n": 0.6, "kinetic_friction_n": 0.5}
    twirl = {"type": "lasso", "mass_kg": 0.1, "stiffness_n_per_m": 300, "length_m": 0.01, "damping_n_s_per_m": 0.5}
    write_scene("bodies", patch(angle_deg=10, layers=[brick, twirl]), patch(name="river", combine="add", x_m=0.02, width_m=0.03, layers=[{"type": "mover", "speed_mps": 0.1, "damping_n_s_per_m": 2}]))
    write_path("path.csv", KNOTS)
    pathlib.Path("bodies.csv").write_text("time_s,command\n0.5,set a.body.stiffness_n_per_m 700\n0.9,move river 0mm,5mm\n1.2,set a.body.stiffness_n_per_m 100\n")
    report = play("bodies.scene.json", "sim:planar,device=sandpaper-1990,hand=minsky-radial", "bodies", "--finger-path", "path.csv", "--script", "bodies.csv")
    again = run_json("replay", "bodies")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
    run("session", "bodies", "-o", "bodies.session.csv")
    assert np.abs(table("bodies.session.csv")["force_x_n"]).max() > 0.5


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


def with_slider(value, least, most):
    return {"value": value, "slider": {"from": least, "to": most}}


def write_sliders():
    elastic = {"type": "spring", "stiffness_n_per_m": with_slider(50, 0, 200), "centre_x_m": with_slider(0, -0.02, 0.02), "centre_y_m": 0}
    write_scene("bench", patch("ice", layers=[damper(1)], order=-1), patch("bench", layers=[{"type": "damper", "damping_n_s_per_m": with_slider(1, 0, 5)}, elastic, spring(10)]))


def write_script(name, times, commands):
    pathlib.Path(name).write_text("time_s,command\n" + "".join(f"{time:.4f},{command}\n" for time, command in zip(times, commands)))


def bit_of_a_force_changed(name, tick):
    """Flips the lowest bit of a tick's last force, and seals its block again (SESSION.md)."""
    data = bytearray(pathlib.Path(name).read_bytes())
    at = 0
    while at < len(data):
        kind, size = data[at + 4], struct.unpack_from("<I", data, at + 8)[0]
        payload = at + 20
        if kind == 8:
            first, _, count, axes = struct.unpack_from("<QqII", data, payload)
            if first <= tick < first + count:
                data[payload + 24 + (tick - first) * (8 + 8 * axes) + 8 * axes] ^= 1
                data[at + 12:at + 20] = hashlib.sha256(data[at + 4:at + 5] + data[at + 8:at + 12] + data[payload:payload + size]).digest()[:8]
                return bytes(data)
        at = payload + size
    raise AssertionError(tick)


def what_the_device_refuses_or_makes_unstable():
    """The free device's limit is 9365 N/m; the wire carries an onset of at most 10 s."""
    write_path("still.csv", {"time_s": [0, 0.2], "x_m": [0, 0], "y_m": [0, 0]})
    for stiffness, warned in ((9000, 0), (9800, 1)):
        write_scene("wall", patch(name="floor", x_m=-0.05, width_m=0.02, layers=[spring(20)]), patch(name="wall", width_m=0.02, layers=[spring(stiffness)]))
        report = play("wall.scene.json", "sim:planar", f"wall{stiffness}", "--finger-path", "still.csv")
        about = [one for one in report.get("warnings", []) if "tactograph design" in one]
        assert len(about) == warned and all("'wall'" in one and f"{stiffness} N/m" in one for one in about), report
    # Beside too much damping no stiffness is small enough: --hold-stable is refused, and not recommended.
    for layers in ([damper(5000)], [damper(5000), spring(20)]):
        write_scene("thick", patch(layers=layers))
        run("render", "thick.scene.json", "--finger-path", "still.csv", "--device", "sandpaper-1990", "--hold-stable", "-o", "thick.csv", code=UNSUITABLE)
        said = run("explain", "thick.scene.json", "--device", "sandpaper-1990")[1]
        assert "5000 N s/m" in said and "--hold-stable" not in said, said
    write_scene("thick", patch(layers=[spring(9800)]))
    assert "--hold-stable" in run("explain", "thick.scene.json", "--device", "sandpaper-1990")[1]
    run("play", "wall.scene.json", "-d", "sim:planar", "-o", "late", "--finger-path", "still.csv", "--onset", "20s", code=USAGE)
    assert not pathlib.Path("late.session").exists()


def play_counts_the_limited_ticks_of_its_session():
    """All ticks to the end of the session, with the fall of the force after the stop: 9 N at 1 mm are above the continuous force."""
    write_path("out.csv", {"time_s": [0, 0.2, 0.5], "x_m": [0, 0.001, 0.001], "y_m": [0, 0, 0]})
    write_scene("hard", patch(layers=[spring(9000)]))
    report = play("hard.scene.json", "sim:planar", "hard", "--finger-path", "out.csv")
    said = run_json("session", "hard")
    keys = [key for key in report if key.endswith("_limited_ticks")]
    assert len(keys) == 3 and report["rms_limited_ticks"] > 100, report
    assert [report[key] for key in keys] == [said[key] for key in keys], (report, said)
    assert report["ticks"] == said["ticks"], (report, said)


def a_scene_is_held_stable_and_replayed():
    """The free device's limit at 4 kHz is 9365 N/m; held are 1 / 1.2 of it, with the range of the slider. The layers that act
    together are scaled by one factor."""
    write_path("out.csv", {"time_s": [0, 1, 1.5], "x_m": [0, 0.001, 0.001], "y_m": [0, 0, 0]})
    hard = {**spring(0), "stiffness_n_per_m": with_slider(5000, 0, 15000)}
    write_scene("wall", patch(name="floor", x_m=-0.05, width_m=0.02, layers=[spring(20)]), patch(name="wall", width_m=0.02, layers=[hard, spring(5000)]))
    report = play("wall.scene.json", "sim:planar", "wall", "--finger-path", "out.csv", "--onset", "0s", "--hold-stable")
    held = {row["layer"]: row for row in report["held_stable"]}
    assert set(held) == {0, 1} and all(row["patch"] == "wall" and row["type"] == "spring" for row in held.values()), report
    factor = report["held_margin"] ** -1 * run_json("explain", "wall.scene.json", "--device", "sandpaper-1990")["stiffness_limit_n_per_m"] / 20000
    assert report["held_margin"] == 1.2 and 0.38 < factor < 0.4, factor  # of 15000 + 5000 N/m
    for layer, stiffness in ((0, 15000), (1, 5000)):
        assert held[layer]["from_n_per_m"] == stiffness and abs(held[layer]["to_n_per_m"] / (factor * stiffness) - 1) < 1e-9, held
    assert not [one for one in report.get("warnings", []) if "tactograph design" in one], report
    run("session", "wall", "-o", "wall.csv")
    played = table("wall.csv")
    # Of single precision; at rest at 1 mm.
    assert abs(played["force_x_n"][5000] / (-factor * (5000 + 5000) * 0.001) - 1) < 1e-6, played["force_x_n"][5000]
    again = run_json("replay", "wall")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
    events = [event["event"] for event in run_json("session", "wall")["events"]]
    assert sum("held stable" in event for event in events) == 2, events
    rendered = run_json("render", "wall.scene.json", "--finger-path", "out.csv", "--device", "sandpaper-1990", "--hold-stable", "-o", "f.csv")
    assert rendered["held_stable"] == report["held_stable"], rendered
    # A place at the border of a count may be rounded to the other one; else single precision of 4 N.
    assert np.mean(np.abs(table("f.csv")["force_x_n"][:5000] - played["force_x_n"][:5000]) < 1e-5) > 0.99
    write_script("beyond.csv", [0.1], ["set wall.0.stiffness_n_per_m 15001"])
    # A number is set within the range that was scaled.
    for value, code in ((0.99, 0), (1.01, MALFORMED)):
        write_script("set.csv", [0.1], [f"set wall.0.stiffness_n_per_m {value * factor * 15000:.3f}"])
        run("play", "wall.scene.json", "-d", "sim:planar", "--finger-path", "out.csv", "--hold-stable", "--script", "set.csv", "-o", f"set{code}", code=code)
    # The range of the file is in the message, too: 15000 N/m is what a reader of the scene expects.
    _, said = run("play", "wall.scene.json", "-d", "sim:planar", "--finger-path", "out.csv", "--hold-stable", "--script", "set.csv", "-o", "again", code=MALFORMED)
    assert "15000" in said and "--hold-stable" in said and f"{factor:.4g}" in said, said
    _, said = run("play", "wall.scene.json", "-d", "sim:planar", "--finger-path", "out.csv", "--script", "beyond.csv", "-o", "again", code=MALFORMED)
    assert "15000" in said and "--hold-stable" not in said, said
    # In a hand that carries it nothing is scaled.
    report = play("wall.scene.json", "sim:planar,hand=minsky-radial", "in_hand", "--time", "0.1s", "--hold-stable")
    assert isinstance(report["held_stable"], str), report
    assert "not_judged" not in report, report
    # What no method judges is named.
    body, lasso = {"type": "body", "mass_kg": 0.3, "stiffness_n_per_m": 100, "damping_n_s_per_m": 4}, {"type": "lasso", "mass_kg": 0.1, "stiffness_n_per_m": 10, "length_m": 0.01, "damping_n_s_per_m": 0.5}
    write_scene("moving", patch(name="a", layers=[body, spring(1)]), patch(name="b", layers=[lasso], order=1))
    names = {"body 0 of patch 'a'", "lasso 0 of patch 'b'"}
    assert set(play("moving.scene.json", "sim:planar", "moving", "--time", "0.1s", "--hold-stable")["not_judged"]) == names
    assert set(run_json("render", "moving.scene.json", "--device", "sandpaper-1990", "--finger-path", "out.csv", "-o", "moving.csv", "--hold-stable")["not_judged"]) == names
    run("play", "oak", "-d", "sim:", "--hold-stable", "-o", "x", code=USAGE)
    run("render", "wall.scene.json", "--finger-path", "out.csv", "--transducer", "wiertlewski2011", "--hold-stable", "-o", "x.wav", code=USAGE)


def an_adaptive_spring_is_a_spring_and_a_damper():
    """To the bit: the damper that `explain` lists, written into the scene. The patch keeps its own damper under its name."""
    write_path("path.csv", {name: 0.01 * column if name != "time_s" else column for name, column in KNOTS.items()})
    slid = {"type": "damper", "damping_n_s_per_m": with_slider(0.1, 0, 0.2)}
    write_scene("soft", patch(width_m=0.05, height_m=0.05, layers=[{**spring(9000), "adaptive": True}, slid]))
    rows = run_json("explain", "soft.scene.json", "--device", "sandpaper-1990")["layers"]
    assert [row["type"] for row in rows] == ["spring", "damper", "damper"] and rows[0]["adaptive"] is True, rows
    added = rows[2]["added_damping_n_s_per_m"]
    write_scene("both", patch(width_m=0.05, height_m=0.05, layers=[spring(9000), slid, {**damper(added), "two_ticks": True}]))
    assert run_json("info", "soft")["patches"][0]["layers"][0]["adaptive"] is True
    write_script("set.csv", [0.5], ["set a.damper.damping_n_s_per_m 0.2"])
    write_script("set1.csv", [0.5], ["set a.1.damping_n_s_per_m 0.2"])
    for scene, script in (("soft", "set.csv"), ("both", "set1.csv")):
        play(f"{scene}.scene.json", "sim:planar", scene, "--finger-path", "path.csv", "--onset", "0s", "--script", script)
        assert run_json("replay", scene)["same_to_the_bit"] is True
        run("session", scene, "-o", f"{scene}.csv")
    soft, both = table("soft.csv"), table("both.csv")
    # A command is sent up to 20 ms after its time; no force is limited, so that nothing else depends on the past.
    ticks = np.r_[0:1990, 2200:8000]
    assert added > 0.1 and all(np.array_equal(soft[name][ticks], both[name][ticks]) for name in ("x_m", "force_x_n", "force_y_n")), added


def sliders_move_the_force_and_are_replayed():
    rng = np.random.default_rng(3110)
    write_sliders()
    times = 0.3 * np.arange(199) + 0.1 + 0.1 * rng.random(199)
    springs = [("stiffness_n_per_m", round(rng.uniform(0, 80), 3)) if rng.random() < 0.6 else ("centre_x_m", round(rng.uniform(-0.02, 0.02), 5)) for _ in times]
    ramps = rng.choice(["", " over 0s", " over 50ms"], len(times))
    write_script("sliders.csv", times, [f"set bench.1.{member} {value}{ramp}" for (member, value), ramp in zip(springs, ramps)])
    write_path("still.csv", {"time_s": [0, 60], "x_m": [0.03, 0.03], "y_m": [0, 0]})
    report = play("bench.scene.json", "sim:planar", "set", "--rate", "1kHz", "--finger-path", "still.csv", "--script", "sliders.csv", "--onset", "0s")
    assert report["lost_ticks"] == report["slew_limited_ticks"] == report["rms_limited_ticks"] == 0, report
    run("session", "set", "-o", "set.csv")
    found = table("set.csv")["force_x_n"][:60000]
    # The hand is at 0.03 m: -stiffness (0.03 - centre) of this spring, -10 x 0.03 of the other one.
    numbers = {"stiffness_n_per_m": 50.0, "centre_x_m": 0.0}
    settled = 0
    for i, ((member, value), ramp) in enumerate(zip(springs, ramps)):
        begin, end = round(1000 * times[i]), round(1000 * times[i + 1]) if i + 1 < len(times) else 60000
        before = -numbers["stiffness_n_per_m"] * (0.03 - numbers["centre_x_m"]) - 0.3
        numbers[member] = value
        after = -numbers["stiffness_n_per_m"] * (0.03 - numbers["centre_x_m"]) - 0.3
        ticks = {"": 10, " over 0s": 1, " over 50ms": 50}[ramp]
        changed = begin + np.flatnonzero(np.abs(found[begin:end] - before) > 1e-6)
        if abs(after - before) > 1e-3:
            # Within 20 ms after its time and one tick, linearly; single precision: 50 steps of 6e-8 x 10 N.
            assert begin <= changed[0] <= begin + 21, (i, begin, changed[0])
            line = before + (after - before) * np.minimum(np.arange(1, end - changed[0] + 1) / ticks, 1)
            assert np.abs(found[changed[0]:end] - line).max() < 3e-5, (i, ramp)
            settled += 1
    assert settled > 190, settled
    events = [event["event"] for event in run_json("session", "set")["events"]]
    assert f"set bench.1.stiffness_n_per_m {springs[[m for m, _ in springs].index('stiffness_n_per_m')][1]}" in "|".join(events), events[:5]
    assert run_json("replay", "set")["same_to_the_bit"] is True
    pathlib.Path("other.session").write_bytes(bit_of_a_force_changed("set.session", 43210))
    other = run_json("replay", "other", code=UNSUITABLE)
    assert other["first_difference_tick"] == 43210 and "recorded_n" in other, other


def moved_and_raised_patches_have_their_forces_and_are_replayed():
    """Two springs, each in a patch that always covers the hand: only the topmost one acts."""
    rng = np.random.default_rng(3112)
    step_m, hand_m, count = 1e-5, 0.03, 200
    write_scene("two", *(patch(name, layers=[{**spring(0), "stiffness_n_per_m": with_slider(stiffness, 0, 60)}], order=order)
                         for name, stiffness, order in (("low", 30, 0), ("high", 20, 1))))
    times = 0.29 * np.arange(count) + 0.1 + 0.1 * rng.random(count)
    commands, states = [], []
    state = {"low": [30.0, 0], "high": [20.0, 0], "top": "high"}  # stiffness, counts along x
    for i in range(count):
        name, ramp = str(rng.choice(["low", "high"])), str(rng.choice(["", " over 0s", " over 50ms"]))
        ticks, before = {"": 10, " over 0s": 1, " over 50ms": 50}[ramp], {**state}
        kind = "raise" if i % 3 == 2 else "set" if i % 3 == 1 else "move"
        if kind == "raise":
            state = {**state, "top": name}
            commands.append(f"raise {name}")
        elif kind == "set":
            stiffness = round(rng.uniform(5, 60), 3)
            state = {**state, name: [stiffness, state[name][1]]}
            commands.append(f"set {name}.spring.stiffness_n_per_m {stiffness}{ramp}")
        else:
            to = int(rng.integers(-3000, 3000))
            state = {**state, name: [state[name][0], to]}
            # Less than half a count beside it: the nearest count is taken.
            commands.append(f"move {name} {1e3 * (to + rng.uniform(-0.4, 0.4)) * step_m:.6f}mm,{rng.uniform(-5, 5):.3f}mm{ramp}")
        states.append((kind, name, ticks, before, state))
    write_script("plane.csv", times, commands)
    write_path("still.csv", {"time_s": [0, 60], "x_m": [hand_m, hand_m], "y_m": [0, 0]})
    report = play("two.scene.json", "sim:planar", "plane", "--rate", "1kHz", "--finger-path", "still.csv", "--script", "plane.csv", "--onset", "0s")
    assert report["lost_ticks"] == report["slew_limited_ticks"] == report["rms_limited_ticks"] == 0, report
    run("session", "plane", "-o", "plane.csv.out.csv")
    found = table("plane.csv.out.csv")["force_x_n"][:60000]

    def force(stiffness, counts):
        return -stiffness * (hand_m - step_m * counts)

    seen = 0
    for i, (kind, name, ticks, before, after) in enumerate(states):
        begin, end = round(1000 * times[i]), round(1000 * times[i + 1]) if i + 1 < count else 60000
        was, becomes = force(*before[before["top"]]), force(*after[after["top"]])
        if abs(becomes - was) < 1e-3:
            continue
        # Of single precision 3e-7 x 4 N; a count of the softest spring is 5e-5 N.
        first = begin + np.flatnonzero(np.abs(found[begin:end] - was) > 2e-6)[0]
        k = np.minimum(np.arange(1, end - first + 1), ticks)
        if kind == "raise":
            line = np.full(len(k), becomes)
        elif kind == "set":
            line = was + (becomes - was) * k / ticks
        else:
            # From the first tick in which the move is a whole count: k / n of the way, rounded towards its beginning.
            way = after[name][1] - before[name][1]
            unseen = int(np.argmax(abs(way) * np.arange(1, ticks + 1) // ticks > 0))
            k = np.minimum(k + unseen, ticks)
            line = force(after[name][0], before[name][1] + np.sign(way) * (abs(way) * k // ticks))
        # Within 20 ms after its time and one tick, and what is not seen of it; single precision: 50 steps of 6e-8 x 4 N.
        assert first <= begin + 21 + ticks, (i, begin, first)
        assert np.abs(found[first:end] - line).max() < 1.5e-5, (i, commands[i], np.abs(found[first:end] - line).max())
        seen += 1
    assert seen > 80, seen
    events = [event["event"] for event in run_json("session", "plane")["events"]]
    assert sum(event.startswith(("set ", "move ", "raise ")) for event in events) == count, events[:5]
    assert run_json("replay", "plane")["same_to_the_bit"] is True
    pathlib.Path("other.session").write_bytes(bit_of_a_force_changed("plane.session", 54321))
    assert run_json("replay", "other", code=UNSUITABLE)["first_difference_tick"] == 54321


def a_hand_under_sliders_is_replayed():
    write_sliders()
    rng = np.random.default_rng(3111)
    times = np.sort(rng.choice(59000, 200, replace=False)) / 1000 + 0.1
    kinds = [("bench.damper.damping_n_s_per_m", 0, 5), ("bench.1.stiffness_n_per_m", 0, 200), ("bench.1.centre_x_m", -0.02, 0.02)]
    commands = [f"set {name} {rng.uniform(least, most):.4f}" for name, least, most in (kinds[k] for k in rng.integers(0, 3, 200))]
    for i in range(0, 200, 3):
        commands[i] = f"raise {rng.choice(['ice', 'bench'])}" if i % 2 else f"move {rng.choice(['ice', 'bench'])} {rng.uniform(-20, 20):.3f}mm,{rng.uniform(-20, 20):.3f}mm"
    write_script("many.csv", times, commands)
    seconds = np.linspace(0, 60, 241)
    write_path("long.csv", {"time_s": seconds, "x_m": 0.03 * np.sin(4 * seconds), "y_m": 0.02 * np.cos(3 * seconds)})
    report = play("bench.scene.json", "sim:planar,hand=minsky-radial", "held", "--finger-path", "long.csv", "--script", "many.csv")
    assert report["lost_ticks"] == 0 and report["ticks"] > 240000, report
    assert run_json("replay", "held")["same_to_the_bit"] is True


def a_wrong_script_plays_nothing():
    write_sliders()
    good = "0.5,set bench.1.stiffness_n_per_m 100"
    for line, word, *rows in (
            (2, "bench", "1,set bnech.1.stiffness_n_per_m 100"), (2, "damper", "1,set bench.dampr.damping_n_s_per_m 1"), (2, "index", "1,set bench.spring.centre_y_m 0"),
            (2, "stiffness_n_per_m", "1,set bench.1.stifness_n_per_m 1"), (2, "damper", "1,set bench.3.stiffness_n_per_m 1"), (2, "slider", "1,set bench.1.centre_y_m 0"),
            (2, "200", "1,set bench.1.stiffness_n_per_m 201"), (2, "nan", "1,set bench.1.stiffness_n_per_m nan"), (2, "1e999", "1,set bench.1.stiffness_n_per_m 1e999"),
            (2, "10 s", "1,set bench.1.stiffness_n_per_m 1 over 11s"), (2, "ms", "1,set bench.1.stiffness_n_per_m 1 over 10"), (2, "inf", "inf,set bench.1.stiffness_n_per_m 1"),
            (2, "-1", "-1,set bench.1.stiffness_n_per_m 1"), (2, "bench", "1,move bnech 1mm,2mm"), (2, "10mm,20mm", "1,move bench 10mm"), (2, "mm", "1,move bench 10,20"),
            (2, "10 s", "1,move bench 1mm,2mm over 11s"), (2, "too far", "1,move bench 20000m,0mm"), (2, "bench", "1,raise bnech"), (2, "raise", "1,raise bench ice"), (2, "shift", "1,shift bench 1"), (2, "bench.1", "1,set bench.1 1"),
            (4, "increase", good, "", "0.5,set bench.1.stiffness_n_per_m 90"), (3, "increase", good, "0.4,set bench.1.stiffness_n_per_m 90")):
        pathlib.Path("script.csv").write_text("\n".join(("time_s,command", *rows)))
        _, said = run("play", "bench.scene.json", "-d", "sim:planar", "--time", "5s", "--script", "script.csv", "-o", "x", code=MALFORMED)
        assert f"script.csv, line {line}" in said and word in said and len(said.strip().split("\n")) <= 2 and not pathlib.Path("x.session").exists(), said
    for text, word in ((good, "line 1"), ("time_mm,command\n" + good, "line 1"), ("", "time_s"), ("time_s,command\n", "time_s"), ("time_s,command\n" + good.replace("0.5", "6"), "--time")):
        pathlib.Path("script.csv").write_text(text)
        _, said = run("play", "bench.scene.json", "-d", "sim:planar", "--time", "5s", "--script", "script.csv", "-o", "x", code=MALFORMED)
        assert word in said and not pathlib.Path("x.session").exists(), said
    _, said = run("play", "oak", "-d", "sim:", "--script", "script.csv", "-o", "x", code=USAGE)
    assert "--script" in said, said
    pathlib.Path("script.csv").write_text("time_ms,command\r\n500, set bench.1.stiffness_n_per_m 100\r\n")
    play("bench.scene.json", "sim:planar", "done", "--time", "1s", "--script", "script.csv")
    with open("quoted.csv", "w", newline="") as file:
        csv.writer(file, quoting=csv.QUOTE_ALL).writerows([("time_s", "command"), (0.1, "move bench -5mm,-3mm"), (0.2, "raise bench")])
    play("bench.scene.json", "sim:planar", "quoted", "--time", "0.5s", "--script", "quoted.csv")
    quoted = [event["event"] for event in run_json("session", "quoted")["events"]]
    assert "raise bench" in quoted and any(event.startswith("move bench -0.005 m,-0.003 m") for event in quoted), quoted
    assert "set bench.1.stiffness_n_per_m 100 over 0.01 s" in [event["event"] for event in run_json("session", "done")["events"]]
    pathlib.Path("script.csv").write_text("time_s,command\n0.1,move bench 0mm,0mm\n0.2,move bench 500mm,0mm\n")
    warned = play("bench.scene.json", "sim:planar", "far", "--time", "0.5s", "--script", "script.csv")["warnings"]
    assert sum("from 0.2 s on" in one and "outside the travel" in one for one in warned) == 1 == sum("travel" in one for one in warned), warned


if __name__ == "__main__":
    for test in (what_the_device_refuses_or_makes_unstable, play_counts_the_limited_ticks_of_its_session, a_scene_is_held_stable_and_replayed, an_adaptive_spring_is_a_spring_and_a_damper, moved_and_raised_patches_have_their_forces_and_are_replayed, sliders_move_the_force_and_are_replayed, a_hand_under_sliders_is_replayed, a_wrong_script_plays_nothing, a_played_scene_has_the_forces_of_render, bodies_replay_to_the_bit, surfaces_replay_to_the_bit, a_hand_on_sim_planar_is_scipys_loop, wrong_uses_are_refused, a_jump_of_the_encoder_ends_in_a_fault):
        tacto.in_folder(test)
