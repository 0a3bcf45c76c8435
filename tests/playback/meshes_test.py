#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes on the command line: import of STL, OBJ and PLY, what is refused and repaired, `render` against all triangles in NumPy, `play` and `replay` to the bit, `explain`, `design`, `info`."""
import hashlib
import json
import math
import pathlib
import struct

import netCDF4
import numpy as np

import tacto
from tacto import error_of, run_json

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE = 2, 3, 4, 5
STEP_M, RATE_HZ, STIFFNESS = 1e-5, 1000, 2000.0  # of the preset arm
CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
CUBE_FACES = np.array([[4, 5, 7], [4, 7, 6], [0, 3, 1], [0, 2, 3], [0, 1, 5], [0, 5, 4], [2, 7, 3], [2, 6, 7], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])


def icosphere(level, radius):
    """20 x 4^level triangles."""
    t = (1 + 5**0.5) / 2
    places = [np.array(p, float) for p in [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(level):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(places)
                places.append((places[a] + places[b]) / 2)
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    places = np.array(places)
    return radius * places / np.linalg.norm(places, axis=1)[:, None], np.array(faces)


def write_stl(name, places, faces):
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *places[face].ravel(), 0) for face in faces)
    pathlib.Path(name).write_bytes(bytes(80) + struct.pack("<I", len(faces)) + rows)


def write_obj(name, places, faces):
    pathlib.Path(name).write_text("".join("v {} {} {}\n".format(*p) for p in places) + "".join("f {} {} {}\n".format(*(face + 1)) for face in faces))


def write_ply(name, places, faces):
    head = f"ply\nformat ascii 1.0\nelement vertex {len(places)}\nproperty float x\nproperty float y\nproperty float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    pathlib.Path(name).write_text(head + "".join("{} {} {}\n".format(*p) for p in places) + "".join("3 {} {} {}\n".format(*face) for face in faces))


def write_scene(name, mesh, place=(0, 0, 0), **members):
    piece = {"name": "part", "shape": "mesh", "mesh": mesh, "place": dict(zip(("x_m", "y_m", "z_m"), place)), "stiffness_n_per_m": STIFFNESS, **members}
    pathlib.Path(f"{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "pieces": [piece]}))


def write_path(name, time_s, places):
    np.savetxt(name, np.column_stack([time_s, places]), delimiter=",", header="time_s,x_m,y_m,z_m", comments="")


def nearest_distance(places, faces, point):
    """From all triangles: the least of the distances from their planes, where the foot is inside, and from their edges."""
    a, b, c = (places[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    above = ((point - a) * normal).sum(1)
    inside = np.ones(len(faces), bool)
    least = np.inf
    for start, end in ((a, b), (b, c), (c, a)):
        edge, way = end - start, point - start
        inside &= (np.cross(normal, edge) * way).sum(1) >= 0
        along = np.clip((way * edge).sum(1) / (edge * edge).sum(1), 0, 1)
        least = min(least, np.linalg.norm(way - along[:, None] * edge, axis=1).min())
    return min(least, np.abs(above[inside]).min(initial=np.inf)), normal, above


def three_formats_give_one_mesh():
    for write, name in ((write_stl, "cube.stl"), (write_obj, "cube.obj"), (write_ply, "cube.ply")):
        write(name, CUBE * 20, CUBE_FACES)
        said = run_json("import", name, "--unit", "mm", "-o", name[-3:])
        assert said["triangles"] == 12 and said["vertices"] == 8 and said["closed"] is True, said
        assert abs(said["volume_m3"] - 8e-6) < 1e-12 and abs(said["size_x_m"] - 0.02) < 1e-9 and abs(said["longest_edge_m"] - 0.02 * 2**0.5) < 1e-9, said
        assert said["files"] == [f"{name[-3:]}.mesh.nc"], said
        printed = run_json("info", f"{name[-3:]}.mesh.nc")
        assert printed["kind"] == "mesh" and printed["triangles"] == 12 and printed["source"].startswith(name) and "SHA-256" in printed["source"], printed
        with netCDF4.Dataset(f"{name[-3:]}.mesh.nc") as file:
            assert file["vertex"].units == "m" and file["vertex"].shape == (8, 3) and file["triangle"].dtype == np.int32, file
            at = np.asarray(file["vertex"])[np.asarray(file["triangle"])]
            assert abs(np.einsum("ij,ij->i", at[:, 0], np.cross(at[:, 1], at[:, 2])).sum() / 6 - 8e-6) < 1e-12
    assert error_of("import", "cube.stl", "--unit", "mm", "-o", "stl", code=USAGE)  # it is there already
    run_json("import", "cube.stl", "--unit", "um", "-o", "stl", "--force")
    assert abs(run_json("info", "stl")["size_x_m"] - 2e-5) < 1e-12
    write_obj("moved.obj", CUBE + [3, -2, 0.5], CUBE_FACES)
    said = run_json("import", "moved.obj", "--unit", "mm", "-o", "moved")
    assert [round(1e6 * said[f"from_{axis}_m"]) for axis in "xyz"] == [3000, -2000, 500], said


def what_is_wrong_with_a_mesh_is_counted():
    write_stl("cube.stl", CUBE, CUBE_FACES)
    error_of("import", "cube.stl", "-o", "part", code=USAGE)  # without a unit
    error_of("import", "cube.stl", "--unit", "kg", "-o", "part", code=USAGE)
    error_of("import", "none.stl", "--unit", "mm", "-o", "part", code=NOT_FOUND)
    error_of("import", "cube.stl", "--unit", "mm", "--rate", "1kHz", "-o", "part", code=USAGE)
    pathlib.Path("text.stl").write_text("this is no mesh\n")
    error_of("import", "text.stl", "--unit", "mm", "-o", "part", code=MALFORMED)
    # Flipped, without an area, a vertex beside its place.
    wrong = CUBE_FACES.copy()
    wrong[3] = wrong[3][[1, 0, 2]]
    soup = CUBE[wrong].reshape(-1, 3)
    soup[4] += 5e-7
    write_obj("wrong.obj", np.vstack([soup, soup[:2]]), np.vstack([np.arange(36).reshape(-1, 3), [0, 1, 1]]))
    said = error_of("import", "wrong.obj", "--unit", "mm", "-o", "part", code=UNSUITABLE)
    assert "--repair" in json.dumps(said), said
    assert not pathlib.Path("part.mesh.nc").exists()
    said = run_json("import", "wrong.obj", "--unit", "mm", "--repair", "-o", "part")
    assert said["turned_triangles"] == 1 and said["merged_vertices"] >= 1 and said["closed"] is True and abs(said["volume_m3"] * 1e9 - 1) < 1e-5, said
    # Inside out.
    write_stl("in.stl", CUBE, CUBE_FACES[:, ::-1])
    error_of("import", "in.stl", "--unit", "mm", "-o", "in", code=UNSUITABLE)
    assert run_json("import", "in.stl", "--unit", "mm", "--repair", "-o", "in")["turned_triangles"] == 12
    # Holes are not filled.
    write_stl("hole.stl", CUBE, CUBE_FACES[:-1])
    error_of("import", "hole.stl", "--unit", "mm", "-o", "hole", code=UNSUITABLE)
    error_of("import", "hole.stl", "--unit", "mm", "--repair", "-o", "hole", code=UNSUITABLE)
    said = run_json("import", "hole.stl", "--unit", "mm", "--open", "-o", "hole")
    assert said["closed"] is False and said["open_edges"] == 3 and "volume_m3" not in said, said
    assert error_of("import", "part.mesh.nc", "--unit", "mm", "-o", "again", code=USAGE)
    # Every triangle twice, and once more as an inner side.
    for name, more in (("twice", CUBE_FACES), ("lined", CUBE_FACES[:, ::-1])):
        write_stl(f"{name}.stl", CUBE, np.vstack([CUBE_FACES, more]))
        said = error_of("import", f"{name}.stl", "--unit", "mm", "-o", name, code=UNSUITABLE)
        assert "12 triangles" in said["what"] and "--repair" in said["remedy"], said
        said = run_json("import", f"{name}.stl", "--unit", "mm", "--repair", "-o", name)
        assert said["dropped_triangles"] == 12 and said["triangles"] == 12 and said["closed"] is True, said
    # A fin on an edge: it is no hole, but its own two edges are.
    write_stl("fin.stl", np.vstack([CUBE, [2, 2, 2]]), np.vstack([CUBE_FACES, [5, 7, 8]]))
    said = error_of("import", "fin.stl", "--unit", "mm", "-o", "fin", code=UNSUITABLE)
    assert "1 edge of three or more triangles" in said["what"] and "2 open edges" in said["what"], said
    said = run_json("import", "fin.stl", "--unit", "mm", "--open", "-o", "fin")
    assert said["closed"] is False and said["edges_of_three_or_more_triangles"] == 1 and said["open_edges"] == 2, said
    # What is found before writing names the file that was read.
    write_stl("large.stl", CUBE * 20, CUBE_FACES)
    assert error_of("import", "large.stl", "--unit", "m", "-o", "large", code=UNSUITABLE)["where"] == "large.stl"


def a_changed_number_of_a_mesh_is_found():
    write_stl("cube.stl", CUBE, CUBE_FACES)
    for variable, change in (("vertex", lambda numbers: numbers + np.eye(8, 3) * 1e-12), ("triangle", lambda numbers: np.roll(numbers, 1, axis=1)), ("vertex", None)):
        run_json("import", "cube.stl", "--unit", "mm", "-o", "part", "--force")
        with netCDF4.Dataset("part.mesh.nc", "a") as file:
            own = hashlib.sha256(file["vertex"][:].astype("<f8").tobytes() + file["triangle"][:].astype("<u4").tobytes())
            assert file.sha256 == own.hexdigest(), file
            if change:
                file[variable][:] = change(np.asarray(file[variable][:]))
            else:  # another program may state no checksum
                file[variable][0, 0] = 1e-12
                file.delncattr("sha256")
        write_scene("part", "part")
        if change:
            assert error_of("info", "part.mesh.nc", code=MALFORMED)["where"] == "part.mesh.nc"
            tacto.run("validate", "part.mesh.nc", code=MALFORMED)
            tacto.run("explain", "part.scene.json", "--device", "arm", code=MALFORMED)
        else:
            tacto.run("info", "part.mesh.nc")


def a_file_that_was_cut_is_refused():
    """In its middle, or as a list without an end: of these the library does not return, or ends its process."""
    write_ply("whole.ply", CUBE, CUBE_FACES)
    text = pathlib.Path("whole.ply").read_bytes()
    binary = text.split(b"end_header")[0].replace(b"ascii", b"binary_little_endian") + b"end_header\n" + np.float32(CUBE).tobytes() + b"".join(b"\3" + np.int32(face).tobytes() for face in CUBE_FACES)
    for name, content in (("empty.stl", b""), ("empty.obj", b""), ("empty.ply", b""), ("head.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n"),
                          ("body.ply", text[:230]), ("binary.ply", binary[:-100]), ("nan.stl", bytes(80) + struct.pack("<I12fH", 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, math.nan, 0, 0))):
        pathlib.Path(name).write_bytes(content)
        error_of("import", name, "--unit", "mm", "-o", "cut", code=MALFORMED)
        assert not pathlib.Path("cut.mesh.nc").exists()
    pathlib.Path("binary.ply").write_bytes(binary)
    assert run_json("import", "binary.ply", "--unit", "mm", "-o", "whole")["triangles"] == 12


def a_rendered_force_is_that_of_all_triangles():
    places, faces = icosphere(3, 30)
    assert len(faces) == 1280
    write_stl("ball.stl", places, faces)
    run_json("import", "ball.stl", "--unit", "mm", "-o", "ball")
    centre = np.array([0.01, -0.02, 0.005])
    write_scene("ball", "ball", centre)
    time_s = np.linspace(0, 2, 401)
    turn = np.pi * time_s
    ways = np.column_stack([np.cos(turn) * np.cos(0.7 * np.sin(1.3 * turn)), np.sin(turn) * np.cos(0.7 * np.sin(1.3 * turn)), np.sin(0.7 * np.sin(1.3 * turn))])
    write_path("path.csv", time_s, centre + np.where(time_s < 0.02, 0.031, 0.029)[:, None] * ways)
    report = run_json("render", "ball.scene.json", "--finger-path", "path.csv", "--device", "arm", "-o", "f.csv", "--force")
    table = np.genfromtxt("f.csv", delimiter=",", names=True)
    hand = np.rint(np.column_stack([table[f"{axis}_m"] for axis in "xyz"]) / STEP_M) * STEP_M
    force = np.column_stack([table[f"force_{axis}_n"] for axis in "xyz"])
    at = places.astype(np.float32).astype(float) * 1e-3 + centre
    touched = 0
    for i in range(100, len(hand), 15):
        ghost = hand[i] + force[i] / STIFFNESS
        distance, normal, above = nearest_distance(at, faces, ghost)
        assert distance < 1e-6, (i, distance)
        way = np.linalg.norm(ghost - hand[i])
        nearest, _, of_hand = nearest_distance(at, faces, hand[i])
        assert way >= nearest - 1e-7, (i, way, nearest)  # never nearer than the nearest place
        # The force is along a facet's normal, and no farther than the facet that the ghost left last.
        facet = (normal @ force[i] / np.linalg.norm(force[i])).argmax()
        assert abs(normal[facet] @ force[i] / np.linalg.norm(force[i]) - 1) < 1e-6 and abs(above[facet]) < 1e-6, i
        assert way < nearest * 1.02 + 1e-6, (i, way, nearest)
        touched += 1
    assert touched > 100 and report["rms_limited_ticks"] == 0, (touched, report)


def a_played_mesh_replays_to_the_bit():
    places, faces = icosphere(2, 0.03)
    write_ply("ball.ply", places, faces)
    run_json("import", "ball.ply", "--unit", "m", "-o", "ball")
    write_scene("ball", "ball", damping_n_s_per_m=4, arrest_mass_kg=0.1)
    time_s = np.linspace(0, 1, 41)
    write_path("path.csv", time_s, np.column_stack([0.035 * np.cos(3 * time_s), 0.02 * np.sin(3 * time_s), 0.01 * np.sin(7 * time_s)]))
    report = run_json("play", "ball.scene.json", "-d", "sim:arm", "--finger-path", "path.csv", "--onset", "0s", "-o", "played")
    assert report["lost_ticks"] == 0 and report["ticks"] >= 1000, report
    again = run_json("replay", "played")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
    said = run_json("explain", "ball.scene.json", "--device", "arm")
    assert said["fits"] is True and said["block_bytes"] > 320 * 12, said
    soft = run_json("design", "ball.scene.json", "--device", "arm")["pieces"][0]
    assert soft["verdict"] == "stable" and soft["piece"] == "part", soft
    said = run_json("info", "ball.scene.json")
    assert said["pieces"][0]["shape"] == "mesh" and said["pieces"][0]["mesh"] == "ball", said
    write_scene("none", "none")
    error_of("explain", "none.scene.json", "--device", "arm", code=NOT_FOUND)


if __name__ == "__main__":
    for test in (three_formats_give_one_mesh, what_is_wrong_with_a_mesh_is_counted, a_changed_number_of_a_mesh_is_found, a_file_that_was_cut_is_refused, a_rendered_force_is_that_of_all_triangles, a_played_mesh_replays_to_the_bit):
        tacto.in_folder(test)
