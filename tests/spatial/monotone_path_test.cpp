// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/monotone_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/spatial/bare_finger.hpp"

namespace tacto::spatial {
namespace {

constexpr double kQuantum_m = 1e-6;

void expect_strictly_increasing(const MonotonePath& path) {
  ASSERT_EQ(path.sample.size(), path.way_m.size());
  for (std::size_t i = 1; i < path.way_m.size(); ++i) {
    ASSERT_GT(path.way_m[i], path.way_m[i - 1]);
    ASSERT_GT(path.sample[i], path.sample[i - 1]);
  }
}

TEST(MonotonePath, LeavesAStrictlyMonotoneOneAlone) {
  const std::vector<double> up = {0, 1e-6, 5e-6, 6e-6}, down = {3e-6, 1e-6, 0};
  const MonotonePath forth = monotone_path(up, 1, {kQuantum_m, 0}),
                     back = monotone_path(down, -1, {kQuantum_m, 0});
  EXPECT_EQ(forth.way_m, up);
  EXPECT_EQ(forth.sample, (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(forth.moved_m, 0);
  EXPECT_EQ(back.way_m, (std::vector<double>{-3e-6, -1e-6, 0}));
}

TEST(MonotonePath, LeavesTheBareFingersSectionAlone) {
  const auto finger = bare_finger();
  if (finger.empty()) GTEST_SKIP() << "skipped: no real data";
  const auto section = std::span(finger).subspan(45500, 23001);
  const MonotonePath path = monotone_path(section, 1, {0.5e-6, 0});
  EXPECT_EQ(path.moved_m, 0);
  EXPECT_TRUE(std::ranges::equal(path.way_m, section));
}

TEST(MonotonePath, SlowEvenMotionComesBackEven) {
  // One count in 8 samples: the knots are on a straight line, except for the two end plateaus.
  std::vector<double> slow;
  for (int i = 0; i < 800; ++i) slow.push_back(std::floor(i / 8.0) * kQuantum_m);
  const MonotonePath path = monotone_path(slow, 1, {kQuantum_m, 0});
  expect_strictly_increasing(path);
  for (std::size_t i = 0; i < path.way_m.size(); ++i)
    EXPECT_NEAR(path.way_m[i], (path.sample[i] - 3.5) / 8 * kQuantum_m, 1e-9 * kQuantum_m);
  EXPECT_LT(path.moved_m, kQuantum_m / 2);
}

TEST(MonotonePath, DitherMovesWithinACount) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0, 0.3);
  std::vector<double> dithered;
  for (int i = 0; i < 5000; ++i) dithered.push_back(std::round(0.07 * i + normal(random)) * kQuantum_m);
  const MonotonePath path = monotone_path(dithered, 1, {kQuantum_m, 0});
  expect_strictly_increasing(path);
  EXPECT_GT(path.moved_m, 0);
  EXPECT_LT(path.moved_m, 2 * kQuantum_m);
}

TEST(MonotonePath, AStickStaysWhereItIs) {
  // 100 samples at rest, then a jump of 50 counts: the path stays within half a count while the finger
  // sticks.
  std::vector<double> jumps;
  for (int i = 0; i < 1000; ++i) jumps.push_back(std::floor(i / 100.0) * 50 * kQuantum_m);
  const MonotonePath path = monotone_path(jumps, 1, {kQuantum_m, 0});
  expect_strictly_increasing(path);
  for (std::size_t i = 0; i < path.way_m.size(); ++i)
    EXPECT_LT(std::abs(path.way_m[i] - jumps[static_cast<std::size_t>(path.sample[i])]), kQuantum_m / 2);
  EXPECT_LT(path.moved_m, kQuantum_m / 2);
}

TEST(MonotonePath, StaysStrictAKilometreAwayAndWithoutAQuantum) {
  std::vector<double> far;
  for (int i = 0; i < 300; ++i) far.push_back(1000 + std::floor(i / 3.0) * 1e-8);
  expect_strictly_increasing(monotone_path(far, 1, {1e-8, 0}));
  expect_strictly_increasing(monotone_path(far, 1, {}));
}

TEST(MonotonePath, IsotonicRegressionIsTheClosest) {
  // The known result for 1 3 2 4 3 5: means of the pools (3 2) and (4 3).
  const std::vector<double> given = {1, 3, 2, 4, 3, 5};
  const MonotonePath path = monotone_path(given, 1, {0.1, 0});
  const std::vector<double> sample = {0, 1, 2, 3, 4, 5};
  const std::vector<double> way = {1, 2.475, 2.525, 3.475, 3.525, 5};
  EXPECT_EQ(path.sample, sample);
  for (std::size_t i = 0; i < way.size(); ++i) EXPECT_NEAR(path.way_m[i], way[i], 1e-12);
  EXPECT_NEAR(path.moved_m, 0.525, 1e-12);
}

// Largest distance of a path from `truth` at its knots, without the first and last `margin` samples.
template <class Truth>
double furthest_off(const MonotonePath& path, const Truth& truth, double samples, double margin) {
  double off = 0;
  for (std::size_t i = 0; i < path.way_m.size(); ++i)
    if (path.sample[i] >= margin && path.sample[i] <= samples - margin)
      off = std::max(off, std::abs(path.way_m[i] - truth(path.sample[i])));
  return off;
}

std::vector<double> noisy(const std::function<double(double)>& truth, int samples, double noise_m) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, noise_m);
  std::vector<double> made;
  for (int i = 0; i < samples; ++i) made.push_back(truth(i) + normal(random));
  return made;
}

TEST(MonotonePath, NoiseIsAveragedOutWithinItsReach) {
  // 40 mm/s at 10 kHz, varying by a fifth: 4 um per sample with 3 um of noise. Isotonic regression alone
  // keeps most of the noise; an average over hundreds of samples reduces it to less than a third, also at the
  // worst of 8000.
  constexpr double kNoise_m = 3e-6;
  const auto truth = [](double i) { return 4e-6 * (i + 160 * std::sin(i / 800)); };
  const auto seen = noisy(truth, 8000, kNoise_m);
  const MonotonePath path = monotone_path(seen, 1, {0, kNoise_m}), isotonic = monotone_path(seen, 1, {});
  expect_strictly_increasing(path);
  EXPECT_LT(furthest_off(path, truth, 8000, 600), kNoise_m / 3);
  EXPECT_GT(furthest_off(isotonic, truth, 8000, 600), 2 * kNoise_m);
  EXPECT_GT(path.moved_m, 3 * kNoise_m);
  EXPECT_LE(path.moved_m, PositionError({0, kNoise_m}).error_bound_m());
}

TEST(MonotonePath, NoiseLeavesASlipAsSharpAsItIs) {
  // Sticks for 30 ms, slips 0.5 mm in 2 ms: a window that smooths the slip would have an error of over 6
  // sigma.
  constexpr double kNoise_m = 3e-6;
  const auto truth = [](double i) {
    const double k = std::floor(i / 320), u = std::min(1.0, (i - 320 * k) / 20);
    return 0.5e-3 * (k + u);
  };
  const auto seen = noisy(truth, 9600, kNoise_m);
  const MonotonePath path = monotone_path(seen, 1, {0, kNoise_m});
  expect_strictly_increasing(path);
  EXPECT_LT(furthest_off(path, truth, 9600, 0), 5 * kNoise_m);
  EXPECT_LE(path.moved_m, PositionError({0, kNoise_m}).error_bound_m());
}

TEST(MonotonePath, AWayBackIsMoreThanItsErrorExplains) {
  std::vector<double> back;
  for (int i = 0; i < 2000; ++i) back.push_back((i < 1000 ? i : i < 1100 ? 2000 - i : i - 200) * 1e-6);
  const MonotonePath path = monotone_path(back, 1, {1e-6, 0});
  EXPECT_NEAR(path.moved_m, 50e-6, 2e-6);
  EXPECT_GT(path.moved_m, PositionError({1e-6, 0}).error_bound_m());
}

TEST(MonotonePath, IsEmptyWhereNothingMoves) {
  EXPECT_TRUE(monotone_path(std::vector<double>{1, 1, 1}, 1, {kQuantum_m, 0}).way_m.empty());
  EXPECT_TRUE(monotone_path({}, 1, {kQuantum_m, 0}).way_m.empty());
  EXPECT_TRUE(monotone_path(std::vector<double>{3, 2, 1}, 1, {kQuantum_m, 0}).way_m.empty());
}

}  // namespace
}  // namespace tacto::spatial
