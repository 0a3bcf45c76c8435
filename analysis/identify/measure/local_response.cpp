// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/local_response.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr Index kLocalTerms = 3;                    // of a polynomial of second degree
constexpr double kLocalSingular = 1e-7;             // of the largest singular value; below: not determined
constexpr int kLocalPlaces = 20, kLocalRounds = 6;  // to each side of the best; to 1e-8

struct LocalTable {
  MatrixXcd columns;  // each of length 1
  Eigen::VectorXd lengths;
};

// Powers of the position from -1 to 1: multiplied by the input, and alone.
LocalTable local_table(std::span<const Complex> input, bool transient) {
  const auto count = static_cast<Index>(input.size());
  const double half = static_cast<double>(count - 1) / 2;
  LocalTable table{MatrixXcd(count, transient ? 2 * kLocalTerms : kLocalTerms), {}};
  for (Index row = 0; row < count; ++row) {
    double power = 1;
    for (Index term = 0; term < kLocalTerms; ++term, power *= (static_cast<double>(row) - half) / half) {
      table.columns(row, term) = power * input[static_cast<std::size_t>(row)];
      if (transient) table.columns(row, kLocalTerms + term) = power;
    }
  }
  table.lengths = table.columns.colwise().norm().transpose().cwiseMax(1e-300);
  for (Index i = 0; i < table.columns.cols(); ++i) table.columns.col(i) /= table.lengths(i);
  return table;
}

// The polynomial's terms at a position, scaled for the product with a solution of unit columns.
VectorXcd local_terms_at(const LocalTable& table, double place) {
  VectorXcd terms = VectorXcd::Zero(table.columns.cols());
  double power = 1;
  for (Index term = 0; term < kLocalTerms; ++term, power *= place) terms(term) = power / table.lengths(term);
  return terms;
}

// From -0.5 to 0.5. For a line between two bins the response is known only at the line, so the search is
// refined in rounds.
template <class Variance>
double best_place(const Variance& variance) {
  double best = 0, least = variance(0), step = 0.5 / kLocalPlaces;
  for (int round = 0; round < kLocalRounds; ++round, step /= kLocalPlaces) {
    const double middle = best;
    for (int i = -kLocalPlaces; i <= kLocalPlaces; ++i) {
      const double place = std::clamp(middle + step * i, -0.5, 0.5), here = variance(place);
      if (here < least) least = here, best = place;
    }
  }
  return best;
}

}  // namespace

LocalResponse local_response(std::span<const Complex> input, std::span<const Complex> output,
                             bool transient) {
  const LocalTable table = local_table(input, transient);
  const Eigen::Map<const VectorXcd> answer(output.data(), static_cast<Index>(output.size()));
  const Eigen::JacobiSVD<MatrixXcd> parts(table.columns, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::ArrayXd sizes = parts.singularValues().array();
  // Undetermined directions keep a large variance.
  const Eigen::ArrayXd told = (sizes.square() + std::pow(kLocalSingular * sizes(0), 2)).inverse();
  const VectorXcd along = parts.matrixU().adjoint() * answer;
  const VectorXcd solution = parts.matrixV() * ((sizes * told).cast<Complex>() * along.array()).matrix();
  LocalResponse local;
  local.freedom = static_cast<double>(table.columns.rows() - table.columns.cols());
  local.noise_power = (answer - table.columns * solution).squaredNorm() / local.freedom;
  const auto variance = [&](double place) {
    return (parts.matrixV().adjoint() * local_terms_at(table, place))
        .array()
        .abs2()
        .matrix()
        .dot(told.matrix());
  };
  const double best = best_place(variance);
  local.response = local_terms_at(table, best).transpose() * solution;
  local.variance_for_one = variance(best) / 2;
  local.offset = best * static_cast<double>(input.size() - 1) / 2;
  return local;
}

}  // namespace tacto::analysis
