// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/fourier_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "spatial/reference/exact_treated_band_pass.hpp"

namespace tacto::spatial {
namespace {

constexpr double kRate_hz = 10000;
constexpr Band kBand{15, 500};

// Tones well inside the band at random frequencies (none periodic in the record), of RMS 1, and the same with
// content that the band must remove: drift, slow waves, an offset, and a slope that makes the ends differ by
// 20 RMS.
struct Example {
  std::vector<double> inside, all;
};

Example example(std::size_t size, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> tone_hz(20, 400), phase(0, 2 * std::numbers::pi);
  Example made{std::vector<double>(size), std::vector<double>(size)};
  for (int tone = 0; tone < 60; ++tone) {
    const double turns = 2 * std::numbers::pi * tone_hz(random) / kRate_hz, start = phase(random);
    for (std::size_t i = 0; i < size; ++i)
      made.inside[i] += std::sqrt(2.0 / 60) * std::cos(turns * static_cast<double>(i) + start);
  }
  for (std::size_t i = 0; i < size; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(size),
                 t_s = static_cast<double>(i) / kRate_hz;
    made.all[i] =
        made.inside[i] + 5 + 20 * u - 1.5 * u * u + 0.7 * std::sin(2 * std::numbers::pi * 3 * t_s + 1);
  }
  return made;
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t from,
                      std::size_t to) {
  double sum = 0;
  for (std::size_t i = from; i < to; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(to - from));
}

struct Errors {
  double middle = 0, near = 0, end = 0;  // RMS over several records
};

Errors errors_of(Edges edges, std::size_t size) {
  constexpr int kRecords = 10;
  Errors squares;
  for (unsigned seed = 0; seed < kRecords; ++seed) {
    const Example record = example(size, seed);
    const auto filtered = fourier_filter(record.all, kRate_hz, kBand, edges);
    const auto square = [&](std::size_t from, std::size_t to) {
      return std::pow(rms_difference(filtered, record.inside, from, to), 2) / kRecords;
    };
    squares.middle += square(size / 4, size * 3 / 4);
    squares.near += square(1000, 3000) / 2 + square(size - 3000, size - 1000) / 2;
    squares.end += square(0, 1000) / 2 + square(size - 1000, size) / 2;
  }
  return {std::sqrt(squares.middle), std::sqrt(squares.near), std::sqrt(squares.end)};
}

TEST(FourierFilter, PlainOneEqualsTheDefinition) {
  for (const std::size_t size : {1000U, 1001U, 1024U}) {
    const auto record = example(size, 1);
    const auto fast = fourier_filter(record.all, kRate_hz, {15, 501}, Edges::none);
    const auto exact = reference::exact_band_pass(record.all, kRate_hz, {15, 501});
    // Required: 1e-9. Double precision gives about 1e-16 of the record's size, 25.
    for (std::size_t i = 0; i < size; ++i) ASSERT_NEAR(fast[i], exact[i], 1e-13) << size;
  }
}

TEST(FourierFilter, KeepsWhatLiesOnTheBandsEdges) {
  std::vector<double> both(10000);
  for (std::size_t i = 0; i < both.size(); ++i)
    both[i] = std::cos(2 * std::numbers::pi * 15 * static_cast<double>(i) / kRate_hz) +
              std::cos(2 * std::numbers::pi * 500 * static_cast<double>(i) / kRate_hz);
  const auto filtered = fourier_filter(both, kRate_hz, kBand, Edges::none);
  for (std::size_t i = 0; i < both.size(); ++i) ASSERT_NEAR(filtered[i], both[i], 1e-12);
}

TEST(FourierFilter, TreatedEndsDoNotRing) {
  // The figures in the header. Plain truncation of the same records is compared with its figures there, too.
  const Errors treated = errors_of(Edges::treated, 20000), plain = errors_of(Edges::none, 20000);
  RecordProperty("treated_middle", std::to_string(treated.middle));
  RecordProperty("treated_near", std::to_string(treated.near));
  RecordProperty("treated_end", std::to_string(treated.end));
  RecordProperty("plain_middle", std::to_string(plain.middle));
  RecordProperty("plain_end", std::to_string(plain.end));
  EXPECT_LT(treated.middle, 0.003);
  EXPECT_LT(treated.near, 0.01);
  EXPECT_LT(treated.end, 0.07);
  EXPECT_GT(plain.middle, 10 * treated.middle);
  EXPECT_GT(plain.end, 10 * treated.end);
}

TEST(FourierFilter, TreatedOneDoesNotDependOnWhereBinsLie) {
  // Brown noise has much energy at 15 Hz, where it is cut. The same record, a little shorter, has bins at
  // other frequencies.
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::vector<double> brown(80000);
  for (std::size_t i = 1; i < brown.size(); ++i) brown[i] = brown[i - 1] + normal(random);
  const auto change = [&](Edges edges) {
    const auto whole = fourier_filter(brown, kRate_hz, kBand, edges);
    const auto cut = fourier_filter(std::span(brown).first(79700), kRate_hz, kBand, edges);
    return rms_difference(whole, cut, 20000, 60000) /
           rms_difference(whole, std::vector<double>(80000), 20000, 60000);
  };
  EXPECT_LT(change(Edges::treated), 0.003);
  EXPECT_GT(change(Edges::none), 0.01);
}

TEST(FourierFilter, TreatedEndsForgetOffsetsAndSlopes) {
  const Example record = example(5000, 2);
  std::vector<double> shifted = record.all;
  for (std::size_t i = 0; i < shifted.size(); ++i) shifted[i] += 1000 - 0.3 * static_cast<double>(i);
  const auto a = fourier_filter(record.all, kRate_hz, kBand, Edges::treated);
  const auto b = fourier_filter(shifted, kRate_hz, kBand, Edges::treated);
  // The residual is the part within the band of the smooth taper from one level to the other, 1500 high.
  EXPECT_LT(rms_difference(a, b, 0, a.size()), 1500 * 2e-5);
}

TEST(FourierFilter, GainActsInsideTheBandOnly) {
  std::vector<double> tone(10000), low(10000);
  for (std::size_t i = 0; i < tone.size(); ++i) {
    tone[i] = std::cos(2 * std::numbers::pi * 100 * static_cast<double>(i) / kRate_hz);
    low[i] = tone[i] + 4 * std::cos(2 * std::numbers::pi * 5 * static_cast<double>(i) / kRate_hz);
  }
  const auto quarter_turn = [](double) { return std::complex<double>(0, 2); };
  const auto turned = fourier_filter(low, kRate_hz, kBand, Edges::none, quarter_turn);
  for (std::size_t i = 0; i + 25 < tone.size(); ++i) ASSERT_NEAR(turned[i], 2 * tone[i + 25], 1e-11);
}

TEST(FourierFilter, TakesTheShortest) {
  EXPECT_TRUE(fourier_filter({}, kRate_hz, kBand, Edges::treated).empty());
  const std::vector<double> one = {3}, two = {3, 4}, three = {1, 2, 3};
  for (const Edges edges : {Edges::none, Edges::treated}) {
    EXPECT_NEAR(fourier_filter(one, kRate_hz, kBand, edges)[0], 0, 1e-15);
    EXPECT_EQ(fourier_filter(two, kRate_hz, kBand, edges).size(), 2U);
    EXPECT_NEAR(fourier_filter(three, kRate_hz, {0, kRate_hz / 2}, edges)[1], 2, 1e-14);
  }
}

}  // namespace
}  // namespace tacto::spatial
