// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numbers>

namespace tacto::analysis {

inline constexpr double kTurn = 2 * std::numbers::pi;       // rad
inline constexpr double kDegrees = 180 / std::numbers::pi;  // a rad

}  // namespace tacto::analysis
