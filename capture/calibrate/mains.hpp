// SPDX-License-Identifier: GPL-3.0-or-later
// Mains lines in noise. Internal to this folder.
#pragma once

#include <span>
#include <vector>

#include "capture/calibrate/tare.hpp"

namespace tacto::capture {

/// See tare_of(). Amplitudes are in the unit of the samples. Lines above 0.45 of the rate, or of
/// `native_rate_hz`, are not searched.
std::vector<MainsLine> mains_lines(std::span<const double> samples, double sample_rate_hz,
                                   double native_rate_hz);

}  // namespace tacto::capture
