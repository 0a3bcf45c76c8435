// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/interpolation.hpp"

namespace tacto::core {
namespace {

using wire::Interpolation;

constexpr float kTwelfth = 1.0F / 12;
constexpr int kPhases = 256;
constexpr double kPi = 3.14159265358979323846;

float slope(float before2, float before, float after, float after2) noexcept {
  return (8 * (after - before) - (after2 - before2)) * kTwelfth;
}

float hermite(const float* y, float u) noexcept {
  const float m0 = slope(y[1], y[2], y[4], y[5]), m1 = slope(y[2], y[3], y[5], y[6]);
  const float rise = y[4] - y[3];
  return y[3] + u * (m0 + u * (3 * rise - 2 * m0 - m1 + u * (m0 + m1 - 2 * rise)));
}

// Taylor's series about 0; |x| <= pi / 2, error below 1e-12.
constexpr double sine(double x) {
  double term = x, sum = x;
  for (int n = 1; n < 10; ++n) sum += term *= -x * x / ((2 * n) * (2 * n + 1));
  return sum;
}

// Bessel's I0 at sqrt(4 q): the Kaiser window without a square root.
constexpr double bessel(double q) {
  double term = 1, sum = 1;
  for (int n = 1; n < 40; ++n) sum += term *= q / (static_cast<double>(n) * n);
  return sum;
}

// sin(pi x) / (pi x) under a Kaiser window of +-4 samples, beta^2 / 4 = kQuarterBeta2.
constexpr double kQuarterBeta2 = 16;
constexpr double windowed(double x) {
  if (x <= -4 || x >= 4) return 0;
  int whole = static_cast<int>(x < 0 ? x - 0.5 : x + 0.5);
  const double rest = x - whole;
  const double swing = (whole % 2 == 0 ? 1 : -1) * sine(kPi * rest);
  const double sinc = x == 0 ? 1 : swing / (kPi * x);
  return sinc * bessel(kQuarterBeta2 * (1 - x * x / 16)) / bessel(kQuarterBeta2);
}

struct SincTable {
  float weights[kPhases + 1][kReach];
};

// Each phase's weights sum to one: a constant stays one.
constexpr SincTable make_sinc() {
  SincTable table{};
  for (int phase = 0; phase <= kPhases; ++phase) {
    double row[kReach] = {}, sum = 0;
    for (int i = 0; i < kReach; ++i) sum += row[i] = windowed(i - kBefore - double{1} * phase / kPhases);
    for (int i = 0; i < kReach; ++i) table.weights[phase][i] = static_cast<float>(row[i] / sum);
  }
  return table;
}
constexpr SincTable kSinc = make_sinc();

float sinc(const float* y, float u) noexcept {
  const float place = u * kPhases;
  const auto phase = static_cast<int32_t>(place);
  const float rest = place - static_cast<float>(phase);
  const float *low = kSinc.weights[phase], *high = kSinc.weights[phase + 1];
  float sum = 0;
  for (int i = 0; i < kReach; ++i) sum += y[i] * (low[i] + rest * (high[i] - low[i]));
  return sum;
}

}  // namespace

float interpolated(Interpolation kind, const float* y, float u) noexcept {
  switch (kind) {
    case Interpolation::nearest:
      return y[u < 0.5F ? kBefore : kBefore + 1];
    case Interpolation::linear:
      return y[kBefore] + u * (y[kBefore + 1] - y[kBefore]);
    case Interpolation::sinc:
      return sinc(y, u);
    case Interpolation::hermite:
      break;
  }
  return hermite(y, u);
}

}  // namespace tacto::core
