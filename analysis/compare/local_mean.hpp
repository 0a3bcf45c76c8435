// SPDX-License-Identifier: GPL-3.0-or-later
// A running mean that keeps a straight line as it is, up to the ends.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::analysis {

/// Mean over `reach` values to each side; nearer than that to an end over as many as the end allows, the same
/// number to each side.
std::vector<double> local_mean(const std::vector<double>& values, std::size_t reach);

/// v_0, v_0 + v_1, ... after a leading 0: one more value than there are.
std::vector<double> running_sums(const std::vector<double>& values);

}  // namespace tacto::analysis
