// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a spatial spectrogram.
#pragma once

#include <cstddef>
#include <optional>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/dsp/resample/decimation.hpp"

namespace tacto::spatial {

/// What is subtracted from each window's samples before they are weighted.
enum class Detrend {
  none,
  constant,  ///< the samples' mean: a force's baseline or a height's zero is not texture
};

/// The sampling for the transform. automatic: the coarsest decimation that keeps the requested bins and the
/// window's leakage (dsp/resample/decimation.hpp). The cells are the same, except that content more than 50 /
/// window above the highest bin no longer leaks into them (at full resolution at most -127 dB of it does).
enum class Resolution { automatic, whole };

struct SpectrogramOptions {
  double window_m = 10e-3;
  double hop_m = 0.1e-3;
  /// Length of a window with its zeros, at least window_m. Default: the next power of two in samples.
  std::optional<double> padded_m;
  /// Bins above it are not stored; above half the sampling frequency all bins are.
  double max_frequency_per_m = 15e3;
  /// The same default as SciPy's.
  Detrend detrend = Detrend::constant;
  schema::Scaling scaling = schema::Scaling::density;
  Resolution resolution = Resolution::automatic;
};

/// Shortest useful window, in samples.
inline constexpr std::size_t kShortestWindow = 8;
/// Longest transform: its buffers need 256 MB.
inline constexpr std::size_t kLongestTransform = std::size_t{1} << 24;

/// The options in whole samples of a grid. Errors: usage, with the allowed range, for a window under 8
/// samples, a hop under one, padding shorter than the window, either beyond 2^24 samples, a frequency that is
/// not above 0.
schema::Result<FrameShape> frame_shape(const SpectrogramOptions& options, double pitch_m);

}  // namespace tacto::spatial
