// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a signal over time to a texture along the finger's path.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

struct SignalAlongPath {
  std::span<const double> values, position_m;  ///< of equal length; one stroke in one direction
  double rate_hz = 0;
  double quantum_m = 0;  ///< step of the positions; 0 if they are not quantised
  spatial::Band band;    ///< in Hz; the values are valid in it
  double pitch_m = 1e-6;
  std::string quantity, unit;
};

/// f(x_i) = S_f(S_x^-1(x_i)) as spatial::TextureMaker computes it, by windowed sinc. Position 0 of the
/// texture is the lowest multiple of the pitch on the path; source_origin_m is its place on the path. The
/// valid band is the band in Hz divided by the finger's speed. Errors: unsuitable: a finger that does not
/// move, fewer than 64 samples.
schema::Result<schema::Texture> texture_along(const SignalAlongPath& signal);

}  // namespace tacto::analysis
