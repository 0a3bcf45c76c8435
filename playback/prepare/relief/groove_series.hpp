// SPDX-License-Identifier: GPL-3.0-or-later
// The cosine series of a profile of grooves.
#pragma once

#include "data-schema/scene/force_layer.hpp"
#include "firmware-host/core/scene/grooves.hpp"

namespace tacto::playback {

struct GrooveShape {
  schema::GrooveProfile profile = schema::GrooveProfile::sine;
  double depth_m = 0;   ///< from the lowest to the highest place
  double period_m = 1;  ///< above 0
  double filter_m = 0;  ///< standard deviation of a Gaussian that smooths the profile; 0 for none
};

/// Odd harmonics up to core::kMostHarmonics, or up to the one that the filter attenuates below 1e-6 of the
/// first. The highest place is at phase 0.
core::Grooves groove_series(const GrooveShape& shape);

}  // namespace tacto::playback
