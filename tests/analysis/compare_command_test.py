#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`tactograph compare` as a user runs it: its figures against SciPy's, its verdicts on a real finger, and bad input."""
import json
import pathlib
import sys

import numpy as np
import soundfile
from scipy import signal

import tacto
from measured import measured, not_measured

PITCH = 10e-6


def write_texture(stem, values, pitch=PITCH, **more):
    """Writes a texture by hand; the sidecar's checksum is the WAV's."""
    import hashlib
    path = pathlib.Path(f"{stem}.texture.wav")
    soundfile.write(path, np.asarray(values, dtype=np.float32), round(1 / pitch), subtype="FLOAT", format="WAV")
    data = {**TEMPLATE["data"], "file": path.name, "sha256": hashlib.sha256(path.read_bytes()).hexdigest(), "samples": len(values)}
    data.pop("numbers_sha256", None)  # as another program writes it
    side = {**TEMPLATE, "data": data, "pitch_m": pitch, **more}
    pathlib.Path(f"{stem}.texture.json").write_text(json.dumps(side))


def make_template():
    """The other members of a sidecar, taken from one that the command made."""
    global TEMPLATE
    tacto.run("record", "-d", "sim:surface=A,speed=50mm/s,seed=77", "--strokes", "1", "-o", "model", "--no-calibration")
    tacto.run("spatial", "model", "-o", "model")
    side = json.loads(pathlib.Path("model.texture.json").read_text())
    side["valid_band"] = [{"position_m": 0.0, "low_per_m": 100.0, "high_per_m": 40000.0}]
    TEMPLATE = side


def pair(ratio=0.3, count=9000):
    random = np.random.default_rng(1)
    a = signal.lfilter([0.02], [1, -0.8], random.normal(size=count))
    b = 1.5 * a + np.sqrt(ratio) * np.std(a) * random.normal(size=count)
    return a.astype(np.float32).astype(float), b.astype(np.float32).astype(float)


def figures_agree_with_scipy():
    make_template()
    a, b = pair()
    write_texture("a", a)
    write_texture("b", b)
    found = tacto.run_json("compare", "a", "b")
    window = round(found["window_m"] / PITCH)
    options = dict(fs=1 / PITCH, window="hann", nperseg=window, noverlap=window // 2, detrend="constant")
    k, aa = signal.welch(a, **options)
    _, bb = signal.welch(b, **options)
    _, ab = signal.csd(a, b, **options)
    _, ee = signal.welch(b - a, **options)
    _, coherence = signal.coherence(a, b, **options)
    low, high = found["low_per_m"], found["high_per_m"]

    def integral(density, lower, upper):
        width = np.minimum(upper, k + k[1] / 2) - np.maximum(lower, k - k[1] / 2)
        return np.sum(density * np.maximum(0, width))

    worst = 0
    for band in found["bands"]:
        edges = max(low, band["centre_per_m"] / 10**0.05), min(high, band["centre_per_m"] * 10**0.05)
        wanted = 10 * np.log10(integral(bb, *edges) / integral(aa, *edges))
        error = 10 * np.log10(integral(ee, *edges) / integral(aa, *edges))
        shared = integral(aa * coherence, *edges) / integral(aa, *edges)
        worst = max(worst, abs(band["level_db"] - wanted), abs(band["error_db"] - error), abs(band["coherence"] - shared))
    gain = integral(ab.real, low, high) / integral(aa, low, high)
    whole = integral(aa * coherence, low, high) / integral(aa, low, high)
    print(f"{len(found['bands'])} bands, worst difference from SciPy {worst:.1e} (dB, or of coherence); gain {gain:.4f}")
    assert worst < 1e-6 and abs(found["gain"] - gain) < 1e-9 and abs(found["coherence"] - whole) < 1e-9
    distance = np.sqrt(np.mean([band["level_db"]**2 for band in found["bands"]]))
    assert abs(found["spectral_distance_db"] - distance) < 1e-9


def files_come_together():
    make_template()
    a, b = pair()
    write_texture("a", a)
    write_texture("b", 2 * a)
    report = tacto.run_json("compare", "a", "b", "--page", "ab.html", "-o", "ab.results.json")
    assert report["beyond_measurement_noise"] == "louder" and abs(report["level_db"] - 20 * np.log10(2)) < 1e-5
    page = pathlib.Path("ab.html").read_text()
    assert page.count("data:image/svg+xml") == 4 and '="http' not in page and "simulated" in page.lower()
    tacto.run("validate", "ab.results.json")
    stored = json.loads(pathlib.Path("ab.results.json").read_text())
    assert stored["details"]["level_db"] == report["level_db"] and stored["kind"] == "results"
    tacto.run("compare", "a", "b", "-o", "ab.html", "-o", "ab.results.json", "--force")  # both are replaced
    before = pathlib.Path("a.texture.json").read_bytes()
    assert tacto.error_of("compare", "a", "b", "-o", "a.texture.json", code=2)["where"] == "a.texture.json"
    assert pathlib.Path("a.texture.json").read_bytes() == before
    tacto.run("compare", "a", "b", "-o", "ab.txt", code=2)


def a_narrow_difference_is_named():
    """6 dB over 2-2.6 /mm, in independent noise of 60 mm; the window's cells are 0.13 /mm wide."""
    make_template()
    random = np.random.default_rng(3)
    def noise():
        return random.normal(size=6000)
    bump = signal.sosfilt(signal.butter(8, [2000, 2600], "bandpass", fs=1 / PITCH, output="sos"), noise())
    plain = noise()
    write_texture("a", noise())
    write_texture("b", plain + np.sqrt(3) * bump)
    found = tacto.run_json("compare", "a", "b")
    assert found["beyond_measurement_noise"] == "different" and found["band_differs"], found["because"]
    assert found["band_low_per_m"] < 2300 < found["band_high_per_m"] and 3 < found["band_level_db"] < 9
    assert "/mm B is" in found["because"]
    write_texture("c", plain)
    found = tacto.run_json("compare", "a", "c")
    assert found["beyond_measurement_noise"] == "none" and not found["band_differs"] and not found["line_differs"]
    widths = [row["width_per_m"] for row in found["detectable_bands"]]
    levels = [row["level_db"] for row in found["detectable_bands"]]
    assert widths == sorted(widths) and min(levels) > 2 and found["detectable_line_db"] > 2
    assert "8 of 10" in found["detectable"]


def one_texture_twice_differs_in_no_band():
    make_template()
    write_texture("one", pair()[0])
    same = tacto.run_json("compare", "one", "one")
    assert same["beyond_measurement_noise"] == "none" and not same["band_differs"] and same["band_level_db"] == 0, same
    assert same["low_per_m"] <= same["band_low_per_m"] < same["band_high_per_m"] <= same["high_per_m"], same


def with_output_all_is_printed_too():
    make_template()
    a, b = pair()
    write_texture("a", a)
    write_texture("b", b)
    shown, _ = tacto.run("compare", "a", "b", "-o", "ab.html")
    labels = [line.split("  ")[0] for line in shown.splitlines()]
    assert {"beyond measurement noise", "because", "detectable", "rms band", "written", "bands"} <= set(labels), shown
    found = tacto.run_json("compare", "a", "b", "-o", "ab.results.json")
    assert found["written"] == ["ab.results.json"] and found["bands"]
    in_band = signal.welch(a, 1 / PITCH, "hann", round(found["window_m"] / PITCH), detrend="constant")[1]
    assert 0 < found["a_rms_n"] < 1.1 * np.sqrt(np.sum(in_band) / (found["window_m"])), "of the compared band alone"
    # The page's spectra are in N^2 mm, as spectrograms: their integral over 1/mm is the square of the RMS in N.
    spectra = json.loads(pathlib.Path("ab.results.json").read_text())["pictures"][0]
    assert spectra["y_label"].endswith("(dB re 1 N² mm)"), spectra["y_label"]
    x, y = (np.array(spectra["curves"][0][axis]) for axis in "xy")
    assert abs(np.trapz(10 ** (y / 10), x) / found["a_rms_n"] ** 2 - 1) < 0.1, "the curve has steps of a 200th decade"


def a_session_is_held_against_its_texture():
    make_template()
    write_texture("a", pair()[0])
    pathlib.Path("path.csv").write_text("time_s,position_m\n0,0\n1.2,0.085\n")
    tacto.run("play", "a", "-d", "sim:seed=78", "--finger-path", "path.csv", "--gain", "0.2mm/N", "-o", "first")
    found = tacto.run_json("compare", "first.session", "a")
    print(f"session against its texture: error {found['error_db']:.1f} dB, gain {found['gain']:.3f}")
    assert found["error_db"] < -20 and found["point_by_point"] and abs(found["gain"] - 1) < 0.05
    assert "verdict" not in found and "beyond_measurement_noise" not in found, "an error, no verdict"
    tacto.run("compare", "first.session", "a", "-o", "first.html", "-o", "first.results.json")
    tacto.run("compare", "first.session", "a", "--align", "none", code=2)
    write_texture("other", pair()[1])
    _, said = tacto.run("compare", "first.session", "other", code=5)
    assert "session" in said


STROKE_PITCH = 40e-6


def stroke_levels(values, edges):
    """One-sixth-octave levels by four sine tapers, from the definition."""
    n = len(values)
    taper = np.sqrt(2 / (n + 1)) * np.sin(np.pi * np.outer(np.arange(1, 5), np.arange(1, n + 1)) / (n + 1))
    density = 2 * STROKE_PITCH * np.mean(np.abs(np.fft.rfft(taper * (values - np.mean(values)), axis=1))**2, axis=0)
    k = np.fft.rfftfreq(n, STROKE_PITCH)
    step = k[1]
    return [10 * np.log10(np.sum(density * np.clip(np.minimum(high, k + step / 2) - np.maximum(low, k - step / 2), 0, None)))
            for low, high in zip(edges, edges[1:])]


def label_statistics(levels, in_b, null):
    """D, its standard error, the largest moderated t^2 and the regularised Hotelling statistic, from their formulas, by least squares."""
    n, bands = levels.shape
    freedom = n - np.linalg.matrix_rank(null) - 1

    def fit(values):
        design = np.column_stack([null, in_b])
        left = values - design @ np.linalg.lstsq(design, values, rcond=None)[0]
        return np.linalg.lstsq(design, values, rcond=None)[0][-1], left
    x = in_b - null @ np.linalg.lstsq(null, in_b, rcond=None)[0]
    t, singles = [], None
    for width in range(1, min(12, bands) + 1):
        windows = np.column_stack([levels[:, i:i + width].mean(axis=1) for i in range(bands - width + 1)])
        difference, left = fit(windows)
        variance = (left**2).sum(axis=0) / freedom
        error = np.sqrt((4 * variance.mean() + freedom * variance) / (4 + freedom) / (x @ x))
        t.append(np.max((difference / error)**2))
        if width == 1:
            singles = difference, error, left
    difference, error, left = singles
    scale = np.sqrt((left**2).sum(axis=0))
    matrix = 0.7 * (left.T @ left) / np.outer(scale, scale) + 0.3 * np.eye(bands)
    ratio = difference / error
    return difference, error, max(t), ratio @ np.linalg.solve(matrix, ratio)


def write_strokes(name, random, count, raised=0):
    """Strokes there and back of noise; their lowest frequency tells their speed. Returns them with speed, load, direction."""
    rows = []
    for i in range(count):
        values = (random.normal(size=800) * 10**(random.normal() * 1.5 / 20)).astype(np.float32)
        if raised:
            spectrum, k = np.fft.rfft(values), np.fft.rfftfreq(800, STROKE_PITCH)
            values = np.fft.irfft(spectrum * np.where((k > 2000) & (k < 2600), 10**(raised / 20), 1), 800).astype(np.float32)
        speed, load, direction = 0.05 * np.exp(0.05 * random.normal()), 0.5 * np.exp(0.05 * random.normal()), 1 - 2 * (i % 2)
        source = {**TEMPLATE["source"], "recording_sha256": name.encode().hex().ljust(64, "0"), "from_s": float(i), "to_s": i + 0.9, "low_hz": 15.0,
                  "mean_speed_mps": speed, "normal_force_n": load, "stroke": i + 1}
        write_texture(f"{name}-{i + 1:02}", values, STROKE_PITCH, source=source, direction=direction,
                      valid_band=[{"position_m": 0.0, "low_per_m": 15 / speed, "high_per_m": 10000.0}])
        rows.append((values.astype(float), speed, load, direction))
    return rows


def surfaces_agree_with_numpy():
    make_template()
    random = np.random.default_rng(8)
    a, b = write_strokes("oak", random, 7), write_strokes("pine", random, 8, raised=8)
    found = tacto.run_json("compare", "oak", "pine", "-o", "woods.html", "-o", "woods.results.json")
    rows = a + b
    lowest = max(15 / row[1] for row in rows)
    number = np.arange(np.ceil(20 * np.log10(lowest / 1000)), 21)
    edges = 1000 * 10**(number / 20)
    assert np.allclose([band["low_per_m"] for band in found["bands"]], edges[:-1], rtol=1e-12)
    levels = np.array([stroke_levels(row[0], edges) for row in rows])
    in_b = np.r_[np.zeros(len(a)), np.ones(len(b))]
    way = np.array([row[3] for row in rows])
    null = np.column_stack([way > 0, way < 0, np.log([row[1] for row in rows]), np.log([row[2] for row in rows])]).astype(float)
    difference, error, window, shape = label_statistics(levels, in_b, null)
    level = np.array([band["level_db"] for band in found["bands"]])
    errors = np.array([band["standard_error_db"] for band in found["bands"]])
    worst = max(np.abs(level - difference).max(), np.abs(errors / error - 1).max(), abs(found["window_statistic"] / window - 1),
                abs(found["shape_statistic"] / shape - 1))
    print(f"worst difference from NumPy {worst:.1e}; p {found['p']}, window {window:.1f}, shape {shape:.1f}")
    assert worst < 1e-7  # rounding: the float samples are the same; 1e-9 dB^2 are added to each variance
    assert found["verdict"] == "different" and found["p"] <= 0.05 and found["unit"] == "stroke"
    assert (found["a_strokes"], found["b_strokes"], found["a_recordings"], found["b_recordings"]) == (7, 8, 1, 1)
    assert found["band_low_per_m"] < 2400 and found["band_high_per_m"] > 2200
    assert found["band_level_low_db"] < found["band_level_db"] < found["band_level_high_db"]
    tacto.run("validate", "woods.results.json")
    assert pathlib.Path("woods.html").read_text().count("data:image/svg+xml") == 2
    again = tacto.run_json("compare", "oak", "pine")
    assert again["p"] == found["p"], "the exchanges are seeded"


def sides_are_lists():
    make_template()
    random = np.random.default_rng(9)
    for i in range(4):
        write_strokes(f"oak{i}", random, 5)
        write_strokes(f"elm{i}", random, 5)
    oak, elm = [f"oak{i}" for i in range(4)], [f"elm{i}" for i in range(4)]
    found = tacto.run_json("compare", "--a", *oak, "--b", *elm)
    assert found["unit"] == "recording" and found["verdict"] == "no difference found" and found["a_recordings"] == 4
    assert not found["holds_for_these_recordings_only"]
    found = tacto.run_json("compare", "--a", *oak[:3], "--b", *elm[:3])
    assert found["unit"] == "stroke" and found["holds_for_these_recordings_only"] and found["a_strokes"] == 15
    for count, limited in ((4, False), (3, True)):
        verdict = next(line for line in tacto.run("compare", "--a", *oak[:count], "--b", *elm[:count])[0].splitlines() if line.startswith("verdict"))
        assert ("these recordings" in verdict) == limited, verdict
    found = tacto.run_json("compare", "--a", "oak0-01", "--b", "elm0-01")
    assert found["verdict"] == "undecided", "a list is a side of a surface, also of one stroke"
    tacto.run("compare", "--a", *oak, "--b", "elm0", "oak0", code=2)  # on both sides
    tacto.run("compare", "oak0", "elm0", "--a", "oak1", "--b", "elm1", code=2)
    tacto.run("compare", "--a", "oak0", code=2)
    tacto.run("compare", code=2)
    assert "beyond_measurement_noise" in tacto.run_json("compare", "oak0", "elm0", "--stroke-a", "1", "--stroke-b", "2")


def a_recording_gives_its_strokes():
    for seed in (3, 4):
        tacto.run("record", "-d", f"sim:surface=C,strokes=8,seed={seed}", "--strokes", "6", "-o", f"C{seed}", "--no-calibration")
    tacto.run("record", "-d", "sim:surface=E,strokes=8,seed=5", "--strokes", "6", "-o", "E", "--no-calibration")
    found = tacto.run_json("compare", "C3", "E")
    assert found["verdict"] == "different" and found["a_strokes"] == 6 and "a_simulated" in found
    tacto.run("spatial", "C3", "-o", "strokes")
    textures = tacto.run_json("compare", "strokes", "E")
    assert abs(textures["band_level_db"] - found["band_level_db"]) < 1e-4, "32-bit textures of the same strokes"
    tacto.run("compare", "strokes", "C3", code=2)  # the same strokes
    assert tacto.run_json("compare", "C3", "C4")["a_load_n"] > 0.4


def more_than_two_give_all_pairs():
    make_template()
    rng = np.random.default_rng(9)
    names = ["first", "second", "third"]
    for i, name in enumerate(names):
        write_texture(name, rng.normal(0, 0.01 * (i + 1), 9000))
    printed = tacto.run_json("compare", *names)
    pairs = [(names[i], names[j]) for i in range(3) for j in range(i + 1, 3)]
    assert [(pair["a"], pair["b"]) for pair in printed["pairs"]] == pairs, printed["pairs"]
    for pair in printed["pairs"]:
        alone = tacto.run_json("compare", pair["a"], pair["b"])
        assert (pair["beyond_measurement_noise"], pair["spectral_distance_db"]) == (alone["beyond_measurement_noise"], alone["spectral_distance_db"]), (pair, alone)
        row = printed["matrix"][names.index(pair["a"])]
        assert row["input"] == pair["a"] and row[f"{names.index(pair['b']) + 1}_db"] == alone["spectral_distance_db"], row
    for surface in "CE":
        tacto.run("record", "-d", f"sim:surface={surface},strokes=6", "--strokes", "6", "-o", surface)
    tacto.run("record", "-d", "sim:surface=C,strokes=6,seed=2", "--strokes", "6", "-o", "C2")
    printed = tacto.run_json("compare", "C", "C2", "E")
    alone = tacto.run_json("compare", "C", "E")
    last = printed["pairs"][1]
    assert (last["a"], last["b"], last["verdict"], last["p"]) == ("C", "E", alone["verdict"], alone["p"]), (last, alone)
    assert printed["matrix"][0]["3"] == alone["verdict"] and printed["matrix"][2] == {"number": 3, "input": "E"}, printed["matrix"]
    tacto.run("compare", *names, "-o", "x.html", code=2)
    tacto.run("compare", "first", "second", "first", code=2)


def bad_input_is_refused():
    make_template()
    a, b = pair()
    write_texture("a", a)
    poisoned = b.copy()
    poisoned[1234] = np.nan
    write_texture("nan", poisoned)
    _, said = tacto.run("compare", "a", "nan", code=4)
    assert "1234" in said, said
    write_texture("heights", b, quantity="height", unit="m")
    _, said = tacto.run("compare", "a", "heights", code=5)
    assert "height" in said and "tangential_force" in said, said
    write_texture("short", b[:40])
    tacto.run("compare", "a", "short", code=5)
    write_texture("slow", b, valid_band=[{"position_m": 0, "low_per_m": 10, "high_per_m": 90}])
    tacto.run("compare", "a", "slow", code=5)
    write_texture("coarse", signal.resample_poly(a, 2, 5), pitch=25e-6)
    _, said = tacto.run("compare", "a", "coarse")
    assert "on the coarser one" in said, said
    tacto.run("compare", "a", "nothing", code=3)
    tacto.run("compare", "a", code=2)
    tacto.run("compare", "a", "b", "--b", "a", code=2)
    tacto.run("compare", "a", "a", "--tolerance", "2", code=2)
    tacto.run("compare", "a", "a", "--max-shift", "3s", code=2)


def real_fingers_verdicts():
    if not tacto.BARE_FINGER.exists():
        not_measured("compare_command.*", "no real data")
        return
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    for name, start, end in [("first", 4.55, 5.2), ("second", 5.2, 5.85), ("rough", 5.95, 6.85), ("down", 4.55, 6.85), ("up", 0.3, 2.3)]:
        tacto.run("spatial", "finger", "-o", name, "--from", f"{start}s", "--to", f"{end}s", "--force")
    def verdict(a, b, figures=("level_db", "shape_db")):
        found = tacto.run_json("compare", a, b)
        print(f"{a} against {b}: {found['beyond_measurement_noise']}: {found['because']}")
        for figure in figures:
            measured(f"compare_command.{a}_{b}.{figure}", found[figure])
        return found["beyond_measurement_noise"]
    all_figures = ("level_db", "level_low_db", "level_high_db", "shape_db", "shape_chance_db")
    assert verdict("first", "second", all_figures) == "none", "both lie before the plate gets rougher at 5.9 s"
    assert verdict("first", "rough") == "different" and verdict("second", "rough") == "different"
    assert verdict("down", "up") == "different"
    x, values, side = tacto.texture("down")
    global TEMPLATE
    TEMPLATE = side
    write_texture("gain", 2 * values, pitch=side["pitch_m"])
    assert verdict("down", "gain", ()) == "louder" and verdict("gain", "down", ()) == "quieter"


if __name__ == "__main__":
    for test in (figures_agree_with_scipy, files_come_together, a_narrow_difference_is_named, one_texture_twice_differs_in_no_band, with_output_all_is_printed_too, a_session_is_held_against_its_texture, surfaces_agree_with_numpy, sides_are_lists,
                 a_recording_gives_its_strokes, more_than_two_give_all_pairs, bad_input_is_refused,
                 real_fingers_verdicts):
        tacto.in_folder(test)
    sys.exit(0)
