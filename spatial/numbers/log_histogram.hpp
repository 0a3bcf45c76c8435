// SPDX-License-Identifier: GPL-3.0-or-later
// A histogram of magnitudes in little memory: bins a sixty-fourth of an octave wide.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tacto::spatial {

/// Input: numbers (>= 0) from 2^-80 to 2^40, one by one; smaller ones count as 0. A bin is 1.1 % wide. A
/// result is the mean of the numbers in its bin, so numbers that are multiples of a step are returned
/// exactly.
class LogHistogram {
 public:
  LogHistogram();
  void add(double size);
  /// Half of the numbers are smaller; 0 if there are none. Error: 1.1 %.
  double median() const;
  /// Half of the sum of all numbers comes from smaller ones; 0 if there are none. Error: 1.1 %.
  double median_by_sum() const;
  /// The smallest number in the bins above `limit`; infinity if there is none.
  double smallest_above(double limit) const;
  std::uint64_t count_above(double limit) const;
  std::uint64_t count() const { return zeros_ + above_zero(); }

 private:
  struct Bin {
    std::uint64_t count = 0;
    double sum = 0, smallest = 0;
    double mean() const { return sum / static_cast<double>(count); }
  };
  std::uint64_t above_zero() const;
  std::vector<Bin> bins_;
  std::uint64_t zeros_ = 0;
};

}  // namespace tacto::spatial
