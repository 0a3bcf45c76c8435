// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/butterworth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "spatial/reference/exact_zero_phase.hpp"
#include "tests/spatial/golden_file.hpp"

namespace tacto::spatial {
namespace {

TEST(Butterworth, EqualsSciPyInResponseAndZeroPhase) {
  GoldenFile file("butterworth.txt");
  const auto signal = file.numbers();
  ASSERT_EQ(signal.size(), 120U);
  int cases = 0;
  for (auto head = file.numbers(); head.size() == 4; head = file.numbers(), ++cases) {
    const auto sections = butterworth_band_pass(static_cast<int>(head[0]), {head[1], head[2]}, head[3]);
    ASSERT_TRUE(sections);
    const auto at = file.numbers(), real = file.numbers(), imaginary = file.numbers(),
               expected = file.numbers();
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::complex<double> error =
          response_of(*sections, at[i], head[3]) - std::complex(real[i], imaginary[i]);
      EXPECT_LT(std::abs(error), 1e-10) << "order " << head[0] << " at " << at[i];
    }
    const auto filtered = filter_zero_phase(*sections, signal, default_padding(*sections));
    for (std::size_t i = 0; i < signal.size(); ++i) EXPECT_NEAR(filtered[i], expected[i], 1e-9) << head[0];
  }
  EXPECT_EQ(cases, 6);
}

TEST(Butterworth, FollowsItsClosedForm) {
  // |H|^2 = 1 / (1 + ((w^2 - w0^2) / (w B))^2N) in prewarped frequencies.
  const double rate_hz = 10000;
  const auto warped = [&](double f) { return std::tan(std::numbers::pi * f / rate_hz); };
  for (const int order : {1, 2, 3, 4, 6, 9}) {
    const auto sections = butterworth_band_pass(order, {15, 500}, rate_hz);
    ASSERT_TRUE(sections);
    EXPECT_EQ(sections->size(), static_cast<std::size_t>(order));
    for (double f = 5; f < 3000; f *= 1.3) {
      const double w = warped(f), centre2 = warped(15) * warped(500), width = warped(500) - warped(15);
      const double expected = 1 / (1 + std::pow((w * w - centre2) / (w * width), 2 * order));
      EXPECT_NEAR(std::norm(response_of(*sections, f, rate_hz)), expected, 1e-9) << order << " at " << f;
    }
  }
}

TEST(Butterworth, ZeroPhaseHasNoDelayAndTheSquaredGain) {
  const auto sections = butterworth_band_pass(4, {15, 500}, 10000);
  std::vector<double> tone(20000);
  for (std::size_t i = 0; i < tone.size(); ++i)
    tone[i] = 7 + std::cos(2 * std::numbers::pi * 500 * static_cast<double>(i) / 10000);
  const auto filtered = filter_zero_phase(*sections, tone, 5000);
  // At the band's edge |H|^2 is exactly a half.
  for (std::size_t i = 8000; i < 12000; ++i) ASSERT_NEAR(filtered[i], (tone[i] - 7) / 2, 1e-6);
}

TEST(Butterworth, ZeroPhaseBandIsWhereTheGainSaysSo) {
  for (const int order : {1, 4, 7})
    for (const Band band : {Band{15, 500}, Band{1, 4900}, Band{200, 220}}) {
      const auto sections = butterworth_band_pass(order, band, 10000);
      const auto amplitude = [&](double hz) {
        double power = 1;
        for (const auto& section : *sections) power *= std::norm(section.response(hz, 10000));
        return power;
      };
      const Band kept = zero_phase_band(order, band, 10000, 0.9);
      EXPECT_NEAR(amplitude(kept.low_hz), 0.9, 1e-6) << order;  // coefficient rounding near 1 Hz
      EXPECT_NEAR(amplitude(kept.high_hz), 0.9, 1e-6) << order;
      EXPECT_GT(kept.low_hz, band.low_hz);
      EXPECT_LT(kept.high_hz, band.high_hz);
    }
}

TEST(Butterworth, ZeroPhaseHoldsToTwelveDigitsInLongDouble) {
  // 60 s at 10 kHz are 600,000 samples; half of them show the same.
  const auto sections = butterworth_band_pass(4, {15, 500}, 10000);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  std::vector<double> brown(300000, 40.0);
  for (std::size_t i = 1; i < brown.size(); ++i) brown[i] = brown[i - 1] + normal(random);
  const auto filtered = filter_zero_phase(*sections, brown, 5333);
  const auto error_of = [&](const std::vector<reference::ExactSection>& exact_sections) {
    const auto exact = reference::exact_zero_phase(exact_sections, brown, 5333);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < brown.size(); ++i) {
      error = std::max(error, std::abs(filtered[i] - exact[i]));
      size = std::max(size, std::abs(exact[i]));
    }
    return error / size;
  };
  EXPECT_LT(error_of(reference::widened(*sections)), 1e-12);
  EXPECT_LT(error_of(reference::exact_butterworth(4, {15, 500}, 10000)), 2e-12);
}

TEST(Butterworth, RefusesWhatCannotBe) {
  const auto refused = [](int order, Band band, schema::ErrorKind fault) {
    const auto sections = butterworth_band_pass(order, band, 1000);
    return !sections && sections.error().kind == fault;
  };
  EXPECT_TRUE(refused(0, {15, 400}, schema::ErrorKind::usage));
  EXPECT_TRUE(refused(21, {15, 400}, schema::ErrorKind::usage));
  EXPECT_TRUE(refused(4, {0, 400}, schema::ErrorKind::unsuitable));
  EXPECT_TRUE(refused(4, {15, 500}, schema::ErrorKind::unsuitable));
  EXPECT_TRUE(refused(4, {400, 15}, schema::ErrorKind::unsuitable));
  EXPECT_TRUE(refused(4, {std::nan(""), 15}, schema::ErrorKind::unsuitable));
}

TEST(Butterworth, TakesTheShortest) {
  const auto sections = butterworth_band_pass(2, {15, 400}, 1000);
  EXPECT_TRUE(filter_zero_phase(*sections, {}, 10).empty());
  // A constant is removed completely: the sections start in their steady state.
  for (const std::size_t size : {1U, 2U, 10U})
    for (const double value : filter_zero_phase(*sections, std::vector<double>(size, 5.0), 15))
      EXPECT_NEAR(value, 0, 1e-12);
}

}  // namespace
}  // namespace tacto::spatial
