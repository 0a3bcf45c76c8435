// SPDX-License-Identifier: GPL-3.0-or-later
// Counters of a run: the time of playback differs from the time since arming.
#include "playback/session/tick_view.hpp"

#include <gtest/gtest.h>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::playback {
namespace {

constexpr double kTicksPerS = 1000;

TEST(TicksSeen, TheTimeInPlayLeavesOutArmedAndFault) {
  TickView view;
  view.begin(kTicksPerS, 1e-6);
  const auto take = [&](std::uint64_t count, std::uint32_t flags) {
    for (const std::uint64_t end = view.expected() + count; view.expected() < end;)
      view.take({view.expected(), 0, 0, 0, flags, 0});
  };
  take(2000, 0);
  EXPECT_EQ(view.playing_s(), 0);
  EXPECT_EQ(view.span_s(), 2);
  take(500, wire::kTickPlaying | wire::kTickEnabled);
  take(250, 0);
  take(125, wire::kTickPlaying);
  take(1000, wire::kTickFault);
  take(1000, wire::kTickPlaying | wire::kTickFault);
  EXPECT_EQ(view.playing_s(), 0.625);
  EXPECT_EQ(view.span_s(), 4.875);
}

}  // namespace
}  // namespace tacto::playback
