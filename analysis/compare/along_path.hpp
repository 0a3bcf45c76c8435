// SPDX-License-Identifier: GPL-3.0-or-later
// A signal over time, as a texture along the way that the finger went meanwhile.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

struct SignalAlongPath {
  std::span<const double> values, position_m;  ///< of equal length; one stroke, which does not turn
  double rate_hz = 0;
  double quantum_m = 0;  ///< step of the positions, 0 where they have none
  spatial::Band band;    ///< in Hz, in which the values are known
  double pitch_m = 1e-6;
  std::string quantity, unit;
};

/// f(x_i) = S_f(S_x^-1(x_i)) as spatial::TextureMaker makes it, by windowed sinc; position 0 of the texture
/// is the lowest place that a multiple of the pitch lies on, source_origin_m is where that was. The valid
/// band is the one in Hz over the finger's speed. Errors: unsuitable: a finger that gets nowhere, fewer than
/// 64 samples.
schema::Result<schema::Texture> texture_along(const SignalAlongPath& signal);

}  // namespace tacto::analysis
