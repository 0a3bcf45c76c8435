// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/strokes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "spatial/strokes/touch_record.hpp"
#include "tests/spatial/bare_finger.hpp"
#include "tests/spatial/force_and_position.hpp"
#include "tests/spatial/strokes_of.hpp"

namespace tacto::spatial {
namespace {

constexpr double kStrokeRate_hz = 10000;

// Positions written part by part, read by an encoder.
class Path {
 public:
  explicit Path(double quantum_m = 1e-6, double dither_m = 0) : quantum_m_(quantum_m), dither_m_(dither_m) {}
  Path& go(double speed_mps, double duration_s) {
    for (int i = 0; i < std::lround(duration_s * kStrokeRate_hz); ++i) {
      exact_m_ += speed_mps / kStrokeRate_hz;
      const double seen_m = exact_m_ + dither_m_ * normal_(random_);
      position_m.push_back(quantum_m_ > 0 ? std::round(seen_m / quantum_m_) * quantum_m_ : seen_m);
    }
    return *this;
  }
  Path& rest(double duration_s) { return go(0, duration_s); }
  // Sticks for `stick_s`, then slips `slip_m` in 2 ms and recoils by a twentieth of it.
  Path& stick_slip(double slip_m, double stick_s, int times) {
    for (int i = 0; i < times; ++i)
      rest(stick_s).go(slip_m * 1.05 / 0.002, 0.002).go(-slip_m * 0.05 / 0.001, 0.001);
    return *this;
  }
  double seconds() const { return static_cast<double>(position_m.size()) / kStrokeRate_hz; }
  std::vector<double> position_m;

 private:
  double quantum_m_, dither_m_, exact_m_ = 0;
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
};

void expect_stroke(const Stroke& stroke, double from_s, double to_s, int direction) {
  // The speed is averaged over 20 ms.
  EXPECT_NEAR(static_cast<double>(stroke.frames.begin) / kStrokeRate_hz, from_s, 0.015);
  EXPECT_NEAR(static_cast<double>(stroke.frames.end) / kStrokeRate_hz, to_s, 0.015);
  EXPECT_EQ(stroke.direction, direction);
}

TEST(Strokes, FindsBothWaysBetweenPauses) {
  const Path path = Path().rest(1).go(0.04, 1).rest(0.5).go(-0.08, 0.5).rest(1);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  expect_stroke(strokes[0], 1, 2, 1);
  expect_stroke(strokes[1], 2.5, 3, -1);
}

TEST(Strokes, AReversalPartsThem) {
  const Path path = Path().go(0.05, 1).go(-0.05, 1).go(0.05, 1);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 3U);
  expect_stroke(strokes[1], 1, 2, -1);
}

TEST(Strokes, APausePartsAndAStickDoesNot) {
  const Path paused = Path().go(0.05, 1).rest(0.3).go(0.05, 1),
             stuck = Path().go(0.05, 1).rest(0.05).go(0.05, 1);
  EXPECT_EQ(strokes_of(paused.position_m, kStrokeRate_hz).size(), 2U);
  EXPECT_EQ(strokes_of(stuck.position_m, kStrokeRate_hz).size(), 1U);
}

TEST(Strokes, EachIsJudgedByItsOwnSpeed) {
  const Path path = Path().rest(1).go(0.002, 10).rest(1).go(0.2, 0.2).rest(1);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  expect_stroke(strokes[0], 1, 11, 1);
  expect_stroke(strokes[1], 12, 12.2, 1);
}

TEST(Strokes, ACoarseEncoderMakesNoFalseOnes) {
  for (const double quantum_m : {0.1e-6, 1e-6, 10e-6}) {
    const Path path = Path(quantum_m, quantum_m / 2).rest(2).go(0.001, 6).rest(60).go(-0.006, 1).rest(2);
    const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
    ASSERT_EQ(strokes.size(), 2U) << quantum_m;
    EXPECT_EQ(strokes[0].direction, 1);
    EXPECT_EQ(strokes[1].direction, -1);
  }
}

TEST(Strokes, ANominalPositionIsOneStroke) {
  const Path path = Path(0).go(0.04, 2);
  EXPECT_EQ(facts_of(path.position_m, kStrokeRate_hz).quantum_m, 0);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].frames.size(), path.position_m.size());
}

TEST(Strokes, AGapPartsThem) {
  const Path path = Path().go(0.05, 2);
  const schema::Gap gap{9000, 9000, 100};
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz, {&gap, 1});
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_EQ(strokes[0].frames.end, 9000U);
  EXPECT_EQ(strokes[1].frames.begin, 9000U);
}

TEST(Strokes, AFingerThatSticksAndSlipsMakesOneStroke) {
  // 40 mm in slips of 0.5 mm with 50 ms between them, back and forth: 9.4 mm/s.
  for (const double quantum_m : {0.1e-6, 1e-6, 10e-6}) {
    const Path path =
        Path(quantum_m).rest(0.5).stick_slip(0.5e-3, 0.05, 80).rest(0.5).stick_slip(-0.5e-3, 0.05, 80);
    const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
    ASSERT_EQ(strokes.size(), 2U) << quantum_m;
    EXPECT_EQ(strokes[0].direction, 1);
    EXPECT_EQ(strokes[1].direction, -1);
    EXPECT_NEAR(strokes[0].advance_m(), 0.04, 1e-3);
    EXPECT_NEAR(strokes[1].advance_m(), 0.04, 1e-3);
  }
}

TEST(Strokes, StickAndSlipBesideASmoothStroke) {
  const Path path = Path().rest(0.5).go(0.1, 1).rest(0.5).stick_slip(0.5e-3, 0.04, 40).rest(0.5);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  EXPECT_NEAR(strokes[1].advance_m(), 0.02, 1e-3);
}

TEST(Strokes, FromOneToAThousandMillimetresASecondInOneRecord) {
  for (const double quantum_m : {0.1e-6, 1e-6, 10e-6}) {
    const Path path = Path(quantum_m, quantum_m / 2)
                          .rest(1)
                          .go(0.001, 10)
                          .rest(1)
                          .go(-0.01, 1)
                          .rest(1)
                          .go(0.1, 1)
                          .rest(1)
                          .go(-1, 0.15)
                          .rest(1);
    const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
    ASSERT_EQ(strokes.size(), 4U) << quantum_m;
    const double way_m[] = {0.01, 0.01, 0.1, 0.15};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(strokes[i].direction, i % 2 == 0 ? 1 : -1);
      EXPECT_NEAR(strokes[i].advance_m(), way_m[i], 0.02 * way_m[i] + 20 * quantum_m)
          << i << " " << quantum_m;
    }
  }
}

TEST(Strokes, ANoisyLvdtShowsTheSameStrokes) {
  // No grid; noise of 3 um, 30 times the distance per sample at 1 mm/s.
  const Path path = Path(0, 3e-6).rest(1).go(0.001, 10).rest(1).go(-0.04, 1).rest(30).go(0.2, 0.2).rest(1);
  const PositionFacts facts = facts_of(path.position_m, kStrokeRate_hz);
  EXPECT_NEAR(facts.noise_m, 3e-6, 0.05e-6);
  EXPECT_LT(facts.quantum_m, 1e-8);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 3U);
  expect_stroke(strokes[1], 12, 13, -1);
  expect_stroke(strokes[2], 43, 43.2, 1);
  EXPECT_NEAR(strokes[0].advance_m(), 0.01, 5e-4);
}

TEST(Strokes, ANominalPositionHasNeitherQuantumNorNoise) {
  const PositionFacts facts = facts_of(Path(0).rest(1).go(0.04, 2).position_m, kStrokeRate_hz);
  EXPECT_EQ(facts.quantum_m, 0);
  EXPECT_EQ(facts.noise_m, 0);
  EXPECT_NEAR(facts.travelling_mps, 0.04, 0.0005);
}

TEST(Strokes, AnEncodersRoundingAndDitherAreNoNoise) {
  for (const double dither : {0.0, 0.3, 0.8}) {
    const Path path = Path(1e-6, dither * 1e-6).rest(1).go(0.0403, 2).rest(1);
    EXPECT_EQ(facts_of(path.position_m, kStrokeRate_hz).noise_m, 0) << dither;
    EXPECT_NEAR(facts_of(path.position_m, kStrokeRate_hz).quantum_m, 1e-6, 1e-15) << dither;
  }
}

TEST(Strokes, AreTheSameInChunksOfALongRecord) {
  // Much longer than a chunk, with strokes across the chunks' borders; each is found at the same place as in
  // a search of its part alone.
  Path path;
  for (int i = 0; i < 30; ++i) path.rest(0.3).go(i % 2 == 0 ? 0.05 : -0.05, 1.7);
  const auto strokes = strokes_of(path.position_m, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 30U);
  for (std::size_t i = 0; i < strokes.size(); ++i)
    expect_stroke(strokes[i], 2.0 * static_cast<double>(i) + 0.3, 2.0 * static_cast<double>(i) + 2,
                  i % 2 == 0 ? 1 : -1);
}

TEST(Strokes, NoneWhereNothingMoves) {
  EXPECT_TRUE(strokes_of(Path().rest(1).position_m, kStrokeRate_hz).empty());
  EXPECT_TRUE(strokes_of({}, kStrokeRate_hz).empty());
  EXPECT_TRUE(strokes_of(std::vector<double>{1.0}, kStrokeRate_hz).empty());
}

TEST(Strokes, QuantumIsTheEncodersCount) {
  EXPECT_NEAR(facts_of(Path(0.5e-6).go(0.0403, 1).position_m, kStrokeRate_hz).quantum_m, 0.5e-6, 1e-15);
  EXPECT_NEAR(facts_of(Path(1e-6).rest(5).go(0.001, 1).position_m, kStrokeRate_hz).quantum_m, 1e-6, 1e-15);
}

TEST(Strokes, PiecesLieBetweenGaps) {
  const std::vector<schema::Gap> gaps = {{0, 0, 5}, {10, 15, 3}, {20, 28, 1}};
  const auto pieces = pieces_between_gaps(20, gaps);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].begin, 0U);
  EXPECT_EQ(pieces[0].end, 10U);
  EXPECT_EQ(pieces[1].end, 20U);
}

// A finger at 50 mm/s on a force of 500 Hz; some frames are missing, and the counter may overflow at one.
class TornSine : public samples::ForceAndPosition {
 public:
  explicit TornSine(const std::vector<schema::Gap>& gaps, std::size_t overflow = SIZE_MAX) {
    for (std::size_t i = 0; i < kWhole; ++i) kept_.push_back(i);
    for (const schema::Gap& gap : gaps) {
      const auto at = kept_.begin() + static_cast<std::ptrdiff_t>(gap.frame);
      kept_.erase(at, at + static_cast<std::ptrdiff_t>(gap.count));
    }
    overflow_ = overflow;
    header.sample_rate_hz = kStrokeRate_hz;
    header.frames = kept_.size();
    header.gaps = gaps;
  }
  static double value(Track track, std::size_t frame) {
    const double t = static_cast<double>(frame) / kStrokeRate_hz;
    return track == Track::position ? 0.05 * t : std::sin(2 * std::numbers::pi * 500 * t);
  }
  schema::Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = value(track, kept_.at(first + i));
      if (track == Track::position && kept_[first + i] >= overflow_) out[i] -= 0.065536;
    }
    return {};
  }
  static constexpr std::size_t kWhole = 400;
  schema::RecordingHeader header;

 private:
  std::vector<std::size_t> kept_;
  std::size_t overflow_;
};

BridgedTouch bridged(const std::vector<schema::Gap>& gaps, std::size_t overflow = SIZE_MAX) {
  auto torn = std::make_unique<TornSine>(gaps, overflow);
  const schema::RecordingHeader header = torn->header;
  auto touch = bridge_short_gaps(std::move(torn), header);
  EXPECT_TRUE(touch);
  return std::move(*touch);
}

// Lagrange's remainder: |f - cubic| <= prod |x - x_i| / 24 (2 pi 500 / 10000)^4 at each missing frame x.
TEST(Strokes, AShortGapIsOnTheCubicThroughItsNeighbours) {
  for (std::uint64_t missing = 1; missing <= kMostFilledFrames; ++missing) {
    const BridgedTouch touch = bridged({{103, 103 + missing, missing}, {200, 200 + 2 * missing, missing}});
    EXPECT_TRUE(touch.header.gaps.empty());
    ASSERT_EQ(touch.header.frames, TornSine::kWhole);
    ASSERT_EQ(touch.filled.size(), 2U);
    const double h4 = std::pow(2 * std::numbers::pi * 500 / kStrokeRate_hz, 4) / 24;
    const auto n = static_cast<double>(missing);
    for (const std::size_t part : {1, 7, 400}) {  // read in parts of every kind
      for (std::size_t first = 0; first < TornSine::kWhole; first += part) {
        std::vector<double> force(std::min(part, TornSine::kWhole - first)), position(force.size());
        ASSERT_TRUE(touch.source->read(Track::value, first, force));
        ASSERT_TRUE(touch.source->read(Track::position, first, position));
        for (std::size_t i = 0; i < force.size(); ++i) {
          double bound = 0;
          for (const FrameRange& range : touch.filled)
            if (const auto x = static_cast<double>(first + i + 1) - static_cast<double>(range.begin);
                x > 0 && x <= n)
              bound = (x + 1) * x * (n + 1 - x) * (n + 2 - x) * h4;
          EXPECT_NEAR(force[i], TornSine::value(Track::value, first + i), bound + 1e-12) << first + i;
          EXPECT_NEAR(position[i], TornSine::value(Track::position, first + i), 1e-12) << first + i;
        }
      }
    }
  }
}

TEST(Strokes, AGapStaysIfItIsLongOrHasNoNeighboursOrThePositionJumps) {
  EXPECT_EQ(bridged({{100, 105, 5}}).header.gaps.size(), 1U);
  EXPECT_EQ(bridged({{1, 2, 1}}).header.gaps.size(), 1U);
  EXPECT_EQ(bridged({{100, 101, 1}, {101, 103, 1}}).header.gaps.size(), 2U);
  EXPECT_EQ(bridged({{100, 101, 1}}, 101).header.gaps.size(), 1U) << "a counter that overflows in the gap";
  const BridgedTouch mixed = bridged({{100, 102, 2}, {200, 207, 5}});
  ASSERT_EQ(mixed.header.gaps.size(), 1U);
  EXPECT_EQ(mixed.header.gaps[0].frame, 202U);
  EXPECT_EQ(schema::frame_time_s(mixed.header, 202), 207 / kStrokeRate_hz);
}

TEST(Strokes, FindsTheTwoOfTheBareFinger) {
  const auto finger = bare_finger();
  if (finger.empty()) GTEST_SKIP() << "skipped: no real data";
  EXPECT_NEAR(facts_of(finger, kStrokeRate_hz).quantum_m, 0.5e-6, 1e-15);
  const auto strokes = strokes_of(finger, kStrokeRate_hz);
  ASSERT_EQ(strokes.size(), 2U);
  // By the data's own timeline: 0.1 to 2.45 s back, 4.5 to 6.9 s ahead; the stage ramps up and down over 0.25
  // s.
  const auto time_s = [](std::size_t frame) { return static_cast<double>(frame) / kStrokeRate_hz; };
  EXPECT_EQ(strokes[0].direction, -1);
  EXPECT_NEAR(time_s(strokes[0].frames.begin), 0.1, 0.1);
  EXPECT_NEAR(time_s(strokes[0].frames.end), 2.45, 0.15);
  EXPECT_EQ(strokes[1].direction, 1);
  EXPECT_NEAR(time_s(strokes[1].frames.begin), 4.5, 0.1);
  EXPECT_NEAR(time_s(strokes[1].frames.end), 6.9, 0.15);
}

}  // namespace
}  // namespace tacto::spatial
