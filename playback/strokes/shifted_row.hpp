// SPDX-License-Identifier: GPL-3.0-or-later
// A displacement at a row of a session, and shortly before and after it: for errors without a constant delay.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tacto::playback {

/// Shifts in time for which a row has its displacement: 1/12 ms apart, 1 ms either way. That is twice the
/// delay of a sensor of 200 Hz at 500 Hz (0.5 ms), and corresponds to fidelity's 50 um at 50 mm/s.
inline constexpr std::size_t kShifts = 25, kUnshifted = 12;
inline constexpr double kShiftStepS = 1e-3 / 12;

inline constexpr double shift_s_at(double index) {
  return (index - static_cast<double>(kUnshifted)) * kShiftStepS;
}

/// Displacement in m, in the session's band, at the row's time + shift_s_at(index).
using ShiftedRow = std::array<float, kShifts>;

/// Readings per period of the band's upper edge between which shifted_row() interpolates: its error is then
/// (2 pi / 32)^4 / 48, -90 dB.
inline constexpr double kReadingsAPeriod = 32;

/// Samples of a displacement, m, at `rate_hz`, around the time of sample `at`; constant beyond the ends. By a
/// Catmull-Rom spline, whose weights differ for each shift, because a shift is not a whole number of
/// readings.
inline ShiftedRow shifted_row(const std::vector<double>& fine_m, double rate_hz, double at) {
  const double last = static_cast<double>(fine_m.size()) - 1;
  const auto reading = [&](double index) {
    return fine_m[static_cast<std::size_t>(std::clamp(index, 0.0, last))];
  };
  ShiftedRow values;
  for (std::size_t i = 0; i < kShifts; ++i) {
    const double index = at + shift_s_at(static_cast<double>(i)) * rate_hz;
    const double whole = std::floor(index), u = index - whole;
    const double a = reading(whole - 1), b = reading(whole), c = reading(whole + 1), d = reading(whole + 2);
    const double value = b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
    values[i] = static_cast<float>(value);
  }
  return values;
}

}  // namespace tacto::playback
