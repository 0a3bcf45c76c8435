// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's limits: how much of them a drive uses, and a drive held within them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/transducer.hpp"

namespace tacto::playback {

/// The greatest magnitude of something, when it is, and how much is allowed.
struct Peak {
  std::string_view name;  ///< "drive", "displacement", "slew"
  std::string_view unit;
  double value = 0;
  double time_s = 0;  ///< from the drive's start
  double limit = 0;

  double used() const { return value / limit; }
};

struct Peaks {
  Peak drive_v, slew_v_per_s, displacement_m;
  /// The one that uses most of its limit.
  const Peak& tightest() const;
  bool fit() const { return tightest().used() <= 1; }
};

/// Of samples at rate_hz; slew is the step between neighbours, from and to rest at the ends included, times
/// the rate.
Peaks peaks_of(std::span<const double> drive_v, std::span<const double> displacement_m, double rate_hz,
               const schema::Transducer& transducer);

/// Errors: unsuitable, where a limit is passed: by which peak, at what time, and the largest gain that fits.
schema::Result<void> check_limits(const Peaks& peaks, double gain_m_per_n);

/// Holds every sample within drive_limit_v, then every step, from rest on, within slew_limit_v_per_s. Gives
/// the number of samples that it changed.
std::size_t clip_drive(std::vector<double>& drive_v, double rate_hz, const schema::Transducer& transducer);

}  // namespace tacto::playback
