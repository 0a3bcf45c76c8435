#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The real finger: import, texture and spectrogram against SciPy on the same numbers."""
import json

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import spectrogram

import tacto
from measured import measured

FROM_S, TO_S = 4.55, 6.85


def source():
    table = np.loadtxt(tacto.BARE_FINGER, delimiter=",", skiprows=1)
    return table[:, 0] * 0.444444, table[:, 4] * 0.5e-6


def plain_truncation(force):
    spectrum = np.fft.rfft(force)
    frequency = np.fft.rfftfreq(len(force), 1e-4)
    spectrum[(frequency < 15) | (frequency > 500)] = 0
    return np.fft.irfft(spectrum, len(force))


def force_at(positions_m):
    """SciPy's f(x) = S_f(S_x^-1(x)): PCHIP both ways (time against position, force against time)."""
    force, x = source()
    t = np.arange(len(x)) * 1e-4
    stretch = slice(round(FROM_S / 1e-4), round(TO_S / 1e-4) + 1)
    assert np.all(np.diff(x[stretch]) > 0)
    time_at = PchipInterpolator(x[stretch], t[stretch])
    return PchipInterpolator(t, plain_truncation(force))(time_at(positions_m))


def texture_agrees_with_scipy():
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    tacto.run("spatial", "finger", "-o", "plain", "--from", "4.55s", "--to", "6.85s", "--filter", "fourier", "--edges", "none")
    x, f, side = tacto.texture("plain")
    wanted = force_at(side["source_origin_m"] + x)
    middle = (x >= 10e-3) & (x <= 80e-3)
    error = tacto.rms((f - wanted)[middle]) / tacto.rms(wanted[middle])
    print(f"texture against SciPy (swapped axes), 10-80 mm: {error:.2e} of the RMS")
    measured("bare_finger.texture_error", error)
    assert error < 1e-4, error  # the limit of the specification; most of the error is from exchanging the axes
    assert abs(side["pitch_m"] - 1e-6) < 1e-18 and x[-1] > 89e-3


def default_edges_do_not_ring():
    """A baseline that drifts by 1 V over the record is no texture: the default must remove it; plain truncation does
    not."""
    table = np.loadtxt(tacto.BARE_FINGER, delimiter=",", skiprows=1)
    table[:, 0] += np.linspace(0, 1, len(table))
    np.savetxt("drifting.csv", table, delimiter=",", fmt="%.6f", comments="",
               header="lateral_V,normal_V,ldv_V,current_V,encoder_count")
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    tacto.run("import", "drifting.csv", "-o", "drifting", *tacto.IMPORT_BARE_FINGER[4:])
    change = {edges: drift_felt(edges) for edges in ("treated", "none")}
    print(f"a drift of 1 V changes the texture by {change['treated']:.3%} of the RMS, plain truncation by {change['none']:.2%}")
    assert change["treated"] < 1e-3 and change["none"] > 10 * change["treated"]


def drift_felt(edges):
    stretch = ["--from", "4.55s", "--to", "6.85s", "--edges", edges, "--force"]
    tacto.run("spatial", "finger", "-o", "still", *stretch)
    tacto.run("spatial", "drifting", "-o", "moved", *stretch)
    x, still, _ = tacto.texture("still")
    _, moved, _ = tacto.texture("moved")
    middle = (x >= 10e-3) & (x <= 80e-3)
    return tacto.rms((moved - still)[middle]) / tacto.rms(still[middle])


def finger_up_is_weaker():
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    tacto.run("spatial", "finger", "-o", "down", "--from", "4.55s", "--to", "6.85s")
    tacto.run("spatial", "finger", "-o", "up", "--from", "0.3s", "--to", "2.3s")
    level = {name: band_level_db(name) for name in ("down", "up")}
    print(f"1-10 /mm: finger down {level['down']:.1f} dB, up {level['up']:.1f} dB")
    measured("bare_finger.up_weaker_db", level["down"] - level["up"])
    assert level["down"] - level["up"] > 10
    assert tacto.texture("up")[2]["direction"] == -1


def strokes_are_found_and_the_finger_up_told():
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    listed = tacto.run_json("spatial", "finger", "--list")
    assert [(stroke["direction"], stroke["finger"]) for stroke in listed["strokes"]] == [(-1, "up"), (1, "down")]
    assert 0.04 < listed["finger_up_below_n"] < 0.06, "a tenth of what the finger pressed with, 0.53 N"
    out, said = tacto.run("spatial", "finger", "-o", "found", "--json")
    assert "stroke 1" in said and "--finger-up" in said, said
    (made,) = json.loads(out)["textures"]
    assert made["stroke"] == 2 and made["file"] == "found.texture.json"
    # 15 to 500 Hz at the stage's 40 mm/s (0.375 and 12.5 /mm) in the part of constant speed; over the whole stroke,
    # whose ends are slow, from 15 Hz / 4 mm/s on.
    side = tacto.texture("found")[2]
    even = [point for point in side["valid_band"] if 0.01 < point["position_m"] < 0.08]
    assert all(abs(point["low_per_m"] / 375 - 1) < 0.02 and abs(point["high_per_m"] / 12500 - 1) < 0.02 for point in even)
    assert made["valid_low_per_m"] < 4000 and abs(made["valid_high_per_m"] / 12500 - 1) < 0.02
    assert abs(side["source"]["position_quantum_m"] - 5e-7) < 1e-13 and side["source"]["position_moved_m"] < 5.1e-7
    tacto.run("spatial", "finger", "-o", "each", "--finger-up")
    assert tacto.texture("each-01")[2]["source"]["finger_up"] is True
    tacto.run("spatial", "finger", "-o", "asked", "--stroke", "1")
    assert tacto.texture("asked")[2]["direction"] == -1


def a_finger_that_all_but_rests_makes_no_texture():
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    for more in ([], ["--grid", "10nm"]):
        _, said = tacto.run("spatial", "finger", "-o", "rest", "--from", "7.6s", "--to", "8.4s", *more, code=5)
        assert "4 um" in said, said


def band_level_db(name):
    x, f, _ = tacto.texture(name)
    power = np.abs(np.fft.rfft(f * np.hanning(len(f)))) ** 2 / len(f)
    k = np.fft.rfftfreq(len(f), 1e-3)
    return 10 * np.log10(power[(k >= 1) & (k <= 10)].mean())


def spectrogram_agrees_with_scipy():
    import xarray
    tacto.run(*tacto.IMPORT_BARE_FINGER)
    tacto.run("spatial", "finger", "-o", "oak", "--from", "4.55s", "--to", "6.85s")
    tacto.run("spectrogram", "oak", "-o", "oak.nc", "-o", "oak.png", "-o", "oak.svg", "-o", "oak.csv", "--max-frequency", "500/mm")
    _, f, _ = tacto.texture("oak")
    opened = xarray.open_dataset("oak.nc")
    density = opened["density"]
    assert opened["position"].attrs["units"] == "mm" and opened["spatial_frequency"].attrs["units"] == "1/mm"
    hop = round(opened.attrs["hop_mm"] * 1000)
    k, x, wanted = spectrogram(f, fs=1000.0, window="blackman", nperseg=10000, noverlap=10000 - hop, nfft=16384,
                               detrend="constant", scaling="density")
    assert density.shape == wanted.T.shape, (density.shape, wanted.T.shape)
    np.testing.assert_allclose(opened["spatial_frequency"], k, rtol=1e-9)
    np.testing.assert_allclose(opened["position"], x, atol=1e-6)
    strong = wanted.T > wanted.max() * 1e-6
    relative = np.abs(density.values[strong] / wanted.T[strong] - 1).max()
    print(f"spectrogram against SciPy above -60 dB: {relative:.1e} relative over {strong.sum()} cells")
    measured("bare_finger.spectrogram_error", relative)
    assert relative < 1e-4


if __name__ == "__main__":
    tacto.need_real_data()
    for test in (texture_agrees_with_scipy, default_edges_do_not_ring, finger_up_is_weaker,
                 strokes_are_found_and_the_finger_up_told, a_finger_that_all_but_rests_makes_no_texture, spectrogram_agrees_with_scipy):
        tacto.in_folder(test)
