// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer samples of a signal, without folding.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Cycles a kept sample up to which thinned() keeps everything.
inline constexpr double kThinnedPass = 0.4;

/// The first of the values and every n-th after it (n >= 1), low-passed: all is kept to 2.5e-7 up to
/// kThinnedPass, and what would fold back under that is suppressed by 132 dB. Beyond the ends the ends' own
/// values go on.
std::vector<double> thinned(std::span<const double> values, std::size_t n);

}  // namespace tacto::spatial
