// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/uniform_clock.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tacto::capture {
namespace {

schema::Result<UniformClock> clock_of(const std::vector<double>& times) {
  const auto place_of = [](std::uint64_t row) { return fmt::format("line {}", row + 2); };
  ClockFinder finder;
  const std::size_t half = times.size() / 2;  // in two pieces, as a long file comes in many
  finder.survey(std::span(times).first(half));
  finder.survey(std::span(times).subspan(half));
  TACTO_TRY(finder.end_survey("t.csv"));
  if (finder.second_pass_needed())
    for (const auto part : {std::span(times).first(half), std::span(times).subspan(half)})
      TACTO_TRY(finder.locate(part, place_of, "t.csv"));
  return finder.clock();
}

// Ticks at a rate, without those for which `keep` is false, rounded to steps of `resolution_s`.
template <class Keep>
std::vector<double> ticks(std::size_t count, double rate_hz, double resolution_s, Keep keep) {
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i)
    if (keep(i)) times.push_back(std::round(static_cast<double>(i) / rate_hz / resolution_s) * resolution_s);
  return times;
}

bool all(std::size_t) {
  return true;
}

TEST(UniformClock, FindsWholeRatesExactly) {
  for (const double rate : {1000.0, 10000.0, 44100.0}) {
    const auto clock = clock_of(ticks(20000, rate, 1e-9, all));
    ASSERT_TRUE(clock) << rate;
    EXPECT_NEAR(clock->rate_hz, rate, rate * 1e-7) << rate;
    EXPECT_TRUE(clock->gaps.empty());
  }
  EXPECT_EQ(clock_of(ticks(20000, 10000, 1e-4, all))->rate_hz, 10000);
}

// Steps of 0.3, 0.3 and 0.4 ms: over n rows only the ends have an error, of half a printed step each.
TEST(UniformClock, CoarselyPrintedTimesAreNoJitter) {
  const auto clock = clock_of(ticks(3000, 3000, 1e-4, all));
  ASSERT_TRUE(clock) << schema::message(clock.error());
  EXPECT_NEAR(clock->rate_hz, 3000, 3000 * 1e-4);
  EXPECT_TRUE(clock->gaps.empty());
}

TEST(UniformClock, MissingTicksAreGapsAndDoNotMoveTheRate) {
  const auto clock =
      clock_of(ticks(1000, 1000, 1e-6, [](std::size_t i) { return i != 10 && (i < 500 || i >= 520); }));
  ASSERT_TRUE(clock);
  EXPECT_EQ(clock->rate_hz, 1000);
  ASSERT_EQ(clock->gaps.size(), 2U);
  EXPECT_EQ(clock->gaps[0].frame, 10U);
  EXPECT_EQ(clock->gaps[0].device_sequence, 11U);
  EXPECT_EQ(clock->gaps[0].count, 1U);
  EXPECT_EQ(clock->gaps[1].frame, 499U);
  EXPECT_EQ(clock->gaps[1].device_sequence, 520U);
  EXPECT_EQ(clock->gaps[1].count, 20U);
}

TEST(UniformClock, JitterIsRefusedWithItsRow) {
  auto times = ticks(100, 1000, 1e-9, all);
  times[40] += 0.24e-3;
  EXPECT_TRUE(clock_of(times));
  times[40] += 0.03e-3;
  const auto clock = clock_of(times);
  ASSERT_FALSE(clock);
  EXPECT_EQ(clock.error().where, "t.csv: line 42");
  EXPECT_NE(clock.error().what.find("0.25"), std::string::npos);
}

TEST(UniformClock, TimeThatStandsStillOrRunsBackIsRefusedWithItsRow) {
  auto times = ticks(100, 1000, 1e-9, all);
  times[50] = times[49];
  EXPECT_EQ(clock_of(times).error().where, "t.csv: line 52");
  times[50] = times[40];
  EXPECT_EQ(clock_of(times).error().where, "t.csv: line 52");
}

TEST(UniformClock, EvenTimesNeedNoSecondPass) {
  ClockFinder finder;
  finder.survey(ticks(20000, 10000, 1e-4, all));
  ASSERT_TRUE(finder.end_survey("t.csv"));
  EXPECT_FALSE(finder.second_pass_needed());
}

TEST(UniformClock, NeedsThreeTimes) {
  EXPECT_FALSE(clock_of({0, 1}));
}

}  // namespace
}  // namespace tacto::capture
