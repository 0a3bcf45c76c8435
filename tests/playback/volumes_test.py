#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes on the command line: NRRD by its specification, what is refused, `render` against SciPy's interpolation, `play` and `replay` to the bit, `explain`, `design`, `info`, `scene`, `validate`."""
import gzip
import hashlib
import json
import pathlib

import netCDF4
import numpy as np
from scipy.ndimage import map_coordinates

import tacto
from tacto import error_of, run_json

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE, UNSTABLE = 2, 3, 4, 5, 9
STEP_M = 1e-5  # of the preset arm
NAMES = {"i1": "signed char", "u1": "uchar", "i2": "short", "u2": "uint16", "i4": "int32", "f4": "float", "f8": "double"}


def write_nrrd(name, values, fields=(), encoding="raw", endian="little", spacing="spacings: 0.5 0.5 0.5", data=None):
    """`values` by z, y and x. A field replaces one of the same name; None drops it."""
    order = {"little": "<", "big": ">"}[endian]
    kind = values.dtype.str[1:]
    head = {"type": NAMES[kind], "dimension": "3", "sizes": " ".join(str(n) for n in values.shape[::-1]), "encoding": encoding, "endian": endian}
    key, _, words = spacing.partition(": ")
    if spacing:
        head[key] = words
    head.update(dict(fields))
    lines = "".join(f"{key}: {words}\n" for key, words in head.items() if words is not None)
    raw = values.astype(order + kind).tobytes() if data is None else data
    pathlib.Path(name).write_bytes(b"NRRD0005\n# a comment\nmodality:=CT\n" + lines.encode() + b"\n" + (gzip.compress(raw, mtime=0) if encoding in ("gzip", "gz") and data is None else raw))


def values_in(name):
    with netCDF4.Dataset(name) as file:
        value = file["value"]
        value.set_auto_maskandscale(False)
        return np.asarray(value[:]), value.scale_factor, value.add_offset, [file.getncattr(f"spacing_{axis}_m") for axis in "xyz"]


def ball(samples, radius, spacing, slope=1000):
    """Values that fall along the radius, 0 at `radius`."""
    z, y, x = (spacing * (np.arange(n) - (n - 1) / 2) for n in samples)
    r = np.sqrt(z[:, None, None] ** 2 + y[:, None] ** 2 + x**2)
    return np.rint(np.clip(slope * (radius - r), -32000, 32000)).astype("i2")


def write_scene(name, volume, place=(0, 0, 0), scene=(), **members):
    piece = {"name": "bone", "shape": "volume", "volume": volume, "iso": 0, "value_per_m": 1e6, "place": dict(zip(("x_m", "y_m", "z_m"), place)), "stiffness_n_per_m": 300, **members}
    pathlib.Path(f"{name}.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "pieces": [piece], **dict(scene)}))


def write_path(name, time_s, places):
    np.savetxt(name, np.column_stack([time_s, places]), delimiter=",", header="time_s,x_m,y_m,z_m", comments="")


def path_through(seconds, size):
    t = np.linspace(0, seconds, 60 * seconds + 1)
    return t, size * np.column_stack([np.cos(2.3 * t) * (1.2 - 0.3 * t / seconds), np.sin(3.1 * t), 0.8 * np.sin(1.7 * t + 0.4)])


def every_type_and_encoding_gives_the_values():
    rng = np.random.default_rng(7)
    for kind, low, high in (("i1", -128, 127), ("u1", 0, 255), ("i2", -32768, 32767), ("u2", 0, 65535), ("i4", -30000, 30000), ("f4", -1000, 1000), ("f8", -500, 500)):
        values = rng.integers(low, high + 1, (4, 5, 6)).astype(kind)
        for encoding, endian in (("raw", "little"), ("raw", "big"), ("gzip", "little"), ("gz", "big")):
            write_nrrd("v.nrrd", values, encoding=encoding, endian=endian, spacing="spacings: 0.5 0.6 0.7")
            said = run_json("import", "v.nrrd", "--unit", "mm", "-o", "v", "--force")
            stored, scale, offset, spacing = values_in("v.volume.nc")
            assert scale == 1 and (stored + offset == values).all() and np.allclose(spacing, [5e-4, 6e-4, 7e-4], rtol=1e-15), (kind, encoding, endian)
            assert [said[f"values_{axis}"] for axis in "xyz"] == [6, 5, 4] and said["smallest"] == values.min() and said["largest"] == values.max(), said
            assert "rounded_by_at_most" not in said and said["files"] == ["v.volume.nc"], said
    # Numbers that do not fit 16 bits: 65,535 equal steps.
    values = rng.normal(0, 1e5, (3, 4, 5)).astype("f4")
    write_nrrd("v.nrrd", values, encoding="gzip")
    said = run_json("import", "v.nrrd", "--unit", "um", "-o", "v", "--force")
    stored, scale, offset, _ = values_in("v.volume.nc")
    error = abs(stored * scale + offset - values.astype(float)).max()
    assert 0 < error <= said["rounded_by_at_most"] * (1 + 1e-9) < np.ptp(values) / 65000, (error, said)
    printed = run_json("info", "v.volume.nc")
    assert printed["kind"] == "volume" and printed["source"].startswith("v.nrrd (SHA-256 ") and abs(printed["size_x_m"] - 2e-6) < 1e-15, printed
    steps = [abs(np.diff(values.astype(float), axis=axis)).max() / 5e-7 for axis in range(3)]
    assert max(steps) * 0.99 < printed["steepest_value_per_m"] <= np.hypot(np.hypot(*steps[:2]), steps[2]) * 1.01, (printed, steps)
    with netCDF4.Dataset("v.volume.nc") as file:
        assert file.sha256 == hashlib.sha256(stored.astype("<i2").tobytes()).hexdigest() and np.allclose(file["x"][:], 5e-7 * np.arange(-2, 3)), file
        assert abs(file["value"][:] - values).max() <= error * (1 + 1e-9)  # CF programs scale by themselves


def directions_and_units_are_those_of_the_file():
    values = np.arange(60, dtype="i2").reshape(3, 4, 5)
    write_nrrd("v.nrrd", values, {"space": "left-posterior-superior", "space origin": "(7,8,9)", "space units": '"mm" "mm" "mm"', "kinds": "domain domain domain"}.items(), spacing="space directions: (0,0.5,0) (-0.6,0,0) (0,0,0.7)")
    said = run_json("import", "v.nrrd", "-o", "v")
    stored, _, _, spacing = values_in("v.volume.nc")
    assert np.allclose(spacing, [5e-4, 6e-4, 7e-4]) and (stored == values).all() and "turned_round" not in said, said
    write_nrrd("v.nrrd", values, {"units": '"um" "um" "um"'}.items(), spacing="space directions: (5,0,0) (0,6,0) (0,0,-7)")
    assert "turned_round" in run_json("import", "v.nrrd", "-o", "v", "--force")
    stored, _, _, spacing = values_in("v.volume.nc")
    assert np.allclose(spacing, [5e-6, 6e-6, 7e-6]) and (stored == values[::-1]).all()
    error_of("import", "v.nrrd", "--unit", "mm", "-o", "other", code=USAGE)  # it states its own


def what_is_wrong_with_a_file_is_said():
    values = np.arange(60, dtype="i2").reshape(3, 4, 5)
    raw = values.tobytes()
    packed = gzip.compress(raw, mtime=0)
    noise = np.random.default_rng(1).integers(0, 9999, (9, 10, 11)).astype("i2")
    broken = bytearray(gzip.compress(noise.tobytes(), mtime=0))
    broken[len(broken) // 2] ^= 0x55
    cases = [
        (UNSUITABLE, {"spacing": ""}),  # without a spacing
        (UNSUITABLE, {"spacing": "spacings: 0.5 nan 0.5"}),
        (UNSUITABLE, {"spacing": "spacings: 0.5 -0.5 0.5"}),
        (UNSUITABLE, {"spacing": "space directions: (1,0,0) (0.1,1,0) (0,0,1)"}),
        (MALFORMED, {"spacing": "space directions: (1,0,0) none (0,0,1)"}),
        (UNSUITABLE, {"fields": {"units": '"mm" "mm" "s"'}}),
        (UNSUITABLE, {"fields": {"units": '"mm" "mm" "um"'}}),
        (UNSUITABLE, {"fields": {"type": "block"}}),
        (UNSUITABLE, {"fields": {"type": None}}),
        (UNSUITABLE, {"fields": {"encoding": "bzip2"}}),
        (UNSUITABLE, {"fields": {"dimension": "4"}}),
        (UNSUITABLE, {"fields": {"data file": "v.raw"}}),
        (UNSUITABLE, {"fields": {"byte skip": "-1"}}),
        (MALFORMED, {"fields": {"endian": None}}),
        (MALFORMED, {"fields": {"sizes": "5 4"}}),
        (MALFORMED, {"fields": {"sizes": "5 4 2.5"}}),
        (MALFORMED, {"fields": {"sizes": "5 4 -3"}}),
        (UNSUITABLE, {"fields": {"sizes": "5 12 1"}}),
        (UNSUITABLE, {"fields": {"sizes": "4096 4096 4096"}}),  # too large, before memory is taken
        (UNSUITABLE, {"fields": {"sizes": "4000000000 4000000000 4000000000"}}),
        (MALFORMED, {"fields": {"sizes": "500 500 500"}}),
        (MALFORMED, {"data": raw[:-1]}),
        (MALFORMED, {"data": raw + b"0"}),
        (MALFORMED, {"encoding": "gzip", "data": packed[:-12]}),
        (MALFORMED, {"encoding": "gzip", "data": packed[: len(packed) // 2]}),
        (MALFORMED, {"encoding": "gzip", "data": b""}),
        (MALFORMED, {"encoding": "gzip", "data": raw}),
        (MALFORMED, {"encoding": "gzip", "data": gzip.compress(raw[:-2])}),
        (MALFORMED, {"encoding": "gzip", "data": gzip.compress(raw + b"00")}),
        (MALFORMED, {"values": noise, "encoding": "gzip", "data": bytes(broken)}),
        (MALFORMED, {"values": np.full((3, 3, 3), np.nan, "f4")}),
    ]
    for code, case in cases:
        write_nrrd("v.nrrd", case.get("values", values), case.get("fields", {}).items(), **{key: case[key] for key in ("spacing", "encoding", "data") if key in case})
        unit = () if "units" in case.get("fields", {}) else ("--unit", "mm")
        said = error_of("import", "v.nrrd", *unit, "-o", "v", code=code)
        assert said["where"] == "v.nrrd" and not pathlib.Path("v.volume.nc").exists(), (case, said)
    write_nrrd("v.nrrd", values)
    error_of("import", "v.nrrd", "-o", "v", code=USAGE)  # no unit
    error_of("import", "v.nrrd", "--unit", "mm", "--rate", "1kHz", "-o", "v", code=USAGE)
    for content in (b"", b"NRRD0005\n", b"NRRD0005\ntype: short\n", b"PNG\n\n", b"NRRD0005\nwords\n\n"):
        pathlib.Path("v.nrrd").write_bytes(content)
        error_of("import", "v.nrrd", "--unit", "mm", "-o", "v", code=MALFORMED)
    error_of("import", "none.nrrd", "--unit", "mm", "-o", "v", code=NOT_FOUND)
    write_nrrd("v.nrrd", values)


def a_changed_volume_is_found():
    write_nrrd("v.nrrd", ball((9, 9, 9), 1.5, 0.5))
    run_json("import", "v.nrrd", "--unit", "mm", "-o", "v")
    tacto.run("validate", "v.volume.nc")
    with netCDF4.Dataset("v.volume.nc", "a") as file:
        file["value"].set_auto_maskandscale(False)
        file["value"][1, 2, 3] += 1
    assert error_of("info", "v.volume.nc", code=MALFORMED)["where"] == "v.volume.nc"
    tacto.run("validate", "v.volume.nc", code=MALFORMED)
    write_scene("s", "v")
    tacto.run("explain", "s.scene.json", "--device", "arm", code=MALFORMED)
    with netCDF4.Dataset("v.volume.nc", "a") as file:
        file.delncattr("spacing_y_m")
    error_of("info", "v.volume.nc", code=MALFORMED)


def what_is_wrong_with_a_scene_is_said():
    write_nrrd("v.nrrd", ball((9, 9, 9), 1.5, 0.5))
    run_json("import", "v.nrrd", "--unit", "mm", "-o", "v")
    for members, scene, where in (({"iso": 5000}, {}, "/iso"), ({"iso": -5000}, {}, "/iso"), ({"value_per_m": 1}, {}, "/value_per_m"), ({"travel": [{"depth_m": 0.001, "force_n": 1}]}, {}, "/travel"),
                                  ({"texture": {"type": "sine", "periods_m": [1e-3, 1e-3], "amplitude_n": 1}}, {}, "/texture"),
                                  ({"slide": {"direction": [1, 0, 0], "from_m": -0.01, "to_m": 0.01, "mass_kg": 1}}, {}, "/slide"), ({"radius_m": 1}, {}, "/radius_m"), ({}, {"radius_m": 0.001}, "#/radius_m")):
        write_scene("s", "v", scene=scene.items(), **members)
        assert error_of("explain", "s.scene.json", "--device", "arm", code=UNSUITABLE)["where"].endswith(where), (members, scene)
    write_scene("s", "v", shape="sphere", radius_m=0.01)
    error_of("explain", "s.scene.json", "--device", "arm", code=UNSUITABLE)
    write_scene("s", "none")
    error_of("explain", "s.scene.json", "--device", "arm", code=NOT_FOUND)
    assert tacto.run("validate", "s.scene.json", code=MALFORMED)


def a_rendered_force_is_that_of_scipys_interpolation():
    rng = np.random.default_rng(3)
    samples, spacing = (23, 27, 31), 0.9
    values = (ball(samples, 8.0, spacing) + rng.integers(-60, 60, samples)).astype("i2")
    write_nrrd("v.nrrd", values, spacing="spacings: 0.9 0.9 0.9", encoding="gzip")
    run_json("import", "v.nrrd", "--unit", "mm", "-o", "v")
    centre = np.array([0.0120037, -0.0199962, 0.0050041])  # so that no place of the hand is on the face of a cell, where the gradient jumps
    write_scene("s", "v", centre, iso=12)
    time_s, places = path_through(4, 0.0075)
    write_path("p.csv", time_s, centre + places)
    report = run_json("render", "s.scene.json", "--finger-path", "p.csv", "--device", "arm", "-o", "f.csv")
    table = np.genfromtxt("f.csv", delimiter=",", names=True)
    hand = np.rint(np.column_stack([table[f"{axis}_m"] for axis in "xyz"]) / STEP_M) * STEP_M - centre
    force = np.column_stack([table[f"force_{axis}_n"] for axis in "xyz"])
    at = (hand / (spacing * 1e-3) + (np.array(samples[::-1]) - 1) / 2).T[::-1]  # z, y and x, in samples
    value = map_coordinates(values.astype(float), at, order=1)
    # The gradient of a trilinear interpolant is a difference of two faces of the cell.
    first = np.floor(at)
    gradient = np.empty_like(hand)
    for axis in range(3):
        low, high = at.copy(), at.copy()
        low[axis], high[axis] = first[axis], first[axis] + 1
        gradient[:, 2 - axis] = (map_coordinates(values.astype(float), high, order=1) - map_coordinates(values.astype(float), low, order=1)) / (spacing * 1e-3)
    expected = -300 * (np.maximum(0, value - 12) / 1e6)[:, None] * gradient / 1e6
    largest = np.linalg.norm(expected, axis=1).max()
    assert 0.5 < largest < 20 and (value > 12).mean() > 0.3 and (value < 12).mean() > 0.1, (largest, (value > 12).mean())
    assert report["peak_limited_ticks"] == report["slew_limited_ticks"] == report["rms_limited_ticks"] == 0, report
    error = abs(force - expected).max()
    assert error < 1e-5 * largest, (error, largest)
    assert report["other_side_ticks"] == 0 and report["largest_rounding_n"] < 1e-5 * largest, report


def a_tool_is_the_sum_of_its_points():
    values = ball((31, 31, 31), 9.0, 0.8)
    write_nrrd("v.nrrd", values, spacing="spacings: 0.8 0.8 0.8")
    run_json("import", "v.nrrd", "--unit", "mm", "-o", "v")
    rng = np.random.default_rng(2)
    tool = rng.normal(0, 1, (1000, 3))
    tool *= 0.003 / np.linalg.norm(tool, axis=1)[:, None]
    write_scene("s", "v", stiffness_n_per_m=2, scene={"tool_m": tool.tolist()}.items())
    time_s, places = path_through(1, 0.007)
    write_path("p.csv", time_s, places)
    report = run_json("render", "s.scene.json", "--finger-path", "p.csv", "--device", "arm", "-o", "f.csv")
    table = np.genfromtxt("f.csv", delimiter=",", names=True)
    hand = np.rint(np.column_stack([table[f"{axis}_m"] for axis in "xyz"]) / STEP_M) * STEP_M
    force = np.column_stack([table[f"force_{axis}_n"] for axis in "xyz"])
    for i in range(0, len(hand), 50):
        at = ((hand[i] + tool) / 8e-4 + 15).T[::-1]
        depth = np.maximum(0, map_coordinates(values.astype(float), at, order=1, cval=-1e9)) / 1e6
        first, expected = np.floor(at), np.zeros(3)
        for axis in range(3):
            low, high = at.copy(), at.copy()
            low[axis], high[axis] = first[axis], first[axis] + 1
            rise = (map_coordinates(values.astype(float), high, order=1) - map_coordinates(values.astype(float), low, order=1)) / 8e-4 / 1e6
            expected[2 - axis] = -2 * (depth * rise).sum()
        assert abs(force[i] - expected).max() < 2e-6 * (1 + report["force_peak_n"]), (i, force[i], expected)
    assert report["force_peak_n"] > 0.5 and run_json("info", "s.scene.json")["tool_points"] == 1000, report
    report = run_json("play", "s.scene.json", "-d", "sim:arm", "--finger-path", "p.csv", "--onset", "0s", "-o", "played")
    assert run_json("replay", "played")["same_to_the_bit"] is True
    for scene, code in (({"tool_m": tool.tolist() + [[0, 0, 0]]}, MALFORMED), ({"tool_m": []}, MALFORMED), ({"tool_m": [[0, 0]]}, MALFORMED), ({"tool_m": [[0, 0, 2]]}, MALFORMED)):
        write_scene("s", "v", scene=scene.items())
        error_of("explain", "s.scene.json", "--device", "arm", code=code)
    pathlib.Path("s.scene.json").write_text(json.dumps({"kind": "scene", "version": "1.0", "tool_m": [[0, 0, 0]], "pieces": [{"name": "floor", "shape": "plane", "place": {"x_m": 0, "y_m": 0, "z_m": 0}, "stiffness_n_per_m": 100}]}))
    assert error_of("explain", "s.scene.json", "--device", "arm", code=UNSUITABLE)["where"].endswith("#/tool_m")


def a_played_volume_replays_to_the_bit():
    write_nrrd("v.nrrd", ball((31, 31, 31), 9.0, 0.8), spacing="spacings: 0.8 0.8 0.8")
    run_json("import", "v.nrrd", "--unit", "mm", "-o", "v")
    write_scene("s", "v", damping_n_s_per_m=2, static_friction=0.3, kinetic_friction=0.2)
    time_s, places = path_through(2, 0.008)
    write_path("p.csv", time_s, places)
    report = run_json("play", "s.scene.json", "-d", "sim:arm", "--finger-path", "p.csv", "--onset", "0s", "-o", "played")
    assert report["lost_ticks"] == 0 and report["ticks"] >= 2000, report
    again = run_json("replay", "played")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
    said = run_json("explain", "s.scene.json", "--device", "arm")
    assert said["fits"] is True and said["block_bytes"] > 2 * 31**3 and said["pieces"][0]["values"] == 31**3, said
    write_nrrd("small.nrrd", ball((17, 17, 17), 9.0, 1.5), spacing="spacings: 1.5 1.5 1.5")
    run_json("import", "small.nrrd", "--unit", "mm", "-o", "small")
    write_scene("small", "small")
    said = run_json("explain", "small.scene.json", "--device", "arm", "--board", "stm32f405")
    assert said["fits"] is True and 2 * 17**3 < said["block_bytes"] < said["device_bytes"], said
    write_nrrd("w.nrrd", ball((99, 99, 99), 9.0, 0.2))
    run_json("import", "w.nrrd", "--unit", "mm", "-o", "w")
    write_scene("w", "w")
    said = run_json("explain", "w.scene.json", "--device", "arm", "--board", "stm32f405")
    assert said["fits"] is False and "970299" in said["because"], said
    soft = run_json("design", "s.scene.json", "--device", "arm")["pieces"][0]
    assert soft["verdict"] == "stable" and soft["piece"] == "bone", soft
    # Values that are ten times as steep as value_per_m act with a hundredfold stiffness.
    write_scene("hard", "v", value_per_m=1e5)
    assert run_json("design", "hard.scene.json", "--device", "arm", code=UNSTABLE)["pieces"][0]["verdict"] == "unstable"
    said = run_json("info", "s.scene.json")["pieces"][0]
    assert said["shape"] == "volume" and said["volume"] == "v" and said["iso"] == 0, said
    tacto.run("validate", "s.scene.json")
    run_json("scene", "s.scene.json", "-o", "s.png", "--device", "arm")
    assert pathlib.Path("s.png").stat().st_size > 5000


def carved_by(values, spacing, place, counts, stiffness, force_n, per_tick):
    """Tick by tick in NumPy: the trilinear gradient of the potential, then the fall of the eight values."""
    left, lowest, rest = values.astype(int).copy(), values.min(), 0.0
    corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
    for count in counts:
        at = (count * STEP_M - place) / spacing + (np.array(values.shape[::-1]) - 1) / 2
        first = np.floor(at).astype(int)
        if (first < 0).any() or (first > np.array(values.shape[::-1]) - 2).any():
            continue
        index = tuple((first + corners).T[::-1])
        weights = np.where(corners == 1, at - first, 1 - (at - first))
        depth = left[index] @ weights.prod(1) / 1e6
        slope = [left[index] @ (np.where(corners[:, k] == 1, 1, -1) / spacing * np.delete(weights, k, 1).prod(1)) / 1e6 for k in range(3)]
        if depth > 0 and stiffness * depth * np.linalg.norm(slope) > force_n:
            rest += per_tick
            left[index] = np.maximum(lowest, left[index] - int(rest))
            rest -= int(rest)
    return left


def what_was_carved_replays_and_is_exported():
    values = ball((31, 31, 31), 9.0, 0.8)
    write_nrrd("v.nrrd", values, spacing="spacings: 0.8 0.8 0.8")
    run_json("import", "v.nrrd", "--unit", "mm", "-o", "v")
    off_the_counts = np.array([3.7e-6, -4.1e-6, 2.9e-6])  # no place of the hand is on the face of a cell
    write_scene("s", "v", off_the_counts, carve={"force_n": 0.6, "value_per_s": 20500})
    time_s, places = path_through(2, 0.008)
    write_path("p.csv", time_s, places)
    report = run_json("play", "s.scene.json", "-d", "sim:arm", "--finger-path", "p.csv", "--onset", "0s", "-o", "played")
    assert report["lost_ticks"] == 0, report
    again = run_json("replay", "played", "--volume", "v", "-o", "carved")
    assert again["same_to_the_bit"] is True and again["carved_values"] > 40 and again["files"] == ["carved.volume.nc"], again
    left, scale, _, spacing = values_in("carved.volume.nc")
    assert scale == 1 and np.allclose(spacing, 8e-4, rtol=1e-12) and (left <= values).all() and left.min() == values.min()
    run_json("session", "played", "-o", "played.csv")
    table = np.genfromtxt("played.csv", delimiter=",", names=True)
    counts = np.column_stack([table[f"{axis}_m"] for axis in "xyz"]) / STEP_M
    assert abs(counts - np.rint(counts)).max() < 1e-3
    expected = carved_by(values, 8e-4, off_the_counts, np.rint(counts), 300, 0.6, 20.5)
    assert (left != values).sum() == again["carved_values"] and (left != expected).sum() <= 8, (left != expected).sum()
    for arguments, code in ((("--volume", "v"), USAGE), (("-o", "w"), USAGE), (("--volume", "v", "-o", "carved"), USAGE), (("--volume", "carved", "-o", "w"), UNSUITABLE), (("--volume", "none", "-o", "w"), NOT_FOUND)):
        error_of("replay", "played", *arguments, code=code)
    assert not pathlib.Path("w.volume.nc").exists()
    # The reference in double precision carves the same.
    said = run_json("render", "s.scene.json", "--finger-path", "p.csv", "--device", "arm", "-o", "f.csv")
    assert said["largest_rounding_n"] < 1e-4 * said["force_peak_n"] and said["other_side_ticks"] <= 0.01 * said["ticks"], said
    tight = run_json("explain", "s.scene.json", "--device", "arm")
    assert tight["live_bytes"] > 2 * 31**3 and run_json("explain", "s.scene.json", "--device", "arm", "--device-memory", str(tight["block_bytes"] // 4 + 1000))["fits"] is False, tight
    write_scene("s", "v", carve={"force_n": 0.6, "value_per_s": 1e12})
    assert error_of("explain", "s.scene.json", "--device", "arm", code=UNSUITABLE)["where"].endswith("/carve/value_per_s")


if __name__ == "__main__":
    for test in (every_type_and_encoding_gives_the_values, directions_and_units_are_those_of_the_file, what_is_wrong_with_a_file_is_said, a_changed_volume_is_found, what_is_wrong_with_a_scene_is_said,
                 a_rendered_force_is_that_of_scipys_interpolation, a_played_volume_replays_to_the_bit, what_was_carved_replays_and_is_exported, a_tool_is_the_sum_of_its_points):
        tacto.in_folder(test)
