#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of each stage of the benchmark in SciPy, on the recording of workload.hpp: JSON of {stage: milliseconds}.

One thread, CPU time, medians. Each stage is what a laboratory would write with SciPy's own functions; `decimated`
decimates by 4 first.
"""
import json
import os
import sys
import tempfile
import time

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"

import numpy as np
import scipy.fft
import soundfile
import xarray
from scipy.interpolate import PchipInterpolator
from scipy.signal import butter, decimate, sosfiltfilt, spectrogram

RATE, PITCH, STROKE, FRAMES = 10000.0, 1e-6, 8000, 10000


def workload(seconds):
    """The same numbers as workload.hpp."""
    i = np.arange(seconds * FRAMES)
    stroke, frame = i // FRAMES, i % FRAMES
    turn = 2 * np.pi * 3 / 0.8
    t = frame / RATE
    way = np.where(frame < STROKE, 0.05 * (t + 0.1 * np.sin(turn * t) / turn), 40e-3)
    exact = np.where(stroke % 2 == 0, way, 40e-3 - way)
    hashed = np.fmod((i % 65536) * 0.6180339887498949, 1.0)
    phase = 2 * np.pi * exact * 1e3
    force = 0.3 + 1e-3 * i / RATE + 0.05 * np.sin(2 * phase) + 0.02 * np.sin(8 * phase) + 0.005 * (hashed - 0.5)
    return np.round(exact / 1e-6) * 1e-6, force


def fourier(force):
    spectrum = scipy.fft.rfft(force)
    f = scipy.fft.rfftfreq(len(force), 1 / RATE)
    spectrum[(f < 15) | (f > 500)] = 0
    return scipy.fft.irfft(spectrum, len(force))


def to_space(position, force):
    """PCHIP in both directions with exchanged axes; repeated positions are dropped."""
    textures = []
    for begin in range(0, len(position), FRAMES):
        x, f = position[begin:begin + STROKE], force[begin:begin + STROKE]
        if x[-1] < x[0]:
            x, f = x[::-1], f[::-1]
        x, first = np.unique(x, return_index=True)
        grid = np.arange(np.ceil(x[0] / PITCH), np.floor(x[-1] / PITCH)) * PITCH
        t = PchipInterpolator(x, first.astype(float))(grid)
        textures.append(PchipInterpolator(np.arange(len(f), dtype=float), f)(t))
    return textures


def spectrograms(textures, step=1):
    pitch = PITCH * step
    return [spectrogram(x, 1 / pitch, "blackman", 10000 // step, (10000 - 100) // step, 16384 // step)[2] for x in textures]


def to_15_per_mm(textures):
    return [s[: int(15e3 * 16384 * PITCH) + 1] for s in spectrograms([decimate(x, 4, ftype="fir") for x in textures], 4)]


def whole_way(folder):
    recorded, _ = soundfile.read(os.path.join(folder, "recording.wav"))
    rows = np.concatenate([s.T for s in spectrograms(to_space(recorded[:, 1], fourier(recorded[:, 0])))])
    rows = rows[:, : int(15e3 * 16384 * PITCH) + 1]
    xarray.DataArray(rows, dims=("position", "spatial_frequency"), name="density").to_netcdf(os.path.join(folder, "s.nc"))


def milliseconds(job, repeats):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        job()
        times.append(1e3 * (time.process_time() - start))
    return float(np.median(times))


def write_inputs(folder, position, force):
    soundfile.write(os.path.join(folder, "recording.wav"), np.column_stack([force, position]), int(RATE), subtype="DOUBLE")
    table = np.column_stack([np.arange(len(force)) / RATE, force, np.round(position / 1e-6)])
    np.savetxt(os.path.join(folder, "recording.csv"), table, delimiter=",", fmt=("%.6f", "%.9f", "%d"))


def main():
    position, force = workload(60)
    long_force = workload(600)[1]
    textures = to_space(position, fourier(force))
    sos = butter(4, [15, 500], "bandpass", fs=RATE, output="sos")
    with tempfile.TemporaryDirectory() as folder:
        write_inputs(folder, position, force)
        csv = os.path.join(folder, "recording.csv")
        columns = {
            "pchip_true_inverse": milliseconds(lambda: to_space(position, force), 7),
            "zero_phase_sos": milliseconds(lambda: sosfiltfilt(sos, force), 7),
            "fourier_band_pass/60": milliseconds(lambda: fourier(force), 7),
            "fourier_band_pass/600": milliseconds(lambda: fourier(long_force), 3),
            "spectrogram_all_bins": milliseconds(lambda: spectrograms(textures), 1),
            "spectrogram_to_15_per_mm": milliseconds(lambda: to_15_per_mm(textures), 3),
            "import_csv": milliseconds(lambda: np.loadtxt(csv, delimiter=","), 5),
            "recording_to_spectrogram": milliseconds(lambda: whole_way(folder), 1),
        }
    json.dump(columns, sys.stdout, indent=1)


if __name__ == "__main__":
    main()
