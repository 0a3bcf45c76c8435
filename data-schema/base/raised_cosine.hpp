// SPDX-License-Identifier: GPL-3.0-or-later
// Half a period of a cosine between 0 and 1: the shape of windows, fades, joints and skirts of bands.
#pragma once

#include <cmath>

namespace tacto::schema {

/// 0 at angle 0, 1 at pi; over 2 pi it is Hann's window. Callers give the angle, so that each of them keeps
/// its own rounding.
inline double rising_cosine(double angle_rad) {
  return 0.5 - 0.5 * std::cos(angle_rad);
}
/// 1 at angle 0, 0 at pi.
inline double falling_cosine(double angle_rad) {
  return 0.5 + 0.5 * std::cos(angle_rad);
}

}  // namespace tacto::schema
