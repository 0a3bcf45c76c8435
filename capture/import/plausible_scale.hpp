// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a measured scale is plausible for its device.
#pragma once

#include <string>

#include "data-schema/calibration/calibration.hpp"

namespace tacto::capture {

/// The largest factor between the scale and the nominal scale, in either direction, and the largest width of
/// the 95 % interval as a fraction of the scale. Our choice: nominal gains are known to some ten per cent. So
/// beyond a factor of two a unit or a weight is wrong, and beyond a fifth the nominal scale is the better
/// one.
inline constexpr double kMostOffOwnScale = 2, kWidestInterval = 0.2;

/// The reason why the entry's scale is implausible: its ratio to the nominal scale (also a negative one), or
/// its interval. Empty if it is plausible, or if the entry has no scale.
std::string scale_fault(const schema::CalibrationEntry& entry);

}  // namespace tacto::capture
