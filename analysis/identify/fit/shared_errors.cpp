// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/shared_errors.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

namespace tacto::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kLeastShared = 1e-2;  // of the noise; smaller shared errors are ignored

MatrixXd over_the_noise(const BodeData& data) {
  MatrixXd b(static_cast<Index>(2 * data.size()), static_cast<Index>(data.shared_errors.size()));
  for (Index j = 0; j < b.cols(); ++j)
    for (std::size_t i = 0; i < data.size(); ++i) {
      const auto error =
          data.response[i] * data.shared_errors[static_cast<std::size_t>(j)][i] / sigma_at(data, i);
      b(static_cast<Index>(2 * i), j) = error.real();
      b(static_cast<Index>(2 * i + 1), j) = error.imag();
    }
  return b;
}

}  // namespace

SharedErrors::SharedErrors(const BodeData& data) {
  if (data.shared_errors.empty()) return;
  const MatrixXd b = over_the_noise(data);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> squares(b.transpose() * b);
  for (Index j = 0; j < b.cols(); ++j) {
    const double size = std::sqrt(std::max(0.0, squares.eigenvalues()[j]));
    if (size < kLeastShared) continue;
    const Eigen::VectorXd direction = b * squares.eigenvectors().col(j) / size;
    directions_.emplace_back(direction.data(), direction.data() + direction.size());
    taken_.push_back(1 - 1 / std::sqrt(1 + size * size));
  }
}

void SharedErrors::take_from(std::span<double> residuals) const {
  std::vector<double> sizes;
  for (const auto& direction : directions_)
    sizes.push_back(std::inner_product(direction.begin(), direction.end(), residuals.begin(), 0.0));
  for (std::size_t j = 0; j < sizes.size(); ++j)
    for (std::size_t i = 0; i < residuals.size(); ++i)
      residuals[i] -= taken_[j] * sizes[j] * directions_[j][i];
}

std::vector<std::complex<double>> turned_residuals(const BodeData& data,
                                                   std::span<const std::complex<double>> modelled) {
  std::vector<double> parts;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto residual = (data.response[i] - modelled[i]) / sigma_at(data, i);
    parts.insert(parts.end(), {residual.real(), residual.imag()});
  }
  SharedErrors(data).take_from(parts);
  std::vector<std::complex<double>> turned;
  for (std::size_t i = 0; i < data.size(); ++i)
    turned.push_back(std::complex<double>(parts[2 * i], parts[2 * i + 1]) *
                     std::polar(1.0, -std::arg(modelled[i])));
  return turned;
}

}  // namespace tacto::analysis
