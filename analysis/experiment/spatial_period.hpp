// SPDX-License-Identifier: GPL-3.0-or-later
// The period of a displacement along position.
#pragma once

#include <optional>
#include <span>

namespace tacto::analysis {

/// The period at the largest peak of the spectrum over position, with a Hann window over the whole path and
/// each sample weighted by the way that it stands for, so that the speed has no effect. Periods from 0.2 mm
/// to a quarter of the path. For a sinusoid of 10 periods the error is below 1e-3: the part of its negative
/// frequency under the window, at most (periods)^-3. None: fewer than 8 samples, a path below 1 mm, or no
/// displacement. Precondition: both have the same length; the position moves in one direction.
std::optional<double> spatial_period_m(std::span<const double> position_m,
                                       std::span<const double> displacement_m);

}  // namespace tacto::analysis
