// SPDX-License-Identifier: GPL-3.0-or-later
// Range, mean and RMS of samples in one pass, and the samples that are not finite.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::schema {

/// Takes sample by sample. NaN and infinities are counted and otherwise left out; without a finite sample
/// min, max, mean and RMS are NaN.
class Statistics {
 public:
  void add(double value);
  double min() const;
  double max() const;
  double mean() const;
  double rms() const;
  std::uint64_t not_finite() const { return not_finite_; }
  std::uint64_t first_not_finite() const {
    return first_not_finite_;
  }  ///< its index; valid only if there is one

 private:
  double per_number(double sum) const;
  std::uint64_t count_ = 0;  // all samples
  std::uint64_t not_finite_ = 0, first_not_finite_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0, sum_of_squares_ = 0;
};

Statistics statistics_of(std::span<const double> values);

/// Of every channel of a WAV at once, in physical units (stored * scale + offset). Reads block by block, so
/// that a recording of any length fits. `progress`, if given, gets fractions from 0 to 1. Errors: as of
/// WavReader; malformed, if the WAV has another number of channels.
Result<std::vector<Statistics>> channel_statistics(const std::string& wav, std::span<const Channel> channels,
                                                   const std::function<void(double)>& progress = {});

}  // namespace tacto::schema
