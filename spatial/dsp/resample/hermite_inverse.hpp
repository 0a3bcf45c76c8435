// SPDX-License-Identifier: GPL-3.0-or-later
// The true inverse of a monotone piecewise cubic: S_x^-1 of Wiertlewski 2011, the time at which the finger
// was at a position. (Interpolation with exchanged axes is another curve: it differs from the inverse between
// knots.)
#pragma once

#include <span>

#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::spatial {

/// The u in [0, 1] at which a segment that rises from y0 to y1 has `value`; 0 below it and 1 above. Newton's
/// method inside a bracket, with bisection where the derivative is near 0; ends when a step is below 1e-10 of
/// the segment.
double solve_segment(const HermiteSegment& segment, double value);

/// The t with S(t) = x, for the curve S through knots (t, x). It copies nothing: the spans must outlive it.
class HermiteInverse {
 public:
  /// Precondition: t and x both strictly increasing, of equal size, at least 2.
  HermiteInverse(std::span<const double> t, std::span<const double> x);
  /// Clamped to the first and last t outside the knots. Error: below 1e-10 of the segment in t.
  double operator()(double x) const;
  /// The same for increasing positions: one search, then one pass over the knots.
  void evaluate_sorted(std::span<const double> at, std::span<double> t) const;

 private:
  std::size_t segment_of(double x) const;
  std::span<const double> t_, x_;
  HermiteCurve curve_;
};

}  // namespace tacto::spatial
