# SPDX-License-Identifier: GPL-3.0-or-later
"""A real finger's texture, played at its own speed and at twice that: the default gain fits the paper's transducer, and
SciPy's actuator follows the target within 1 % RMS over 15-500 Hz."""
import os
import pathlib
import sys
import tempfile

import numpy as np

import made_files as made
from measured import measured

DATA = pathlib.Path(os.environ.get("TACTO_DATA", "")) / "bare-finger" / "bare_finger_10kHz.csv"
RATE = 10_000


def make_texture(folder):
    made.report_of("import", DATA, "-o", folder / "finger", "--rate", "10kHz", "--channel", "tangential_force=lateral_V*0.444444N", "--channel", "position=encoder_count*0.5um")
    made.report_of("spatial", folder / "finger", "-o", folder / "finger", "--from", "4.55s", "--to", "6.85s")


def displacement(drive):
    """Applies H_a of Wiertlewski 2011 at the drive's frequencies; the drive is followed by silence."""
    period = 4 * len(drive)
    s = 2j * np.pi * np.fft.rfftfreq(period, 1 / RATE)
    stiffness = 76.47e3 + 4.05e3
    response = 20e-6 * stiffness / ((1 + 2 * 680 * 818e-9 * s) * (6.8e-3 * s**2 + 4.49 * s + stiffness))
    return np.fft.irfft(np.fft.rfft(drive, period) * response, period)[: len(drive)]


def in_band(values):
    period = 4 * len(values)
    spectrum = np.fft.rfft(values, period)
    frequency = np.fft.rfftfreq(period, 1 / RATE)
    spectrum[(frequency < 15) | (frequency > 500)] = 0
    return np.fft.irfft(spectrum, period)[: len(values)]


def check(folder, speed_mps):
    made.write_path(folder / "path.csv", [0, 0.08 / speed_mps], [0.005, 0.085])
    report = made.report_of("render", folder / "finger", "--finger-path", folder / "path.csv", "--transducer", "wiertlewski2011", "-o", folder / "drive.wav", "--target", folder / "wanted.wav")
    wanted = in_band(made.samples(folder / "wanted.wav"))
    moved = in_band(displacement(made.samples(folder / "drive.wav")))
    error = np.sqrt(np.mean((moved - wanted) ** 2) / np.mean(wanted**2))
    print(f"{speed_mps * 1e3:.0f} mm/s: error {100 * error:.3f} %, drive {report['drive_peak_v']:.3f} V, wanted {1e6 * report['target_rms_m']:.2f} um RMS, "
          f"limits used: drive {report['drive_limit_used_percent']:.0f} %, displacement {report['displacement_limit_used_percent']:.0f} %, slew {report['slew_limit_used_percent']:.0f} %")
    key = f"render_real_finger.at_{1e3 * speed_mps:.0f}_mm_per_s"
    measured(f"{key}.error_percent", 100 * error)
    measured(f"{key}.limit_used_percent", max(report[f"{name}_limit_used_percent"] for name in ("drive", "displacement", "slew")))
    assert error < 0.01
    assert report["displacement_error_db"] < -40


def main():
    if not DATA.is_file():
        print("skipped: no real data")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_texture(folder)
        for speed_mps in (0.02, 0.04, 0.08):
            check(folder, speed_mps)


if __name__ == "__main__":
    main()
