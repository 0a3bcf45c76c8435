// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/plausible_scale.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "capture/calibrate/uncertain.hpp"

namespace tacto::capture {
namespace {

// In an entry, 0 degrees of freedom mean that the uncertainty is not from scatter.
double degrees_of(const schema::CalibrationEntry& entry) {
  return entry.degrees_of_freedom > 0 ? entry.degrees_of_freedom : std::numeric_limits<double>::infinity();
}

}  // namespace

std::string scale_fault(const schema::CalibrationEntry& entry) {
  if (!entry.scale) return {};
  const double ratio = *entry.scale / entry.nominal_scale;
  if (!(ratio >= 1 / kMostOffOwnScale && ratio <= kMostOffOwnScale))
    return fmt::format("the scale of {} would be {:.3g} times the nominal scale of the device", entry.channel,
                       ratio);
  const double interval =
      std::abs(entry.scale_uncertainty.value_or(0) / *entry.scale) * coverage_factor_95(degrees_of(entry));
  if (interval <= kWidestInterval) return {};
  return fmt::format("the scale of {} is known only to +-{:.0f} % (95 %)", entry.channel, 100 * interval);
}

}  // namespace tacto::capture
