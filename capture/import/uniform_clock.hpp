// SPDX-License-Identifier: GPL-3.0-or-later
// The rate and the gaps that a column of times tells of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "capture/import/place_of.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// A clock that ticks evenly, with ticks missing here and there.
struct UniformClock {
  double rate_hz = 0;
  std::vector<schema::Gap> gaps;
};

/// How far a step of time may be from a whole number of periods, in periods. Times are often printed with few
/// digits (3 kHz to 0.1 ms jumps by 0.2 periods); more than this is no even clock.
inline constexpr double kMostJitter = 0.25;

/// Finds the rate, and gaps where whole periods are missing, in one pass over the times where they tick
/// evenly, in two where they don't: survey() all, then end_survey(); where second_pass_needed() says so,
/// locate() all again. Then clock(). The period is the mean of the steps within half of the median step
/// (which is known to 1/64); a rate within 1e-9 of whole hertz is taken to be whole. Memory: the gaps.
class ClockFinder {
 public:
  void survey(std::span<const double> time_s);
  /// Errors: malformed, for less than three times. `file` is for messages.
  schema::Result<void> end_survey(const std::string& file);
  bool second_pass_needed() const { return stands_or_falls_ || uneven_; }

  /// Errors: malformed, for a time that doesn't grow, else for one that is off by more than kMostJitter;
  /// `where` names the row.
  schema::Result<void> locate(std::span<const double> time_s, const PlaceOf& place_of,
                              const std::string& file);

  UniformClock clock() const;

 private:
  // Steps of nearly one length.
  struct Bin {
    std::uint64_t count = 0;
    double sum = 0, smallest = 0, largest = 0;
    void add(double step);
    void add(const Bin& other);
  };
  double median_step() const;
  double find_period() const;
  bool is_one_tick(double step) const;
  schema::Result<void> locate_step(double step, std::uint64_t row, const PlaceOf& place_of,
                                   const std::string& file);

  std::map<std::uint64_t, Bin> bins_;  // by the leading bits of the step
  std::uint64_t count_ = 0, located_ = 0;
  double first_s_ = 0, last_s_ = 0, previous_s_ = 0, period_s_ = 0;
  bool stands_or_falls_ = false, uneven_ = false;
  std::uint64_t missing_ = 0;
  std::vector<schema::Gap> gaps_;
};

}  // namespace tacto::capture
