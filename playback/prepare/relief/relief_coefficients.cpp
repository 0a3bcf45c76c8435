// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/relief/relief_coefficients.hpp"

#include <cassert>

namespace tacto::playback {
namespace {

// (c[i-1] + 4 c[i] + c[i+1]) / 6 = h[i], with c[-1] = c[0] and c[n] = c[n-1]: elimination forwards, then
// backwards.
class SplineSystem {
 public:
  explicit SplineSystem(std::size_t size) : above_(size) {
    for (std::size_t i = 0; i < size; ++i) above_[i] = 1 / (diagonal(i) - (i > 0 ? above_[i - 1] : 0));
  }

  void solve(double* values, std::size_t stride) const {
    const std::size_t n = above_.size();
    double before = 0;
    for (std::size_t i = 0; i < n; ++i)
      before = values[i * stride] = (6 * values[i * stride] - before) * above_[i];
    for (std::size_t i = n - 1; i > 0; --i) values[(i - 1) * stride] -= above_[i - 1] * values[i * stride];
  }

 private:
  double diagonal(std::size_t i) const { return 4 + (i == 0 ? 1 : 0) + (i + 1 == above_.size() ? 1 : 0); }

  std::vector<double> above_;  // of the eliminated rows: 1 over the diagonal
};

}  // namespace

std::vector<float> relief_coefficients(std::span<const double> heights, std::size_t columns,
                                       std::size_t rows) {
  assert(columns > 0 && rows > 0 && heights.size() == columns * rows);
  std::vector<double> c(heights.begin(), heights.end());
  const SplineSystem along_x(columns), along_y(rows);
  for (std::size_t row = 0; row < rows; ++row) along_x.solve(c.data() + row * columns, 1);
  for (std::size_t column = 0; column < columns; ++column) along_y.solve(c.data() + column, columns);
  return {c.begin(), c.end()};
}

}  // namespace tacto::playback
