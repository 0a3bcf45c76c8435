// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the drift and offset of the device's clock against the host's.
#pragma once

#include <optional>
#include <span>

#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// device_s - host_s = offset_s + drift (host_s - host_s of the first pair).
struct ClockFit {
  double drift_ppm = 0;              ///< above zero: the device's clock is fast
  double drift_uncertainty_ppm = 0;  ///< standard, of the slope, from the scatter (type A)
  double offset_s = 0;               ///< at the first pair
  double scatter_s = 0;              ///< RMS of the residuals: how late messages come
};

/// Ordinary least squares over the pairs. None for fewer than 3 pairs, or if they span less than 10 s: the
/// host's own lateness, some ms, would dominate. The uncertainty assumes independent pairs: a host that is
/// late for long periods has a larger one.
std::optional<ClockFit> fit_clock(std::span<const ClockPair> pairs);

}  // namespace tacto::schema
