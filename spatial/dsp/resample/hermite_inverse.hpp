// SPDX-License-Identifier: GPL-3.0-or-later
// The true inverse of a monotone piecewise cubic: S_x^-1 of Wiertlewski 2011, where the finger was when.
// (Interpolating with the axes swapped is another curve: between knots it differs from the inverse.)
#pragma once

#include <span>

#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::spatial {

/// The u in [0, 1] where a segment that rises from y0 to y1 takes `value`; 0 below it and 1 above. Newton's
/// steps inside a bracket, halving where the derivative nears 0; ends when a step is under 1e-10 of the
/// segment.
double solve_segment(const HermiteSegment& segment, double value);

/// Gives t where S(t) = x, for the curve S through knots (t, x). Copies nothing: the spans must outlive it.
class HermiteInverse {
 public:
  /// t and x both strictly increasing, of equal size, at least 2.
  HermiteInverse(std::span<const double> t, std::span<const double> x);
  /// Clamped to the first and last t outside the knots. Error: below 1e-10 of the segment in t.
  double operator()(double x) const;
  /// The same for positions that grow: one search, then a walk over the knots.
  void evaluate_sorted(std::span<const double> at, std::span<double> t) const;

 private:
  std::size_t segment_of(double x) const;
  std::span<const double> t_, x_;
  HermiteCurve curve_;
};

}  // namespace tacto::spatial
