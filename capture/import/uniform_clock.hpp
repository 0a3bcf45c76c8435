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

/// A longer gap is a wrong time: at 10 kHz it would last a day.
inline constexpr double kLongestGap_samples = 1e9;

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

  /// A program that pauses goes on after any time. From now on locate() takes a step that is no whole number
  /// of periods as a gap to the nearest sample, if it is longer than 1.5 periods and there is at most one for
  /// each thousand rows; the rate is that of the other steps.
  void allow_pauses() { pauses_allowed_ = true; }
  std::uint64_t pauses() const { return pauses_; }

  /// Errors: malformed, for a time that does not increase, a step that deviates by more than kMostJitter, or
  /// a gap above kLongestGap_samples; `where` names the row.
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
  bool is_pause(double step);
  schema::Result<void> locate_step(double step, std::uint64_t row, const PlaceOf& place_of,
                                   const std::string& file);

  std::map<std::uint64_t, Bin> bins_;  // by the leading bits of the step
  std::uint64_t count_ = 0, located_ = 0;
  double first_s_ = 0, last_s_ = 0, previous_s_ = 0, period_s_ = 0;
  bool not_increasing_ = false, uneven_ = false;
  std::uint64_t missing_ = 0;
  bool pauses_allowed_ = false;
  std::uint64_t pauses_ = 0;
  double pauses_s_ = 0, pauses_ticks_ = 0;
  std::vector<schema::Gap> gaps_;
};

}  // namespace tacto::capture
