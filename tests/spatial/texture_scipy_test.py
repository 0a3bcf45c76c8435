# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures of the real bare-finger recording, made by the command, against SciPy.

SciPy's side reads the CSV itself, truncates the Fourier transform of the whole record, and resamples to space in two
ways: with exchanged axes (PCHIP of time over position) and by the true inverse of the PCHIP of position over time.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import soundfile
from scipy.interpolate import PchipInterpolator
from scipy.signal import butter, fftconvolve, sosfiltfilt, welch

from measured import measured

COMMAND = os.environ["TACTOGRAPH"]
CSV = pathlib.Path(os.environ["TACTO_DATA"]) / "bare-finger/bare_finger_10kHz.csv"
RATE_HZ = 10000


def run(*arguments, code=0):
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, (arguments, done.returncode, done.stderr)
    return done


def import_finger(folder):
    run("import", CSV, "--rate", "10kHz", "--channel", "tangential_force=lateral_V*0.4444444444444444N",
        "--channel", "normal_force=normal_V*-0.31+1.6647N", "--channel", "position=encoder_count*0.5um",
        "-o", folder / "finger")


def texture(folder, name):
    sidecar = json.loads((folder / f"{name}.texture.json").read_text())
    values, rate = soundfile.read(folder / f"{name}.texture.wav", dtype="float64")
    assert rate == round(1 / sidecar["pitch_m"])
    return sidecar, sidecar["source_origin_m"] + sidecar["pitch_m"] * np.arange(values.size), values


def truncated(values, low_hz, high_hz):
    spectrum, frequency = np.fft.rfft(values), np.fft.rfftfreq(values.size, 1 / RATE_HZ)
    spectrum[(frequency < low_hz) | (frequency > high_hz)] = 0
    return np.fft.irfft(spectrum, values.size)


def true_inverse(curve, low, high, wanted):
    low, high = np.full(wanted.shape, low), np.full(wanted.shape, high)
    for _ in range(60):
        middle = (low + high) / 2
        below = curve(middle) < wanted
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return (low + high) / 2


def rms(values):
    return np.sqrt(np.mean(values**2))


def check_against_scipy(folder, force, position):
    run("spatial", folder / "finger", "--from", "4.55s", "--to", "6.85s", "--filter", "fourier", "--edges", "none",
        "-o", folder / "plain")
    sidecar, at_m, values = texture(folder, "plain")
    assert sidecar["source"]["position_moved_m"] == 0, "the stretch is strictly monotone as it stands"
    t = np.arange(force.size) / RATE_HZ
    force_at = PchipInterpolator(t, truncated(force, 15, 500))
    frames = slice(45500, 68501)
    x, t = position[frames], t[frames]
    assert np.all(np.diff(x) > 0)
    inside = (at_m >= x[0] + 0.010) & (at_m <= x[0] + 0.080)
    errors = {}
    for way, when in [("true inverse", true_inverse(PchipInterpolator(t, x), t[0], t[-1], at_m[inside])),
                      ("axes swapped", PchipInterpolator(x, t)(at_m[inside]))]:
        expected = force_at(when)
        errors[way] = rms(values[inside] - expected) / rms(expected)
    print("against SciPy, re the RMS:", errors)
    measured("texture_scipy.true_inverse_error", errors["true inverse"])
    # The WAV holds 32-bit floats: 3e-8 of each value.
    assert errors["true inverse"] < 1e-6, errors
    assert errors["axes swapped"] < 1e-4, errors
    return values, inside


def check_butterworth(folder, force, position):
    run("spatial", folder / "finger", "--from", "4.55s", "--to", "6.85s", "--filter", "butterworth", "--order", "3",
        "--edges", "none", "--low", "20Hz", "--high", "400Hz", "-o", folder / "butter")
    sidecar, at_m, values = texture(folder, "butter")
    assert sidecar["source"]["order"] == 3 and sidecar["source"]["low_hz"] == 20
    filtered = sosfiltfilt(butter(3, [20, 400], "bandpass", fs=RATE_HZ, output="sos"), force)
    t = np.arange(force.size) / RATE_HZ
    curve = PchipInterpolator(t[45500:68501], position[45500:68501])
    expected = PchipInterpolator(t, filtered)(true_inverse(curve, t[45500], t[68500], at_m))
    assert rms(values - expected) < 1e-6 * rms(expected)


def ideal_band_pass(values, low_hz, high_hz):
    """Convolution with the ideal kernel: no bins; the ends are brought to one level, so that there is no step."""
    level = values - np.linspace(values[:200].mean(), values[-200:].mean(), values.size)
    t = np.arange(1 - values.size, values.size) / RATE_HZ
    kernel = (2 * high_hz * np.sinc(2 * high_hz * t) - 2 * low_hz * np.sinc(2 * low_hz * t)) / RATE_HZ
    return fftconvolve(level, kernel)[values.size - 1:2 * values.size - 1]


def check_treated_ends(folder, force, position, plain, inside):
    run("spatial", folder / "finger", "--from", "4.55s", "--to", "6.85s", "-o", folder / "treated")
    sidecar, at_m, values = texture(folder, "treated")
    assert sidecar["source"]["edges"] == "treated"
    t = np.arange(force.size)
    frames = slice(45500, 68501)
    when = PchipInterpolator(position[frames], t[frames])(at_m[inside])
    ideal = PchipInterpolator(t, ideal_band_pass(force, 15, 500))(when)
    treated_error, plain_error = (rms(each[inside] - ideal) / rms(ideal) for each in (values, plain))
    print(f"off the ideal band-pass between 10 and 80 mm: {treated_error:.2%} of the RMS, plain {plain_error:.2%}")
    assert treated_error < 0.002
    assert plain_error > 0.02


def band_power(values):
    frequency, density = welch(values, fs=1000, nperseg=10000)
    return density[(frequency >= 1) & (frequency <= 10)].sum()


def check_finger_up(folder):
    run("spatial", folder / "finger", "--from", "0.3s", "--to", "2.3s", "-o", folder / "up")
    up, down = texture(folder, "up"), texture(folder, "treated")
    assert up[0]["direction"] == -1 and down[0]["direction"] == 1
    weaker_db = 10 * np.log10(band_power(down[2]) / band_power(up[2]))
    print(f"finger up is {weaker_db:.1f} dB weaker between 1 and 10 /mm")
    assert weaker_db > 10


def check_strokes(folder):
    listed = json.loads(run("spatial", folder / "finger", "--list", "--json").stdout)["strokes"]
    assert [stroke["direction"] for stroke in listed] == [-1, 1]
    assert listed[0]["normal_force_n"] < 0.05 < 0.4 < listed[1]["normal_force_n"]
    report = json.loads(run("spatial", folder / "finger", "-o", folder / "all", "--finger-up", "--json").stdout)
    assert [pathlib.Path(t["file"]).name for t in report["textures"]] == ["all-01.texture.json", "all-02.texture.json"]
    second, _, values = texture(folder, "all-02")
    assert second["source"]["stroke"] == 2 and abs(values.size - 91000) < 1000
    band = second["valid_band"]
    gaps = np.diff([point["position_m"] for point in band])
    assert np.all(gaps > 0) and len(band) < 500
    steady = [point for point in band if 0.02 < point["position_m"] < 0.07]
    assert all(abs(point["high_per_m"] - 500 / 0.04) < 0.05 * 500 / 0.04 for point in steady)


def check_refusals(folder):
    before = sorted(path.name for path in folder.iterdir())

    def refused(words, code, *arguments):
        line = run("spatial", folder / "finger", "-o", folder / "no", *arguments, code=code).stderr.strip()
        assert "\n" not in line and all(word in line for word in words), line

    refused(["stroke 3", "1:", "2:"], 5, "--stroke", "3")
    refused(["not within the recording", "8.5"], 5, "--from", "8s", "--to", "9s")
    refused(["reverses"], 5, "--from", "1s", "--to", "6s")
    refused(["does not advance"], 5, "--from", "4.2s", "--to", "4.25s")
    refused(["less than one period"], 5, "--from", "5s", "--to", "5.01s")
    refused(["5000 Hz"], 5, "--band", "15Hz..6kHz")
    refused(["unit"], 2, "--band", "15..500")
    refused(["15Hz..500Hz"], 2, "--band", "15Hz")
    refused(["1e9"], 5, "--stroke", "2", "--grid", "0.00001nm")
    refused(["transducer"], 5, "--equalise", "on")
    refused(["tangential_force"], 5, "--channel", "drive")
    assert sorted(path.name for path in folder.iterdir()) == before
    run("spatial", folder / "finger", "--from", "5s", "--to", "5.01s", "--band", "off", "-o", folder / "short")
    run("spatial", folder / "finger", "--stroke", "2", "-o", folder / "finger.json" / "x", code=7)  # below a file no folder can be made


def main():
    if not CSV.exists():
        print("skipped: no real data")
        return 77
    table = np.genfromtxt(CSV, delimiter=",", names=True)
    force, position = table["lateral_V"] * (4 / 9), table["encoder_count"] * 0.5e-6
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        import_finger(folder)
        plain, inside = check_against_scipy(folder, force, position)
        check_butterworth(folder, force, position)
        check_treated_ends(folder, force, position, plain, inside)
        check_finger_up(folder)
        check_strokes(folder)
        check_refusals(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
