// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/pyramid_shape.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::playback {

double samples_per_period(const PrepareOptions& options) {
  if (options.samples_per_period > 0) return options.samples_per_period;
  if (options.interpolation == wire::Interpolation::hermite) return 16;
  return options.interpolation == wire::Interpolation::sinc ? 6 : 64;
}

PyramidShape pyramid_shape(double highest_per_m, double passes_to_hz, const PrepareOptions& o) {
  PyramidShape shape{o.ends, 1, 0, samples_per_period(o), o.metres_per_count};
  const double per_m = passes_to_hz / o.max_speed_mps;  // passes at the greatest speed
  const double coarsest = std::exp2(0.5 * (wire::kMaxLevels - 1)) * per_m;
  shape.finest_per_m = std::min(std::max(highest_per_m, per_m), coarsest);
  const double steps = std::ceil(2 * std::log2(shape.finest_per_m / per_m));
  shape.levels = std::min(static_cast<int>(steps) + 1, static_cast<int>(wire::kMaxLevels));
  return shape;
}

}  // namespace tacto::playback
