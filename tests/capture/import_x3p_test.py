#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`import` of X3P files (ISO 25178-72) that Python's zipfile writes (tests/fuzz/x3p_maker.py): the heights of each type, holes, checksums, cuts and damage."""
import hashlib
import json
import pathlib
import random
import re
import sys
import zipfile

import netCDF4
import numpy as np
import tacto

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "fuzz"))
from x3p_maker import COLUMNS, PITCH_X_M, PITCH_Y_M, ROWS, main_xml, x3p

USAGE, NOT_FOUND, MALFORMED, UNSUITABLE = 2, 3, 4, 5
TYPES = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}


def imported(content, *more, code=0):
    pathlib.Path("s.x3p").write_bytes(content)
    words = ["import", "s.x3p", *([] if "-o" in more else ["-o", "s"]), "--force", *more]
    return tacto.run_json(*words) if code == 0 else tacto.error_of(*words, code=code)


def heights():
    return tacto.soundfile.read("s.texture.wav", dtype="float64")[0]


def stored_matrix(letter):
    rng = np.random.default_rng(1)
    if letter in "IL":
        return rng.integers(-3000, 3000, (ROWS, COLUMNS)).astype(TYPES[letter])
    return (rng.normal(size=(ROWS, COLUMNS)) * 1000).astype(TYPES[letter])


def each_type_along_rows_and_columns():
    for letter in TYPES:
        matrix = stored_matrix(letter)
        made_m = (matrix.astype(float) * 1e-9 + 5e-7).astype(np.float32)  # a texture has 32 bits
        content = x3p(main_xml(letter, matrix.tobytes()), matrix.tobytes())
        printed = imported(content, "--row", "7")
        assert np.array_equal(heights(), made_m[6]) and printed["pitch_m"] == PITCH_X_M, (letter, printed)
        texture = json.loads(pathlib.Path("s.texture.json").read_text())
        assert texture["source_origin_m"] == 1e-3 and "row 7" in texture["notes"] and "T-1" in texture["notes"], texture
        printed = imported(content, "--column", "40")
        assert np.array_equal(heights(), made_m[:, 39]) and printed["pitch_m"] == PITCH_Y_M, (letter, printed)
        assert np.array_equal(tacto_points(content, "5..10"), made_m[6, 4:10])
        assert json.loads(pathlib.Path("s.texture.json").read_text())["source_origin_m"] == 1e-3 + 4 * PITCH_X_M
    profile = stored_matrix("D")[0]
    imported(x3p(main_xml("D", profile.tobytes(), feature="PRF", sizes=(COLUMNS, 1, 1)), profile.tobytes()))
    assert np.array_equal(heights(), (profile * 1e-9 + 5e-7).astype(np.float32))


def heights_far_from_zero_keep_their_roughness():
    rough_m = np.random.default_rng(3).normal(0, 20e-9, (ROWS, COLUMNS))
    for far_m in (0.05, -0.05):
        content = x3p(main_xml("D", rough_m.tobytes(), scale=1, offset=far_m), rough_m.tobytes())
        imported(content, "--row", "1")
        # A float of 60 nm has a step of 3.6e-15 m; a double of 50 mm one of 6.9e-18 m.
        assert np.abs(heights() - (rough_m[0] - rough_m[0].mean())).max() < 1e-14
        notes = json.loads(pathlib.Path("s.texture.json").read_text())["notes"]
        mean_m = float(re.search(r"mean height of (\S+) m subtracted", notes)[1])
        assert abs(mean_m - (rough_m[0].mean() + far_m)) < 1e-15, notes
    imported(x3p(main_xml("D", rough_m.tobytes(), scale=1, offset=1e-6), rough_m.tobytes()), "--row", "1")
    assert "subtracted" not in json.loads(pathlib.Path("s.texture.json").read_text())["notes"]


def options_that_a_texture_does_not_store_are_refused():
    matrix = stored_matrix("F")
    content = x3p(main_xml("F", matrix.tobytes()), matrix.tobytes())
    for more in (["--date", "2026-01-01"], ["--calibrated", "2026-01-01"], ["--humidity", "50%"], ["--speed", "5mm/s"], ["--no-position"],
                 ["--mask-outliers"], ["--stream", "x"], ["--skip", "3"]):
        assert imported(content, "--row", "1", *more, code=USAGE)["where"] == more[0]
    for pitch in (b"5", b"1e-12"):
        assert imported(x3p(main_xml("F", matrix.tobytes()).replace(b"2e-06", pitch), matrix.tobytes()), "--row", "1", code=UNSUITABLE)["where"] == "s.x3p"


def tacto_points(content, points):
    imported(content, "--row", "7", "--points", points)
    return heights()


def holes_are_refused_with_the_longest_section():
    matrix = stored_matrix("L")
    valid = np.ones((ROWS, COLUMNS), bool)
    valid[6, [0, 3, 30]] = False
    mask = np.packbits(valid.ravel(), bitorder="little").tobytes()
    masked = x3p(main_xml("L", matrix.tobytes(), mask), matrix.tobytes(), mask)
    floats = stored_matrix("F")
    floats[6, [0, 3, 30]] = np.nan
    for content in (masked, x3p(main_xml("F", floats.tobytes()), floats.tobytes())):
        error = imported(content, "--row", "7", code=UNSUITABLE)
        assert error["what"].startswith("3 of 40 ") and error["remedy"].endswith("--points 5..30"), error
        assert imported(content, "--row", "7", "--points", "5..30")["samples"] == 26
        imported(content, "--row", "7", "--points", "4..30", code=UNSUITABLE)
        assert imported(content, "--row", "8")["samples"] == COLUMNS


def lines_and_options_that_do_not_fit():
    matrix = stored_matrix("F")
    content = x3p(main_xml("F", matrix.tobytes()), matrix.tobytes())
    for more in ([], ["--row", "0"], ["--row", "31"], ["--column", "41"], ["--row", "1", "--points", "7..7"], ["--row", "1", "--points", "30..41"],
                 ["--row", "1", "--points", "0..4"], ["--row", "1", "--points", "x"], ["--row", "1", "--pitch", "1um"], ["--row", "1", "--column", "1"]):
        imported(content, *more, code=USAGE)
    assert "--row N (1 to 30)" in imported(content, code=USAGE)["remedy"]
    imported(x3p(main_xml("F", matrix[0].tobytes(), feature="PRF", sizes=(COLUMNS, 1, 1)), matrix[0].tobytes()), "--row", "1", code=USAGE)
    tacto.error_of("import", "none.x3p", "-o", "s", "--row", "1", code=NOT_FOUND)
    pathlib.Path("t.csv").write_text("1,2\n3,4\n")
    tacto.error_of("import", "t.csv", "-o", "s", "--row", "1", code=USAGE)
    assert not list(pathlib.Path(".").glob("s.texture.*"))


def square_xml(letter, points, *more, **others):
    return main_xml(letter, points, *more, **others).replace(f"{PITCH_Y_M}".encode(), f"{PITCH_X_M}".encode())


def a_whole_surface_is_a_height_map_of_a_scene():
    for letter in TYPES:
        matrix = stored_matrix(letter)
        printed = imported(x3p(square_xml(letter, matrix.tobytes()), matrix.tobytes()), "-o", "map.height.nc")
        with netCDF4.Dataset("map.height.nc") as file:
            assert np.array_equal(file["height"][:], (matrix.astype(float) * 1e-9 + 5e-7).astype(np.float32)), letter
            assert file.pitch_m == PITCH_X_M and "T-1" in file.notes and "surface" in file.notes, file
        assert (printed["columns"], printed["rows"]) == (COLUMNS, ROWS), printed
    rough_m = np.random.default_rng(3).normal(0, 20e-9, (ROWS, COLUMNS))
    imported(x3p(square_xml("D", rough_m.tobytes(), scale=1, offset=0.05), rough_m.tobytes()), "-o", "map.height.nc")
    with netCDF4.Dataset("map.height.nc") as file:
        assert np.abs(file["height"][:] - (rough_m - rough_m.mean())).max() < 1e-14 and "mean height" in file.notes, file.notes
    # z = 0.01 x over 19.5 mm; the force is -4 N times the slope. The spline's mirrored edges fade by 0.27 a sample, 15 samples away.
    plane = np.tile(np.arange(COLUMNS, dtype="<f8") * 5e-4 * 0.01, (ROWS, 1))
    xml = square_xml("D", plane.tobytes(), scale=1, offset=0).replace(str(PITCH_X_M).encode(), b"5e-4")
    imported(x3p(xml, plane.tobytes()), "-o", "map.height.nc")
    scene = {"kind": "scene", "version": "1.0", "name": "s", "patches": [
        {"name": "p", "place": {"x_m": 0, "y_m": 0}, "size": {"width_m": 0.0195, "height_m": 0.0145},
         "layers": [{"type": "height_map", "file": "map", "kappa_n": 4}]}]}
    pathlib.Path("s.scene.json").write_text(json.dumps(scene))
    tacto.run("validate", "s.scene.json")
    pathlib.Path("hand.csv").write_text("time_s,x_mm,y_mm\n0,-2,0\n1,2,0\n")
    tacto.run("render", "s.scene.json", "--finger-path", "hand.csv", "--device", "sandpaper-1990", "-o", "force.csv")
    forces = np.genfromtxt("force.csv", delimiter=",", names=True)
    assert np.allclose(forces["force_x_n"], -0.04, rtol=1e-3) and np.allclose(forces["force_y_n"], 0, atol=4e-5), forces
    # A row, and a profile, are maps of one row; PRF has no pitch along y.
    assert imported(x3p(main_xml("D", plane.tobytes()), plane.tobytes()), "-o", "map.height.nc", "--row", "3")["rows"] == 1
    printed = imported(x3p(main_xml("D", plane[0].tobytes(), feature="PRF", sizes=(COLUMNS, 1, 1)), plane[0].tobytes()), "-o", "map.height.nc")
    assert (printed["columns"], printed["rows"]) == (COLUMNS, 1), printed


def a_surface_that_is_no_height_map_is_refused():
    matrix = stored_matrix("F")
    matrix[[4, 4, 11], [30, 5, 7]] = np.nan
    error = imported(x3p(square_xml("F", matrix.tobytes()), matrix.tobytes()), "-o", "map.height.nc", code=UNSUITABLE)
    assert re.findall(r"\d+", error["what"]) == ["3", str(ROWS * COLUMNS), "5", "12", "6", "31"], error
    matrix = stored_matrix("F")
    error = imported(x3p(main_xml("F", matrix.tobytes()), matrix.tobytes()), "-o", "map.height.nc", code=UNSUITABLE)
    assert "2e-06" in error["what"] and "3e-06" in error["what"], error
    imported(x3p(square_xml("F", matrix.tobytes()), matrix.tobytes()), "-o", "map.height.nc", "--pitch", "1um", code=USAGE)
    imported(x3p(square_xml("F", matrix.tobytes(), sizes=(2**15, 2**14, 1)), matrix.tobytes()), "-o", "map.height.nc", code=UNSUITABLE)
    assert not list(pathlib.Path(".").glob("map*"))


def folders_foreign_files_and_checksums():
    matrix = stored_matrix("D")
    points = matrix.tobytes()
    xml = main_xml("D", points)
    foreign = [("readme.txt", b"x"), ("__MACOSX/._main.xml", b"x"), ("other/data.bin", b"y" * 1000)]
    for content in (x3p(xml, points, folder="sample 3/"), x3p(xml, points, more=foreign), x3p(xml, points, packing=zipfile.ZIP_STORED)):
        imported(content, "--row", "1")
        assert np.array_equal(heights(), (matrix[0] * 1e-9 + 5e-7).astype(np.float32))
    assert "main.xml" in imported(x3p(xml.replace(b"tester", b"Tester"), points, sums=False, more=[("md5checksum.hex", hashlib.md5(xml).hexdigest())]),
                                  "--row", "1", code=MALFORMED)["where"]
    written_otherwise = main_xml("D", points, scale="+1e-9", sizes=(f"+{COLUMNS}", ROWS, 1)).replace(b">bindata/", b">./bindata/")
    imported(x3p(written_otherwise, points), "--row", "1")
    assert np.array_equal(heights(), (matrix[0] * 1e-9 + 5e-7).astype(np.float32))
    changed = bytearray(points)
    changed[17] ^= 1
    assert "data.bin" in imported(x3p(xml, bytes(changed)), "--row", "1", code=MALFORMED)["where"]
    mask = bytes([255] * (ROWS * COLUMNS // 8))
    assert "valid.bin" in imported(x3p(main_xml("D", points, mask), points, mask[:-1] + b"\0"), "--row", "1", code=MALFORMED)["where"]
    imported(x3p(main_xml("D", points, sums=False), points), "--row", "1")
    assert "no checksum" in json.loads(pathlib.Path("s.texture.json").read_text())["notes"]


def what_is_not_read_is_named():
    matrix = stored_matrix("F")
    points = matrix.tobytes()
    unsuitable = (main_xml("F", points, feature="PCL"), main_xml("F", points, sizes=(COLUMNS, ROWS, 2)), main_xml("F", points, axis="A"),
                  main_xml("F", points, link=False), main_xml("F", points, sizes=(2**40, 2**40, 1)), main_xml("F", points, sizes=(2**20, 2**12, 1)))
    for xml in unsuitable:
        imported(x3p(xml, points), "--row", "1", code=UNSUITABLE)
    malformed = (main_xml("Q", points), main_xml("F", points, sizes=(COLUMNS, ROWS + 1, 1)), main_xml("F", points, sizes=(0, ROWS, 1)),
                 main_xml("F", points, scale="x"), main_xml("F", points, scale="0"), main_xml("F", points, scale="+-1"), b"<a/>", b"no xml", main_xml("F", points).replace(b"data.bin", b"else.bin"),
                 main_xml("F", points).replace(b"2e-06", b"-2e-06"))
    for xml in malformed:
        imported(x3p(xml, points), "--row", "1", code=MALFORMED)
    both = [("a/main.xml", b""), ("b/main.xml", b"")]
    imported(x3p(main_xml("F", points), points, folder="c/", more=both), "--row", "1", code=MALFORMED)


def cuts_and_damage_are_never_silent():
    matrix = stored_matrix("I")
    whole = x3p(main_xml("I", matrix.tobytes()), matrix.tobytes())
    imported(whole, "--row", "3")
    right = heights()
    rng = random.Random(2)
    for size in rng.sample(range(1, len(whole)), 200):
        imported(whole[:size], "--row", "3", code=MALFORMED)
    for _ in range(100):  # a changed byte is found, or does not matter
        damaged = bytearray(whole)
        damaged[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
        judged("s.x3p", bytes(damaged), right)
    xml = main_xml("I", matrix.tobytes(), sums=False)
    for _ in range(100):  # the archive is in order, but its XML is not
        begin = rng.randrange(len(xml))
        changed = xml[:begin] + rng.choice([b"", b"<", b"9", b"-1e400", b"</CX>", bytes([rng.randrange(256)])]) + xml[begin + rng.randrange(9):]
        judged("s.x3p", x3p(changed, matrix.tobytes()), None)


def judged(name, content, right):
    pathlib.Path(name).write_bytes(content)
    done = tacto.subprocess.run([tacto.COMMAND, "import", name, "-o", "s", "--force", "--row", "3"], capture_output=True, text=True)
    assert done.returncode in (0, USAGE, MALFORMED, UNSUITABLE), done
    if done.returncode == 0 and right is not None:
        assert np.array_equal(heights(), right)
    assert done.returncode == 0 or done.stderr.count("\n") == 1, done


if __name__ == "__main__":
    for test in (each_type_along_rows_and_columns, heights_far_from_zero_keep_their_roughness, options_that_a_texture_does_not_store_are_refused,
                 holes_are_refused_with_the_longest_section, lines_and_options_that_do_not_fit,
                 a_whole_surface_is_a_height_map_of_a_scene, a_surface_that_is_no_height_map_is_refused, folders_foreign_files_and_checksums, what_is_not_read_is_named, cuts_and_damage_are_never_silent):
        tacto.in_folder(test)
