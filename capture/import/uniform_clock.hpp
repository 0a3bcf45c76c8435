// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the sample rate and the gaps from a column of times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "capture/import/source_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// A clock with even periods, some of them missing.
struct UniformClock {
  double rate_hz = 0;
  std::vector<schema::Gap> gaps;
};

/// The largest deviation of a time step from a whole number of periods, in periods. Times are often printed
/// with few digits (3 kHz printed to 0.1 ms deviates by 0.2 periods); a clock with a larger deviation is not
/// even.
inline constexpr double kMostJitter = 0.25;

/// Finds the rate, and the gaps where whole periods are missing. One pass over the times is enough if all
/// steps are even, otherwise two: survey() for all, then end_survey(); if second_pass_needed(), locate() for
/// all again; then clock(). The period is the mean of the steps that are within half of the median step
/// (which is known to 1/64). A rate within 1e-9 of a whole number of hertz is rounded to it. Memory: the
/// gaps.
class ClockFinder {
 public:
  void survey(std::span<const double> time_s);
  /// Errors: malformed, for fewer than three times. `file` is for messages.
  schema::Result<void> end_survey(const std::string& file);
  bool second_pass_needed() const { return not_increasing_ || uneven_; }

  /// Errors: malformed, for a time that does not increase, or a step that deviates by more than kMostJitter;
  /// `where` names the row.
  schema::Result<void> locate(std::span<const double> time_s, const PlaceOf& place_of,
                              const std::string& file);

  UniformClock clock() const;

 private:
  // Steps of nearly the same length.
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
  bool not_increasing_ = false, uneven_ = false;
  std::uint64_t missing_ = 0;
  std::vector<schema::Gap> gaps_;
};

}  // namespace tacto::capture
