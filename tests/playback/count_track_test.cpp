// SPDX-License-Identifier: GPL-3.0-or-later
// Counts that arrive several at a time, late and by another clock, as in a loop on the host.
#include "playback/host-loop/host_board.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "playback/session/tick_view.hpp"

namespace tacto::playback {
namespace {

constexpr double kTrackRateHz = 2000;

/// A device whose finger moves at constant speed, and the ticks of a host.
struct Cable {
  double counts_per_period = 9.3;
  double device_periods_per_tick = 1;  ///< its clock relative to the host's
  int batch = 3;                       ///< periods that are delivered together
  double late_ticks = 0;               ///< largest random delay
};

/// Lag in counts in each of 20,000 ticks: the finger's position minus the position seen.
std::vector<double> lags_of(const Cable& cable, CountTrack& track) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> late(0, cable.late_ticks);
  std::vector<double> lags;
  std::uint32_t given = 0;
  double held_until = 0;
  track.put(0, 0, 0);
  track.begin();
  for (int tick = 0; tick < 20000; ++tick) {
    const auto made = static_cast<std::uint32_t>(tick * cable.device_periods_per_tick);
    const std::uint32_t whole = made / cable.batch * cable.batch;
    if (whole > given && tick >= held_until) {
      for (; given < whole; ++given)
        track.put(given + 1, static_cast<std::int32_t>(std::floor((given + 1) * cable.counts_per_period)), 0);
      held_until = tick + late(random);
    }
    lags.push_back(tick * cable.device_periods_per_tick * cable.counts_per_period - track.see().count);
  }
  return lags;
}

struct Range {
  double least, most;
};
Range range_of(const std::vector<double>& lags, std::size_t first, std::size_t last) {
  const auto [least, most] = std::minmax_element(lags.begin() + static_cast<std::ptrdiff_t>(first),
                                                 lags.begin() + static_cast<std::ptrdiff_t>(last));
  return {*least, *most};
}

// The position is known to one count, and its interpolation is rounded to one.
TEST(CountTrack, GoesEvenlyWhereCountsComeThreeAtATime) {
  CountTrack track(kTrackRateHz);
  const Cable cable;
  const auto lags = lags_of(cable, track);
  const Range settled = range_of(lags, 4000, lags.size());
  EXPECT_LT(settled.most - settled.least, 2.5);
  EXPECT_LT(settled.most, (cable.batch + 2) * cable.counts_per_period);
}

// A drift of 100 ppm in either direction, and delays of up to 4 ms: over each half second the lag changes by
// less than the distance per period; the last count alone would jump by three.
TEST(CountTrack, FollowsAnotherClock) {
  for (const double part : {1 - 1e-4, 1 + 1e-4}) {
    CountTrack track(kTrackRateHz);
    Cable cable;
    cable.device_periods_per_tick = part, cable.late_ticks = 8;
    const auto lags = lags_of(cable, track);
    for (std::size_t i = 4000; i + 1000 < lags.size(); i += 1000) {
      const Range here = range_of(lags, i, i + 1000);
      EXPECT_LT(here.most - here.least, cable.counts_per_period + 2.5) << part << " " << i;
      EXPECT_LT(here.most, (cable.batch + cable.late_ticks + 2) * cable.counts_per_period) << part;
    }
  }
}

TEST(CountTrack, ComesNearAgainAfterAStall) {
  CountTrack track(kTrackRateHz);
  std::uint32_t period = 0;
  track.put(0, 0, 0);
  track.begin();
  CountTrack::Sight sight;
  const auto give = [&](std::uint32_t periods) {
    for (const std::uint32_t end = period + periods; period < end;) {
      ++period;
      track.put(period, static_cast<std::int32_t>(10 * period), 0);
    }
  };
  for (int i = 0; i < 100; ++i) give(1), sight = track.see();
  EXPECT_GE(sight.count, 980);
  for (int i = 0; i < 30; ++i) sight = track.see();  // 15 ms without a count: linear extrapolation for 2 ms
  EXPECT_EQ(sight.count, 1040);
  give(30);
  sight = track.see();
  EXPECT_LE(sight.passed, 2U) << "less than 20 ms: no leap";
  for (int i = 0; i < 4000; ++i) give(1), sight = track.see();
  EXPECT_GE(sight.count, static_cast<std::int32_t>(10 * period) - 30);
  give(1000);
  sight = track.see();
  EXPECT_EQ(sight.count, static_cast<std::int32_t>(10 * period)) << "half a second: at once";
  EXPECT_GT(sight.passed, 900U);
}

// With a reserve equal to the periods that arrive together, the finger moves evenly from the first tick on,
// with constant lag. Without it the track first has to fall behind.
TEST(CountTrack, BeginsAsFarBehindAsItStays) {
  for (const bool reserved : {false, true}) {
    constexpr std::int32_t kBatch = 20;
    CountTrack track(20e3);
    track.set_reserve(reserved ? kBatch + 1 : 0);
    std::vector<std::int32_t> steps;
    std::int32_t before = 0;
    for (std::int32_t tick = 0; tick < 2000; ++tick) {
      for (std::int32_t i = 1; tick % kBatch == 0 && i <= kBatch; ++i)
        track.put(static_cast<std::uint32_t>(tick + i), (tick + i) * (tick + i) / 100, 0);  // it accelerates
      const std::int32_t count = tick == 0 ? track.begin().count : track.see().count;
      if (tick > 100) steps.push_back(count - before - (2 * tick - 2 * kBatch) / 100);
      before = count;
    }
    const auto [least, most] = std::ranges::minmax_element(steps);
    EXPECT_EQ(*most - *least <= 3, reserved) << *least << " " << *most;
  }
}

TEST(CountTrack, PeriodsThatAreLeftOutLieOnALine) {
  CountTrack track(kTrackRateHz);
  track.put(UINT32_MAX - 1, 100, 0);
  track.begin();
  track.put(3, 200, 7000);  // across the counter's overflow: 5 periods later
  std::vector<std::int32_t> seen;
  for (int i = 0; i < 5; ++i) seen.push_back(track.see().count);
  EXPECT_EQ(seen, (std::vector<std::int32_t>{120, 140, 160, 180, 200}));
}

TEST(CountTrack, ACounterThatPassesItsEndGoesOn) {
  CountTrack track(kTrackRateHz);
  track.put(1, INT32_MAX - 29, 0);
  track.begin();
  track.put(6, INT32_MIN + 20, 0);  // 50 counts in 5 periods
  std::vector<std::int32_t> seen;
  for (int i = 0; i < 6; ++i) seen.push_back(track.see().count);
  EXPECT_EQ(seen, (std::vector<std::int32_t>{INT32_MAX - 19, INT32_MAX - 9, INT32_MIN, INT32_MIN + 10,
                                             INT32_MIN + 20, INT32_MIN + 30}))
      << "the last one straight on";
}

TEST(TickView, ACounterThatPassesItsEndGoesOn) {
  TickView view;
  view.begin(kTrackRateHz, 1e-6);
  for (std::uint64_t i = 0; i < 100; ++i) {
    const std::uint32_t count = 0x7FFFFFFFU - 490 + 10 * static_cast<std::uint32_t>(i);  // 20 mm/s
    view.take({.tick = i, .encoder = static_cast<std::int32_t>(count)});
  }
  EXPECT_NEAR(view.speed_mps(), 0.02, 1e-9);
  EXPECT_NEAR(view.position_m(), 1e-6 * (2147483647.0 + 500), 1e-9);
  EXPECT_NEAR(view.greatest_position_m() - view.least_position_m(), 990e-6, 1e-9);
}

TEST(CountTrack, AFingerThatStandsStands) {
  CountTrack track(kTrackRateHz);
  for (std::uint32_t i = 0; i < 50; ++i) {
    track.put(i, -7, 0);
    if (i == 0) track.begin();
    EXPECT_EQ(track.see().count, -7);
  }
}

}  // namespace
}  // namespace tacto::playback
