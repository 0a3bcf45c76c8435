#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the thresholds of `compare`'s two maximum statistics (analysis/compare/verdict.cpp).

Not a test: it takes some minutes. Run it by hand with `python3 tests/analysis/compare_thresholds.py` when a statistic changes, and copy
the last column of each table. Pairs are white Gaussian noise; seeds are fixed. The statistics are written here a second time, in NumPy.
"""
import sys

import numpy as np

DB = 10 / np.log(10)
WIDTHS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
OVERLAP = 19 / 18  # variance of Welch's mean: half-overlapping Hann windows
SAME = (1, 4 / 9, 1 / 36)  # correlation of a segment's power with that 0, 1, 2 bins away
NEXT = (1 / 36, (8 / (9 * np.pi))**2 / 4, 1 / 144, (8 / (45 * np.pi))**2 / 4)  # and with that of the next segment
BANDS_SHARE, LINES_SHARE = 0.045, 0.005


def segments(x, window):
    hop = window - window // 2
    taper = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(window) / window)
    frames = np.lib.stride_tricks.sliding_window_view(x, window)[::hop]
    return np.abs(np.fft.rfft((frames - frames.mean(1, keepdims=True)) * taper, axis=1))**2


def local_mean(v, most):
    """Running mean over `most` values to each side; near the ends over fewer, so that it stays symmetric."""
    sums, k = np.concatenate([[0], np.cumsum(v)]), np.arange(len(v))
    reach = np.minimum(most, np.minimum(k, len(v) - 1 - k))
    return (sums[k + reach + 1] - sums[k - reach]) / (2 * reach + 1)


def trigamma(x):
    return 1 / x + 1 / (2 * x * x) + 1 / (6 * x**3)


def shape_of_gamma(width, n):
    variance = 0
    for d in range(min(width, 4)):
        both = (SAME[d] if d < 3 else 0) + 2 * (n - 1) / n * NEXT[d]
        variance += (1 if d == 0 else 2) * (width - d) * both
    return width * width * n / variance


def sums(v, width):
    total = np.concatenate([np.zeros(v.shape[:-1] + (1,)), np.cumsum(v, -1)], -1)
    return total[..., width:] - total[..., :-width]


def level_of(a, b, width):
    """Logarithm of B over A in each band, relative to its mean over all cells."""
    return np.log(sums(b, width) / sums(a, width)) - np.mean(np.log(b / a), -1, keepdims=True)


def jackknife(levels):
    """Jackknife variance of values computed from all segments but one, mean over all bands."""
    n = len(levels)
    return (n - 1) / n * np.mean(np.sum((levels - levels.mean(0))**2, 0))


def band_statistic(pa, pb, paired):
    """The largest score over all bands: rows are segments, columns cells."""
    n, m, cells = len(pa), len(pb), pa.shape[1]
    white = np.exp(local_mean(np.log(pa.mean(0)) + np.log(pb.mean(0)), 8) / 2)
    pa, pb = pa / white, pb / white
    a, b = pa.mean(0), pb.mean(0)
    without_a, without_b = (n * a - pa) / (n - 1), (m * b - pb) / (m - 1)
    best = 0
    for width in (w for w in WIDTHS if w <= max(1, cells // 2)):
        if paired:
            seen = jackknife(level_of(without_a, without_b, width))
        else:
            seen = jackknife(level_of(without_a, b + 0 * without_a, width)) + jackknife(level_of(a + 0 * without_b, without_b, width))
        steady = (trigamma(shape_of_gamma(width, n)) + trigamma(shape_of_gamma(width, m))) * (1 - width / cells)
        best = max(best, np.max(np.abs(level_of(a, b, width))) / np.sqrt(max(steady, OVERLAP * seen)))
    return best


def tapered_power(x, taper=0.25):
    """Periodogram under a cosine taper, at half bins."""
    n, edge = len(x), int(taper * len(x) / 2)
    weights = np.ones(n)
    weights[:edge] = 0.5 - 0.5 * np.cos(np.pi * (np.arange(edge) + 0.5) / edge)
    weights[n - edge:] = weights[:edge][::-1]
    return np.abs(np.fft.rfft((x - x.mean()) * weights, 2 * n))**2


def line_statistic(a, b):
    log_a, log_b = np.log(a), np.log(b)
    density = (local_mean(log_a, 48) + local_mean(log_b, 48)) / 2 + np.euler_gamma
    half_level = local_mean(log_b - log_a, 192) / 2
    a, b = np.exp(log_a - density + half_level), np.exp(log_b - density - half_level)
    return max(np.max(a / np.maximum(1, local_mean(b, 8))), np.max(b / np.maximum(1, local_mean(a, 8))))


def band_scores(cells, n, m, paired, pairs):
    random, window = np.random.default_rng(1000 * cells + n), 2 * (cells + 2)
    noise = lambda count: random.normal(size=window + (count - 1) * (window // 2))
    power = lambda count: segments(noise(count), window)[:, 2:cells + 2]
    return np.sort([band_statistic(power(n), power(m), paired) for _ in range(pairs)])


def line_scores(cells, pairs):
    random, count = np.random.default_rng(cells), 2 * (cells + 10)
    power = lambda: tapered_power(random.normal(size=count))[10:2 * cells + 10]
    return np.sort([line_statistic(power(), power()) for _ in range(pairs)])


def row(scores, shares):
    return "  ".join(f"{scores[int((1 - share) * len(scores))]:6.3f}" for share in shares)


def main():
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 8000
    shares = (0.05, 0.04, 0.035, 0.025, BANDS_SHARE)
    print("bands: cells, segments of A and B, paired; scores exceeded in", *shares, "of the pairs")
    for n, m, paired in ((15, 15, True), (15, 15, False), (8, 8, True), (30, 30, True), (15, 30, False)):
        for cells in (6, 12, 24, 48, 96, 192, 384, 768, 1536):
            if (n, m, paired) == (15, 15, True) or cells in (24, 96, 384):
                print(f"{cells:6} {n:3} {m:3} {paired!s:5}", row(band_scores(cells, n, m, paired, min(pairs, 1600 * pairs // (cells * 4))), shares), flush=True)
    shares = (0.05, 0.025, 0.01, LINES_SHARE)
    print("lines: length times band; scores exceeded in", *shares, "of the pairs, and 7.7 + 0.8 ln(cells) + 0.02 ln(cells)^2")
    for cells in (30, 60, 120, 240, 480, 960, 1920, 7680):
        scores = line_scores(cells, min(2 * pairs, 2400 * pairs // cells))
        print(f"{cells:6}", row(scores, shares), f"{7.7 + 0.8 * np.log(cells) + 0.02 * np.log(cells)**2:7.2f}", flush=True)


if __name__ == "__main__":
    main()
