// SPDX-License-Identifier: GPL-3.0-or-later
// Slow references in extended precision, against which the errors of the library are measured.
#pragma once

#include <span>
#include <vector>

namespace tacto::spatial::reference {

/// The monotone cubic through knots (t, x), in long double, with its inverse by bisection alone.
class ExactHermite {
 public:
  /// Precondition: t strictly increasing, at least 2 knots; x strictly increasing too if inverse() is called.
  ExactHermite(std::span<const double> t, std::span<const double> x);
  long double value(long double t) const;
  /// 120 bisection steps: exact to the last bit of t.
  long double inverse(long double x) const;

 private:
  long double slope(std::size_t i) const;
  std::vector<long double> t_, x_;
};

}  // namespace tacto::spatial::reference
