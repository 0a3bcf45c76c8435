// SPDX-License-Identifier: GPL-3.0-or-later
// The rate and the gaps that a column of times tells of.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/recording.hpp"

namespace tacto::capture {

/// Names a row of the source for messages: "line 17".
using PlaceOf = std::function<std::string(std::size_t row)>;

/// A clock that ticks evenly, with ticks missing here and there.
struct UniformClock {
  double rate_hz = 0;
  std::vector<schema::Gap> gaps;
};

/// How far a step of time may be from a whole number of periods, in periods. Times are often printed with few
/// digits (3 kHz to 0.1 ms jumps by 0.2 periods); more than this is no even clock.
inline constexpr double kMostJitter = 0.25;

/// Finds the rate, and gaps where whole periods are missing. The period is the mean of the steps within half
/// of the median step; a rate within 1e-9 of whole hertz is taken to be whole. Errors: malformed, for less
/// than three times, one that doesn't grow, one that is off by more than kMostJitter; `where` names the row.
/// `file` is for messages.
schema::Result<UniformClock> find_uniform_clock(std::span<const double> time_s, const PlaceOf& place_of,
                                                const std::string& file);

}  // namespace tacto::capture
