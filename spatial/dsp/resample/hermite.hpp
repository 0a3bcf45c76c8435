// SPDX-License-Identifier: GPL-3.0-or-later
// Piecewise cubic Hermite interpolation that keeps monotone data monotone (Fritsch and Carlson 1980; slopes
// of Fritsch and Butland 1984, the same as SciPy's PchipInterpolator). It is S_x and S_f of Wiertlewski 2011.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tacto::spatial {

/// Slopes at the knots. `x` strictly increasing, at least 2 knots; x and y of equal size. Units: y per x.
std::vector<double> hermite_slopes(std::span<const double> x, std::span<const double> y);

/// The same for knots `step` > 0 apart; at least 2 values.
std::vector<double> hermite_slopes_uniform(double step, std::span<const double> y);

/// Both, written into the caller's memory for y.size() slopes.
void hermite_slopes(std::span<const double> x, std::span<const double> y, std::span<double> slopes);
void hermite_slopes_uniform(double step, std::span<const double> y, std::span<double> slopes);

/// One segment between two knots in its local variable u = (x - x0) / h in [0, 1].
struct HermiteSegment {
  double y0, y1;  ///< values at the ends
  double m0, m1;  ///< slopes at the ends, times h

  double value(double u) const { return y0 + rise(u); }
  /// value(u) - y0, without the rounding errors of a large y0.
  double rise(double u) const {
    const double dy = y1 - y0;
    return u * (m0 + u * (3 * dy - 2 * m0 - m1 + u * (m0 + m1 - 2 * dy)));
  }
  /// d value / d u
  double derivative(double u) const {
    const double dy = y1 - y0;
    return m0 + u * (2 * (3 * dy - 2 * m0 - m1) + u * 3 * (m0 + m1 - 2 * dy));
  }
};

/// The interpolant through knots. It copies nothing: the spans must outlive it.
class HermiteCurve {
 public:
  /// Preconditions: those of hermite_slopes().
  HermiteCurve(std::span<const double> x, std::span<const double> y);
  /// Value at x; outside the knots the end segments are extrapolated (check the range if that is not
  /// acceptable).
  double operator()(double x) const;
  /// Values at increasing positions: one pass over the knots, no search.
  void evaluate_sorted(std::span<const double> at, std::span<double> out) const;
  HermiteSegment segment(std::size_t i) const;

 private:
  std::span<const double> x_, y_;
  std::vector<double> slopes_;
};

/// The interpolant through evenly spaced knots start + i step, which needs no search. The span must outlive
/// it.
class UniformHermiteCurve {
 public:
  /// Preconditions: those of hermite_slopes_uniform().
  UniformHermiteCurve(double start, double step, std::span<const double> y);
  /// Value at x; outside the knots the end segments are extrapolated.
  double operator()(double x) const;
  HermiteSegment segment(std::size_t i) const;

 private:
  double start_, step_;
  std::span<const double> y_;
  std::vector<double> slopes_;
};

}  // namespace tacto::spatial
