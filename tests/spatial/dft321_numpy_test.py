# SPDX-License-Identifier: GPL-3.0-or-later
"""`spatial --channel acceleration:dft321` against NumPy: the spectrum of three axes is kept, and what is said of the waveform.

The nominal position advances by four grid steps a frame, so that a sample of the texture lies at each frame and resampling adds no error.
(With fewer, a finer grid would be made first, and low-passed.)
"""
import json
import pathlib

import numpy as np
import tacto

RATE_HZ, FRAMES = 10000, 20000
USAGE, UNSUITABLE = 2, 5


def write_table(axes):
    np.savetxt("t.csv", axes.T, delimiter=",", header="ax,ay,az,f", comments="", fmt="%.17g")


def imported(*channels):
    words = [word for channel in channels for word in ("--channel", channel)]
    tacto.run("import", "t.csv", "-o", "t", "--force", "--rate", "10kHz", "--speed", "20mm/s", *words)


def texture(*more):
    printed = tacto.run_json("spatial", "t", "-o", "t", "--force", "--grid", "0.5um", "--from", "0s", "--to", f"{(FRAMES - 1) / RATE_HZ}s", *more)
    sidecar = json.loads(pathlib.Path("t.texture.json").read_text())
    values = tacto.soundfile.read("t.texture.wav", dtype="float64")[0]
    return printed, sidecar, values[::4]


def band_limited(rng, low_hz=15, high_hz=500):
    spectrum, frequency = np.fft.rfft(rng.standard_normal(FRAMES)), np.fft.rfftfreq(FRAMES, 1 / RATE_HZ)
    spectrum[(frequency < low_hz) | (frequency > high_hz)] = 0
    return np.fft.irfft(spectrum, FRAMES)


def dft321(axes):
    spectra = np.fft.rfft(axes, axis=1)
    return np.fft.irfft(np.sqrt((np.abs(spectra)**2).sum(0)) * np.exp(1j * np.angle(spectra.sum(0))), axes.shape[1])


def turning(rng, degrees):
    angle = np.deg2rad(degrees) * np.linspace(0, 1, FRAMES)
    return np.vstack([np.cos(angle), np.sin(angle), 0 * angle]) * band_limited(rng)


def the_spectrum_is_kept_and_the_waveform_named():
    rng = np.random.default_rng(1)
    found = {}
    for degrees in (0, 180):
        axes = turning(rng, degrees)
        write_table(np.vstack([axes, axes[:1]]))
        imported("x:acceleration=ax*1m/s^2", "y:acceleration=ay*1m/s^2", "z:acceleration=az*1m/s^2")
        printed, sidecar, values = texture("--channel", "acceleration:dft321", "--band", "off")
        expected = dft321(axes)
        # 32-bit samples; the times of the knots are found to some 1e-9 of a frame.
        error = np.max(np.abs(values - expected)) / np.max(np.abs(expected))
        assert values.size == FRAMES and error < 1e-6, (degrees, values.size, error)
        magnitude = np.sqrt((np.abs(np.fft.rfft(axes, axis=1))**2).sum(0))
        assert np.max(np.abs(np.abs(np.fft.rfft(values)) - magnitude)) < 1e-6 * magnitude.max(), degrees
        source = sidecar["source"]
        assert source["reduction"] == "dft321" and source["axes"] == ["x", "y", "z"] and sidecar["unit"] == "m/s^2", source
        correlation = np.linalg.norm(axes @ expected) / np.linalg.norm(axes) / np.linalg.norm(expected)
        assert abs(source["waveform_correlation"] - correlation) < 1e-9, (source, correlation)
        assert printed["textures"][0]["waveform_correlation"] == source["waveform_correlation"] and "dft321" in printed["reduction"], printed
        assert tacto.run_json("info", "t.texture.json")["waveform_correlation"] == source["waveform_correlation"]
        tacto.run("validate", "t.texture.json")
        found[degrees] = correlation
    assert abs(found[0] - 1) < 1e-9 and 0.6 < found[180] < 0.75, found  # issue 35: 0.68 where the direction turns


def the_axes_stay_raw_and_are_filtered_one_by_one():
    rng = np.random.default_rng(2)
    axes = turning(rng, 90)
    drift = np.vstack([5 + 0 * axes[0], np.linspace(0, 9, FRAMES), -9.81 + 0 * axes[0]])
    write_table(np.vstack([axes + drift, axes[:1]]))
    imported("x:acceleration=ax*1m/s^2", "y:acceleration=ay*1m/s^2", "z:acceleration=az*1m/s^2")
    stored = tacto.soundfile.read("t.wav", dtype="float64")[0]
    assert np.array_equal(stored[:, :3], np.loadtxt("t.csv", delimiter=",", skiprows=1)[:, :3])
    values = texture("--channel", "acceleration:dft321")[2]
    # The same by the textures of the single axes: the band-pass has removed gravity and drift before.
    single = np.vstack([texture("--channel", axis)[2] for axis in "xyz"])
    error = np.max(np.abs(values - dft321(single))) / np.max(np.abs(values))
    assert error < 1e-5, error


def wrong_axes_are_refused():
    rng = np.random.default_rng(3)
    write_table(np.vstack([turning(rng, 90), band_limited(rng)]))
    imported("x:acceleration=ax*1m/s^2", "y:acceleration=ay*1m/s^2")
    error = tacto.error_of("spatial", "t", "-o", "n", "--channel", "acceleration:dft321", code=UNSUITABLE)
    assert "x" in error["what"] and "y" in error["what"], error
    imported("x:acceleration=ax*1m/s^2", "y:acceleration=ay*1m/s^2", "z:acceleration=az*1m/s^2", "tangential_force=f*1N")
    error = tacto.error_of("spatial", "t", "-o", "n", "--channel", "x,y,tangential_force:dft321", code=UNSUITABLE)
    assert "tangential_force" in error["what"] and "N" in error["what"], error
    for names in ("x,y", "x,y,y", "x,y,z,x", "x,y,", "speed", ""):
        tacto.error_of("spatial", "t", "-o", "n", "--channel", names + ":dft321", code=UNSUITABLE)
    imported("x:acceleration=ax*1m/s^2", "y:acceleration=ay*1m/s^2", "z:acceleration=az*1m/s^2", "q:acceleration=f*1m/s^2")
    tacto.error_of("spatial", "t", "-o", "n", "--channel", "acceleration:dft321", code=UNSUITABLE)
    assert texture("--channel", "q,z,x:dft321")[1]["source"]["axes"] == ["q", "z", "x"]
    assert not list(pathlib.Path(".").glob("n*"))


if __name__ == "__main__":
    for test in (the_spectrum_is_kept_and_the_waveform_named, the_axes_stay_raw_and_are_filtered_one_by_one, wrong_axes_are_refused):
        tacto.in_folder(test)
