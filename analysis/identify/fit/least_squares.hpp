// SPDX-License-Identifier: GPL-3.0-or-later
// Non-linear least squares within bounds: the wall around Eigen's Levenberg-Marquardt.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tacto::analysis {

/// Residuals of coordinates, whitened. Writes all of them.
using Residuals = std::function<void(std::span<const double> coordinates, std::span<double> residuals)>;

struct Bounds {
  std::vector<double> low, high;
};

struct Solution {
  std::vector<double> coordinates;
  double squares = 0;  ///< sum of the squared residuals
  bool converged = false;
  std::string ended;                    ///< in words
  std::optional<std::size_t> at_bound;  ///< the coordinate that stands at one
  int iterations = 0;
  /// Inverse of J^T J at the solution, row by row; for residuals of variance 1 the coordinates' covariance.
  std::vector<double> covariance;
  double condition = 0;  ///< of J with columns of length 1
};

/// Moré's Levenberg-Marquardt (MINPACK's, in Eigen's unsupported modules) in u, where coordinate = low +
/// (high - low) (1 + tanh u) / 2, so that no step leaves the bounds. Jacobian by central differences of 1e-5:
/// exact to 1e-9 for coordinates that are logarithms. Converged: its own tests (1e-12 of the squares or the
/// step) passed within 200 iterations, and no coordinate stands within 1e-3 of the range from a bound.
/// Preconditions: as many residuals as coordinates at least; the start within the bounds.
Solution least_squares(const Residuals& residuals, std::size_t residual_count, std::vector<double> start,
                       const Bounds& bounds);

/// Of a solution whose residuals are not all of one variance: the coordinates' covariance A J^T W J A, row by
/// row, where A is the inverse of J^T J and W holds (r / (1 - h))^2, h being the diagonal of J A J^T (HC3 of
/// MacKinnon and White 1985); and the fewest degrees of freedom that a coordinate's variance is told by
/// (Satterthwaite's, the fourth moments being Gaussian ones). Preconditions: as of least_squares().
struct RobustErrors {
  std::vector<double> covariance;
  double freedom = 0;
};
RobustErrors robust_errors(const Residuals& residuals, std::size_t residual_count, const Solution& solution);

/// x >= 0 that minimises |A x - b| (Lawson and Hanson 1974, active set). `columns` of A, each as long as b.
/// The last `free_columns` of x may be negative.
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               std::span<const double> b, std::size_t free_columns);

/// How least squares over `columns` (A = Q R) err. `noise`: where b errs by independent errors of variance 1,
/// the changes of x along independent directions, one standard error each: the columns of the inverse of R.
/// `taken` and `left`: where b holds one of the `omitted` columns besides, what x takes up of it, and the
/// square sum of the rest.
struct ColumnErrors {
  std::vector<std::vector<double>> noise, taken;
  std::vector<double> left;
};
ColumnErrors column_errors(const std::vector<std::vector<double>>& columns,
                           const std::vector<std::vector<double>>& omitted);

}  // namespace tacto::analysis
