#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Height maps on the command line: a PNG or a profile is imported, described, played, and its forces are those of SciPy's splines."""
import json
import pathlib
import struct
import zlib

import netCDF4
import numpy as np
from scipy.interpolate import CubicSpline, RectBivariateSpline

import tacto
from made_files import write_texture
from plane_render_test import MALFORMED, NOT_FOUND, STEP_M, UNSUITABLE, USAGE, counted, patch, write_path, write_scene
from tacto import run, run_json

PITCH_M, WHITE_M, SIZE = 2e-4, 2e-4, 256
UNSTABLE = 9


def png(name, rows, bits=16, colour=0):
    """Greyscale rows (colour type 0), the first row at the top; only the header if rows is a (width, height)."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    empty = isinstance(rows, tuple)
    width, height = rows if empty else (rows.shape[1] // (3 if colour == 2 else 1), rows.shape[0])
    data = b"" if empty else b"".join(b"\0" + row.astype(">u2" if bits == 16 else "u1").tobytes() for row in rows)
    pathlib.Path(name).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)) +
                                   chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def smooth_noise(periods=12, seed=31):
    """Noise with at least `periods` samples to a period, from 0 to 65535, that ends smoothly nowhere."""
    random = np.random.default_rng(seed)
    spectrum = np.fft.fft2(random.standard_normal((2 * SIZE, 2 * SIZE)))
    f = np.fft.fftfreq(2 * SIZE)
    spectrum[np.hypot(*np.meshgrid(f, f)) > 1 / periods] = 0
    field = np.fft.ifft2(spectrum).real[:SIZE, :SIZE]
    return np.round((field - field.min()) / np.ptp(field) * 65535).astype(np.uint16)


def import_noise():
    rows = smooth_noise()
    png("plate.png", rows)
    run("import", "plate.png", "--pitch", "200um", "--height", "200um", "-o", "plate", "--surface", "made of noise")
    return rows


def a_png_becomes_a_height_map():
    rows = import_noise()
    with netCDF4.Dataset("plate.height.nc") as file:
        height, x, y = file["height"][:], file["x"][:], file["y"][:]
        assert file["height"].dimensions == ("y", "x") and file["height"].units == "m"
    # 24 bits hold a sample of 16 bits times the height of white to 2^-24 of it.
    expected = rows[::-1] * (WHITE_M / 65535)
    assert np.abs(height - expected).max() < 2**-23 * WHITE_M and np.allclose(x, y) and np.allclose(np.diff(x), PITCH_M)
    said = run_json("info", "plate")
    slopes = np.diff(expected, axis=1), np.diff(expected, axis=0)
    assert (said["kind"], said["columns"], said["rows"], said["surface"]) == ("height_map", SIZE, SIZE, "made of noise") and abs(said["pitch_m"] - PITCH_M) < 1e-15, said
    assert abs(said["rms_slope"] / (np.sqrt(np.mean(slopes[0]**2) + np.mean(slopes[1]**2)) / PITCH_M) - 1) < 1e-4, said
    assert abs(said["highest_m"] - WHITE_M) < 1e-10 and said["lowest_m"] == 0 and "plate.png" in said["source"], said
    assert run_json("validate", "plate.height.nc")["valid"] is True
    # Eight bits on request: the same heights in 255 steps.
    png("steps.png", rows // 257, bits=8)
    run("import", "steps.png", "--pitch", "200um", "--height", "200um", "-o", "steps", "--allow-8bit")
    with netCDF4.Dataset("steps.height.nc") as file:
        assert np.abs(file["height"][:] - (rows // 257)[::-1] * (WHITE_M / 255)).max() < 2**-23 * WHITE_M


def a_profile_becomes_a_map_of_one_row():
    x = np.arange(200) * 1e-4
    np.savetxt("profile.csv", np.column_stack([x * 1e3, 50 * np.sin(2 * np.pi * x / 2e-3)]), delimiter=",", header="x,z", comments="")
    run("import", "profile.csv", "--channel", "position=x*1mm", "--channel", "height=z*1um", "-o", "profile.height.nc")
    said = run_json("info", "profile.height.nc")
    assert (said["columns"], said["rows"]) == (200, 1) and abs(said["pitch_m"] - 1e-4) < 1e-12 and abs(said["highest_m"] - 50e-6) < 1e-10, said
    write_scene("line", patch(layers=[{"type": "height_map", "file": "profile", "kappa_n": 2}], angle_deg=90, width_m=0.019))
    t = np.linspace(0, 1, 21)
    write_path("path.csv", {"time_s": t, "x_m": 0.001 * np.ones(21), "y_m": 0.004 * np.sin(2 * np.pi * t)})
    run("render", "line.scene.json", "--finger-path", "path.csv", "--device", "sandpaper-1990", "-o", "line.csv")
    table = np.genfromtxt("line.csv", delimiter=",", names=True)
    # The map's x axis is the plane's y axis; 20 samples a period: 0.036 % (16 samples) times (16 / 20)^3 of the steepest slope.
    slope = 50e-6 * 2 * np.pi / 2e-3
    expected = -2 * slope * np.cos(2 * np.pi * (counted(table["y_m"]) + 99.5e-4) / 2e-3)
    assert np.abs(table["force_y_n"] - expected).max() < 6e-4 * 2 * slope and np.abs(table["force_x_n"]).max() < 1e-7, np.abs(table["force_y_n"] - expected).max() / slope


def forces_are_scipys_spline():
    import_noise()
    write_scene("bench", patch(x_m=0.01, y_m=-0.005, width_m=0.05, height_m=0.05, layers=[{"type": "height_map", "file": "plate", "kappa_n": 1.5}]))
    t = np.linspace(0, 2, 81)
    # 44 mm/s: the shortest periods of 2.4 mm pass 20 times a second.
    write_path("circle.csv", {"time_s": t, "x_m": 0.01 + 0.014 * np.cos(np.pi * t), "y_m": -0.005 + 0.014 * np.sin(np.pi * t)})
    report = run_json("render", "bench.scene.json", "--finger-path", "circle.csv", "--device", "sandpaper-1990", "-o", "forces.csv")
    table = np.genfromtxt("forces.csv", delimiter=",", names=True)
    with netCDF4.Dataset("plate.height.nc") as file:
        places = np.arange(SIZE) - (SIZE - 1) / 2
        spline = RectBivariateSpline(places, places, np.float64(file["height"][:]), s=0)
    u, v = (counted(table["x_m"]) - 0.01) / PITCH_M, (counted(table["y_m"]) + 0.005) / PITCH_M
    assert max(np.abs(u).max(), np.abs(v).max()) < SIZE / 2 - 12
    exact = -1.5 / PITCH_M * np.array([spline.ev(v, u, dy=1), spline.ev(v, u, dx=1)])
    difference = np.array([table["force_x_n"], table["force_y_n"]]) - exact
    relative = np.sqrt(np.mean(difference**2) / np.mean(exact**2))
    print(f"  a circle over a height map: within {relative:.2g} of the RMS of SciPy's gradient")
    assert relative < 1e-6 and report["largest_rounding_n"] < 1e-6 * np.abs(exact).max(), (relative, report)


def no_other_interpolant_is_worth_it():
    """The kernel has one interpolant, the cubic B-spline: 4 coefficients a direction. Catmull-Rom's spline reads as many and errs
    more at each number of samples to a period; a straight line reads 2. Error of the slope, re the steepest one, against the
    sine itself: that of the kernel in its forces, of the others by their formulas at the same places."""
    for samples in (4, 6, 8, 12, 16, 24):
        period = samples * 1e-4
        i = np.arange(400)
        height = np.sin(2 * np.pi * i / samples)
        np.savetxt("sine.csv", np.column_stack([i * 0.1, 50 * height]), delimiter=",", header="x,z", comments="")
        run("import", "sine.csv", "--channel", "position=x*1mm", "--channel", "height=z*1um", "-o", "sine.height.nc", "--force")
        write_scene("sine", patch(layers=[{"type": "height_map", "file": "sine", "kappa_n": 2}], width_m=0.03))
        t = np.linspace(0, 1, 21)
        write_path("path.csv", {"time_s": t, "x_m": 0.0005 * np.sin(2 * np.pi * t), "y_m": 0 * t})
        run("render", "sine.scene.json", "--finger-path", "path.csv", "--device", "sandpaper-1990", "-o", "sine.force.csv", "--force")
        table = np.genfromtxt("sine.force.csv", delimiter=",", names=True)
        at = counted(table["x_m"]) / 1e-4 + 199.5  # in samples
        steepest, cell = 2 * np.pi / samples, np.floor(at).astype(int)
        exact, u = steepest * np.cos(2 * np.pi * at / samples), at - cell
        before, here, after, beyond = (height[cell + k] for k in (-1, 0, 1, 2))
        rom = ((after - before) + 2 * u * (2 * before - 5 * here + 4 * after - beyond) + 3 * u**2 * (3 * here - before - 3 * after + beyond)) / 2
        slopes = {"B-spline": -table["force_x_n"] / 2 * 1e-4 / 50e-6, "Catmull-Rom": rom, "line": after - here}
        errors = {name: np.abs(slope - exact).max() / steepest for name, slope in slopes.items()}
        print(f"  {samples} samples to a period: " + ", ".join(f"{name} {100 * error:.3f} %" for name, error in errors.items()))
        assert errors["B-spline"] < errors["Catmull-Rom"] < errors["line"], (samples, errors)
        # The cheapest with an error below 1 % (the knee of `trade` where there is no corner) from 8 samples to a period on.
        assert samples < 8 or (errors["B-spline"] < 0.01 < errors["line"]), (samples, errors)


def write_forces(name, x, y, x_n, y_n):
    """x, y: places of columns and rows; forces row by row."""
    columns, rows = np.meshgrid(x, y)
    table = np.array([columns, rows, x_n, y_n]).reshape(4, -1).T
    np.savetxt(name, table, delimiter=",", header="x_m,y_m,fx_n,fy_n", comments="", fmt="%.12g")


def a_force_map_is_scipys_spline_and_is_replayed():
    # 81 x 61 nodes 0.5 mm apart, of periods from 12 nodes on; the origin of the file is the centre of the patch.
    x, y = 5e-4 * np.arange(-30, 51), 5e-4 * np.arange(-40, 21)
    noise = smooth_noise(seed=7) / 65535 - 0.5
    x_n, y_n = 0.4 + noise[:61, :81], -0.2 + 0.5 * noise[100:161, 100:181]
    write_forces("forces.csv", x, y, x_n, y_n)
    layer = {"type": "force_map", "file": "forces.csv", "gain": {"value": -1.5, "slider": {"from": -2, "to": 2}}}
    write_scene("bench", patch(x_m=0.01, y_m=-0.005, width_m=0.02, height_m=0.02, layers=[layer]))
    t = np.linspace(0, 2, 81)
    path = {"time_s": t, "x_m": 0.01 + 0.005 + 0.006 * np.cos(np.pi * t) - 0.004, "y_m": -0.005 - 0.004 + 0.006 * np.sin(np.pi * t) + 0.001}
    write_path("circle.csv", path)
    report = run_json("render", "bench.scene.json", "--finger-path", "circle.csv", "--device", "sandpaper-1990", "-o", "found.csv")
    table = np.genfromtxt("found.csv", delimiter=",", names=True)
    u, v = counted(table["x_m"]) - 0.01, counted(table["y_m"]) + 0.005
    splines = [RectBivariateSpline(y, x, values, s=0) for values in (x_n, y_n)]
    exact = -1.5 * np.array([spline.ev(v, u) for spline in splines])
    difference = np.array([table["force_x_n"], table["force_y_n"]]) - exact
    relative = np.sqrt(np.mean(difference**2) / np.mean(exact**2))
    print(f"  a circle over a force map: within {relative:.2g} of the RMS of SciPy's spline")
    # 12 nodes from the edges the spline that continues evenly is 1.3e-7 of SciPy's edge beside it (the factor 2 - sqrt(3) a node).
    assert relative < 1e-6 and report["largest_rounding_n"] < 1e-6 * np.abs(exact).max(), (relative, report)
    # Stiffness and curl by the same splines, at the nodes and halfway between them in the patch and half a node more.
    fine_x, fine_y = np.arange(-10.25e-3, 10.26e-3, 2.5e-4), np.arange(-10.25e-3, 10.01e-3, 2.5e-4)
    (xx, xy), (yx, yy) = ([spline(fine_y, fine_x, dy=1), spline(fine_y, fine_x, dx=1)] for spline in splines)
    stiffness = 2 * (np.abs(xx + yy) / 2 + np.hypot((xx - yy) / 2, (xy + yx) / 2)).max()
    curl = 2 * np.abs(yx - xy).max()
    row = run_json("explain", "bench.scene.json", "--device", "sandpaper-1990")["layers"][0]
    assert (row["columns"], row["rows"]) == (81, 61), row
    assert abs(row["curl_n_per_m"] / curl - 1) < 1e-3 and abs(row["stiffness_n_per_m"] / stiffness - 1) < 1e-3, (row, stiffness, curl)
    judged = run_json("design", "bench", "--device", "sandpaper-1990")["layers"][0]
    assert judged["verdict"] == "not known" and f"{row['curl_n_per_m']:.4g} J" in judged["because"], judged
    pathlib.Path("script.csv").write_text("time_s,command\n0.5,set a.force_map.gain 1 over 20ms\n1,move a 12mm,-4mm\n")
    played = run_json("play", "bench.scene.json", "-d", "sim:planar", "-o", "forced", "--finger-path", "circle.csv", "--script", "script.csv")
    again = run_json("replay", "forced")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == played["ticks"] and played["lost_ticks"] == 0, again
    kept = run_json("trade", "bench", "--device", "sandpaper-1990", "--finger-path", "circle.csv")
    assert all(row["stability"] == "not known" or row["choice"] == "100 Hz" for row in kept["choices"]) and kept["choices"][-1]["error_n"] <= kept["rounding_n"] < 1e-4, kept
    run("scene", "bench", "-o", "bench.png", "--session", "forced")


def force_maps_that_do_not_fit_are_refused_or_warned_of():
    x = 1e-3 * np.arange(-20, 21)
    spring = -100 * np.array(np.meshgrid(x, x))
    write_forces("forces.csv", x, x, *spring)
    layer = {"type": "force_map", "file": "forces.csv"}
    write_scene("bench", patch(width_m=0.02, height_m=0.02, layers=[layer]))
    row = run_json("design", "bench", "--device", "sandpaper-1990")["layers"][0]
    assert abs(row["stiffness_n_per_m"] - 100) < 1e-3 and row["verdict"] == "stable", row
    write_scene("stiff", patch(width_m=0.02, height_m=0.02, layers=[{**layer, "gain": 1000}]))
    assert run_json("design", "stiff", "--device", "sandpaper-1990", code=UNSTABLE)["layers"][0]["verdict"] == "unstable"
    # A map of 500 N/m away from the middle, against what holds the hand there.
    for held, verdict in ((0, "not known"), (400, "not known"), (500, "not known"), (600, "stable")):
        away = [{**layer, "gain": -5}] + ([{"type": "spring", "stiffness_n_per_m": held}] if held else [])
        write_scene("away", patch(width_m=0.02, height_m=0.02, layers=away))
        row = run_json("design", "away", "--device", "sandpaper-1990")["layers"][0]
        assert row["verdict"] == verdict and row["stiffness_n_per_m"] == 0, row
    write_scene("away", patch(width_m=0.02, height_m=0.02, layers=[{**layer, "gain": -5}]))
    for stiffness, verdict in ((100, "not known"), (600, "stable")):
        pathlib.Path("held.hand.json").write_text(json.dumps({"kind": "hand", "version": "1.0", "name": "held", "mass_kg": 0.05, "damping_n_s_per_m": 1, "stiffness_n_per_m": stiffness, "source": "test"}))
        row = run_json("design", "away", "--device", "sandpaper-1990", "--hand", "held.hand.json")["layers"][0]
        assert row["verdict"] == verdict, row
    write_scene("wide", patch(width_m=0.05, height_m=0.02, layers=[layer]))
    _, err = run("explain", "wide.scene.json", "--device", "sandpaper-1990")
    assert "forces.csv" in err and "exceeds the peak force" not in err, err
    good = pathlib.Path("forces.csv").read_text().splitlines()
    bad = {"hole": good[:700] + good[701:], "pitch": good + ["0.0207,0,0,0"], "nan": good[:-1] + ["0.02,0.02,nan,0"], "twice": good + [good[-1]],
           "newton": good[:-1] + ["0.02,0.02,2e3,0"], "column": [good[0].replace("fx_n", "f_n")] + good[1:]}
    for name, lines in bad.items():
        pathlib.Path("forces.csv").write_text("\n".join(lines) + "\n")
        for verb in (("explain", "bench.scene.json", "--device", "sandpaper-1990"), ("design", "bench", "--device", "sandpaper-1990"),
                     ("play", "bench.scene.json", "-d", "sim:planar", "-o", "x"), ("scene", "bench", "-o", "x.png")):
            _, err = run(*verb, code=MALFORMED)
            assert "forces.csv" in err and err.strip().count("\n") == 0 and not list(pathlib.Path().glob("x*")), (name, err)
        assert run_json("validate", "bench.scene.json", code=MALFORMED)["valid"] is False, name


def explain_says_levels_speeds_and_memory():
    import_noise()
    write_scene("bench", patch(width_m=0.046, height_m=0.044, layers=[{"type": "height_map", "file": "plate", "kappa_n": 1.5}]))
    said = run_json("explain", "bench.scene.json", "--device", "sandpaper-1990")
    row = said["layers"][0]
    assert (row["type"], row["columns"], row["rows"]) == ("height_map", SIZE, SIZE) and row["samples_per_period"] == 12, row
    # The taper of the spectrum broadens it by a few of 512 bins.
    assert 0.85 * 12 * PITCH_M < row["shortest_period_m"] <= 12 * PITCH_M, row
    assert abs(row["whole_to_mps"] / (np.sqrt(0.5) / 2 * 4000 * row["shortest_period_m"]) - 1) < 1e-6, row
    assert abs(row["zero_from_mps"] / (row["whole_to_mps"] * 2 ** (row["levels"] / 2)) - 1) < 1e-6 and row["zero_from_mps"] >= 10, row
    # Levels half an octave apart: each half as many coefficients, together as many as the map.
    assert 4 * SIZE**2 < row["bytes"] < 2.3 * 4 * SIZE**2, row
    # In numbers of 4 bytes: a quarter of what the map needs.
    small = run_json("explain", "bench.scene.json", "--device", "sandpaper-1990", "--device-memory", str(row["bytes"] // 16))
    assert small["fits"] is False and "2.0" in small["because"], small
    # The stiffness that `design` counts too: kappa times the largest curvature.
    with netCDF4.Dataset("plate.height.nc") as file:
        places = np.arange(SIZE)
        spline = RectBivariateSpline(places, places, np.float64(file["height"][:]), s=0)
    fine = np.arange(0, SIZE - 0.75, 0.5)
    yy, xx, xy = (spline(fine, fine, dx=a, dy=b) for a, b in ((2, 0), (0, 2), (1, 1)))
    largest = 1.5 / PITCH_M**2 * (np.abs(xx + yy) / 2 + np.hypot((xx - yy) / 2, xy))
    # The places that the patch shows, and half a sample more; 12 samples from the edges SciPy's spline is the same.
    shown = [np.abs(fine - (SIZE - 1) / 2) <= length / 2 / PITCH_M + 0.5 for length in (0.044, 0.046)]
    inside = largest[np.ix_(*shown)].max()
    assert abs(row["stiffness_n_per_m"] / inside - 1) < 1e-5, (row, inside)
    design = run_json("design", "bench", "--device", "sandpaper-1990")
    assert abs(design["layers"][0]["stiffness_n_per_m"] / row["stiffness_n_per_m"] - 1) < 1e-9, design
    write_scene("wide", patch(layers=[{"type": "height_map", "file": "plate", "kappa_n": 1.5}]))
    _, err = run("explain", "wide.scene.json", "--device", "sandpaper-1990")
    assert "tactograph: warning: " in err, err
    write_scene("strong", patch(width_m=0.05, height_m=0.05, layers=[{"type": "height_map", "file": "plate", "kappa_n": 900}]))
    _, err = run("explain", "strong.scene.json", "--device", "sandpaper-1990")
    assert "peak" in err and "%" in err, err


def a_large_map_is_played_and_replayed():
    # White noise, 1024 x 1024: no level can be coarser before the sixth.
    png("white.png", np.random.default_rng(2).integers(0, 65536, (1024, 1024)))
    run("import", "white.png", "--pitch", "50um", "--height", "1um", "-o", "white")
    write_scene("white", patch(width_m=0.05, height_m=0.05, layers=[{"type": "height_map", "file": "white", "kappa_n": {"value": 1, "slider": {"from": 0, "to": 2}}}]))
    t = np.linspace(0, 1, 41)
    write_path("path.csv", {"time_s": t, "x_m": 0.02 * np.sin(9 * t), "y_m": 0.02 * np.sin(5 * t)})
    pathlib.Path("script.csv").write_text("time_s,command\n0.3,set a.height_map.kappa_n 2 over 10ms\n")
    report = run_json("play", "white.scene.json", "-d", "sim:planar", "-o", "white", "--finger-path", "path.csv", "--script", "script.csv")
    assert report["lost_ticks"] == 0, report
    again = run_json("replay", "white")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == report["ticks"], again
    run("session", "white", "-o", "white.csv")
    assert np.abs(np.genfromtxt("white.csv", delimiter=",", names=True)["force_x_n"]).max() > 1e-3


def a_map_beyond_the_memory_is_refused():
    # White noise has levels of 8 times the map: 1500 x 1500 are 73 MB, sim:planar has 64 MB.
    png("white.png", np.random.default_rng(3).integers(0, 65536, (1500, 1500)))
    run("import", "white.png", "--pitch", "30um", "--height", "1um", "-o", "white")
    write_scene("white", patch(width_m=0.04, height_m=0.04, layers=[{"type": "height_map", "file": "white", "kappa_n": 1}]))
    _, err = run("play", "white.scene.json", "-d", "sim:planar", "--time", "1s", "-o", "x", code=UNSUITABLE)
    assert " 1.0" in err and not list(pathlib.Path().glob("x*")), err


def write_noise(name, pitch_m=1e-6, samples=30001, seed=32):
    """Forces between 0.5 and 10 periods per mm, as `spatial` makes them."""
    spectrum = np.fft.rfft(np.random.default_rng(seed).standard_normal(samples))
    f = np.fft.rfftfreq(samples, pitch_m)
    spectrum[(f < 500) | (f > 10_000)] = 0
    force = np.fft.irfft(spectrum, samples)
    force = (0.3 * force / np.abs(force).max()).astype(np.float32)
    write_texture(pathlib.Path(name), force)
    return force.astype(np.float64)


def a_texture_is_scipys_spline_along_its_direction():
    force, pitch_m, gain = write_noise("oak"), 1e-6, -1.5
    write_scene("line", patch(x_m=0.01, y_m=-0.005, angle_deg=20, width_m=0.029, height_m=0.02, layers=[{"type": "texture", "file": "oak", "direction_deg": -50, "gain": {"value": gain, "slider": {"from": -2, "to": 1}}}]))
    t = np.linspace(0, 2, 81)
    write_path("path.csv", {"time_s": t, "x_m": 0.01 + 0.007 * np.sin(2 * t), "y_m": -0.005 + 0.006 * np.cos(3 * t)})
    report = run_json("render", "line.scene.json", "--finger-path", "path.csv", "--device", "sandpaper-1990", "-o", "forces.csv")
    table = np.genfromtxt("forces.csv", delimiter=",", names=True)
    place = np.arange(len(force)) * pitch_m
    length = place[-1]
    # As on a tray the last mm before each end fades by a raised cosine.
    faded = force * (0.5 - 0.5 * np.cos(np.pi * np.minimum(np.minimum(place, length - place) / 1e-3, 1)))
    angle = np.deg2rad(-30)
    along = np.cos(angle) * (counted(table["x_m"]) - 0.01) + np.sin(angle) * (counted(table["y_m"]) + 0.005)
    expected = gain * CubicSpline(place, faded)(along + length / 2)
    assert np.abs(along).max() < length / 2 and np.abs(along).max() > 0.006
    difference = np.array([table["force_x_n"], table["force_y_n"]]) - np.array([[np.cos(angle)], [np.sin(angle)]]) * expected
    relative = np.sqrt(np.sum(difference**2) / np.sum(expected**2))
    print(f"  a path over a texture: within {relative:.2g} of the RMS of SciPy's spline")
    # Single precision of heights of some 1e-5 m: 1e-12 m on a pitch of 1e-6 m, of forces of 0.1 N.
    assert relative < 2e-5 and report["largest_rounding_n"] < 1e-6, (relative, report)
    row = run_json("explain", "line.scene.json", "--device", "sandpaper-1990")["layers"][0]
    steepest = 2 * np.abs(CubicSpline(place, faded)(np.arange(0, length, pitch_m / 2), 1)).max()
    assert (row["type"], row["columns"], row["rows"]) == ("texture", len(force) + 1, 1) and abs(row["stiffness_n_per_m"] / steepest - 1) < 1e-3, (row, steepest)
    assert 0.8e-4 < row["shortest_period_m"] < 1.1e-4 and row["zero_from_mps"] >= 10, row
    design = run_json("design", "line", "--device", "sandpaper-1990", code=UNSTABLE)
    assert abs(design["layers"][0]["stiffness_n_per_m"] / row["stiffness_n_per_m"] - 1) < 1e-9, design
    pathlib.Path("script.csv").write_text("time_s,command\n0.3,set a.texture.gain 1\n0.5,move a 12mm,-3mm\n")
    played = run_json("play", "line.scene.json", "-d", "sim:planar", "-o", "drawn", "--finger-path", "path.csv", "--script", "script.csv")
    again = run_json("replay", "drawn")
    assert again["same_to_the_bit"] is True and again["ticks_compared"] == played["ticks"], again


def textures_that_do_not_fit_are_refused_or_warned_of():
    force = write_noise("oak", samples=5001)
    layer = {"type": "texture", "file": "oak"}
    explained = ("explain", "a.scene.json", "--device", "sandpaper-1990")
    write_scene("a", patch(width_m=0.02, height_m=0.004, layers=[layer]))
    _, err = run(*explained)
    assert "larger than its texture 'oak' of 0.005" in err, err
    # Across its height it is long enough.
    write_scene("a", patch(width_m=0.02, height_m=0.004, layers=[{**layer, "direction_deg": 90}]))
    assert "larger" not in run(*explained)[1]
    small = run_json(*explained, "--device-memory", "1000")
    assert small["fits"] is False and "shorter" in small["because"], small
    write_texture(pathlib.Path("deep"), force, quantity="height", unit="m")
    write_texture(pathlib.Path("drag"), np.full(30001, 2000.0))
    for file, code, words in (("deep", UNSUITABLE, ("deep", "force")), ("drag", UNSUITABLE, ("drag", "mean")), ("elm", NOT_FOUND, ("elm",))):
        write_scene("a", patch(layers=[{**layer, "file": file}]))
        _, err = run(*explained, code=code)
        assert all(word in err for word in words) and err.strip().count("\n") == 0, err


def bad_input_is_refused_with_its_remedy():
    rows = smooth_noise()[:16, :16]
    png("grey.png", rows)

    def refused(code, word, *arguments):
        _, err = run("import", *arguments, "-o", "x", code=code)
        assert word in err and err.strip().count("\n") == 0 and not list(pathlib.Path().glob("x*")), (word, err)

    scale = ("--pitch", "50um", "--height", "200um")
    refused(USAGE, "--height", "grey.png", "--pitch", "50um")
    refused(USAGE, "--pitch", "grey.png", "--height", "200um")
    refused(USAGE, "--channel", "grey.png", *scale, "--channel", "height=1*1um")
    refused(USAGE, "--height", "grey.png", "--pitch", "50um", "--height", "0um")
    refused(UNSUITABLE, "pitch", "grey.png", "--pitch", "0um", "--height", "200um")
    png("eight.png", rows // 257, bits=8)
    refused(UNSUITABLE, "--allow-8bit", "eight.png", *scale)
    png("colour.png", np.repeat(rows, 3, axis=1), colour=2)
    refused(UNSUITABLE, "greyscale", "colour.png", *scale)
    png("huge.png", (1 << 15, 1 << 14))
    refused(UNSUITABLE, "resample", "huge.png", *scale)
    pathlib.Path("cut.png").write_bytes(pathlib.Path("grey.png").read_bytes()[:200])
    refused(MALFORMED, "PNG", "cut.png", *scale)
    pathlib.Path("a.csv").write_text("x,z\n0,1\n1,2\n")
    refused(USAGE, "PNG", "a.csv", "--height", "200um", "--rate", "1kHz", "--channel", "signal=z*1")
    run("import", "grey.png", *scale, "-o", "grey")
    _, err = run("import", "grey.png", *scale, "-o", "grey", code=USAGE)
    assert "--force" in err, err
    write_scene("bench", patch(layers=[{"type": "height_map", "file": "grey", "kappa_n": 1}]))
    assert run_json("validate", "bench.scene.json")["valid"] is True
    with netCDF4.Dataset("grey.height.nc", "a") as file:
        file["height"][3, 5] = np.nan
    for verb in (("explain", "bench.scene.json", "--device", "sandpaper-1990"), ("info", "grey.height.nc"), ("design", "bench", "--device", "sandpaper-1990")):
        _, err = run(*verb, code=UNSUITABLE)
        assert "column 5, row 3" in err, err
    assert run_json("validate", "bench.scene.json", code=MALFORMED)["valid"] is False
    with netCDF4.Dataset("grey.height.nc", "a") as file:
        file["height"][3, 5] = 0
        file.delncattr("pitch_m")
    _, err = run("render", "bench.scene.json", "--device", "sandpaper-1990", "--finger-path", "no.csv", "-o", "x.csv", code=UNSUITABLE)
    assert "pitch" in err, err
    pathlib.Path("grey.height.nc").unlink()
    _, err = run("play", "bench.scene.json", "-d", "sim:planar", "-o", "x", code=NOT_FOUND)
    assert "grey.height.nc" in err and "import" in err, err


if __name__ == "__main__":
    for test in (a_png_becomes_a_height_map, a_profile_becomes_a_map_of_one_row, forces_are_scipys_spline, no_other_interpolant_is_worth_it, a_force_map_is_scipys_spline_and_is_replayed, force_maps_that_do_not_fit_are_refused_or_warned_of, explain_says_levels_speeds_and_memory,
                 a_large_map_is_played_and_replayed, a_map_beyond_the_memory_is_refused, a_texture_is_scipys_spline_along_its_direction, textures_that_do_not_fit_are_refused_or_warned_of,
                 bad_input_is_refused_with_its_remedy):
        tacto.in_folder(test)
