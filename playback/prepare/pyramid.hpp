// SPDX-License-Identifier: GPL-3.0-or-later
// The levels of a texture: copies with less and less detail.
#pragma once

#include <cstddef>
#include <vector>

#include "data-schema/base/signal.hpp"
#include "firmware-host/core/kernel/profile.hpp"

namespace tacto::playback {

/// A level falls to zero between its edge and this many times its edge.
inline constexpr double kStopOverPass = 1.25;

struct PyramidShape {
  wire::ProfileEnds ends = wire::ProfileEnds::stop;
  int levels = 1;
  double finest_per_m = 0;         ///< passed by the first level
  double samples_per_period = 16;  ///< of the finest
  double metres_per_count = 0;     ///< of the encoder that reads it; 0: unknown
};

/// Samples of all levels, one after the other, in the order of core::Profile.
struct Pyramid {
  std::vector<float> samples;
  std::size_t first_level_samples = 0;
  double pitch_m = 0;      ///< of the first level, which begins at the signal's first sample
  std::size_t levels = 0;  ///< number of levels made
};

/// The number of samples of make_pyramid().
std::size_t pyramid_size(const schema::SpaceSignal& signal, const PyramidShape& shape);

/// Level n passes up to finest / 2^(n/2) unchanged, falls by a raised cosine to zero at kStopOverPass times
/// that, and is on a grid 2^floor(n/2) times as wide as the first: by Fourier transform of the signal,
/// continued beyond its ends (loop: periodic; mirror: even; stop: zeros, as many as there are samples up to
/// 20 mm). A count, which the wire rounds to 2^-32 of a sample, errs over the whole signal by less than 2e-5
/// of the finest period, or as little as up to a sixteenth more samples permit. The error of a level within
/// its band is that of rounding to float. Precondition: at least 2 samples, 0 < finest.
Pyramid make_pyramid(const schema::SpaceSignal& signal, const PyramidShape& shape);

}  // namespace tacto::playback
