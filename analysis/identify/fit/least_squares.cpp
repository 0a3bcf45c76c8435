// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/least_squares.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace tacto::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDerivativeStep = 1e-5;
constexpr double kTolerance = 1e-12;
constexpr int kMostEvaluations = 200;
constexpr double kNearBound = 1e-3;
constexpr double kLeastLeft = 1e-6;  // smallest 1 - leverage; of a value that the model always follows

// Residuals and their derivatives with respect to the bounded coordinates.
struct Problem {
  const Residuals& residuals;
  const Bounds& bounds;
  Index count;

  VectorXd at(const VectorXd& c) const {
    VectorXd r(count);
    residuals({c.data(), static_cast<std::size_t>(c.size())}, {r.data(), static_cast<std::size_t>(count)});
    return r;
  }
  MatrixXd jacobian(const VectorXd& c) const {
    MatrixXd j(count, c.size());
    for (Index i = 0; i < c.size(); ++i) {
      VectorXd ahead = c, behind = c;
      ahead[i] += kDerivativeStep;
      behind[i] -= kDerivativeStep;
      j.col(i) = (at(ahead) - at(behind)) / (2 * kDerivativeStep);
    }
    return j;
  }
  double range(Index i) const { return bounds.high[static_cast<std::size_t>(i)] - low(i); }
  double low(Index i) const { return bounds.low[static_cast<std::size_t>(i)]; }
  VectorXd coordinates(const VectorXd& u) const {
    VectorXd c(u.size());
    for (Index i = 0; i < u.size(); ++i) c[i] = low(i) + range(i) * 0.5 * (1 + std::tanh(u[i]));
    return c;
  }
  VectorXd unbounded(const VectorXd& c) const {
    VectorXd u(c.size());
    for (Index i = 0; i < c.size(); ++i)
      u[i] = std::atanh(std::clamp(2 * (c[i] - low(i)) / range(i) - 1, -0.999, 0.999));
    return u;
  }
};

// The interface for Eigen's algorithm.
struct Functor : Eigen::DenseFunctor<double> {
  Functor(const Problem& of, Index inputs)
      : DenseFunctor(static_cast<int>(inputs), static_cast<int>(of.count)), problem(of) {}
  int operator()(const VectorXd& u, VectorXd& r) const {
    r = problem.at(problem.coordinates(u));
    return r.allFinite() ? 0 : -1;
  }
  int df(const VectorXd& u, MatrixXd& j) const {
    j = problem.jacobian(problem.coordinates(u));
    for (Index i = 0; i < u.size(); ++i)
      j.col(i) *= problem.range(i) * 0.5 * (1 - std::pow(std::tanh(u[i]), 2));
    return j.allFinite() ? 0 : -1;
  }
  const Problem& problem;
};

using Status = Eigen::LevenbergMarquardtSpace::Status;

const char* words_of(Status status) {
  switch (status) {
    case Eigen::LevenbergMarquardtSpace::RelativeReductionTooSmall:
    case Eigen::LevenbergMarquardtSpace::RelativeErrorTooSmall:
    case Eigen::LevenbergMarquardtSpace::RelativeErrorAndReductionTooSmall:
    case Eigen::LevenbergMarquardtSpace::CosinusTooSmall:
    case Eigen::LevenbergMarquardtSpace::FtolTooSmall:
    case Eigen::LevenbergMarquardtSpace::XtolTooSmall:
    case Eigen::LevenbergMarquardtSpace::GtolTooSmall:
      return "no step reduces the residuals";
    case Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation:
      return "not converged after 200 iterations";
    default:
      return "the model gave values that are not finite";
  }
}

std::optional<std::size_t> at_bound(const Problem& problem, const VectorXd& c) {
  for (Index i = 0; i < c.size(); ++i) {
    const double part = (c[i] - problem.low(i)) / problem.range(i);
    if (part < kNearBound || part > 1 - kNearBound) return static_cast<std::size_t>(i);
  }
  return std::nullopt;
}

void add_uncertainty(const Problem& problem, const VectorXd& c, Solution& solution) {
  const MatrixXd j = problem.jacobian(c);
  const MatrixXd covariance = (j.transpose() * j).completeOrthogonalDecomposition().pseudoInverse().eval();
  solution.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  const MatrixXd scaled = j.array().rowwise() / j.colwise().norm().array().max(1e-300);
  const Eigen::JacobiSVD<MatrixXd> svd(scaled.transpose() * scaled);
  const auto& values = svd.singularValues();
  const double least = std::max(values[values.size() - 1], std::numeric_limits<double>::min());
  solution.condition = std::sqrt(values[0] / least);
}

}  // namespace

Solution least_squares(const Residuals& residuals, std::size_t residual_count, std::vector<double> start,
                       const Bounds& bounds) {
  const Problem problem{residuals, bounds, static_cast<Index>(residual_count)};
  const auto inputs = static_cast<Index>(start.size());
  VectorXd u = problem.unbounded(Eigen::Map<const VectorXd>(start.data(), inputs));
  Functor functor(problem, inputs);
  Eigen::LevenbergMarquardt<Functor> solver(functor);
  solver.setFtol(kTolerance);
  solver.setXtol(kTolerance);
  solver.setMaxfev(kMostEvaluations);
  const Status status = solver.minimize(u);
  const VectorXd c = problem.coordinates(u);
  Solution solution;
  solution.coordinates.assign(c.data(), c.data() + c.size());
  solution.squares = problem.at(c).squaredNorm();
  solution.iterations = static_cast<int>(solver.iterations());
  solution.ended = words_of(status);
  solution.at_bound = at_bound(problem, c);
  solution.converged = solution.ended.starts_with("no step") && !solution.at_bound;
  if (solution.at_bound) solution.ended = "a parameter reached its bound";
  add_uncertainty(problem, c, solution);
  return solution;
}

RobustErrors robust_errors(const Residuals& residuals, std::size_t residual_count, const Solution& solution) {
  const Bounds unused;
  const Problem problem{residuals, unused, static_cast<Index>(residual_count)};
  const auto n = static_cast<Index>(solution.coordinates.size());
  const VectorXd c = Eigen::Map<const VectorXd>(solution.coordinates.data(), n);
  const MatrixXd j = problem.jacobian(c);
  const MatrixXd pull = j * Eigen::Map<const MatrixXd>(solution.covariance.data(), n, n);
  const VectorXd leverage = pull.cwiseProduct(j).rowwise().sum();
  const VectorXd left = problem.at(c).array() / (1 - leverage.array()).max(kLeastLeft);
  const MatrixXd moved = left.asDiagonal() * pull;
  const MatrixXd covariance = moved.transpose() * moved;
  const MatrixXd shares = moved.array().square();
  const auto freedom = 3 * shares.colwise().sum().array().square() / shares.colwise().squaredNorm().array();
  return {{covariance.data(), covariance.data() + covariance.size()}, freedom.minCoeff()};
}

namespace {

// The least-squares solution over the columns in use; 0 for the others.
VectorXd solved(const MatrixXd& a, const VectorXd& b, const std::vector<bool>& used) {
  std::vector<Index> which;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) which.push_back(static_cast<Index>(i));
  VectorXd x = VectorXd::Zero(a.cols());
  if (which.empty()) return x;
  MatrixXd part(a.rows(), static_cast<Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) part.col(static_cast<Index>(i)) = a.col(which[i]);
  const VectorXd y = part.colPivHouseholderQr().solve(b);
  for (std::size_t i = 0; i < which.size(); ++i) x[which[i]] = y[static_cast<Index>(i)];
  return x;
}

// Moves from x towards a solution with negative values as far as none becomes negative; the values that reach
// 0 leave the set in use.
void go_back(VectorXd& x, const VectorXd& target, std::vector<bool>& used, Index bounded) {
  double part = 1;
  for (Index i = 0; i < bounded; ++i)
    if (used[static_cast<std::size_t>(i)] && target[i] <= 0) part = std::min(part, x[i] / (x[i] - target[i]));
  x += part * (target - x);
  for (Index i = 0; i < bounded; ++i)
    if (used[static_cast<std::size_t>(i)] && x[i] <= 1e-15 * x.cwiseAbs().maxCoeff())
      used[static_cast<std::size_t>(i)] = false, x[i] = 0;
}

bool is_negative(const VectorXd& x, const std::vector<bool>& used, Index bounded) {
  for (Index i = 0; i < bounded; ++i)
    if (used[static_cast<std::size_t>(i)] && x[i] <= 0) return true;
  return false;
}

}  // namespace

namespace {

// Reduces the problem to a triangle of the columns' number: A = Q R has the same minimum.
struct Triangle {
  MatrixXd r;
  VectorXd y;

  Triangle(const std::vector<std::vector<double>>& columns, std::span<const double> b) {
    const auto rows = static_cast<Index>(b.size()), count = static_cast<Index>(columns.size());
    MatrixXd a(rows, count);
    for (Index i = 0; i < count; ++i)
      a.col(i) = Eigen::Map<const VectorXd>(columns[static_cast<std::size_t>(i)].data(), rows);
    const Eigen::HouseholderQR<MatrixXd> qr(a);
    const VectorXd turned = qr.householderQ().transpose() * Eigen::Map<const VectorXd>(b.data(), rows);
    y = turned.head(count);
    r = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  }
  // The unused column with the largest descent; -1 if none descends.
  Index steepest_unused(const VectorXd& x, const std::vector<bool>& used, Index bounded) const {
    const VectorXd gradient = r.transpose() * (y - r * x);
    Index best = -1;
    double most = 1e-12 * (r.transpose() * y).cwiseAbs().maxCoeff();
    for (Index i = 0; i < bounded; ++i)
      if (!used[static_cast<std::size_t>(i)] && gradient[i] > most) best = i, most = gradient[i];
    return best;
  }
};

}  // namespace

std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               std::span<const double> b, std::size_t free_columns) {
  const Triangle triangle(columns, b);
  const auto count = static_cast<Index>(columns.size());
  const Index bounded = count - static_cast<Index>(free_columns);
  std::vector<bool> used(columns.size(), false);
  for (Index i = bounded; i < count; ++i) used[static_cast<std::size_t>(i)] = true;
  VectorXd x = solved(triangle.r, triangle.y, used);
  for (Index round = 0; round < 3 * count; ++round) {
    const Index best = triangle.steepest_unused(x, used, bounded);
    if (best < 0) break;
    used[static_cast<std::size_t>(best)] = true;
    VectorXd target = solved(triangle.r, triangle.y, used);
    for (; is_negative(target, used, bounded); target = solved(triangle.r, triangle.y, used))
      go_back(x, target, used, bounded);
    x = target;
  }
  return {x.data(), x.data() + x.size()};
}

namespace {

std::vector<std::vector<double>> columns_of(const MatrixXd& m) {
  std::vector<std::vector<double>> list;
  for (Index j = 0; j < m.cols(); ++j) list.emplace_back(m.col(j).data(), m.col(j).data() + m.rows());
  return list;
}

}  // namespace

ColumnErrors column_errors(const std::vector<std::vector<double>>& columns,
                           const std::vector<std::vector<double>>& omitted) {
  std::vector<std::vector<double>> all = columns;
  all.insert(all.end(), omitted.begin(), omitted.end());
  const MatrixXd r = Triangle(all, all.front()).r;
  const auto own = static_cast<Index>(columns.size()), others = static_cast<Index>(omitted.size());
  const auto square = r.topLeftCorner(own, own).triangularView<Eigen::Upper>();
  ColumnErrors errors;
  errors.noise = columns_of(square.solve(MatrixXd::Identity(own, own)));
  errors.taken = columns_of(square.solve(r.topRightCorner(own, others)));
  for (Index j = 0; j < others; ++j) errors.left.push_back(r.col(own + j).tail(others).squaredNorm());
  return errors;
}

}  // namespace tacto::analysis
