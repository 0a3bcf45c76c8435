// SPDX-License-Identifier: GPL-3.0-or-later
// How numbers of any size are spread, in little memory: bins a sixty-fourth of an octave wide.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tacto::spatial {

/// Fed number by number with sizes (>= 0) from 2^-80 to 2^40; smaller ones count as 0. 1.1 % from edge to
/// edge of a bin; what it gives is the mean of a bin's numbers, so those of a grid come back as they were.
class LogHistogram {
 public:
  LogHistogram();
  void add(double size);
  /// Half of the numbers are smaller; 0 where there are none. Error: 1.1 %.
  double median() const;
  /// Half of their sum comes from smaller numbers; 0 where there are none. Error: 1.1 %.
  double median_by_sum() const;
  /// The smallest number in the bins above `limit`; infinity where there is none.
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
