// SPDX-License-Identifier: GPL-3.0-or-later
// What the tray's sensor measured at a row of a session, and a little before and after it.
#pragma once

#include <array>
#include <cstddef>

namespace tacto::playback {

/// Shifts in time at which a row has its measured displacement, 1/12 ms apart, 1 ms either way: twice what a
/// sensor of 200 Hz is late by at 500 Hz (0.5 ms), and what fidelity's 50 um are at 50 mm/s.
inline constexpr std::size_t kMeasuredShifts = 25, kUnshifted = 12;
inline constexpr double kMeasuredShiftStepS = 1e-3 / 12;

inline constexpr double measured_shift_s(double index) {
  return (index - static_cast<double>(kUnshifted)) * kMeasuredShiftStepS;
}

/// Displacement in m, in the session's band, at the row's time + measured_shift_s(index).
using MeasuredRow = std::array<float, kMeasuredShifts>;

}  // namespace tacto::playback
