# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered drive against SciPy: path, lookup, band and actuator computed independently.

A finger that rests, crosses the texture, reverses, moves beyond its end and comes back. SciPy interpolates the path
(PchipInterpolator) and the texture (CubicSpline), cuts the band on a grid 16 times as fine, and integrates the
actuator's equations (lsim) for the drive. Limit: 1 % RMS over 15-500 Hz without delay.
"""
import pathlib
import tempfile

import numpy as np
from scipy import interpolate, signal

import made_files as made
from measured import measured

RATE = 10_000
LENGTH_M = 0.06
BAND = (15, 500)
# Half a bin of the reference's 0.035 Hz at an edge, of a band 485 Hz wide: sqrt(0.0175 / 485).
BAR_WANTED = 6e-3


def texture_force() -> np.ndarray:
    """Noise from 0.3 to 9 /mm, and a sine of 20 /mm that is in the band only for a slow finger."""
    count = round(LENGTH_M / made.PITCH_M) + 1
    generator = np.random.default_rng(7)
    bins = np.fft.rfftfreq(count, made.PITCH_M)
    spectrum = generator.standard_normal(len(bins)) + 1j * generator.standard_normal(len(bins))
    spectrum[(bins < 300) | (bins > 9000)] = 0
    noise = np.fft.irfft(spectrum, count)
    position = np.arange(count) * made.PITCH_M
    return 0.008 * noise / noise.std() + 0.004 * np.sin(2 * np.pi * 20e3 * position)


def finger_path():
    knots = [(0, -2), (0.2, -2), (0.6, 12), (1.0, 40), (1.2, 52), (1.4, 55), (1.7, 45), (1.9, 49), (2.2, 63), (2.4, 64), (2.9, 30), (3.4, 1), (3.6, 1)]
    time_s, position_mm = np.array(knots, dtype=float).T
    return time_s + 0.5, position_mm * 1e-3


def faded(force, position_m, at_m):
    """Ends: stop. Zero outside, a raised cosine over the last millimetre inside."""
    inside = np.minimum(position_m - at_m, at_m + LENGTH_M - position_m)
    fade = np.where(inside < 1e-3, 0.5 - 0.5 * np.cos(np.pi * np.clip(inside, 0, None) / 1e-3), 1.0)
    return np.where(inside < 0, 0.0, force * fade)


def in_band(values, rate, periods=8):
    """Plain Fourier truncation, followed by long silence: at both ends the finger rests outside of the texture."""
    count = len(values)
    spectrum = np.fft.rfft(values, periods * count)
    frequency = np.fft.rfftfreq(periods * count, 1 / rate)
    spectrum[(frequency < BAND[0]) | (frequency > BAND[1])] = 0
    return np.fft.irfft(spectrum, periods * count)[:count]


def wanted_by_scipy(force, time_s, position_m, at_m, fine=16):
    count = round((time_s[-1] - time_s[0]) * RATE) + 1
    fine_time = time_s[0] + np.arange((count - 1) * fine + 1) / (RATE * fine)
    position = interpolate.PchipInterpolator(time_s, position_m)(fine_time)
    grid = np.arange(len(force)) * made.PITCH_M
    lookup = interpolate.CubicSpline(grid, force.astype(np.float32).astype(float))
    read = faded(lookup(np.clip(position - at_m, 0, LENGTH_M)), position, at_m)
    return 1e-3 * in_band(read, RATE * fine)[::fine]


def actuator():
    """Table I and equations (5), (6) of Wiertlewski 2011; 20 um/V at rest."""
    stiffness = 76.47e3 + 4.05e3
    electrical, mechanical = [2 * 680 * 818e-9, 1], [6.8e-3, 4.49, stiffness]
    return [20e-6 * stiffness], np.polymul(electrical, mechanical)


def tray_under(drive, fine, held, filtered):
    """The analog side at `fine` times the rate: points of a band-limited signal, or a real staircase."""
    driven = np.repeat(drive, fine) if held else signal.resample(np.concatenate([drive, np.zeros_like(drive)]), 2 * fine * len(drive))[: fine * len(drive)]
    time = np.arange(len(driven)) / (RATE * fine)
    if filtered:
        driven = signal.lsim(signal.butter(3, 2 * np.pi * 600, analog=True), driven, time, interp=not held)[1]
    return signal.lsim(actuator(), driven, time, interp=not (held and not filtered))[1][::fine]


def rms(values):
    return np.sqrt(np.mean(values**2))


def error(actual, wanted):
    return rms(actual - wanted) / rms(wanted)


def check(name, value, bar):
    print(f"{name}: {value:.2e} (bar {bar:.0e})")
    assert value < bar, name
    return value


def check_rendering(folder, wanted, options, held, filtered):
    drive, moved, asked = (folder / f"{name}.wav" for name in ("drive", "moved", "asked"))
    report = made.report_of("render", folder / "t", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "--at", "2mm", "-o", drive, "--displacement", moved, "--target", asked, *options)
    assert report["delay_s"] == 0 and report["rate_hz"] == RATE
    tray = tray_under(made.samples(drive), 32, held, filtered)
    label = " ".join(options) or "plain"
    key = "render_scipy." + ("filtered" if filtered else "held" if held else "plain")
    check(f"{label}: wanted against SciPy", error(in_band(made.samples(asked), RATE), wanted), BAR_WANTED)
    found = check(f"{label}: displacement in SciPy against SciPy's wanted", error(in_band(tray, RATE), wanted), 1e-2)
    measured(f"{key}.displacement_error_percent", 100 * found)
    # 0.1 % in the band, 0.1 % over all frequencies between the model and the integrated equations.
    check(f"{label}: displacement in SciPy against --target", rms(in_band(tray - made.samples(asked), RATE)) / rms(wanted), 1e-3)
    found = check(f"{label}: --displacement against SciPy's", error(made.samples(moved), tray), 1e-3)
    measured(f"{key}.model_error_percent", 100 * found)
    if filtered:
        bare = error(in_band(tray_under(made.samples(drive), 32, held, False), RATE), wanted)
        assert bare > 0.1, f"the filter changes nothing: {bare}"
    assert report["displacement_error_db"] < -50, report


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        force = texture_force()
        made.write_texture(folder / "t", force)
        time_s, position_m = finger_path()
        made.write_path(folder / "path.csv", time_s, position_m)
        wanted = wanted_by_scipy(force, time_s, position_m, 2e-3)
        check_rendering(folder, wanted, [], False, False)
        check_rendering(folder, wanted, ["--hold", "zero-order"], True, False)
        check_rendering(folder, wanted, ["--hold", "zero-order", "--reconstruction", "butterworth3"], True, True)


if __name__ == "__main__":
    main()
