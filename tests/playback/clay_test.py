#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clay on the command line: what a session removes beside NumPy, `replay` to the bit, heights and solid that are exported, the reference, what is refused."""
import json
import pathlib
import struct

import netCDF4
import numpy as np

import tacto
from tacto import error_of, run_json

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE = 2, 3, 4, 5
PITCH_M = 1e-3
CLAY = {"force_n": 1, "sink_m_per_s": 4e-3, "thickness_m": 4e-3}


def write_map(name, heights, pitch_m=PITCH_M):
    with netCDF4.Dataset(f"{name}.height.nc", "w") as file:
        file.setncatts({"kind": "height_map", "version": "1.0", "pitch_m": pitch_m})
        for axis, count in zip("yx", heights.shape):
            file.createDimension(axis, count)
            along = file.createVariable(axis, "f8", (axis,))
            along[:] = pitch_m * np.arange(count)
            along.units = "m"
        height = file.createVariable("height", "f4", ("y", "x"))
        height[:] = heights
        height.units = "m"


def heights_in(name):
    with netCDF4.Dataset(f"{name}.height.nc") as file:
        return np.asarray(file["height"][:], float)


def write_scene(name, clay=CLAY, relief="block", **members):
    piece = {"name": "clay", "shape": "plane", "place": {"x_m": 0, "y_m": 0, "z_m": 0}, "stiffness_n_per_m": 800, "relief": relief if isinstance(relief, dict) else {"file": relief}, **members}
    if clay:
        piece["clay"] = clay
    pathlib.Path(f"{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "pieces": [piece]}))


def write_path(name, time_s, places):
    np.savetxt(name, np.column_stack([time_s, places]), delimiter=",", header="time_s,x_m,y_m,z_m", comments="")


def read_stl(name):
    raw = pathlib.Path(name).read_bytes()
    (count,) = struct.unpack_from("<I", raw, 80)
    assert len(raw) == 84 + 50 * count
    table = np.frombuffer(raw, np.dtype([("normal", "<3f4"), ("corner", "<9f4"), ("attribute", "<u2")]), offset=84)
    return table["normal"].astype(float), table["corner"].astype(float).reshape(-1, 3, 3)


def presses_in_one_cell_make_the_paraboloid():
    write_map("block", np.zeros((21, 25)))
    middle = np.array([2.5, -1.5]) * PITCH_M  # of the cell from column 14, row 8 on
    time_s = np.array([0, 0.1, 0.2, 1.0])
    for kept in (False, True):
        write_scene("s", CLAY | {"volume": "kept" if kept else "lost"})
        write_path("p.csv", time_s, [[*middle, z] for z in (2e-3, 2e-3, -6e-3, -6e-3)])
        report = run_json("play", "s.scene.json", "-d", "sim:arm", "--finger-path", "p.csv", "--onset", "0s", "-o", f"played{kept}")
        assert report["lost_ticks"] == 0, report
        again = run_json("replay", f"played{kept}", "--relief", "block", "-o", "bowl", "--force")
        assert again["same_to_the_bit"] is True and again["files"] == ["bowl.height.nc"], again
        d = run_json("explain", "s.scene.json", "--device", "arm")["pieces"][0]["clay_sink_m_per_tick"]
        assert abs(d / 4e-6 - 1) < 1e-3, d
        sunk = -heights_in("bowl")
        y, x = np.meshgrid(np.arange(21) - 8.5, np.arange(25) - 14.5, indexing="ij")
        r2 = x * x + y * y
        near = np.maximum(abs(x), abs(y)) < 2
        n = sunk[8, 14] / d
        assert n == round(n) and n > 500, n
        assert (sunk[near] == 9 / 8 * (1 - r2[near] / 4.5) * d * n).all()
        ring = ~near & (r2 < 9)
        assert ring.sum() == 16 and (sunk[ring] == (-d * n / 2 if kept else 0)).all() and (sunk[~near & ~ring] == 0).all()
        assert sunk.sum() == (0 if kept else 8 * d * n) and abs(again["volume_lost_m3"] - sunk.sum() * PITCH_M**2) < 1e-20, again
        assert again["pressed_heights"] == (28 if kept else 12) and again["deepest_m"] == d * n and again["highest_m"] == (d * n / 2 if kept else 0), again


def what_was_pressed_replays_and_is_exported():
    rng = np.random.default_rng(5)
    y, x = np.mgrid[0:31, 0:41]
    write_map("block", 3e-4 * np.sin(0.4 * x + 1) * np.cos(0.3 * y) + 1e-5 * rng.normal(size=(31, 41)))
    write_scene("s", CLAY | {"volume": "kept"}, damping_n_s_per_m=1, static_friction=0.3, kinetic_friction=0.2)
    t = np.linspace(0, 6, 361)
    write_path("p.csv", t, np.column_stack([0.012 * np.sin(1.1 * t), 0.009 * np.sin(1.7 * t + 1), -2e-3 + 3e-3 * np.cos(2 * np.pi * t / 3)]))
    report = run_json("play", "s.scene.json", "-d", "sim:arm", "--finger-path", "p.csv", "--onset", "0s", "-o", "played")
    assert report["lost_ticks"] == 0, report
    again = run_json("replay", "played", "--relief", "block", "-o", "bowl")
    assert again["same_to_the_bit"] is True and again["pressed_heights"] > 100 and again["highest_m"] > 1e-4, again
    before, after = heights_in("block"), heights_in("bowl")
    assert abs((after - before).sum()) < before.size * 1e-9 and abs(again["volume_lost_m3"]) == 0, again
    # The solid is closed, its outside is outside, and its volume is that of the heights.
    said = run_json("replay", "played", "--relief", "block", "-o", "bowl.stl")
    assert said["files"] == ["bowl.stl"], said
    normal, corner = read_stl("bowl.stl")
    corners, index = np.unique(corner.reshape(-1, 3), axis=0, return_inverse=True)
    triangles = index.reshape(-1, 3)
    edges = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    assert len(np.unique(edges, axis=0)) == len(edges) and {tuple(e) for e in edges} == {tuple(e[::-1]) for e in edges}
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    assert np.allclose(across / np.linalg.norm(across, axis=1)[:, None], normal, atol=1e-5)
    volume = np.einsum("ij,ij->i", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])).sum() / 6
    base = before.min() - CLAY["thickness_m"] - PITCH_M
    cells = [(a[:-1, :-1] + a[1:, :-1] + a[:-1, 1:] + a[1:, 1:]) / 4 for a in (after - base,)][0].sum() * PITCH_M**2
    assert abs(volume * 1e-9 / cells - 1) < 1e-2 and abs(corners[:, 2].min() * 1e-3 - base) < 1e-8, (volume, cells)
    assert len(corners) == 31 * 41 + 2 * (30 + 40) + 1 and np.allclose(np.ptp(corners[:, :2], axis=0), [40, 30])
    mesh = run_json("import", "bowl.stl", "--unit", "mm", "-o", "bowl")
    assert mesh["triangles"] == len(triangles), mesh
    # It is clay again.
    write_scene("next", relief="bowl")
    run_json("explain", "next.scene.json", "--device", "arm")
    # The reference in double precision.
    said = run_json("render", "s.scene.json", "--finger-path", "p.csv", "--device", "arm", "-o", "f.csv")
    assert said["largest_rounding_n"] < 0.02 * said["force_peak_n"], said
    for arguments, code in ((("--relief", "block"), USAGE), (("-o", "w"), USAGE), (("--relief", "block", "--volume", "block", "-o", "w"), USAGE), (("--relief", "block", "-o", "bowl"), USAGE), (("--relief", "block", "-o", "bowl.stl"), USAGE),
                            (("--relief", "bowl", "-o", "w"), UNSUITABLE), (("--relief", "bowl", "-o", "w.stl"), UNSUITABLE), (("--relief", "none", "-o", "w"), NOT_FOUND), (("--volume", "none", "-o", "w"), NOT_FOUND)):
        error_of("replay", "played", *arguments, code=code)
    assert not pathlib.Path("w.height.nc").exists() and not pathlib.Path("w.stl").exists()


def what_is_wrong_with_clay_is_said():
    write_map("block", np.zeros((9, 9)))
    write_map("line", np.zeros((1, 9)))
    write_scene("s")
    said = run_json("info", "s.scene.json")["pieces"][0]
    assert said["clay_force_n"] == 1 and said["clay_volume"] == "lost" and said["clay_thickness_m"] == 4e-3, said
    tacto.run("validate", "s.scene.json")
    run_json("scene", "s.scene.json", "-o", "s.png", "--device", "arm")
    for clay, members, code, where in ((CLAY | {"force_n": 1000}, {}, UNSUITABLE, "/clay/force_n"), (CLAY | {"sink_m_per_s": 1e-9}, {}, UNSUITABLE, "/clay/sink_m_per_s"), (CLAY | {"sink_m_per_s": 1, "thickness_m": 1e-5}, {}, UNSUITABLE, "/clay/sink_m_per_s"),
                                       (CLAY, {"relief": {"file": "block", "normals": "interpolated"}}, UNSUITABLE, "/clay"), (CLAY, {"relief": {"file": "line"}}, UNSUITABLE, "/relief/file"),
                                       (CLAY | {"sink_m_per_s": 0}, {}, MALFORMED, "/clay/sink_m_per_s"), (CLAY | {"force_n": 0}, {}, MALFORMED, "/clay/force_n"), (CLAY | {"thickness_m": 0}, {}, MALFORMED, "/clay/thickness_m"),
                                       (CLAY | {"volume": "some"}, {}, MALFORMED, "/clay/volume"), ({k: v for k, v in CLAY.items() if k != "force_n"}, {}, MALFORMED, "/clay"), (CLAY | {"depth": 1}, {}, MALFORMED, "/clay/depth")):
        write_scene("s", clay, **members)
        assert error_of("explain", "s.scene.json", "--device", "arm", code=code)["where"].endswith(where), (clay, members)
    write_scene("s", shape="sphere", radius_m=0.01, relief=None)
    text = json.loads(pathlib.Path("s.scene.json").read_text())
    del text["pieces"][0]["relief"]
    pathlib.Path("s.scene.json").write_text(json.dumps(text))
    assert error_of("explain", "s.scene.json", "--device", "arm", code=UNSUITABLE)["where"].endswith("/clay")
    # A grid that is too large, with the largest that fits; on an emulated arm, and on a board.
    write_map("large", np.zeros((900, 900)))
    write_scene("s", relief="large")
    said = run_json("explain", "s.scene.json", "--device", "arm", "--board", "stm32f405")
    assert said["fits"] is False and "810000" in said["because"], said
    fits = int(said["because"].split(" fit")[0].split()[-1])
    assert 1000 < fits < 810000, said
    side = int(fits**0.5)
    write_map("fits", np.zeros((side, side)))
    write_scene("s", relief="fits")
    assert run_json("explain", "s.scene.json", "--device", "arm", "--board", "stm32f405")["fits"] is True
    write_map("beyond", np.zeros((side + 2, side + 2)))
    write_scene("s", relief="beyond")
    assert run_json("explain", "s.scene.json", "--device", "arm", "--board", "stm32f405")["fits"] is False
    write_map("huge", np.zeros((3000, 3000)))
    write_scene("s", relief="huge")
    write_path("p.csv", [0, 1], [[0, 0, 0.01], [0, 0, 0.01]])
    error = error_of("play", "s.scene.json", "-d", "sim:arm", "--finger-path", "p.csv", "-o", "large", code=UNSUITABLE)
    assert "9000000" in error["remedy"] and not pathlib.Path("large.session").exists(), error


if __name__ == "__main__":
    for test in (presses_in_one_cell_make_the_paraboloid, what_was_pressed_replays_and_is_exported, what_is_wrong_with_clay_is_said):
        tacto.in_folder(test)
