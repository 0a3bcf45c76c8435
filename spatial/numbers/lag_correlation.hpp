// SPDX-License-Identifier: GPL-3.0-or-later
// The correlation of two rows of values at every shift of one against the other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// All shifts at once by Fourier transforms; needs memory for those of both.
class LagCorrelation {
 public:
  LagCorrelation(std::span<const double> a, std::span<const double> b);

  /// sum(a_i b_i+lag) / sqrt(sum a_i^2 sum b_i+lag^2) over their overlap; -1 if that is less than half of the
  /// shorter one, 0 if one of them is zero there.
  double at(std::ptrdiff_t lag) const;

 private:
  std::ptrdiff_t a_size_, b_size_;
  std::vector<double> products_;             // sum_i a[i] b[i + m] at index m; negative m are at the end
  std::vector<double> a_energy_, b_energy_;  // running sums of squares
};

}  // namespace tacto::spatial
