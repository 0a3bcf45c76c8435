// SPDX-License-Identifier: GPL-3.0-or-later
// The displacement measured by the tray's sensor at a row of a session, and shortly before and after it.
#pragma once

#include <array>
#include <cstddef>

namespace tacto::playback {

/// Shifts in time for which a row has its measured displacement: 1/12 ms apart, 1 ms either way. That is
/// twice the delay of a sensor of 200 Hz at 500 Hz (0.5 ms), and corresponds to fidelity's 50 um at 50 mm/s.
inline constexpr std::size_t kMeasuredShifts = 25, kUnshifted = 12;
inline constexpr double kMeasuredShiftStepS = 1e-3 / 12;

inline constexpr double measured_shift_s(double index) {
  return (index - static_cast<double>(kUnshifted)) * kMeasuredShiftStepS;
}

/// Displacement in m, in the session's band, at the row's time + measured_shift_s(index).
using MeasuredRow = std::array<float, kMeasuredShifts>;

}  // namespace tacto::playback
