// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/dft321.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::spatial {
namespace {

using Axes = std::array<std::vector<double>, 3>;

Dft321 reduced(const Axes& axes) {
  const std::array<std::span<const double>, 3> spans = {axes[0], axes[1], axes[2]};
  return dft321(spans);
}

std::vector<double> white_noise_g(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(n);
  for (double& value : values) value = normal(random);
  return values;
}

std::vector<std::complex<double>> spectrum_of(const std::vector<double>& values) {
  RealFft fft(values.size());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(values, spectrum);
  return spectrum;
}

// Rounding of transforms of n values: some eps sqrt(n log n); 1e-12 of the largest bin leaves a factor 100.
TEST(Dft321, KeepsTheMagnitudeOfEveryBin) {
  for (const std::size_t n : {1U, 2U, 97U, 1000U, 4099U}) {
    const Axes axes = {white_noise_g(n, 1), white_noise_g(n, 2), white_noise_g(n, 3)};
    const Dft321 one = reduced(axes);
    ASSERT_EQ(one.values.size(), n);
    const auto made = spectrum_of(one.values);
    std::vector<double> power(made.size());
    for (const auto& axis : axes)
      for (std::size_t k = 0; const auto& bin : spectrum_of(axis)) power[k++] += std::norm(bin);
    for (std::size_t k = 0; k < made.size(); ++k)
      EXPECT_NEAR(std::abs(made[k]), std::sqrt(power[k]), 1e-12 * static_cast<double>(n)) << n << " " << k;
  }
}

TEST(Dft321, AMotionAlongOneDirectionComesBackAsItIs) {
  const auto motion = white_noise_g(1001, 4);
  const std::array direction = {0.48, -0.6, 0.64};  // of length 1
  Axes axes;
  for (std::size_t i = 0; i < 3; ++i)
    for (const double value : motion) axes[i].push_back(direction[i] * value);
  const Dft321 one = reduced(axes);
  for (std::size_t n = 0; n < motion.size(); ++n) ASSERT_NEAR(one.values[n], motion[n], 1e-12);
  EXPECT_NEAR(one.waveform_correlation, 1, 1e-12);
}

// Two axes whose phases differ by 90 degrees: sqrt(2) at their mean phase.
TEST(Dft321, ThePhaseIsThatOfTheSum) {
  constexpr std::size_t kCount = 240;
  Axes axes;
  std::vector<double> expected;
  for (std::size_t n = 0; n < kCount; ++n) {
    const double phase = 2 * std::numbers::pi * 7 * static_cast<double>(n) / kCount;
    axes[0].push_back(std::cos(phase));
    axes[1].push_back(std::sin(phase));
    axes[2].push_back(0);
    expected.push_back(std::sqrt(2.0) * std::cos(phase - std::numbers::pi / 4));
  }
  const Dft321 one = reduced(axes);
  for (std::size_t n = 0; n < kCount; ++n) ASSERT_NEAR(one.values[n], expected[n], 1e-12);
  // <axis, values> is kCount / sqrt(2) / sqrt(2) for both; |axes|^2 = |values|^2 = kCount.
  EXPECT_NEAR(one.waveform_correlation, std::sqrt(0.5), 1e-12);
}

TEST(Dft321, AxesThatCancelAreSeenInTheCorrelation) {
  Axes axes = {white_noise_g(1000, 5), {}, white_noise_g(1000, 6)};
  for (double& value : axes[2]) value *= 1e-3;
  for (const double value : axes[0]) axes[1].push_back(-value);
  EXPECT_LT(reduced(axes).waveform_correlation, 0.15);  // of 1,000 random values: 3 / sqrt(1000) and more
}

TEST(Dft321, SilenceStaysSilence) {
  const Axes axes = {std::vector<double>(64), std::vector<double>(64), std::vector<double>(64)};
  const Dft321 one = reduced(axes);
  for (const double value : one.values) EXPECT_EQ(value, 0);
  EXPECT_EQ(one.waveform_correlation, 1);
}

}  // namespace
}  // namespace tacto::spatial
