#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rendered drive, through the paper's actuator implemented here in SciPy, gives the target displacement."""
import numpy as np
import soundfile
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.signal import TransferFunction, butter, freqresp, freqs

import tacto
from measured import measured

RATE, GAIN = 10000, 1e-3


def actuator(frequency_hz):
    """Table I of Wiertlewski 2011, corrected as in CONTRIBUTING.md, scaled to 20 um/V at DC; unloaded."""
    beta, kp, kr, m, br, cp, ra = 82.35e-6 / 200, 76.47e3, 4.05e3, 6.8e-3, 4.49, 818e-9, 680.0
    mechanics = TransferFunction([2 * beta * kp], [m, br, kr + kp])
    stage = TransferFunction([20.0], [2 * ra * cp, 1])
    response = lambda f: freqresp(mechanics, 2 * np.pi * f)[1] * freqresp(stage, 2 * np.pi * f)[1]
    return response(np.asarray(frequency_hz)) * 20e-6 / abs(response(np.array([1e-6]))[0])


def finger_path():
    """Back and forth within the texture, speeds up to 60 mm/s and through zero, 1.6 s."""
    t = np.arange(0, 1.6, 1e-3)
    x = 17e-3 - 13e-3 * np.cos(2 * np.pi * t / 1.6) + 1e-3 * np.sin(2 * np.pi * 1.5 * t)
    np.savetxt("path.csv", np.column_stack([t, x]), delimiter=",", header="time_s,position_m", comments="", fmt="%.9f")
    return t, x


def band(signal, rate):
    spectrum = np.fft.rfft(signal)
    f = np.fft.rfftfreq(len(signal), 1 / rate)
    spectrum[(f < 15) | (f > 500)] = 0
    return spectrum, f


def wanted(name, n):
    """Gain times the texture under the finger, computed at 20 times the rate, so that nothing aliases into the band."""
    t, x = finger_path()
    fine = np.arange(n * 20) / (RATE * 20)
    position = PchipInterpolator(t, x)(np.minimum(fine, t[-1]))
    at, force, _ = tacto.texture(name)
    displacement = GAIN * CubicSpline(at, force)(position)
    spectrum, f = band(displacement, RATE * 20)
    return np.fft.irfft(spectrum[: n // 2 + 1], n) / 20


def error_after_delay(result, reference, delay_s, settle=1000):
    spectrum = np.fft.rfft(result)
    f = np.fft.rfftfreq(len(result), 1 / RATE)
    advanced = np.fft.irfft(spectrum * np.exp(2j * np.pi * f * delay_s), len(result))
    inner = slice(settle, len(result) - settle)
    return tacto.rms((advanced - reference)[inner]) / tacto.rms(reference[inner])


def displaced(drive, extra=lambda f: 1.0):
    spectrum, f = band(drive, RATE)
    response = np.zeros(len(f), complex)
    inside = (f >= 15) & (f <= 500)
    response[inside] = actuator(f[inside]) * extra(f[inside])
    return np.fft.irfft(spectrum * response, len(drive))


def made(name):
    tacto.run("record", "-d", "sim:surface=E,speed=50mm/s,seed=3", "--time", "1.2s", "-o", "rec")
    tacto.run("spatial", "rec", "-o", name, "--stroke", "1")
    finger_path()


def drive_gives_what_was_wanted():
    made("tex")
    report = tacto.run_json("render", "tex", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o", "drive.wav")
    drive, rate = soundfile.read("drive.wav")
    assert rate == RATE and drive.ndim == 1
    error = error_after_delay(displaced(drive), wanted("tex", len(drive)), report["delay_s"])
    print(f"displacement against wanted, 15-500 Hz: {error:.3%} RMS after a delay of {report['delay_s']} s")
    measured("render_against_scipy.error_percent", 100 * error)
    measured("render_against_scipy.delay_s", report["delay_s"])
    assert error < 0.01


def reconstruction_filter_is_accounted_for():
    made("tex")
    tacto.run("render", "tex", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o", "drive.wav",
              "--reconstruction", "butterworth3")
    drive, _ = soundfile.read("drive.wav")
    filter_response = lambda f: freqs(*butter(3, 2 * np.pi * 600, analog=True), worN=2 * np.pi * f)[1]
    error = error_after_delay(displaced(drive, filter_response), wanted("tex", len(drive)), 0.0)
    bare = error_after_delay(displaced(drive), wanted("tex", len(drive)), 0.0)
    print(f"with the 600 Hz filter: {error:.3%} RMS; were it not there: {bare:.1%}")
    measured("render_against_scipy.filter_compensated_error_percent", 100 * error)
    measured("render_against_scipy.filter_uncompensated_error_percent", 100 * bare)
    assert error < 0.01 < bare


def displacement_file_is_the_model():
    made("tex")
    tacto.run("render", "tex", "--finger-path", "path.csv", "--transducer", "wiertlewski2011", "-o", "drive.wav",
              "--displacement", "tray.wav")
    drive, _ = soundfile.read("drive.wav")
    tray, _ = soundfile.read("tray.wav")
    kept = np.fft.irfft(band(tray, RATE)[0], len(tray))
    error = error_after_delay(kept, displaced(drive), 0.0)
    print(f"--displacement against SciPy's actuator: {error:.4%}")
    assert error < 0.005


if __name__ == "__main__":
    for test in (drive_gives_what_was_wanted, reconstruction_filter_is_accounted_for, displacement_file_is_the_model):
        tacto.in_folder(test)
