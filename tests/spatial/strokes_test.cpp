// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/spatial/bare_finger.hpp"
#include "tests/spatial/strokes_of.hpp"

namespace tacto::spatial {
namespace {

constexpr double kRate_hz = 10000;

// Positions written stretch by stretch, read by an encoder.
class Path {
 public:
  explicit Path(double quantum_m = 1e-6, double dither_m = 0) : quantum_m_(quantum_m), dither_m_(dither_m) {}
  Path& go(double speed_mps, double duration_s) {
    for (int i = 0; i < std::lround(duration_s * kRate_hz); ++i) {
      exact_m_ += speed_mps / kRate_hz;
      const double seen_m = exact_m_ + dither_m_ * normal_(random_);
      position_m.push_back(quantum_m_ > 0 ? std::round(seen_m / quantum_m_) * quantum_m_ : seen_m);
    }
    return *this;
  }
  Path& rest(double duration_s) { return go(0, duration_s); }
  double seconds() const { return static_cast<double>(position_m.size()) / kRate_hz; }
  std::vector<double> position_m;

 private:
  double quantum_m_, dither_m_, exact_m_ = 0;
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
};

void expect_stroke(const Stroke& stroke, double from_s, double to_s, int direction) {
  // The speed is known over 20 ms.
  EXPECT_NEAR(static_cast<double>(stroke.frames.begin) / kRate_hz, from_s, 0.015);
  EXPECT_NEAR(static_cast<double>(stroke.frames.end) / kRate_hz, to_s, 0.015);
  EXPECT_EQ(stroke.direction, direction);
}

TEST(Strokes, FindsBothWaysBetweenPauses) {
  const Path path = Path().rest(1).go(0.04, 1).rest(0.5).go(-0.08, 0.5).rest(1);
  const auto strokes = strokes_of(path.position_m, kRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  expect_stroke(strokes[0], 1, 2, 1);
  expect_stroke(strokes[1], 2.5, 3, -1);
}

TEST(Strokes, AReversalPartsThem) {
  const Path path = Path().go(0.05, 1).go(-0.05, 1).go(0.05, 1);
  const auto strokes = strokes_of(path.position_m, kRate_hz);
  ASSERT_EQ(strokes.size(), 3U);
  expect_stroke(strokes[1], 1, 2, -1);
}

TEST(Strokes, APausePartsAndAStickDoesNot) {
  const Path paused = Path().go(0.05, 1).rest(0.3).go(0.05, 1),
             stuck = Path().go(0.05, 1).rest(0.05).go(0.05, 1);
  EXPECT_EQ(strokes_of(paused.position_m, kRate_hz).size(), 2U);
  EXPECT_EQ(strokes_of(stuck.position_m, kRate_hz).size(), 1U);
}

TEST(Strokes, EachIsJudgedByItsOwnSpeed) {
  const Path path = Path().rest(1).go(0.002, 10).rest(1).go(0.2, 0.2).rest(1);
  const auto strokes = strokes_of(path.position_m, kRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  expect_stroke(strokes[0], 1, 11, 1);
  expect_stroke(strokes[1], 12, 12.2, 1);
}

TEST(Strokes, ACoarseEncoderMakesNoFalseOnes) {
  for (const double quantum_m : {0.1e-6, 1e-6, 10e-6}) {
    const Path path = Path(quantum_m, quantum_m / 2).rest(2).go(0.001, 5).rest(60).go(-0.005, 1).rest(2);
    const auto strokes = strokes_of(path.position_m, kRate_hz);
    ASSERT_EQ(strokes.size(), 2U) << quantum_m;
    EXPECT_EQ(strokes[0].direction, 1);
    EXPECT_EQ(strokes[1].direction, -1);
  }
}

TEST(Strokes, ANominalPositionIsOneStroke) {
  const Path path = Path(0).go(0.04, 2);
  EXPECT_EQ(facts_of(path.position_m, kRate_hz).quantum_m, 0);
  const auto strokes = strokes_of(path.position_m, kRate_hz);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].frames.size(), path.position_m.size());
}

TEST(Strokes, AGapPartsThem) {
  const Path path = Path().go(0.05, 2);
  const schema::Gap gap{9000, 9000, 100};
  const auto strokes = strokes_of(path.position_m, kRate_hz, {&gap, 1});
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].frames.end, 9000U);
  EXPECT_EQ(strokes[1].frames.begin, 9000U);
}

TEST(Strokes, NoneWhereNothingMoves) {
  EXPECT_TRUE(strokes_of(Path().rest(1).position_m, kRate_hz).empty());
  EXPECT_TRUE(strokes_of({}, kRate_hz).empty());
  EXPECT_TRUE(strokes_of(std::vector<double>{1.0}, kRate_hz).empty());
}

TEST(Strokes, QuantumIsTheEncodersCount) {
  EXPECT_NEAR(facts_of(Path(0.5e-6).go(0.0403, 1).position_m, kRate_hz).quantum_m, 0.5e-6, 1e-15);
  EXPECT_NEAR(facts_of(Path(1e-6).rest(5).go(0.001, 1).position_m, kRate_hz).quantum_m, 1e-6, 1e-15);
}

TEST(Strokes, PiecesLieBetweenGaps) {
  const std::vector<schema::Gap> gaps = {{0, 0, 5}, {10, 15, 3}, {20, 28, 1}};
  const auto pieces = pieces_between_gaps(20, gaps);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].begin, 0U);
  EXPECT_EQ(pieces[0].end, 10U);
  EXPECT_EQ(pieces[1].end, 20U);
}

TEST(Strokes, FindsTheTwoOfTheBareFinger) {
  const auto finger = bare_finger();
  if (finger.empty()) GTEST_SKIP() << "skipped: no real data";
  EXPECT_NEAR(facts_of(finger, kRate_hz).quantum_m, 0.5e-6, 1e-15);
  const auto strokes = strokes_of(finger, kRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  // By the data's own timeline: 0.1 to 2.45 s back, 4.5 to 6.9 s forth; the stage ramps up and down over 0.25
  // s.
  const auto time_s = [](std::size_t frame) { return static_cast<double>(frame) / kRate_hz; };
  EXPECT_EQ(strokes[0].direction, -1);
  EXPECT_NEAR(time_s(strokes[0].frames.begin), 0.1, 0.1);
  EXPECT_NEAR(time_s(strokes[0].frames.end), 2.45, 0.15);
  EXPECT_EQ(strokes[1].direction, 1);
  EXPECT_NEAR(time_s(strokes[1].frames.begin), 4.5, 0.1);
  EXPECT_NEAR(time_s(strokes[1].frames.end), 6.9, 0.15);
}

}  // namespace
}  // namespace tacto::spatial
