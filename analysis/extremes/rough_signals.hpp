// SPDX-License-Identifier: GPL-3.0-or-later
// Test signals for the conditions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace tacto::analysis {

inline double largest_of(std::span<const double> values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

inline double largest_difference(std::span<const double> a, std::span<const double> b) {
  double size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) size = std::max(size, std::abs(a[i] - b[i]));
  return size;
}

/// White noise plus a random walk: energy at all frequencies, most of it at low ones.
inline std::vector<double> rough_values(std::size_t size, double scale = 1) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<double> values(size);
  double level = 3;
  for (double& value : values) {
    level += 0.1 * normal(random);
    value = scale * (level + normal(random));
  }
  return values;
}

inline std::vector<double> step_values(std::size_t size) {
  std::vector<double> values(size, 0.0);
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(size / 2), values.end(), 1.0);
  return values;
}

}  // namespace tacto::analysis
