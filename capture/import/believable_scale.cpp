// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/believable_scale.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "capture/calibrate/uncertain.hpp"

namespace tacto::capture {
namespace {

// An entry writes 0 for an uncertainty that does not come from scatter.
double degrees_of(const schema::CalibrationEntry& entry) {
  return entry.degrees_of_freedom > 0 ? entry.degrees_of_freedom : std::numeric_limits<double>::infinity();
}

}  // namespace

std::string doubt_of_scale(const schema::CalibrationEntry& entry) {
  if (!entry.scale) return {};
  const double ratio = *entry.scale / entry.nominal_scale;
  if (!(ratio >= 1 / kMostOffOwnScale && ratio <= kMostOffOwnScale))
    return fmt::format("the scale of {} would be {:.3g} times the device's own", entry.channel, ratio);
  const double interval =
      std::abs(entry.scale_uncertainty.value_or(0) / *entry.scale) * coverage_factor_95(degrees_of(entry));
  if (interval <= kWidestInterval) return {};
  return fmt::format("the scale of {} is known to +-{:.0f} % only (95 %)", entry.channel, 100 * interval);
}

}  // namespace tacto::capture
