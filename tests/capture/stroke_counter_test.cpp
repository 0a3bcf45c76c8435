// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/live_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "capture/record/live_view.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "spatial/strokes/strokes.hpp"

namespace tacto::capture {
namespace {

constexpr double kStrokeCounterRate_hz = 1000;

// Positions, frame by frame.
class Motion {
 public:
  Motion& go(double to_m, double speed_mps) {
    const double step_m = speed_mps / kStrokeCounterRate_hz * (to_m > at_m_ ? 1 : -1);
    for (auto left = static_cast<int>(std::lround(std::abs((to_m - at_m_) / step_m))); left > 0; --left)
      position_m_.push_back(at_m_ += step_m);
    return *this;
  }
  Motion& rest(int frames) {
    position_m_.insert(position_m_.end(), static_cast<std::size_t>(frames), at_m_);
    return *this;
  }
  const std::vector<double>& position_m() const { return position_m_; }
  std::size_t counted() const {
    StrokeCounter counter(kStrokeCounterRate_hz);
    for (const double position_m : position_m_) counter.add(position_m);
    return counter.strokes();
  }

 private:
  double at_m_ = 0;
  std::vector<double> position_m_;
};

TEST(StrokeCounter, ThereAndBackAreTwo) {
  EXPECT_EQ(Motion().rest(300).go(0.04, 0.05).go(0, 0.04).rest(200).counted(), 2U);
}

TEST(StrokeCounter, CountsWhenTheFingerTurnsOrRests) {
  EXPECT_EQ(Motion().go(0.04, 0.05).counted(), 0U);  // still going on
  EXPECT_EQ(Motion().go(0.04, 0.05).rest(110).counted(), 1U);
  EXPECT_EQ(Motion().go(0.04, 0.05).go(0.039, 0.05).counted(), 1U);
}

TEST(StrokeCounter, AShortHaltDoesNotEndAStroke) {
  EXPECT_EQ(Motion().go(0.02, 0.05).rest(90).go(0.04, 0.05).rest(200).counted(), 1U);
  EXPECT_EQ(Motion().go(0.02, 0.05).rest(120).go(0.04, 0.05).rest(200).counted(), 2U);
}

TEST(StrokeCounter, TrembleAndShortWaysAreNone) {
  Motion motion;
  for (int i = 0; i < 20; ++i) motion.go(i % 2 == 0 ? 0.0045 : 0, 0.05).rest(50);
  EXPECT_EQ(motion.counted(), 0U);
}

TEST(StrokeCounter, ASlowFingerMakesStrokesToo) {
  EXPECT_EQ(Motion().go(0.01, 0.002).rest(200).go(0, 0.002).rest(200).counted(), 2U);
}

TEST(StrokeCounter, OneCountOfDitherDoesNotTurnAStroke) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  for (int i = 0; i < 1000; ++i) counter.add(50e-6 * i - (i % 3 == 0 ? 100e-6 : 0));
  EXPECT_EQ(counter.strokes(), 0U);  // still going on
  for (int i = 0; i < 200; ++i) counter.add(0.05);
  EXPECT_EQ(counter.strokes(), 1U);
}

// The count during the recording is that of the complete recording, for strokes from 5.5 to 60 mm, of which
// none is below 5 % of the longest.
TEST(StrokeCounter, CountsWhatIsFoundInTheWholeRecord) {
  std::mt19937 random(20261128);  // NOLINT: the same motions on every machine
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  for (int round = 0; round < 50; ++round) {
    Motion motion;
    double at_m = 0;
    for (int i = 0; i < 8; ++i) {
      const double way_m = between(5.5e-3, 60e-3);
      at_m += i % 2 == 0 ? way_m : -way_m;
      motion.rest(static_cast<int>(between(0, 400))).go(at_m, between(0.01, 0.2));
    }
    motion.rest(300);
    const auto& position_m = motion.position_m();
    const spatial::ReadFrames read = [&](std::size_t first, std::span<double> out) -> schema::Result<void> {
      std::copy_n(position_m.begin() + static_cast<std::ptrdiff_t>(first), out.size(), out.begin());
      return {};
    };
    const std::vector<spatial::FrameRange> whole{{0, position_m.size()}};
    const auto facts = spatial::position_facts(read, whole, kStrokeCounterRate_hz, 1);
    ASSERT_TRUE(facts);
    const auto found = spatial::find_strokes(read, whole, kStrokeCounterRate_hz, *facts);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->strokes.size(), 8U) << "round " << round;
    EXPECT_EQ(motion.counted(), 8U) << "round " << round;
  }
}

// A counter of 32 bits that passes 2^31 in the middle of a stroke continues.
TEST(LiveFigures, CountAStrokeThroughTheCountersWrap) {
  schema::RecordingHeader header;
  header.sample_rate_hz = kStrokeCounterRate_hz;
  header.channels.resize(1);
  header.channels[0].quantity = "position";
  header.channels[0].scale = 1e-6;
  LiveFigures figures(header);
  for (int i = 0; i < 1500; ++i) {
    const std::uint32_t count = 0x7fffffffU - 30'000U + 53U * static_cast<std::uint32_t>(std::min(i, 1200));
    const auto code = static_cast<std::int32_t>(count);
    figures.add(std::span(&code, 1));
  }
  EXPECT_EQ(figures.strokes(), 1U);
  EXPECT_NEAR(*figures.take_view().speed_mps, 1200 * 53e-6 / 1.5, 1e-6);
}

}  // namespace
}  // namespace tacto::capture
