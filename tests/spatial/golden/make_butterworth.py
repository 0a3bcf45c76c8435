# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes butterworth.txt: SciPy's band-pass responses and sosfiltfilt. Run: /usr/bin/python3 make_butterworth.py"""
import pathlib

import numpy as np
from scipy.signal import butter, sosfiltfilt, sosfreqz

rng = np.random.default_rng(8)


def line(values):
    return " ".join(repr(float(v)) for v in values)


out = []
signal = np.cumsum(rng.standard_normal(120)) + 3.0
for order, low, high, rate in [
    (1, 15.0, 500.0, 1e4),
    (2, 100.0, 140.0, 1e3),
    (3, 5.0, 450.0, 1e3),
    (4, 15.0, 500.0, 1e4),
    (5, 200.0, 300.0, 1e3),
    (8, 40.0, 300.0, 2e3),
]:
    sos = butter(order, [low, high], "bandpass", fs=rate, output="sos")
    at = np.array([0.3 * low, low, 0.5 * (low + high), high, 0.5 * (high + rate / 2)])
    response = sosfreqz(sos, at, fs=rate)[1]
    out.append("\n".join([line([order, low, high, rate]), line(at), line(response.real), line(response.imag),
                          line(sosfiltfilt(sos, signal))]))
pathlib.Path(__file__).with_name("butterworth.txt").write_text("\n".join([line(signal)] + out) + "\n")
