// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/block_fourier_filter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include "spatial/dsp/filter/fourier_filter.hpp"
#include "spatial/reference/exact_treated_band_pass.hpp"

namespace tacto::spatial {
namespace {

constexpr double kPi = std::numbers::pi;

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// White noise of RMS 1, plus an offset, a drift and slow waves that are 100 times as large.
std::vector<double> drifting(std::size_t size, unsigned seed, double largest = 100) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(size);
    values[i] = normal(random) + largest * (1 + u - u * u * u + 0.3 * std::sin(9 * u));
  }
  return values;
}

// In chunks of different sizes.
std::vector<double> in_chunks(BlockFourierFilter& filter, std::span<const double> values,
                              std::size_t largest) {
  std::mt19937_64 random(7);
  std::vector<double> out;
  while (!values.empty()) {
    const std::size_t size = std::min<std::size_t>(random() % (largest + 1), values.size());
    filter.push(values.first(size), out);
    values = values.subspan(size);
  }
  filter.finish(out);
  return out;
}

struct Case {
  const char* name;
  double rate_hz;
  Band band;
  std::size_t size;
};

// The largest error at some 60 places, many of them near the ends, re the RMS of the output.
double error_of(const Case& c, const std::vector<double>& values) {
  BlockFourierFilter filter(c.rate_hz, c.band);
  const auto fast = in_chunks(filter, values, 30000);
  EXPECT_EQ(fast.size(), values.size());
  const double lowest = std::max(c.band.low_hz, std::min(c.band.high_hz, c.rate_hz / 2) / 512);
  const reference::ExactTreatedBandPass exact(values, c.rate_hz, c.band, lowest, filter.reach_s());
  double worst = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    const double share = 0.5 - 0.5 * std::cos(kPi * static_cast<double>(i) / 59);
    const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
    worst = std::max(worst, std::abs(fast[index] - exact(index)));
  }
  return worst / rms(fast);
}

class EqualsTheDefinition : public testing::TestWithParam<Case> {};

TEST_P(EqualsTheDefinition, ToFiveTenMillionths) {
  const Case& c = GetParam();
  const double error = error_of(c, drifting(c.size, 1));
  RecordProperty("error_re_rms", fmt::format("{:.1e}", error));
  // Required: 1e-4. The half-band filters have 1e-8 of a drift of 100 and of noise outside of the band.
  EXPECT_LT(error, 5e-7) << c.name;
}

std::string name_of_case(const testing::TestParamInfo<Case>& tested) {
  std::string name = tested.param.name;
  std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    BlockFourierFilter, EqualsTheDefinition,
    testing::Values(Case{"60 s", 10000, {15, 500}, 600000}, Case{"2 s", 10000, {15, 500}, 20000},
                    Case{"short", 10000, {15, 500}, 1000}, Case{"two", 10000, {15, 500}, 2},
                    Case{"to half the rate", 1000, {15, 500}, 30000},
                    Case{"just under it", 1000, {15, 499}, 30000}, Case{"from 0 Hz", 2000, {0, 100}, 30000},
                    Case{"narrow", 10000, {99, 101}, 50000}, Case{"wide", 2000, {1, 900}, 60000},
                    Case{"1 MHz", 1e6, {2000, 10000}, 400000}, Case{"low and slow", 100, {0.5, 20}, 30000}),
    name_of_case);

// The real recording's tangential force, in volts; empty without the data.
std::vector<double> lateral_force() {
  std::ifstream file(std::string(TACTO_DATA) + "/bare-finger/bare_finger_10kHz.csv");
  std::vector<double> values;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) values.push_back(std::stod(line));
  return values;
}

TEST(BlockFourierFilter, EqualsTheDefinitionOnARealFingersForce) {
  const auto once = lateral_force();
  if (once.empty()) GTEST_SKIP() << "skipped: no real data";
  // Repeated ten times, over a drift of 3 V.
  std::vector<double> values;
  for (int turn = 0; turn < 10; ++turn) values.insert(values.end(), once.begin(), once.end());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += 3 * static_cast<double>(i) / static_cast<double>(values.size());
  for (const auto& record : {once, values}) {
    const double error = error_of({"finger", 10000, {15, 500}, record.size()}, record);
    RecordProperty(record.size() == once.size() ? "once" : "ten_times", fmt::format("{:.1e}", error));
    EXPECT_LT(error, 5e-7);
  }
}

TEST(BlockFourierFilter, GivesTheSameInChunksOfAnySize) {
  const auto values = drifting(150000, 2);
  BlockFourierFilter filter(10000, {15, 500});
  const auto whole = in_chunks(filter, values, values.size() * 4);
  EXPECT_EQ(whole, in_chunks(filter, values, 3));
  EXPECT_EQ(whole, in_chunks(filter, values, 10000));
  const auto promised = fourier_filter(values, 10000, {15, 500}, Edges::treated);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(whole[i], promised[i], 1e-10);
}

TEST(BlockFourierFilter, ForgetsTheRecordBefore) {
  const auto values = drifting(40000, 3);
  BlockFourierFilter filter(10000, {15, 500});
  const auto first = in_chunks(filter, values, 5000);
  std::vector<double> dropped;
  filter.push(values, dropped);
  filter.reset();
  EXPECT_EQ(first, in_chunks(filter, values, 5000));
}

TEST(BlockFourierFilter, GivesValuesInBoundedLag) {
  BlockFourierFilter filter(10000, {15, 500});
  std::vector<double> out, second(10000, 1.0);
  for (std::size_t s = 1; s <= 200; ++s) {
    filter.push(second, out);
    ASSERT_GT(out.size() + 520000, s * second.size());
  }
}

TEST(BlockFourierFilter, AppliesAGain) {
  // A resonance like a sensor's, in a record that rests at both ends for longer than the kernel, so that the
  // transform of the whole record is exact.
  const auto gain = [](double f_hz) {
    const std::complex<double> s(0, f_hz / 200);
    return s / (1.0 + 0.1 * s + s * s);
  };
  constexpr std::size_t kRest = 140000, kMoves = 100000;
  auto values = drifting(kMoves + 2 * kRest, 4, 0);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] *= i < kRest || i >= kRest + kMoves
                     ? 0
                     : std::pow(std::sin(kPi * static_cast<double>(i - kRest) / kMoves), 4);
  BlockFourierFilter with(10000, {15, 500}, gain), without(10000, {15, 500});
  const auto filtered = in_chunks(with, values, 9000), plain = in_chunks(without, values, 9000);
  const auto expected = fourier_filter(plain, 10000, {0, 5000}, Edges::none, gain);
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    worst = std::max(worst, std::abs(filtered[i] - expected[i]));
  RecordProperty("error_re_rms", fmt::format("{:.1e}", worst / rms(expected)));
  EXPECT_LT(worst, 1e-4 * rms(expected));
}

TEST(BlockFourierFilter, TakesTheShortest) {
  BlockFourierFilter band(10000, {15, 500}), low(10000, {0, 500});
  std::vector<double> out;
  band.finish(out);
  EXPECT_TRUE(out.empty());
  band.push(std::vector<double>{3}, out);
  band.finish(out);
  EXPECT_EQ(out, std::vector<double>{0});
  low.push(std::vector<double>{3}, out);
  low.finish(out);
  EXPECT_EQ(out, (std::vector<double>{0, 3}));
}

}  // namespace
}  // namespace tacto::spatial
