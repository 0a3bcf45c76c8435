// SPDX-License-Identifier: GPL-3.0-or-later
// Non-linear least squares within bounds; hides Eigen's Levenberg-Marquardt.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tacto::analysis {

/// Computes all whitened residuals at the coordinates.
using Residuals = std::function<void(std::span<const double> coordinates, std::span<double> residuals)>;

struct Bounds {
  std::vector<double> low, high;
};

struct Solution {
  std::vector<double> coordinates;
  double squares = 0;  ///< sum of the squared residuals
  bool converged = false;
  std::string ended;                    ///< in words
  std::optional<std::size_t> at_bound;  ///< a coordinate at one of its bounds
  int iterations = 0;
  /// Inverse of J^T J at the solution, row by row: the coordinates' covariance if the residuals have variance
  /// 1.
  std::vector<double> covariance;
  double condition = 0;  ///< of J with columns scaled to length 1
};

/// Moré's Levenberg-Marquardt (MINPACK's, in Eigen's unsupported modules) in u, where coordinate = low +
/// (high - low) (1 + tanh u) / 2, so that no step leaves the bounds. The Jacobian uses central differences of
/// 1e-5: exact to 1e-9 for logarithmic coordinates. Converged: its tests (1e-12 of the squares or the step)
/// passed within 200 iterations, and no coordinate is within 1e-3 of the range from a bound. Preconditions:
/// at least as many residuals as coordinates; the start is within the bounds.
Solution least_squares(const Residuals& residuals, std::size_t residual_count, std::vector<double> start,
                       const Bounds& bounds);

/// Errors of a solution whose residuals have different variances. The coordinates' covariance is A J^T W J A,
/// row by row, where A is the inverse of J^T J and W contains (r / (1 - h))^2, with the diagonal h of J A J^T
/// (HC3 of MacKinnon and White 1985). `freedom` is the fewest degrees of freedom of a coordinate's variance
/// (Satterthwaite's, with Gaussian fourth moments). Preconditions: those of least_squares().
struct RobustErrors {
  std::vector<double> covariance;
  double freedom = 0;
};
RobustErrors robust_errors(const Residuals& residuals, std::size_t residual_count, const Solution& solution);

/// x >= 0 that minimises |A x - b| (Lawson and Hanson 1974, active set). `columns` of A, each as long as b.
/// The last `free_columns` of x may be negative.
std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               std::span<const double> b, std::size_t free_columns);

/// Errors of least squares over `columns` (A = Q R). `noise`: for independent errors of b with variance 1,
/// the changes of x along independent directions, one standard error each: the columns of the inverse of R.
/// `taken` and `left`: if b also contains one of the `omitted` columns, the change of x that it causes, and
/// the sum of squares of the rest.
struct ColumnErrors {
  std::vector<std::vector<double>> noise, taken;
  std::vector<double> left;
};
ColumnErrors column_errors(const std::vector<std::vector<double>>& columns,
                           const std::vector<std::vector<double>>& omitted);

}  // namespace tacto::analysis
