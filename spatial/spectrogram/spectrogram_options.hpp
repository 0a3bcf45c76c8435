// SPDX-License-Identifier: GPL-3.0-or-later
// What a spatial spectrogram is asked for.
#pragma once

#include <cstddef>
#include <optional>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/dsp/resample/decimation.hpp"

namespace tacto::spatial {

/// What is taken off each window's samples before the window weighs them.
enum class Detrend {
  none,
  constant,  ///< the samples' mean: where a force's baseline or a height's zero lies is not texture
};

/// On which grid the transform works. automatic: on the coarsest that keeps the bins that are asked for and
/// the window's leakage (dsp/decimation.hpp). The cells are the same, but what lies more than 50 / window
/// above the highest bin no longer leaks into them (it would at -127 dB of itself, or less).
enum class Resolution { automatic, whole };

struct SpectrogramOptions {
  double window_m = 10e-3;
  double hop_m = 0.1e-3;
  /// Length of a window with its zeros, at least window_m; unless told, the next power of two in samples.
  std::optional<double> padded_m;
  /// Bins above it are not kept; beyond half the sampling frequency it keeps all.
  double max_frequency_per_m = 15e3;
  /// SciPy's default too.
  Detrend detrend = Detrend::constant;
  schema::Scaling scaling = schema::Scaling::density;
  Resolution resolution = Resolution::automatic;
};

/// Shortest window, in samples, whose spectrum still says something.
inline constexpr std::size_t kShortestWindow = 8;
/// Longest transform: its buffers take 256 MB.
inline constexpr std::size_t kLongestTransform = std::size_t{1} << 24;

/// The options in whole samples of a grid. Errors: usage, with the range that is allowed, for a window under
/// 8 samples, a hop under one, padding shorter than the window, either beyond 2^24 samples, a frequency that
/// is not above 0.
schema::Result<FrameShape> frame_shape(const SpectrogramOptions& options, double pitch_m);

}  // namespace tacto::spatial
