// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/plausibility.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tacto::capture {
namespace {

std::vector<double> noisy(std::size_t count, double level) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  std::vector<double> values(count);
  for (double& value : values) value = level + noise(random);
  return values;
}

// In pieces, as during import: the result must not depend on where they are cut.
template <class Take>
void in_pieces(const std::vector<double>& values, std::size_t piece, Take take) {
  for (std::size_t at = 0; at < values.size(); at += piece)
    take(std::span(values).subspan(at, std::min(piece, values.size() - at)), at);
}

std::vector<std::uint64_t> outliers(const std::vector<double>& values, std::size_t piece = 1000) {
  std::vector<std::uint64_t> found;
  const auto note = [&](std::uint64_t sample, double value) {
    EXPECT_EQ(value, values[sample]);
    found.push_back(sample);
  };
  Outliers lone;
  in_pieces(values, piece, [&](auto part, std::size_t) { lone.survey(part); });
  lone.end_survey();
  in_pieces(values, piece, [&](auto part, std::size_t) { lone.find(part, note); });
  lone.end_find(note);
  EXPECT_EQ(lone.any(), !found.empty());
  return found;
}

std::vector<std::string> warnings_of(const char* quantity, const std::vector<double>& values,
                                     double scale = 1) {
  schema::Channel channel;
  channel.name = channel.quantity = quantity;
  channel.scale = scale;
  const auto place_of = [](std::uint64_t i) { return fmt::format("line {}", i + 2); };
  Plausibility judged(channel);
  in_pieces(values, 70, [&](auto part, std::size_t first) { judged.survey(part, first, place_of); });
  judged.end_survey();
  if (judged.second_pass_needed()) {
    in_pieces(values, 70, [&](auto part, std::size_t) { judged.find(part, place_of); });
    judged.end_find(place_of);
  }
  return judged.warnings([](std::uint64_t i) { return fmt::format("{} ms", i); });
}

TEST(Plausibility, LostExponentsAreFound) {
  auto values = noisy(5000, 100);
  values[1000] = 4581.47818;
  values[3000] = 6.99807232;
  EXPECT_EQ(outliers(values), (std::vector<std::uint64_t>{1000, 3000}));
}

// For all sizes of pieces, down to single samples.
TEST(Plausibility, ThePiecesDoNotMatter) {
  auto values = noisy(3000, 100);
  for (const std::size_t i : {0, 1, 5, 150, 2996, 2999}) values[i] = 9999;
  const auto whole = outliers(values, values.size());
  EXPECT_EQ(whole, (std::vector<std::uint64_t>{5, 150, 2996, 2999}));  // 0 and 1 are neighbours
  for (std::size_t piece = 1; piece < 12; ++piece) EXPECT_EQ(outliers(values, piece), whole) << piece;
}

TEST(Plausibility, ASineThatBeginsAtZeroPasses) {
  std::vector<double> values(5000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(0.05 * static_cast<double>(i));
  EXPECT_TRUE(outliers(values).empty());
}

TEST(Plausibility, TheFirstAndLastSampleCount) {
  auto values = noisy(5000, 100);
  values.front() = 1e5;
  values.back() = 1e-5;
  EXPECT_EQ(outliers(values), (std::vector<std::uint64_t>{0, 4999}));
}

TEST(Plausibility, NoiseStepsAndTransientsPass) {
  auto values = noisy(5000, 0);
  EXPECT_TRUE(outliers(values).empty());
  for (std::size_t i = 2000; i < 3000; ++i) values[i] += 1000;
  EXPECT_TRUE(outliers(values).empty());
  for (std::size_t i = 0; i < 60; ++i)  // a tap: up in some samples, then ringing
    values[4000 + i] += 500 * std::exp(-static_cast<double>(i) / 20) * std::sin(0.3 * static_cast<double>(i));
  EXPECT_TRUE(outliers(values).empty());
}

TEST(Plausibility, OneFlickeringCountOfAnEncoderPasses) {
  std::vector<double> counts(1000, 0);
  for (const std::size_t i : {100, 300, 310, 900}) counts[i] = 1;
  EXPECT_TRUE(outliers(counts).empty());
  counts[500] = 65536;
  EXPECT_EQ(outliers(counts), (std::vector<std::uint64_t>{500}));
}

TEST(Plausibility, ShortChannelsAreNotJudged) {
  EXPECT_TRUE(outliers(std::vector<double>{0, 0, 1e9, 0}).empty());
}

TEST(Plausibility, AWarningNamesTheFirstSamplesAndCountsAll) {
  auto values = noisy(5000, 100);
  for (std::size_t i = 0; i < 7; ++i) values[100 * (i + 1)] = 9999;
  const auto warnings = warnings_of("signal", values);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("7 of 5000 samples"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("line 102, 100 ms, "), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("line 502, 500 ms, ..."), std::string::npos) << warnings[0];
  EXPECT_EQ(warnings[0].find("line 602"), std::string::npos) << warnings[0];
}

TEST(Plausibility, ValuesThatNoBenchHasPointAtTheUnit) {
  auto values = noisy(100, 40);
  EXPECT_TRUE(warnings_of("speed", values, 1e-3).empty());
  const auto warnings = warnings_of("speed", values);  // mm/s interpreted as m/s
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("(5 m/s)"), std::string::npos) << warnings[0];
}

TEST(Plausibility, AChannelThatNeverChangesIsSaid) {
  const auto warnings = warnings_of("position", std::vector<double>(50, 3), 1e-3);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0], "position is constant: 3 mm");
}

}  // namespace
}  // namespace tacto::capture
