// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a scale that was found can be what the device has.
#pragma once

#include <string>

#include "data-schema/calibration/calibration.hpp"

namespace tacto::capture {

/// How far a device's own scale may be off, as a factor either way, and how wide the interval of 95 % may be,
/// as a part of the scale. Ours: nominal gains are known to some ten per cent, so beyond a factor of two a
/// unit or a weight was mistaken, and beyond a fifth the device's own scale is the better one.
inline constexpr double kMostOffOwnScale = 2, kWidestInterval = 0.2;

/// What says that the entry's scale is a mistake: its ratio to the device's own (below zero, too), or its
/// interval. Empty where nothing does, or the entry has no scale.
std::string doubt_of_scale(const schema::CalibrationEntry& entry);

}  // namespace tacto::capture
