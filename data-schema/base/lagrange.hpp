// SPDX-License-Identifier: GPL-3.0-or-later
// The polynomial through some points, by Lagrange's formula.
#pragma once

#include <array>
#include <cstddef>

namespace tacto::schema {

/// At `x`, of the polynomial of degree N - 1 with the values `y` at `nodes`. Precondition: no two nodes are
/// equal.
template <std::size_t N>
double lagrange(const std::array<double, N>& nodes, const std::array<double, N>& y, double x) {
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < N; ++j)
      if (j != i) weight *= (x - nodes[j]) / (nodes[i] - nodes[j]);
    sum += weight * y[i];
  }
  return sum;
}

}  // namespace tacto::schema
