// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's limits: how much of them a drive uses, and how to clip a drive to them.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::playback {

/// The greatest magnitude of a quantity, its time, and its limit.
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
  /// The peak that uses most of its limit.
  const Peak& tightest() const;
  bool fit() const { return tightest().used() <= 1; }
};

/// What follows a drive's last sample.
enum class AfterDrive { rest, more };

/// For samples at rate_hz. Slew is the step between neighbours times the rate, including the step from rest
/// to the first sample and that from the last one to what follows.
Peaks peaks_of(std::span<const double> drive_v, std::span<const double> displacement_m, double rate_hz,
               const schema::Transducer& transducer, AfterDrive after = AfterDrive::rest);

/// Errors: unsuitable, if a limit is exceeded: which peak, at what time, and the largest gain that fits.
schema::Result<void> check_limits(const Peaks& peaks, double gain_m_per_n, double default_gain_m_per_n);

/// The largest gain whose peaks fit, by proportional estimates that are tested, because with an energy limit
/// or a hysteresis the peaks are not proportional to the gain. `peaks` are those at `gain_m_per_n`, `at`
/// gives them at another gain. 0: none of 30 fits.
double fitting_gain(double gain_m_per_n, Peaks peaks, const std::function<Peaks(double gain_m_per_n)>& at);

/// The error of check_limits() for one peak, with the gain that fits (0: none is known) and as a factor of
/// the default; `may_clip` adds the hint to clip.
tl::unexpected<schema::Error> limit_passed(const Peak& peak, double fitting_m_per_n,
                                           double default_gain_m_per_n, bool may_clip);

/// Clips each sample to drive_limit_v, then each step, beginning from rest, to slew_limit_v_per_s. Returns
/// the number of samples changed.
std::size_t clip_drive(std::vector<double>& drive_v, double rate_hz, const schema::Transducer& transducer);

}  // namespace tacto::playback
