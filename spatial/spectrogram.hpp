// SPDX-License-Identifier: GPL-3.0-or-later
// The spatial spectrogram: short-time Fourier transform along position (Wiertlewski, Lozada and Hayward 2011,
// III-C: 10 mm Blackman window, zero padded). Offline; not safe in the tick.
#pragma once

#include <functional>
#include <optional>

#include "data-schema/error.hpp"
#include "data-schema/spectrogram.hpp"
#include "data-schema/texture.hpp"

namespace tacto::spatial {

/// What is taken off each window's samples before the window weighs them.
enum class Detrend {
  none,
  constant,  ///< the samples' mean: where a force's baseline or a height's zero lies is not texture
};

struct SpectrogramOptions {
  double window_m = 10e-3;
  double hop_m = 0.1e-3;
  /// Length of a window with its zeros, at least window_m; unless told, the next power of two in samples.
  std::optional<double> padded_m;
  /// Bins above it are not kept; beyond half the sampling frequency it keeps all.
  double max_frequency_per_m = 15e3;
  /// SciPy's default too.
  Detrend detrend = Detrend::constant;
};

/// Shortest window, in samples, whose spectrum still says something.
inline constexpr std::size_t kShortestWindow = 8;

/// Power spectral density of the texture around each position, one-sided:
///   S[p, k] = c_k |sum_n w_n (x[p H + n] - mean_p) exp(-2 pi i k n / P)|^2 pitch / sum_n w_n^2,  in unit^2
///   m,
/// with c_k = 2, but 1 at zero and at half the sampling frequency; w_n = 0.42 - 0.5 cos(2 pi n / W) + 0.08
/// cos(4 pi n / W). The same as scipy.signal.spectrogram(x, 1 / pitch, 'blackman', W, W - H, P,
/// detrend='constant', scaling='density'). Lengths are rounded to whole samples W, H, P. Row p belongs to the
/// window's centre, origin + (p H + W / 2) pitch; only whole windows are taken. In double precision, stored
/// as float: a cell is right to 1e-7 of itself and 1e-15 of the row's largest. The caller fills in `name`.
/// Errors: usage (window under 8 samples, hop under one, padding shorter than the window, frequency not above
/// 0); unsuitable (texture shorter than the window, which says what would fit; a value that is not finite, by
/// sample).
schema::Result<schema::Spectrogram> spatial_spectrogram(const schema::Texture& texture,
                                                        const SpectrogramOptions& options,
                                                        const std::function<void(double)>& progress = {});

}  // namespace tacto::spatial
