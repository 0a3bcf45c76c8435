// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/touch_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace tacto::spatial {
namespace {

// 200 mm back and forth with counts of 1 um, and the same through a counter of some bits that starts high.
std::vector<double> true_counts() {
  std::vector<double> counts;
  for (int i = 0; i < 40000; ++i)
    counts.push_back(std::round(1e5 * (1 - std::cos(2 * std::numbers::pi * i / 20000))));
  return counts;
}

std::vector<double> wrapped(const std::vector<double>& counts, int bits, double start, bool two_sided) {
  const double turn = std::ldexp(1.0, bits);
  std::vector<double> seen;
  for (const double count : counts) {
    double value = std::fmod(count + start, turn);
    if (two_sided && value >= turn / 2) value -= turn;
    seen.push_back(value);
  }
  return seen;
}

CounterWraps found_in(const std::vector<double>& counts, std::span<const schema::Gap> gaps = {}) {
  CounterWrapFinder finder(gaps);
  // In pieces of odd sizes, as in a long record.
  for (std::size_t begin = 0; begin < counts.size(); begin += 777)
    finder.add(std::span(counts).subspan(begin, std::min<std::size_t>(777, counts.size() - begin)));
  return finder.finish();
}

void expect_put_right(const std::vector<double>& truth, std::vector<double> seen, int bits) {
  const CounterWraps wraps = found_in(seen);
  ASSERT_EQ(wraps.bits, bits);
  // From any start on.
  for (const std::size_t first : {std::size_t{0}, std::size_t{12345}}) {
    std::vector<double> part(seen.begin() + static_cast<std::ptrdiff_t>(first), seen.end());
    wraps.unwrap(first, part);
    for (std::size_t i = 0; i < part.size(); ++i)
      ASSERT_EQ(part[i] - seen[0], truth[first + i] - truth[0]) << i;
  }
}

TEST(CounterWraps, SixteenTwentyFourAndThirtyTwoBitsArePutRight) {
  const auto truth = true_counts();
  for (const bool two_sided : {false, true})
    for (const int bits : {16, 24, 32})
      expect_put_right(
          truth, wrapped(truth, bits, std::ldexp(1.0, bits - (two_sided ? 1 : 0)) - 50000, two_sided), bits);
}

TEST(CounterWraps, AreCountedWhereTheyAre) {
  const auto truth = true_counts();
  const CounterWraps wraps = found_in(wrapped(truth, 16, 0, false));
  ASSERT_EQ(wraps.turns.size(), 12U);  // 3 on each pass of the four
  EXPECT_EQ(wraps.count_in(0, 10000), 3U);
  EXPECT_EQ(wraps.count_in(10000, 20000), 3U);
  EXPECT_EQ(wraps.count_in(wraps.turns[0].frame, 10000), 2U);  // the first frame has no previous one
}

TEST(CounterWraps, ACounterThatIsLongEnoughHasNone) {
  EXPECT_EQ(found_in(true_counts()).bits, 0);
  EXPECT_EQ(found_in({}).bits, 0);
  EXPECT_EQ(found_in({70000}).bits, 0);
}

TEST(CounterWraps, AResetAndAGlitchAreNone) {
  std::vector<double> reset = true_counts();
  for (std::size_t i = 5000; i < reset.size(); ++i) reset[i] -= reset[5000];  // set to 0 at 100000
  EXPECT_EQ(found_in(reset).bits, 0);
  std::vector<double> homed;
  for (int i = 0; i < 6000; ++i) homed.push_back(i < 3000 ? 20.0 * i : 20.0 * (i - 3000));  // 59980 to 0
  EXPECT_EQ(found_in(homed).bits, 0);
  std::vector<double> glitch = true_counts();
  glitch[7000] += 65536;
  EXPECT_EQ(found_in(glitch).bits, 0);  // the record spans more than 16 bits
}

TEST(CounterWraps, NumbersThatAreNoCountsHaveNone) {
  auto metres = wrapped(true_counts(), 16, 0, false);
  for (double& value : metres) value = value * 1.0001 + 0.25;
  EXPECT_EQ(found_in(metres).bits, 0);
}

TEST(CounterWraps, AGapHidesNone) {
  const auto truth = true_counts();
  auto seen = wrapped(truth, 16, 65536 - 50, false);
  // 40 frames are missing at its first overflow.
  const CounterWraps before = found_in(seen);
  const std::size_t wrap = before.turns[0].frame;
  seen.erase(seen.begin() + static_cast<std::ptrdiff_t>(wrap) - 20,
             seen.begin() + static_cast<std::ptrdiff_t>(wrap) + 20);
  const schema::Gap gap{wrap - 20, wrap - 20, 40};
  EXPECT_EQ(found_in(seen, {&gap, 1}).turns.size(), before.turns.size());
}

}  // namespace
}  // namespace tacto::spatial
