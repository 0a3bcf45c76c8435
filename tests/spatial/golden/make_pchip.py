# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes pchip.txt: SciPy's PchipInterpolator on uneven and even knots. Run: /usr/bin/python3 make_pchip.py"""
import pathlib

import numpy as np
from scipy.interpolate import PchipInterpolator

rng = np.random.default_rng(7)


def line(values):
    return " ".join(repr(float(v)) for v in values)


def case(name, x, y, out):
    curve = PchipInterpolator(x, y)
    at = np.sort(np.concatenate([x, rng.uniform(x[0], x[-1], 40)]))
    out.append("\n".join([name, line(x), line(y), line(curve.derivative()(x)), line(at), line(curve(at))]))


out = []
x = np.cumsum(rng.uniform(0.05, 2, 30))
case("uneven", x, rng.standard_normal(30), out)
case("even", 0.25 * np.arange(30), rng.standard_normal(30), out)
case("flats", np.arange(12.0), np.array([0, 0, 0, 1, 1, 3, 2, 2, 2, 5, 5, 5.0]), out)
case("monotone", x, np.cumsum(rng.exponential(1, 30) ** 3), out)
case("two", np.array([1.0, 3.5]), np.array([2.0, -1.0]), out)
case("three", np.array([0.0, 1.0, 1.5]), np.array([0.0, 1.0, -8.0]), out)
case("small", 1e-4 * np.arange(20), 1e-200 * rng.standard_normal(20), out)
pathlib.Path(__file__).with_name("pchip.txt").write_text("\n".join(out) + "\n")
