// SPDX-License-Identifier: GPL-3.0-or-later
// A running mean that leaves a straight line unchanged, including its ends.
#pragma once

#include <cstddef>
#include <vector>

namespace tacto::analysis {

/// Mean over `reach` values to each side. Near an end the reach is shorter, but equal to both sides.
std::vector<double> local_mean(const std::vector<double>& values, std::size_t reach);

/// 0, v_0, v_0 + v_1, ...: one value more than the input.
std::vector<double> running_sums(const std::vector<double>& values);

}  // namespace tacto::analysis
