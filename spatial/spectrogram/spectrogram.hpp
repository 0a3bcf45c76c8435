// SPDX-License-Identifier: GPL-3.0-or-later
// The spatial spectrogram: short-time Fourier transform along position (Wiertlewski, Lozada and Hayward 2011,
// III-C: 10 mm Blackman window, zero padded). Offline; not safe in the tick.
#pragma once

#include <functional>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"

namespace tacto::spatial {

/// The value of a cell, with X[p, k] = sum_n w_n (x[p H + n] - mean_p) exp(-2 pi i k n / P) and Blackman's
/// w_n = 0.42 - 0.5 cos(2 pi n / W) + 0.08 cos(4 pi n / W):
///   density    c_k |X|^2 pitch / sum_n w_n^2, in unit^2 m: one-sided power spectral density, c_k = 2
///   amplitude  c_k |X| / sum_n w_n, in unit: a sine of amplitude A reads A at its bin
/// except that c_k = 1 at zero and at half the sampling frequency. The first is
/// scipy.signal.spectrogram(x, 1 / pitch, 'blackman', W, W - H, P, detrend='constant', scaling='density'),
/// the second the root of twice its 'spectrum'. Lengths are rounded to whole samples W, H, P. Row p belongs
/// to the window's centre, origin + (p H + W / 2) pitch; only whole windows are used. In single precision:
/// the error of X is 1e-6 (-120 dB) of the largest |X| of the texture over all frequencies. The whole result
/// is in memory; SpectrogramMaker makes the same row by row. The caller sets `name`. Errors: of
/// SpectrogramMaker.
schema::Result<schema::Spectrogram> spatial_spectrogram(const schema::Texture& texture,
                                                        const SpectrogramOptions& options,
                                                        const std::function<void(double)>& progress = {});

}  // namespace tacto::spatial
