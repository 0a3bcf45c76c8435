// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/block_zero_phase.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "spatial/dsp/filter/butterworth.hpp"

namespace tacto::spatial {
namespace {

// Brown noise has much energy at the filter's low frequencies.
std::vector<double> brown(std::size_t size) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  std::vector<double> values(size, 50.0);
  for (std::size_t i = 1; i < size; ++i) values[i] = values[i - 1] + normal(random);
  return values;
}

double largest_difference(const std::vector<double>& values) {
  double size = 0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

std::vector<double> in_chunks(BlockZeroPhase& filter, std::span<const double> values, std::size_t most) {
  std::mt19937_64 random(7);
  std::vector<double> out;
  while (!values.empty()) {
    const std::size_t size = std::min<std::size_t>(random() % (most + 1), values.size());
    filter.push(values.first(size), out);
    values = values.subspan(size);
  }
  filter.finish(out);
  return out;
}

void expect_equal(int order, Band band, double rate_hz, std::size_t size, std::size_t padding) {
  const auto sections = butterworth_band_pass(order, band, rate_hz);
  ASSERT_TRUE(sections);
  const auto values = brown(size), expected = filter_zero_phase(*sections, values, padding);
  BlockZeroPhase filter(*sections, padding);
  const auto filtered = in_chunks(filter, values, 50000);
  ASSERT_EQ(filtered.size(), size);
  const double most = 1e-13 * largest_difference(values);
  for (std::size_t i = 0; i < size; ++i)
    ASSERT_NEAR(filtered[i], expected[i], most) << order << " of " << size << " at " << i;
}

TEST(BlockZeroPhase, GivesWhatTheWholeRecordGives) {
  expect_equal(4, {15, 500}, 10000, 600000, 5333);
  expect_equal(4, {15, 500}, 10000, 600000, 27);
  expect_equal(8, {15, 500}, 10000, 500000, 5333);
  expect_equal(1, {15, 500}, 10000, 300000, 5333);
  expect_equal(2, {0.5, 5}, 100, 300000, 1600);
}

TEST(BlockZeroPhase, TakesTheShortest) {
  for (const std::size_t size : {1U, 2U, 3U, 30U, 5000U}) expect_equal(4, {15, 500}, 10000, size, 5333);
  const auto sections = butterworth_band_pass(4, {15, 500}, 10000);
  BlockZeroPhase filter(*sections, 100);
  EXPECT_TRUE(in_chunks(filter, {}, 10).empty());
}

TEST(BlockZeroPhase, GivesTheSameInChunksOfAnySizeAndForgetsTheRecordBefore) {
  const auto sections = butterworth_band_pass(4, {15, 500}, 10000);
  const auto values = brown(400000);
  BlockZeroPhase filter(*sections, 5333);
  const auto whole = in_chunks(filter, values, 4000000);
  EXPECT_EQ(whole, in_chunks(filter, values, 7));
  std::vector<double> dropped;
  filter.push(values, dropped);
  filter.reset();
  EXPECT_EQ(whole, in_chunks(filter, values, 30000));
}

}  // namespace
}  // namespace tacto::spatial
