#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The real finger: import, texture and spectrogram against SciPy on the same numbers."""
import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.signal import spectrogram

import tacto

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
    assert error < 1e-4, error  # the bar of the specification; the swap of axes itself is most of it
    assert abs(side["pitch_m"] - 1e-6) < 1e-18 and x[-1] > 89e-3


def default_edges_do_not_ring():
    """A baseline that drifts by 1 V over the record is no texture: the default must not feel it, the plain truncation does."""
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
    stretch = ["--from", "4.55s", "--to", "6.85s", "--edges", edges]
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
    assert level["down"] - level["up"] > 10
    assert tacto.texture("up")[2]["direction"] == -1


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
    assert relative < 1e-4


if __name__ == "__main__":
    tacto.need_real_data()
    for test in (texture_agrees_with_scipy, default_edges_do_not_ring, finger_up_is_weaker, spectrogram_agrees_with_scipy):
        tacto.in_folder(test)
