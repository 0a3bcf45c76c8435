// SPDX-License-Identifier: GPL-3.0-or-later
// Decimation of a signal without aliasing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Pass band of thinned(), in cycles per sample of the output.
inline constexpr double kThinnedPass = 0.4;

/// The first of the values and every n-th after it (n >= 1), low-passed: the gain is 1 to within 2.5e-7 up to
/// kThinnedPass, and what would alias below that is suppressed by 132 dB. The first and last values continue
/// beyond the ends.
std::vector<double> thinned(std::span<const double> values, std::size_t n);

}  // namespace tacto::spatial
