// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/toeplitz.hpp"

#include <cmath>
#include <cstddef>

namespace tacto::playback {
namespace {

/// L of A = L L^T, row by row.
std::vector<double> factor(std::span<const double> row) {
  const std::size_t n = row.size();
  std::vector<double> lower(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = row[i - j];
      for (std::size_t k = 0; k < j; ++k) sum -= lower[i * n + k] * lower[j * n + k];
      lower[i * n + j] = i == j ? std::sqrt(sum) : sum / lower[j * n + j];
    }
  }
  return lower;
}

}  // namespace

std::vector<double> solve_toeplitz(std::span<const double> row, std::span<const double> right) {
  const std::size_t n = row.size();
  const std::vector<double> lower = factor(row);
  std::vector<double> x(right.begin(), right.end());
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= lower[i * n + k] * x[k];
    x[i] /= lower[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= lower[k * n + i] * x[k];
    x[i] /= lower[i * n + i];
  }
  return x;
}

}  // namespace tacto::playback
