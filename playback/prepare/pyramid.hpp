// SPDX-License-Identifier: GPL-3.0-or-later
// Copies of a texture with less and less detail.
#pragma once

#include <cstddef>
#include <vector>

#include "data-schema/base/signal.hpp"
#include "firmware-host/core/kernel/profile.hpp"

namespace tacto::playback {

/// A level falls to nothing between what it passes and this many times that.
inline constexpr double kStopOverPass = 1.25;

struct PyramidShape {
  wire::ProfileEnds ends = wire::ProfileEnds::stop;
  int levels = 1;
  double finest_per_m = 0;         ///< that the first level passes
  double samples_per_period = 16;  ///< of the finest
  double metres_per_count = 0;     ///< of the encoder that reads it; 0: not known
};

/// Samples of all levels, one after the other, as core::Profile reads them.
struct Pyramid {
  std::vector<float> samples;
  std::size_t first_level_samples = 0;
  double pitch_m = 0;      ///< of the first level, whose first sample is the signal's
  std::size_t levels = 0;  ///< as they were made
};

/// How many samples it will have.
std::size_t pyramid_size(const schema::SpaceSignal& signal, const PyramidShape& shape);

/// Level n passes up to finest / 2^(n/2) whole, falls by a raised cosine to nothing at kStopOverPass times
/// that, and lies on a grid 2^floor(n/2) times as wide as the first: by Fourier transform of the signal as it
/// is continued beyond its ends (loop: periodic; mirror: even; stop: zeros, as many as there are samples up
/// to 20 mm). The grid is such that a count, which the wire keeps to 2^-32 of a sample, errs by less than
/// 2e-5 of the finest period over the whole signal, or as little as up to a sixteenth more samples can. The
/// error of a level against its band is that of rounding to float. Precondition: at least 2 samples, 0 <
/// finest.
Pyramid make_pyramid(const schema::SpaceSignal& signal, const PyramidShape& shape);

}  // namespace tacto::playback
