// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the finger was on the surface during a stroke, from the normal force.
#pragma once

#include <span>
#include <string>

#include "spatial/strokes/strokes.hpp"

namespace tacto::spatial {

/// The smallest normal force that counts as touch: 20 mN, a fifth of the lightest load of touch studies (0.1
/// N) and the weight of 2 g.
inline constexpr double kLightestTouch_n = 0.02;
/// Share of the force of the hardest pressed stroke of the record: the offset that a load cell may have if it
/// was not set to zero.
inline constexpr double kUpShareOfHardest = 0.1;

/// A stroke with a mean normal force below this was made with the finger up: a tenth of the force of the
/// hardest pressed stroke, at least 20 mN. Precondition: the strokes have a normal force.
double finger_up_below_n(std::span<const Stroke> strokes);

/// The reason for users: which of the two thresholds applies.
std::string why_finger_up(double threshold_n);

}  // namespace tacto::spatial
