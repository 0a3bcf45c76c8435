#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Force scenes of `tactograph live`, without a browser: what the server serves of them, what it refuses, and the page's
device in node, whose sessions `tactograph replay` computes again natively, to the bit, and whose forces have a closed form.
"""
import json
import pathlib
import struct
import subprocess
import sys

import numpy as np
from live_client import TickFrame, fetch_page, live
from tacto import COMMAND, in_folder, run, run_json

HERE = pathlib.Path(__file__).resolve().parent
STIFFNESS, RADIUS_M = 600.0, 0.03


def number(value, low, high):
    return {"value": value, "slider": {"from": low, "to": high}}


def write_scene(name, **members):
    pathlib.Path(f"folder/{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", **members}))


def patch(name, x_m, y_m, *layers, **members):
    return {"name": name, "place": {"x_m": x_m, "y_m": y_m}, "size": {"width_m": 0.06, "height_m": 0.05}, "layers": list(layers), **members}


def make_scenes():
    pathlib.Path("folder").mkdir()
    spring = {"type": "spring", "stiffness_n_per_m": number(100, 0, 200), "centre_x_m": 0, "centre_y_m": 0}
    damper = {"type": "damper", "damping_n_s_per_m": number(1, 0, 3)}
    grooves = {"type": "grooves", "profile": "sine", "period_m": 0.004, "depth_m": 1e-4, "kappa_n": 2}
    write_scene("plane", patches=[patch("bench", -0.03, 0, spring, damper), patch("bars", 0.03, 0.01, grooves, angle_deg=20)])
    at = {"x_m": 0, "y_m": 0, "z_m": 0}
    ball = {"name": "ball", "shape": "sphere", "place": at, "radius_m": RADIUS_M, "stiffness_n_per_m": number(STIFFNESS, 0, 800)}
    floor = {"name": "floor", "shape": "plane", "place": at | {"z_m": -0.06}, "stiffness_n_per_m": STIFFNESS, "static_friction": number(0.5, 0, 1)}
    vertices, faces = np.array([[0, 0, 0], [30, 0, 0], [0, 30, 0], [0, 0, 30]]), [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *vertices[list(face)].ravel(), 0) for face in faces)
    pathlib.Path("part.stl").write_bytes(bytes(80) + struct.pack("<I", len(faces)) + rows)
    run("import", "part.stl", "--unit", "mm", "-o", "folder/part")
    part = {"name": "part", "shape": "mesh", "mesh": "part", "place": {"x_m": 0.06, "y_m": 0, "z_m": 0}, "stiffness_n_per_m": STIFFNESS}
    write_scene("room", pieces=[ball, floor, part])
    pathlib.Path("folder/broken.scene.json").write_text("{")
    write_scene("tray", layers=[{"type": "texture", "texture": "none", "at_m": 0}])
    write_scene("<img src=x onerror=alert(1)>", patches=[patch("bench", 0, 0, spring)])
    device = json.loads((HERE.parents[1] / "data-schema/presets/sandpaper-1990.device.json").read_text())
    for axis in device["axes"]:
        axis.update(travel_m=[-0.07, 0.07], encoder_step_m=5e-6, peak_force_n=2, continuous_force_n=2)
    device.update(name="own joystick", peak_force_n=2, continuous_force_n=2, rates_hz=[250, 1000])
    pathlib.Path("folder/own.device.json").write_text(json.dumps(device))
    pathlib.Path("folder/bent.device.json").write_text("{")


def pixels(answer):
    assert answer.status == 200, answer.body
    return np.frombuffer(answer.body, "<u4")


def check_list(server):
    rows = {row["name"]: row for row in server.json("/scenes")["scenes"]}
    assert set(rows) == {"plane", "room", "broken", "tray", "<img src=x onerror=alert(1)>"}, rows
    assert rows["plane"]["patches"] == 2 and rows["room"]["pieces"] == 3, rows
    for name in ("broken", "tray"):
        assert "reason" in rows[name]
        assert server.ask(f"/scene/{rows[name]['index']}").status == 422 and server.ask(f"/scene-thumbnail/{rows[name]['index']}").status == 422
    for name in ("plane", "room"):
        width, height, *colours = pixels(server.ask(f"/scene-thumbnail/{rows[name]['index']}"))
        assert 80 <= width <= 160 and len(colours) == width * height and len(set(colours)) > 1, (name, width, height)
    for path in ("/scene/99", "/scene/x", "/scene/", "/scene-upload/99", "/scene-thumbnail/99", "/section/0/0/0", "/section/99/0/0", "/scene/../plane"):
        assert server.ask(path).status == 404, path
    for path in ("/scenes", "/scene/0", "/scene-upload/0", "/section/0/0/0", "/scene-thumbnail/0", "/scene.html"):
        assert server.ask(path, cookie=False).status == 401 and server.ask(path, Host="evil.example").status == 421, path
        assert server.ask(path, Origin="http://evil.example").status == 403, path
    for headers, status in (({"Origin": None}, 403), ({"Origin": "http://evil.example"}, 403), ({"Cookie": None}, 401)):
        assert server.page("/scene-session", **headers).status == status, headers
    return {name: row["index"] for name, row in rows.items()}


def check_sections(server, room):
    """Each pixel is solid or not as its place says; the plane through the offset."""
    colours = {piece["name"]: int(piece["colour"][1:], 16) for piece in room["pieces"]}
    for i, section in enumerate(room["sections"]):
        for through_m in (0.0013, 0.02, -0.05):
            image = pixels(server.ask(f"/section/{room['made']}/{i}/{through_m}")).reshape(section["rows"], section["columns"])
            place = np.zeros((3, *image.shape))
            place[section["right"]] = section["left_m"] + (np.arange(image.shape[1]) + 0.5)[None, :] * section["pixel_m"]
            place[section["up"]] = section["top_m"] - (np.arange(image.shape[0]) + 0.5)[:, None] * section["pixel_m"]
            place[section["across"]] = through_m
            ball, floor = np.linalg.norm(place, axis=0) < RADIUS_M, place[2] < -0.06
            part = (place[0] > 0.06) & (place[1] > 0) & (place[2] > 0) & (place[0] - 0.06 + place[1] + place[2] < 0.03)
            assert np.array_equal(image != 0xFFFFFF, ball | floor | part), (i, through_m, np.argwhere((image != 0xFFFFFF) != (ball | floor | part))[:5])
            assert not ball.any() or colours["ball"] in image[ball]  # its border
    for path in (f"{room['made']}/3/0", f"{room['made']}/0/nan", f"{room['made']}/0/inf", f"{room['made']}/0", f"{room['made']}/0/0/", f"{room['made']}/-1/0"):
        assert server.ask(f"/section/{path}").status == 404, path


def play(server, scene, seed, seconds, targets):
    pathlib.Path("about").write_text(json.dumps(scene))
    pathlib.Path("upload").write_bytes(server.ask(f"/scene-upload/{scene['made']}").body)
    done = subprocess.run(["node", "page/live_scene.mjs", "page/core.wasm", "about", "upload", str(seed), str(seconds), json.dumps(targets), "log"],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    met = json.loads(done.stdout)
    print(f"{scene['name']}: {met['tick_us']:.2f} us for a tick of the page, up to {met['pushed_n']:.1f} N")
    return met, pathlib.Path("log").read_bytes()


def keep(server, scene, log):
    page = server.page("/scene-session")
    assert page.ask(request="begin", made=scene["made"])["ok"]
    for at in range(0, len(log), 16000):
        page.send(log[at:at + 16000])
    answer = page.ask(request="keep")
    assert answer["ok"], answer
    return answer


def check_bits(server, scene, seeds, targets):
    for seed in seeds:
        met, log = play(server, scene, seed, 6, targets)
        kept = keep(server, scene, log)
        report = run_json("replay", kept["kept"])
        assert report["same_to_the_bit"] and report["ticks_compared"] == kept["ticks"] > 10 * scene["rate_hz"] and "lost_ticks" not in report, report
        run("validate", kept["kept"])
        info = json.dumps(run_json("info", kept["kept"]))
        assert "simulated" in info and "browser" in info, info
    # One bit of one force: the comparison is able to fail.
    changed = TickFrame(log, 0x8a).with_one_bit_changed(20 + 4 * len(scene["axes"]))
    assert not run_json("replay", keep(server, scene, changed)["kept"], code=5)["same_to_the_bit"]
    return met


def check_devices(server, index):
    """A device of the folder, with its own rate, travel, steps and limits; those that do not fit are refused."""
    rows = {row["name"]: row for row in server.json("/scenes")["devices"]}
    assert set(rows) == {"own", "bent"} and "reason" in rows["bent"] and "reason" not in rows["own"], rows
    own = rows["own"]["index"]
    for query, status, fault in ((f"device={rows['bent']['index']}", 422, 3), ("device=99", 404, 2), ("device=x", 404, None), ("device=", 404, None), ("x=1", 404, None), (f"device={own}&x=1", 404, None)):
        refused = server.ask(f"/scene/{index['plane']}?{query}")
        assert refused.status == status and (fault is None or json.loads(refused.body)["error"]["fault"] == fault), (query, refused.status, refused.body)
    refused = server.ask(f"/scene/{index['room']}?device={own}")  # pieces need three axes
    assert refused.status == 422 and json.loads(refused.body)["error"]["fault"] == 4, refused.body
    plane = server.json(f"/scene/{index['plane']}?device={own}")
    assert plane["device"] == "own joystick" and plane["rate_hz"] == 1000 and plane["peak_n"] == 2, plane
    assert [(axis["from_m"], axis["to_m"], axis["encoder_step_m"]) for axis in plane["axes"]] == 2 * [(-0.07, 0.07, 5e-6)], plane
    met = check_bits(server, plane, (3,), [[-0.02, -0.005]])
    assert np.allclose(met["force_n"], [-1, 0.5], rtol=0, atol=2e-6) and met["pushed_n"] < 2.001, met


def check_protocol(server, scene):
    page = server.page("/scene-session")
    assert page.ask(request="keep")["error"]["fault"] == 4
    assert page.ask(request="begin", made=999)["error"]["fault"] == 2
    assert page.ask(request="begin", made=scene["made"])["ok"]
    assert not page.ask(request="change", made=0, playing=0, times=1)["ok"]  # a texture
    page.send(b"x" * 64)
    assert page.receive()["error"]["fault"] == 3


def live_scenes():
    make_scenes()
    with live("folder") as server:
        index = check_list(server)
        plane, room = server.json(f"/scene/{index['plane']}"), server.json(f"/scene/{index['room']}")
        assert [axis["name"] for axis in plane["axes"]] == ["x", "y"] and plane["device"] == "sandpaper-1990" and not plane["ghost"], plane
        assert [axis["name"] for axis in room["axes"]] == ["x", "y", "z"] and room["device"] == "arm" and room["ghost"], room
        assert [slider["name"] for slider in plane["sliders"]] == ["bench.spring.stiffness_n_per_m", "bench.damper.damping_n_s_per_m"], plane
        assert {slider["name"] for slider in room["sliders"]} == {"ball.stiffness_n_per_m", "floor.static_friction"}, room
        start_m = np.array([axis["start_m"] for axis in room["axes"]])
        assert np.linalg.norm(start_m) > RADIUS_M and start_m[2] > -0.06, start_m
        check_sections(server, room)
        check_protocol(server, room)
        fetch_page(server, ("core.js", "finger.js", "hand.js", "core.wasm"), ("live_scene.mjs", "live_draws.mjs"))
        # At rest only the spring: -100 N/m x (10, -5) mm.
        met = check_bits(server, plane, (1, 2), [[-0.02, -0.005]])
        assert np.allclose(met["force_n"], [-1, 0.5], rtol=0, atol=2e-6) and met["values"] == [100, 1] and met["ghost_m"] is None, met
        check_devices(server, index)
        # Out of all pieces, then the ball from above: the ghost is on the sphere, the hand 2 mm deep: 1.2 N.
        # The ghost is at most 1 um inside of a piece (ghost_point.hpp).
        met = check_bits(server, room, (1, 2), [[-0.08, None, None], [None, None, 0.08], [0, 0, None], [None, None, RADIUS_M - 0.002]])
        assert np.allclose(met["ghost_m"], [0, 0, RADIUS_M], rtol=0, atol=1.1e-6), met
        assert np.allclose(met["force_n"], [0, 0, 0.002 * STIFFNESS], rtol=0, atol=1.1e-6 * STIFFNESS), met


if __name__ == "__main__":
    refused = subprocess.run([COMMAND, "live", "/nonexistent", "--json"], capture_output=True, text=True)
    if refused.returncode == 5:  # built without libwebsockets, clang-16 or lld-16
        print("skipped: built without the page")
        sys.exit(77)
    in_folder(live_scenes)
