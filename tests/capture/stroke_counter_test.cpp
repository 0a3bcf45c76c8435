// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/stroke_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/record/live_view.hpp"

namespace tacto::capture {
namespace {

constexpr double kStrokeCounterRate_hz = 1000;

// Moves to a position at a speed, then rests.
void go(StrokeCounter& counter, double& at_m, double to_m, double speed_mps, double load_n, int rest = 0) {
  const double step_m = speed_mps / kStrokeCounterRate_hz * (to_m > at_m ? 1 : -1);
  for (auto left = static_cast<int>(std::lround(std::abs((to_m - at_m) / step_m))); left > 0; --left)
    counter.add(at_m += step_m, load_n);
  for (int i = 0; i < rest; ++i) counter.add(at_m, 9);
}

TEST(StrokeCounter, ThereAndBackAreTwo) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  double at_m = 0;
  go(counter, at_m, 0, 1, 0, 300);
  go(counter, at_m, 0.04, 0.05, 0.5);
  go(counter, at_m, 0, 0.04, 0.3, 200);
  ASSERT_EQ(counter.strokes().size(), 2U);
  const CountedStroke &forth = counter.strokes()[0], &back = counter.strokes()[1];
  EXPECT_NEAR(forth.length_m, 0.04, StrokeCounter::kTurn_m);  // it begins within that of its start
  EXPECT_NEAR(forth.mean_speed_mps, 0.05, 0.05 * 0.02);
  EXPECT_NEAR(forth.mean_normal_n, 0.5, 0.5 * 0.02);
  EXPECT_EQ(forth.direction, 1);
  EXPECT_EQ(back.direction, -1);
  EXPECT_NEAR(back.mean_speed_mps, 0.04, 0.04 * 0.03);
  EXPECT_NEAR(back.mean_normal_n, 0.3, 0.3 * 0.03);
}

TEST(StrokeCounter, RestsBeforeAndAfterAreNoPartOfTheSpeed) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  double at_m = 0;
  go(counter, at_m, 0, 1, 0, 140);  // less than a rest
  go(counter, at_m, 0.04, 0.05, 0.5);
  for (int i = 0; i < 140; ++i) counter.add(at_m + i * 0.5e-6, 9);  // creeps by a count
  go(counter, at_m, 0, 0.05, 0.5, 160);
  ASSERT_EQ(counter.strokes().size(), 2U);
  for (const CountedStroke& stroke : counter.strokes()) {
    EXPECT_NEAR(stroke.mean_speed_mps, 0.05, 1e-9);
    EXPECT_NEAR(stroke.mean_normal_n, 0.5, 0.02);
    EXPECT_NEAR(stroke.length_m, 0.04, StrokeCounter::kTurn_m + StrokeCounter::kStill_m);
  }
}

TEST(StrokeCounter, TheStreamsEndEndsAStrokeThatHadStopped) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  double at_m = 0;
  go(counter, at_m, 0.04, 0.05, 0.5, 30);
  EXPECT_TRUE(counter.strokes().empty());
  counter.finish();
  counter.finish();
  EXPECT_EQ(counter.strokes().size(), 1U);
  go(counter, at_m, 0, 0.05, 0.5);  // cut off
  counter.finish();
  EXPECT_EQ(counter.strokes().size(), 1U);
}

TEST(StrokeCounter, AShortHaltDoesNotEndAStroke) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  double at_m = 0;
  go(counter, at_m, 0.02, 0.05, 0.5, 100);
  go(counter, at_m, 0.04, 0.05, 0.5, 200);
  EXPECT_EQ(counter.strokes().size(), 1U);
}

TEST(StrokeCounter, TrembleAndShortWaysAreNone) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  double at_m = 0;
  for (int i = 0; i < 20; ++i) go(counter, at_m, i % 2 == 0 ? 0.004 : 0, 0.05, 0.5, 50);
  EXPECT_TRUE(counter.strokes().empty());
}

TEST(StrokeCounter, OneCountOfDitherDoesNotTurnAStroke) {
  StrokeCounter counter(kStrokeCounterRate_hz);
  for (int i = 0; i < 1000; ++i) counter.add(50e-6 * i - (i % 3 == 0 ? 100e-6 : 0), 0.5);
  EXPECT_TRUE(counter.strokes().empty());  // still going on
  for (int i = 0; i < 200; ++i) counter.add(0.05, 0.5);
  EXPECT_EQ(counter.strokes().size(), 1U);
}

// 60 mm in 1.2 s, of which 25 frames are missing in the middle and 3 samples are clipped.
TEST(LiveFigures, TellWhatIsMissingAndClippedInAStroke) {
  schema::RecordingHeader header;
  header.sample_rate_hz = kStrokeCounterRate_hz;
  header.channels.resize(2);
  header.channels[0].quantity = "position";
  header.channels[0].scale = 1e-6;
  header.channels[1].quantity = "tangential_force";
  header.channels[1].range_min = -100;
  header.channels[1].range_max = 100;
  LiveFigures figures(header);
  for (int i = 0; i < 1500; ++i) {
    const std::int32_t codes[] = {50 * std::min(i, 1200), i >= 500 && i < 503 ? 100 : 0};
    figures.add(codes);
  }
  header.gaps = {{0, 0, 7}, {600, 607, 25}, {1400, 1432, 9}};
  const auto strokes = figures.stroke_figures();
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].clipped_samples, 3U);
  EXPECT_EQ(strokes[0].lost_frames, 25U);
  EXPECT_NEAR(strokes[0].mean_speed_mps, 0.06 / 1.225, 1e-3);
  EXPECT_FALSE(strokes[0].mean_normal_n);
}

// A counter of 32 bits that passes 2^31 in the middle of a stroke continues; the stroke does not get 4.3 km
// long.
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
  const auto strokes = figures.stroke_figures();
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].direction, 1);
  EXPECT_NEAR(strokes[0].length_m, 1200 * 53e-6, 0.2e-3);  // resolution of 0.1 mm
  EXPECT_NEAR(*figures.take_view().speed_mps, 1200 * 53e-6 / 1.5, 1e-6);
}

}  // namespace
}  // namespace tacto::capture
