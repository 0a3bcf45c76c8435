// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/kernel/interpolation.hpp"

namespace tacto::core {
namespace {

using wire::Interpolation;

constexpr float kTwelfth = 1.0F / 12;
constexpr int kPhases = 256;
constexpr double kPi = 3.14159265358979323846;

// The coefficients of the cubic, for 1, u, u^2 and u^3, of each sample.
Weights hermite(float u) noexcept {
  constexpr float k = kTwelfth;
  constexpr Float4 one{0, 0, 0, 1};
  constexpr Float4 low1{0, k, -8 * k, 0}, low2{0, -2 * k, 15 * k, -28 * k}, low3{0, k, -7 * k, 16 * k};
  constexpr Float4 high1{8 * k, -k, 0, 0}, high2{20 * k, -6 * k, k, 0}, high3{-16 * k, 7 * k, -k, 0};
  const float u2 = u * u;
  return {(one + u * low1) + u2 * (low2 + u * low3), u * high1 + u2 * (high2 + u * high3)};
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

// The weights of each phase sum to one, so that a constant is unchanged.
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

Float4 between(const float* low, const float* high, float rest) noexcept {
  return load_float4(low) + rest * (load_float4(high) - load_float4(low));
}

Weights sinc(float u) noexcept {
  const float place = u * kPhases;
  const auto phase = static_cast<int32_t>(place);
  const float rest = place - static_cast<float>(phase);
  const float *low = kSinc.weights[phase], *high = kSinc.weights[phase + 1];
  return {between(low, high, rest), between(low + 4, high + 4, rest)};
}

Weights of_two(float next) noexcept {
  return {Float4{0, 0, 0, 1 - next}, Float4{next, 0, 0, 0}};
}

}  // namespace

Weights weights_at(Interpolation kind, float u) noexcept {
  switch (kind) {
    case Interpolation::nearest:
      return of_two(u < 0.5F ? 0.0F : 1.0F);
    case Interpolation::linear:
      return of_two(u);
    case Interpolation::sinc:
      return sinc(u);
    case Interpolation::hermite:
      break;
  }
  return hermite(u);
}

}  // namespace tacto::core
