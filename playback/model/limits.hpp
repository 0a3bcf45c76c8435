// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's limits: how much of them a drive uses, and a drive held within them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"

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

/// What follows a drive's last sample.
enum class AfterDrive { rest, more };

/// Of samples at rate_hz; slew is the step between neighbours, from rest before the first one and to what
/// follows the last one included, times the rate.
Peaks peaks_of(std::span<const double> drive_v, std::span<const double> displacement_m, double rate_hz,
               const schema::Transducer& transducer, AfterDrive after = AfterDrive::rest);

/// Errors: unsuitable, where a limit is passed: by which peak, at what time, and the largest gain that fits.
schema::Result<void> check_limits(const Peaks& peaks, double gain_m_per_n);

/// The gain at which the tightest just fits, where all is proportional to it: gain / used, rounded down in
/// the fourth digit.
double proportional_fit(const Peaks& peaks, double gain_m_per_n);

/// What check_limits() says of one peak, with the gain that fits (0: none is known), and that clipping would
/// help where it would.
tl::unexpected<schema::Error> limit_passed(const Peak& peak, double fitting_m_per_n, bool may_clip);

/// Holds every sample within drive_limit_v, then every step, from rest on, within slew_limit_v_per_s. Gives
/// the number of samples that it changed.
std::size_t clip_drive(std::vector<double>& drive_v, double rate_hz, const schema::Transducer& transducer);

}  // namespace tacto::playback
