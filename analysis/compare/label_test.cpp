// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/compare/label_test.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace tacto::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::uint64_t kExchangeSeed = 17;
constexpr double kPriorFreedom = 4;
constexpr double kCorrelationShare = 0.7;
constexpr double kDependent = 1e-6;    // part of a column's length that is left if others determine it
constexpr double kLeastSquare = 1e-9;  // dB^2, so that equal strokes have a variance
constexpr double kTie = 1e-9;          // two exchanges that are one up to the sign differ by rounding

Index index(std::size_t i) {
  return static_cast<Index>(i);
}

using Strata = std::map<int, std::vector<std::size_t>>;

Strata strata_of(const LabelledLevels& data) {
  Strata strata;
  for (std::size_t i = 0; i < data.strokes(); ++i) strata[data.stratum[i]].push_back(i);
  return strata;
}

VectorXd side_of(const std::vector<bool>& in_b) {
  VectorXd side(index(in_b.size()));
  for (std::size_t i = 0; i < in_b.size(); ++i) side[index(i)] = in_b[i] ? 1 : 0;
  return side;
}

// What is left of the columns after projection off an orthonormal basis.
MatrixXd off(const MatrixXd& basis, const MatrixXd& columns) {
  return columns - basis * (basis.transpose() * columns);
}

// An orthonormal basis of the strata's means.
MatrixXd strata_basis(const LabelledLevels& data) {
  const Strata strata = strata_of(data);
  MatrixXd basis = MatrixXd::Zero(index(data.strokes()), index(strata.size()));
  Index column = 0;
  for (const auto& [stratum, members] : strata) {
    for (const std::size_t i : members)
      basis(index(i), column) = 1 / std::sqrt(static_cast<double>(members.size()));
    ++column;
  }
  return basis;
}

// ... and of the covariates.
MatrixXd null_basis(const LabelledLevels& data) {
  MatrixXd basis = strata_basis(data);
  for (const std::vector<double>& covariate : data.covariates) {
    const VectorXd column = Eigen::Map<const VectorXd>(covariate.data(), index(covariate.size()));
    VectorXd left = off(basis, column);
    left = off(basis, left);  // twice, against rounding
    if (left.norm() <= kDependent * column.norm()) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = left.normalized();
  }
  return basis;
}

// Sides as columns, the given one first, exchanged within the strata.
MatrixXd exchanged_sides(const LabelledLevels& data) {
  const Strata strata = strata_of(data);
  std::mt19937_64 random(kExchangeSeed);
  MatrixXd sides(index(data.strokes()), index(1 + kExchanges));
  VectorXd side = side_of(data.in_b);
  sides.col(0) = side;
  for (std::size_t draw = 1; draw <= kExchanges; ++draw) {
    for (const auto& [stratum, members] : strata)
      for (std::size_t i = members.size(); i > 1; --i)
        std::swap(side[index(members[i - 1])], side[index(members[random() % i])]);
    sides.col(index(draw)) = side;
  }
  return sides;
}

std::vector<BandWindow> all_windows(std::size_t bands) {
  std::vector<BandWindow> windows;
  for (std::size_t width = 1; width <= std::min(kMostWindowBands, bands); ++width)
    for (std::size_t first = 0; first + width <= bands; ++first) windows.push_back({first, width, 0, 0});
  return windows;
}

// Mean levels over the windows, one window per column.
MatrixXd over_windows(const MatrixXd& bands, const std::vector<BandWindow>& windows) {
  MatrixXd out(bands.rows(), index(windows.size()));
  for (std::size_t w = 0; w < windows.size(); ++w)
    out.col(index(w)) = bands.middleCols(index(windows[w].first), index(windows[w].bands)).rowwise().mean();
  return out;
}

// The data after the null model; the same for all exchanges.
struct LevelResiduals {
  std::vector<BandWindow> windows;
  MatrixXd by_band, by_window;
  MatrixXd band_products;  // e_a' e_b
  VectorXd window_squares;
  double freedom = 0;
};

LevelResiduals residuals_of(const LabelledLevels& data, const MatrixXd& basis) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const MatrixXd levels =
      Eigen::Map<const RowMajor>(data.level_db.data(), index(data.strokes()), index(data.bands));
  LevelResiduals r;
  r.windows = all_windows(data.bands);
  r.by_band = off(basis, levels);
  r.by_window = over_windows(r.by_band, r.windows);
  r.band_products = r.by_band.transpose() * r.by_band;
  r.band_products.diagonal().array() += kLeastSquare;
  r.window_squares = r.by_window.colwise().squaredNorm().array() + kLeastSquare;
  r.freedom = static_cast<double>(data.strokes()) - static_cast<double>(basis.cols()) - 1;
  return r;
}

// Of one side vector of unit length.
struct SideStatistics {
  VectorXd contrast, variance;  // per window; the variance is moderated
  double window = 0, shape = 0;
};

// Windows of one width follow one another.
VectorXd moderated(const LevelResiduals& r, const VectorXd& variance) {
  VectorXd out(variance.size());
  for (Index from = 0; from < variance.size();) {
    const std::size_t width = r.windows[static_cast<std::size_t>(from)].bands;
    Index to = from;
    while (to < variance.size() && r.windows[static_cast<std::size_t>(to)].bands == width) ++to;
    const auto part = variance.segment(from, to - from);
    out.segment(from, to - from) =
        (kPriorFreedom * part.mean() + r.freedom * part.array()) / (kPriorFreedom + r.freedom);
    from = to;
  }
  return out;
}

double shape_statistic(const LevelResiduals& r, const SideStatistics& s) {
  const Index bands = r.by_band.cols();
  const VectorXd contrast = s.contrast.head(bands);
  const MatrixXd products = r.band_products - contrast * contrast.transpose();
  const VectorXd scale = products.diagonal().cwiseSqrt().cwiseInverse();
  MatrixXd correlation = kCorrelationShare * (scale.asDiagonal() * products * scale.asDiagonal());
  correlation.diagonal().array() += 1 - kCorrelationShare;
  const VectorXd t = contrast.array() / s.variance.head(bands).array().sqrt();
  return t.dot(correlation.llt().solve(t));
}

SideStatistics statistics_of(const LevelResiduals& r, const VectorXd& side) {
  SideStatistics s;
  s.contrast = r.by_window.transpose() * side;
  s.variance = moderated(r, (r.window_squares - s.contrast.cwiseAbs2()) / r.freedom);
  s.window = (s.contrast.array().square() / s.variance.array()).maxCoeff();
  s.shape = shape_statistic(r, s);
  return s;
}

// The part of all values that are at least as large as each one.
std::vector<double> upper_ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values, ranks;
  std::ranges::sort(sorted);
  for (const double value : values) {
    const auto from = std::ranges::lower_bound(sorted, value - kTie * std::abs(value));
    ranks.push_back(static_cast<double>(sorted.end() - from) / static_cast<double>(sorted.size()));
  }
  return ranks;
}

// p of the first value: the part of all values that are at most as large.
double lower_rank_of_first(const std::vector<double>& values) {
  const auto smaller =
      std::ranges::count_if(values, [&](double value) { return value <= values.front() * (1 + kTie); });
  return static_cast<double>(smaller) / static_cast<double>(values.size());
}

void judge(LabelTest& test, const std::vector<double>& window, const std::vector<double>& shape) {
  const std::vector<double> window_p = upper_ranks(window), shape_p = upper_ranks(shape);
  std::vector<double> smaller(window_p.size());
  std::ranges::transform(window_p, shape_p, smaller.begin(),
                         [](double a, double b) { return std::min(a, b); });
  test.window_statistic = window.front();
  test.window_p = window_p.front();
  test.shape_statistic = shape.front();
  test.shape_p = shape_p.front();
  test.p = lower_rank_of_first(smaller);
  std::vector<double> sorted = window;
  std::ranges::sort(sorted);
  test.reach =
      std::sqrt(sorted[static_cast<std::size_t>((1 - kTestLevel) * static_cast<double>(sorted.size()))]);
}

void describe(LabelTest& test, const LevelResiduals& r, const SideStatistics& s, double length) {
  test.windows = r.windows;
  double strongest = -1;
  for (std::size_t w = 0; w < test.windows.size(); ++w) {
    const double contrast = s.contrast[index(w)], error = std::sqrt(s.variance[index(w)]);
    test.windows[w].level_db = contrast / length;
    test.windows[w].error_db = error / length;
    if (std::abs(contrast) / error > strongest) {
      strongest = std::abs(contrast) / error;
      test.strongest = w;
    }
  }
  const VectorXd contrast = s.contrast.head(r.by_band.cols());
  test.spread_db = std::sqrt((r.band_products.diagonal() - contrast.cwiseAbs2()).mean() / r.freedom);
}

}  // namespace

double exchanges(const LabelledLevels& data) {
  double logarithm = 0;
  for (const auto& [stratum, members] : strata_of(data)) {
    const auto n = static_cast<double>(members.size());
    const auto b = static_cast<double>(
        std::ranges::count_if(members, [&](std::size_t i) { return static_cast<bool>(data.in_b[i]); }));
    logarithm += std::lgamma(n + 1) - std::lgamma(b + 1) - std::lgamma(n - b + 1);
  }
  return std::round(std::exp(logarithm));
}

double separable_part(const LabelledLevels& data) {
  const VectorXd side = side_of(data.in_b);
  const double within = off(strata_basis(data), side).squaredNorm();
  if (within < kDependent) return 0;
  return off(null_basis(data), side).squaredNorm() / within;
}

LabelTest label_test(const LabelledLevels& data) {
  const MatrixXd basis = null_basis(data);
  const LevelResiduals residuals = residuals_of(data, basis);
  const MatrixXd sides = off(basis, exchanged_sides(data));
  LabelTest test;
  std::vector<double> window, shape;
  for (Index i = 0; i < sides.cols(); ++i) {
    const double length = sides.col(i).norm();
    if (length < kDependent) continue;  // the null model determines this exchange
    const SideStatistics s = statistics_of(residuals, sides.col(i) / length);
    window.push_back(s.window);
    shape.push_back(s.shape);
    if (i == 0) describe(test, residuals, s, length);
  }
  judge(test, window, shape);
  return test;
}

}  // namespace tacto::analysis
