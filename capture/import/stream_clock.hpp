// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the sample rate and the gaps of a stream of the Lab Streaming Layer from the times of its samples.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/import/uniform_clock.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/exchange/xdf_file.hpp"

namespace tacto::capture {

/// Of a stream whose times scatter: a longer step is a gap, as in pyxdf (jitter_break_threshold_seconds and
/// _samples); a shorter one cannot be told from scatter.
inline constexpr double kLongestScatter_s = 1;
inline constexpr double kLongestScatter_samples = 500;

/// A jump of the stream's clock against the recorder's, or a step back, from which the clock was reset. LSL's
/// clocks do not jump, and pyxdf has the same threshold (clock_reset_threshold_offset_seconds).
inline constexpr double kClockReset_s = 1;

struct StreamClock {
  UniformClock clock;                 ///< by the recorder's clock, if offset_drift() is certain
  std::string words;                  ///< where the rate is from, for the recording
  std::vector<std::string> warnings;  ///< scatter; a large drift; a rate far from the nominal one
};

/// The times are even, with missing whole periods and a few pauses (ClockFinder); or, if they scatter and the
/// stream has a nominal rate, the rate is the slope of a least-squares line through times against sample
/// numbers, one line for each part between gaps, all with the same slope. Errors: unsuitable, for a clock
/// that was reset or jumped over more than kLongestGap_samples, with its time; malformed, for times that are
/// not even in a stream without a nominal rate; as read_xdf(). Reads the samples once, twice if they have
/// gaps or scatter.
schema::Result<StreamClock> find_stream_clock(const std::string& file, const schema::XdfStream& stream,
                                              const std::function<void(double)>& progress);

}  // namespace tacto::capture
