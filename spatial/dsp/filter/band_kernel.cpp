// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/band_kernel.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace tacto::spatial {
namespace {

// A low-pass of gain 1 at 0 Hz; `edge` in cycles per sample.
std::vector<double> low_pass(double edge, std::size_t reach) {
  std::vector<double> taps(reach + 1, 0.0);
  if (edge >= 0.5) taps[0] = 1;
  if (edge >= 0.5 || edge <= 0) return taps;
  taps[0] = 2 * edge;
  double sum = taps[0];
  for (std::size_t k = 1; k <= reach; ++k) {
    const double n = static_cast<double>(k);
    taps[k] = std::sin(2 * std::numbers::pi * edge * n) / (std::numbers::pi * n) *
              kernel_window(n / static_cast<double>(reach));
    sum += 2 * taps[k];
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

}  // namespace

double kernel_window(double share) {
  const double u = std::clamp((share - kFlatShare) / (1 - kFlatShare), 0.0, 1.0);
  return 1 - u * u * u * u * (35 - u * (84 - u * (70 - 20 * u)));
}

std::vector<double> band_kernel(Band band, double sample_rate_hz, std::size_t reach) {
  assert(reach >= 1);
  std::vector<double> taps = low_pass(band.high_hz / sample_rate_hz, reach);
  const std::vector<double> below = low_pass(band.low_hz / sample_rate_hz, reach);
  for (std::size_t k = 0; k <= reach; ++k) taps[k] -= below[k];
  return taps;
}

}  // namespace tacto::spatial
