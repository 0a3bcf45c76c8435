# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes resample.txt: strokes resampled to a grid by SciPy. Run: /usr/bin/python3 make_resample.py

A stroke is a line of positions (counts of 1 um, ahead or back), one of forces, and one of resampled forces.
"""
import pathlib

import numpy as np
from scipy.interpolate import PchipInterpolator

rng = np.random.default_rng(5)


def line(values):
    return " ".join(repr(float(v)) for v in values)


def true_inverse(curve, low, high, wanted):
    low, high = np.full(wanted.shape, low), np.full(wanted.shape, high)
    for _ in range(70):
        middle = (low + high) / 2
        below = curve(middle) < wanted
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return (low + high) / 2


out = []
for direction in (1, -1):
    counts = 40 + np.cumsum(rng.integers(1, 8, 120))
    force = np.cumsum(rng.standard_normal(120))
    t = np.arange(120.0)
    at = np.arange(counts[0], counts[-1] + 1).astype(float)
    value = PchipInterpolator(t, force)(true_inverse(PchipInterpolator(t, counts), 0.0, 119.0, at))
    # Back: the same path with decreasing counts, so that the grid meets it from its end.
    out.append(line(counts if direction > 0 else -counts))
    out.append(line(force))
    out.append(line(value[::direction]))
pathlib.Path(__file__).with_name("resample.txt").write_text("\n".join(out) + "\n")
