// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the finger was on the surface during a stroke, by the normal force.
#pragma once

#include <span>
#include <string>

#include "spatial/strokes/strokes.hpp"

namespace tacto::spatial {

/// The least normal force that counts as touch: 20 mN, a fifth of the lightest load of touch studies (0.1 N)
/// and the weight of 2 g.
inline constexpr double kLightestTouch_n = 0.02;
/// And of the hardest pressed stroke of the record: what a load cell that was not set to zero may keep.
inline constexpr double kUpOfHardest = 0.1;

/// A stroke whose mean normal force lies below it was made with the finger up: a tenth of that of the hardest
/// pressed stroke, at least 20 mN. Precondition: the strokes know their normal force.
double finger_up_below_n(std::span<const Stroke> strokes);

/// Which of the two it was, for people.
std::string why_finger_up(double threshold_n);

}  // namespace tacto::spatial
