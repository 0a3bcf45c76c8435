// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/fft.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace tacto::spatial {
namespace {

std::vector<double> noise(std::size_t n) {
  std::mt19937_64 random(n);
  std::normal_distribution<double> normal;
  std::vector<double> values(n);
  for (double& value : values) value = normal(random);
  return values;
}

std::complex<double> defined(const std::vector<double>& x, std::size_t k) {
  std::complex<long double> sum = 0;
  const auto n = static_cast<long double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto turns = static_cast<long double>(k * i % x.size()) / n;
    sum += static_cast<long double>(x[i]) * std::polar(1.0L, -2 * std::numbers::pi_v<long double> * turns);
  }
  return {static_cast<double>(sum.real()), static_cast<double>(sum.imag())};
}

TEST(RealFft, EqualsItsDefinition) {
  for (const std::size_t n : {1U, 2U, 3U, 16U, 97U, 360U}) {
    const auto x = noise(n);
    RealFft fft(n);
    std::vector<std::complex<double>> spectrum(fft.bins());
    fft.forward(x, spectrum);
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      EXPECT_LT(std::abs(spectrum[k] - defined(x, k)), 1e-14 * static_cast<double>(n)) << n << " " << k;
  }
}

TEST(RealFft, InverseUndoesForward) {
  for (const std::size_t n : {1U, 2U, 7U, 1000U, 85000U}) {
    const auto x = noise(n);
    RealFft fft(n);
    std::vector<std::complex<double>> spectrum(fft.bins());
    std::vector<double> back(n);
    fft.forward(x, spectrum);
    fft.inverse(spectrum, back);
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(back[i], x[i], 1e-14 * 5) << n;
  }
}

TEST(RealFft, FastLengthIsTheNextProductOfSmallPrimes) {
  EXPECT_EQ(fast_length(0), 1U);
  EXPECT_EQ(fast_length(1), 1U);
  EXPECT_EQ(fast_length(11), 12U);
  EXPECT_EQ(fast_length(97), 98U);
  EXPECT_EQ(fast_length(121), 125U);
  EXPECT_EQ(fast_length(16384), 16384U);
}

}  // namespace
}  // namespace tacto::spatial
