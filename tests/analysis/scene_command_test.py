#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene`: the files it writes, the path and the forces of a session in them, and what is refused."""
import base64
import collections
import json
import pathlib
import re
import sys
import xml.etree.ElementTree

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "playback"))
import tacto
from plane_render_test import damper, grooves, noise, patch, spring, write_path, write_scene
from tacto import run, run_json

USAGE, NOT_FOUND, UNSUITABLE = 2, 3, 5
PATH_BLUE, FORCE_RED, BODY_INK = "rgb(0%,44.7%,69.8%)", "rgb(83.5%,36.9%,0%)", "rgb(45%,25%,55%)"


def write_bench():
    write_scene("bench", patch("sand", -0.03, 0.02, 0.04, 0.04, [noise(0.006, 2e-4, 3, octaves=3)]),
                patch("grid", 0.03, 0.02, 0.04, 0.04, [grooves("square", 0.006, 1e-4, {"value": 2, "slider": {"from": 0, "to": 5}})], angle_deg=20),
                patch("pool", 0, -0.03, 0.06, 0.03, [spring(40, 0.01, 0), damper(3)], order=1))
    scene = json.loads(pathlib.Path("bench.scene.json").read_text())
    pathlib.Path("bench.scene.json").write_text(json.dumps({**scene, "name": "A <bench>"}))
    write_path("path.csv", {"time_s": [0, 1, 2, 3], "x_m": [-0.04, 0.045, 0.03, -0.02], "y_m": [0.02, 0.025, -0.03, -0.035]})


def texts(svg):
    """Each text with the point at which it is."""
    found = []
    for element in xml.etree.ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text"):
        x, y = re.match(r"translate\(([-.\d]+) ([-.\d]+)\)", element.get("transform")).groups()
        found.append(("".join(element.itertext()), float(x), float(y)))
    return found


def axes(svg):
    """From points of the page to metres, by the labels of the ticks."""
    numbers = [(float(text.replace("\u2212", "-")), x, y) for text, x, y in texts(svg) if re.fullmatch(r"\u2212?[.\d]+", text)]
    row = collections.Counter(y for _, _, y in numbers).most_common(1)[0][0]
    column = collections.Counter(x for _, x, _ in numbers).most_common(1)[0][0]
    along_x = np.polyfit(*np.transpose([(x, value) for value, x, y in numbers if y == row]), 1)
    along_y = np.polyfit(*np.transpose([(y, value) for value, x, y in numbers if x == column]), 1)
    return lambda points: 1e-3 * np.column_stack([np.polyval(along_x, points[:, 0]), np.polyval(along_y, points[:, 1])])


def paths(svg, kind, colour):
    """The lines (kind: stroke) or areas (fill) of one colour, as lists of points of the page."""
    found = []
    for style, data in re.findall(r'<path style="([^"]*)" d="([^"]*)"', svg):
        if f"{kind}:{colour}" in style.replace(" ", ""):
            found.append(np.array([[float(number) for number in point] for point in re.findall(r"[ML] ([-.\d]+) ([-.\d]+)", data)]))
    return found


def distance(place, line):
    """To the nearest part of a line."""
    start, way = line[:-1], np.diff(line, axis=0)
    part = np.clip(np.sum((place - start) * way, axis=1) / np.maximum(np.sum(way**2, axis=1), 1e-30), 0, 1)
    return np.hypot(*(start + part[:, None] * way - place).T).min()


def a_scene_becomes_a_picture():
    for name in ("bench.png", "bench.svg"):
        report = run_json("scene", "bench", "-o", name)
        assert report["written"] == name and report["patches"] == 3 and report["slope_of_1_n"] > 0 and "session" not in report, report
    assert pathlib.Path("bench.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    svg = pathlib.Path("bench.svg").read_text()
    image = max((base64.b64decode(data) for data in re.findall(r"data:image/png;base64,([^\"]+)", svg)), key=len)
    assert image[25] == 3, image[:33]  # PNG's colour type: a palette
    said = [text for text, _, _ in texts(svg)]
    for words in ("A <bench>", "sand", "grid", "pool", "x (mm)", "y (mm)", "spring and damper", "slider kappa 2 N", "0 N", "5 N"):
        assert words in said, (words, said)
    assert not any("SIMULATED" in text or "travel" in text for text in said), said
    # A wider view has more plane in a pixel.
    wide = run_json("scene", "bench.scene.json", "-o", "wide.svg", "--device", "sandpaper-1990", "--hand", "minsky-radial")
    assert wide["device"] == "sandpaper-1990" and wide["pixel_m"] > report["pixel_m"] and wide["width_m"] >= 0.2, wide
    assert any("travel" in text for text, _, _ in texts(pathlib.Path("wide.svg").read_text()))
    # The walls of the grooves are smoothed for the device; a hand that holds it permits steeper ones.
    assert run_json("scene", "bench", "-o", "free.svg", "--device", "sandpaper-1990")["slope_of_1_n"] != wide["slope_of_1_n"]
    run_json("scene", "bench", "-o", "free.svg", "--device", "sandpaper-1990", "--force")


def the_session_is_where_its_ticks_are():
    run("play", "bench.scene.json", "-d", "sim:planar,hand=minsky-radial", "--finger-path", "path.csv", "-o", "held")
    run("session", "held", "-o", "held.csv")
    ticks = np.genfromtxt("held.csv", delimiter=",", names=True)
    places, forces = (np.column_stack([ticks[f"{before}x{after}"], ticks[f"{before}y{after}"]]) for before, after in (("", "_m"), ("force_", "_n")))
    report = run_json("scene", "bench", "-o", "held.svg", "--session", "held")
    svg = pathlib.Path("held.svg").read_text()
    assert "simulated" in report and any("SIMULATED" in text for text, _, _ in texts(svg)), report
    way = np.hypot(*np.diff(places, axis=0).T).sum()
    assert abs(report["path_m"] / way - 1) < 1e-6, (report, way)
    to_plane, point_m, bottom = axes(svg), 2 * report["pixel_m"], next(y for text, _, y in texts(svg) if text == "x (mm)")
    lines = [to_plane(line) for line in paths(svg, "stroke", PATH_BLUE) if line[0, 1] < bottom]
    # Coordinates have two decimals; those of the labels, too.
    for place in np.concatenate(lines)[::25]:
        assert np.hypot(*(places - place).T).min() < 0.05 * point_m, place
    # A place is drawn unless it is in the same cell of half a point as one that is drawn.
    for place in places[::50]:
        assert min(distance(place, line) for line in lines) < 0.8 * point_m, place
    tips = [area[0] for area in paths(svg, "fill", FORCE_RED)]
    shafts = [line[0] for line in paths(svg, "stroke", FORCE_RED)]
    assert len(tips) == len(shafts) and 10 < len(tips) - 1 <= report["force_arrows"], (len(tips), len(shafts), report)
    # The last arrow is that of the legend, with its force.
    value, unit = next(text for text, _, _ in texts(svg) if text.startswith("force on the hand, ")).removeprefix("force on the hand, ").split()
    scale = (tips[-1][0] - shafts[-1][0]) / (float(value) * {"N": 1, "mN": 1e-3}[unit])
    for start, tip in zip(shafts[:-1], tips[:-1]):
        distances = np.hypot(*(places - to_plane(start[None])[0]).T)
        near = distances < distances.min() + 0.05 * point_m
        error = np.hypot(*(scale * forces[near] - (tip - start) * [1, -1]).T).min()
        assert error < 0.06, (start, tip, error)  # points: two decimals, of the legend over half the longest arrow


def a_lasso_is_where_its_motion_is():
    """The mass of a lasso depends on the counts of the hand alone: computed here again from the ticks of the session."""
    mass, stiffness, length, damping, rate = 0.1, 300.0, 0.01, 0.5, 1000
    layer = {"type": "lasso", "mass_kg": mass, "stiffness_n_per_m": stiffness, "length_m": length, "damping_n_s_per_m": damping}
    write_scene("twirl", patch("twirl", layers=[layer]), patch("soup", x_m=0.5, width_m=0.01, layers=[damper(1), {"type": "mover", "speed_mps": 0.1, "damping_n_s_per_m": 1}]))
    t = np.linspace(0, 2, 81)
    write_path("turn.csv", {"time_s": t, "x_m": 0.03 * np.cos(5 * t), "y_m": 0.03 * np.sin(5 * t)})
    run("play", "twirl.scene.json", "-d", "sim:planar", "--rate", f"{rate}Hz", "--finger-path", "turn.csv", "-o", "twirl")
    run("session", "twirl", "-o", "twirl.csv")
    ticks = np.genfromtxt("twirl.csv", delimiter=",", names=True)
    z = damping / (rate * mass)
    loss, by_speed, by_force = np.expm1(-z), -np.expm1(-z) / z / rate, (z + np.expm1(-z)) / z**2 / rate**2 / mass
    hand = np.column_stack([ticks["x_m"], ticks["y_m"]])
    place, speed, places = hand[0], np.zeros(2), []
    for at in hand:
        way = at - place
        distance_m = np.hypot(*way)
        force = stiffness * (1 - length / distance_m) * way if distance_m > length else np.zeros(2)
        place, speed = place + by_speed * speed + by_force * force, speed + loss * speed + by_speed / mass * force
        places.append(place)
    report = run_json("scene", "twirl", "-o", "twirl.svg", "--session", "twirl")
    svg = pathlib.Path("twirl.svg").read_text()
    said = [text for text, _, _ in texts(svg)]
    assert "lasso" in said and "damper, mover" in said and not any(text.startswith("spring") for text in said), said
    to_plane, point_m, bottom = axes(svg), 2 * report["pixel_m"], next(y for text, _, y in texts(svg) if text == "x (mm)")
    lines = [to_plane(line) for line in paths(svg, "stroke", BODY_INK) if line[0, 1] < bottom and len(line) != 49]
    for drawn in np.concatenate(lines)[::10]:
        assert np.hypot(*(np.array(places) - drawn).T).min() < 0.2 * point_m, drawn
    for at in places[::50]:
        assert min(distance(at, line) for line in lines) < 0.8 * point_m, at
    # Without a session it has no path; a body that was taken up nowhere has none, either.
    run("scene", "twirl", "-o", "still.svg")
    still = [text for text, _, _ in texts(pathlib.Path("still.svg").read_text())]
    assert any("taken up where the hand enters" in text for text in still), still


def another_scene_than_the_session_s_is_named():
    assert "warning" not in run("scene", "bench", "-o", "same.svg", "--session", "held")[1]
    write_scene("other", patch("sand", layers=[damper(1)]))
    assert "other.scene.json" in run("scene", "other", "-o", "other.svg", "--session", "held")[1]


def wrong_uses_are_refused():
    def refused(code, word, *arguments):
        _, err = run("scene", *arguments, code=code)
        assert word in err and err.count("\n") == 1 and not list(pathlib.Path().glob("x*")), (word, err)

    refused(USAGE, "--output", "bench")
    refused(USAGE, ".svg", "bench", "-o", "x.pdf")
    refused(USAGE, "--device", "bench", "-o", "x.png", "--hand", "minsky-radial")
    refused(USAGE, "bench.svg", "bench", "-o", "bench.svg")
    refused(NOT_FOUND, "nothere", "nothere", "-o", "x.png")
    refused(NOT_FOUND, "sandpaper-1990", "bench", "-o", "x.png", "--device", "nothere")
    refused(NOT_FOUND, "minsky-radial", "bench", "-o", "x.png", "--device", "sandpaper-1990", "--hand", "nothere")
    refused(NOT_FOUND, "nothere", "bench", "-o", "x.png", "--session", "nothere")
    pathlib.Path("tray.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "layers": [{"type": "texture", "texture": "oak", "at_m": 0, "gain_m_per_n": 1e-3}]}))
    refused(UNSUITABLE, "tactograph spectrogram", "tray", "-o", "x.png")
    write_scene("heavy", patch(layers=[{"type": "mass", "mass_kg": 1}]))
    refused(UNSUITABLE, "heavy.scene.json#/patches/0/layers/0/type", "heavy", "-o", "x.png")
    run("record", "-d", "sim:surface=E,seed=1", "--time", "1s", "-o", "E")
    run("spatial", "E", "-o", "E", "--stroke", "1")
    run("play", "E", "-d", "sim:", "--time", "0.3s", "-o", "tray")
    refused(UNSUITABLE, "tray.session", "bench", "-o", "x.png", "--session", "tray")


def samples_are_the_reference_and_the_kernel():
    shown = run_json("scene", "--sample", "noise", "3.14,42,7")
    # Perlin's program of 2002 prints 0.136919958784; single precision is within 2e-7.
    assert shown["noise"] == "0.136919958784" and abs(float(shown["kernel"]) - 0.136919958784) < 2e-7, shown
    # A spring of 40 N/m to (10 mm, -30 mm): exact but for the encoder's count of 10 um.
    shown = run_json("scene", "bench", "--device", "sandpaper-1990", "--sample", "pool.0", "20mm,-20mm")
    for key in ("force_x_n", "kernel_x_n", "force_y_n", "kernel_y_n"):
        assert abs(shown[key] + 40 * 0.01) < 1e-6, shown
    whole = run_json("scene", "bench", "--device", "sandpaper-1990", "--sample", "pool", "20mm,-20mm")
    assert whole["force_x_n"] == shown["force_x_n"], whole  # its damper has no force at rest
    for code, *wrong in ((USAGE, "--sample", "noise", "1,2"), (USAGE, "bench", "--sample", "pool", "20mm,-20mm"),
                         (NOT_FOUND, "bench", "--device", "sandpaper-1990", "--sample", "pool.7", "20mm,-20mm"),
                         (UNSUITABLE, "bench", "--device", "sandpaper-1990", "--sample", "pool", "90mm,90mm")):
        assert "--sample" in run("scene", *wrong, code=code)[1], wrong


def all_of_it():
    write_bench()
    for test in (a_scene_becomes_a_picture, the_session_is_where_its_ticks_are, a_lasso_is_where_its_motion_is, another_scene_than_the_session_s_is_named, samples_are_the_reference_and_the_kernel, wrong_uses_are_refused):
        test()
        print(f"{test.__name__}: passed")


if __name__ == "__main__":
    tacto.in_folder(all_of_it)
