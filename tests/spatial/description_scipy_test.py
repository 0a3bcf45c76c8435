#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""`describe` against SciPy's Welch spectrum and NumPy's regression on the same textures."""
import csv
import json
import pathlib

import numpy as np
from scipy.signal import welch

import tacto


def textures():
    """Simulated strokes: two surfaces of the emulated device."""
    for surface, seed in (("C", 1), ("E", 2)):
        tacto.run("record", "-d", f"sim:surface={surface},speed=50mm/s,seed={seed}", "--time", "2s", "-o", surface)
        tacto.run("spatial", surface, "-o", surface, "--stroke", "1")
    return "C", "E"


def spectrum(each):
    _, values, side = tacto.texture(each["texture"])
    window = round(each["window_m"] / side["pitch_m"])
    first, last = (round(each[end] / side["pitch_m"]) for end in ("from_m", "to_m"))
    k, density = welch(values[first:last + 1], 1 / side["pitch_m"], "hann", nperseg=window, detrend="constant", scaling="density")
    return k, density


def integral(k, density, low, high, power=0):
    """Of k^power S, the density constant within half a bin of each bin."""
    step = k[1]
    left = np.clip(k - step / 2, low, high)
    right = np.clip(k + step / 2, low, high)
    return float(np.sum(density * (right ** (power + 1) - left ** (power + 1)) / (power + 1)))


def slope(k, density, low, high):
    x, y, w = [], [], []
    for number in range(-40, 60):
        centre = 1000 * 10 ** (number / 10)
        a, b = max(low, centre * 10 ** -0.05), min(high, centre * 10 ** 0.05)
        if a < b:
            x.append(np.log2(np.sqrt(a * b)))
            y.append(10 * np.log10(integral(k, density, a, b) / (b - a)))
            w.append(np.log2(b / a))
    return np.polyfit(x, y, 1, w=np.sqrt(w))[0]


def agrees_with_scipy():
    names = textures()
    tacto.run("describe", *names, "-o", "both.json", "--window", "12mm")
    for each in json.loads(pathlib.Path("both.json").read_text())["textures"]:
        side = tacto.texture(each["texture"])[2]
        k, density = spectrum(each)
        low, high = each["low_per_m"], each["high_per_m"]
        lows = [p["low_per_m"] for p in side["valid_band"] if each["from_m"] <= p["position_m"] <= each["to_m"]]
        assert low >= max(lows) * (1 - 1e-12) and each["to_m"] - each["from_m"] > 0.02, each
        power = integral(k, density, low, high)
        # Sums of 1e5 float32 samples in double precision: 1e-9 is ten times the measured error.
        np.testing.assert_allclose(each["rms"], np.sqrt(power), rtol=1e-9)
        np.testing.assert_allclose(each["centroid_per_m"], integral(k, density, low, high, 1) / power, rtol=1e-9)
        np.testing.assert_allclose(each["slope_db_per_octave"], slope(k, density, low, high), rtol=1e-7)
        for band in each["bands"]:
            a, b = max(low, band["low_per_m"]), min(high, band["high_per_m"])
            np.testing.assert_allclose(band["rms"], np.sqrt(integral(k, density, a, b)), rtol=1e-9)
        total = sum(band["rms"] ** 2 for band in each["bands"])
        np.testing.assert_allclose(total, each["rms"] ** 2, rtol=1e-12)
        print(f"{each['texture']}: RMS {each['rms']:.4g}, centroid {each['centroid_per_m']:.4g}/m, slope "
              f"{each['slope_db_per_octave']:.3f} dB per octave, as SciPy has them")


def table_has_one_row_a_texture():
    names = textures()
    tacto.run("describe", *names, "-o", "both.csv")
    rows = list(csv.DictReader(open("both.csv")))
    assert [row["texture"] for row in rows] == list(names)
    report = tacto.run_json("describe", *names)
    for row, each in zip(rows, report["textures"]):
        np.testing.assert_allclose(float(row["rms (N)"]), each["rms_n"], rtol=1e-8)
        np.testing.assert_allclose(float(row["centroid_per_mm"]), each["centroid_per_m"] / 1e3, rtol=1e-8)
        assert row["partial at 1/mm"] == "0"


if __name__ == "__main__":
    for test in (agrees_with_scipy, table_has_one_row_a_texture):
        tacto.in_folder(test)
