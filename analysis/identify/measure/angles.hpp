// SPDX-License-Identifier: GPL-3.0-or-later
// Angles: radians per turn, degrees per radian, and the unwrapped phase of a curve.
#pragma once

#include <complex>
#include <numbers>
#include <vector>

namespace tacto::analysis {

inline constexpr double kTurn = 2 * std::numbers::pi;       // rad
inline constexpr double kDegrees = 180 / std::numbers::pi;  // per rad

/// Unwrapped phase of a curve in degrees: each value continues the one before without jumps of whole turns.
std::vector<double> carried_phase_deg(const std::vector<std::complex<double>>& curve);

}  // namespace tacto::analysis
