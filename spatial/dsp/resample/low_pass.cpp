// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/low_pass.hpp"

#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tacto::spatial {
namespace {

constexpr double kAttenuation_db = 140;
constexpr double kBeta = 0.1102 * (kAttenuation_db - 8.7);

double sinc(double x) {
  return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
}

double kaiser(double part) {
  return std::cyl_bessel_i(0.0, kBeta * std::sqrt(1 - part * part)) / std::cyl_bessel_i(0.0, kBeta);
}

}  // namespace

std::size_t low_pass_reach(double pass, double stop) {
  assert(0 < pass && pass < stop);
  const double length = (kAttenuation_db - 7.95) / (2.285 * 2 * std::numbers::pi * (stop - pass));
  return static_cast<std::size_t>(std::ceil(length / 2));
}

std::vector<double> low_pass(double pass, double stop) {
  const auto reach = static_cast<double>(low_pass_reach(pass, stop));
  std::vector<double> taps;
  for (double n = -reach; n <= reach; ++n)
    taps.push_back(sinc((pass + stop) * n) * kaiser(n / reach));  // cut-off midway, (pass + stop) / 2
  const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
  for (double& tap : taps) tap /= sum;
  return taps;
}

}  // namespace tacto::spatial
