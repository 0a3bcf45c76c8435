// SPDX-License-Identifier: GPL-3.0-or-later
// A texture under a virtual finger with exact positions: the workload of the offline half.
#pragma once

#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/strokes/monotone_path.hpp"

namespace tacto::analysis {

/// The finger moves at 50 mm/s, varying by a tenth, and is sampled every 0.1 ms.
struct StrokedTexture {
  static constexpr double kRate_hz = 10e3, kSpeed_mps = 0.05, kWander = 0.1;
  static constexpr double kLow_hz = 15, kHigh_hz = 500;                ///< band of the filters
  static constexpr double kContentLow_hz = 20, kContentHigh_hz = 450;  ///< band of the texture, well inside

  /// Errors: unsuitable: a texture shorter than 12 mm or with a pitch over 50 um.
  static schema::Result<StrokedTexture> of(const schema::Texture& texture);

  double value(double position_m) const;  ///< by windowed sinc

  schema::Texture banded;  ///< the band-limited texture, with its position 0 at 0
  spatial::MonotonePath path;
  std::vector<double> force;
  spatial::WindowedSinc sinc;
};

/// RMS of a - b re that of b, without the first and last `left_out` values.
double relative_error(const std::vector<double>& a, const std::vector<double>& b, std::size_t left_out);

}  // namespace tacto::analysis
