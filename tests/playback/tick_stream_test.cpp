// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/tick_stream.hpp"

#include <gtest/gtest.h>

#include "data-schema/session/session_blocks.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::playback {
namespace {

using schema::SessionTick;

std::string bytes_of(const std::string& base64) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    bits = bits << 6U | static_cast<std::uint32_t>(kDigits.find(c));
    if ((have += 6) < 8) continue;
    have -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(have) & 255U);
  }
  return bytes;
}

std::vector<SessionTick> ticks_of(const schema::ControlFields& event) {
  const std::string bytes = bytes_of(schema::control_text(event, "ticks"));
  const auto ticks = schema::control_number(event, "block") == 8 ? schema::axis_ticks_from(bytes)
                                                                 : schema::ticks_from(bytes);
  EXPECT_TRUE(ticks);
  EXPECT_LT(schema::control_event_line("ticks", event).size(), schema::kMostControlLine);
  return ticks.value_or(std::vector<SessionTick>());
}

SessionTick tick_of(std::uint64_t number, float drive_v, std::uint32_t flags = 0) {
  return {number,
          static_cast<std::int64_t>(number) * 50'000,
          static_cast<std::int32_t>(number) * 3,
          drive_v,
          flags,
          7};
}

TEST(TickStream, KeepsNothingWhileNobodyWatches) {
  TickStream stream;
  stream.take(tick_of(0, 1));
  EXPECT_TRUE(stream.take_events(2000, true).empty());
  stream.turn(true);
  stream.take(tick_of(1, 1));
  stream.turn(false);
  EXPECT_TRUE(stream.take_events(2000, true).empty());
}

TEST(TickStream, SendsEachTickUpToTwoKilohertz) {
  for (const std::size_t count : {1U, 2U, 3U, 40U, 1000U}) {
    TickStream stream;
    stream.turn(true);
    std::vector<SessionTick> sent, received;
    for (std::size_t i = 0; i < count; ++i) sent.push_back(tick_of(i, 0.1F * static_cast<float>(i), 2));
    for (const SessionTick& tick : sent) stream.take(tick);
    for (const auto& event : stream.take_events(2000, false))
      for (const SessionTick& tick : ticks_of(event)) received.push_back(tick);
    EXPECT_EQ(received, sent);
    EXPECT_TRUE(stream.take_events(2000, true).empty());
  }
}

TEST(TickStream, ALossIsAStepBetweenTwoPayloads) {
  TickStream stream;
  stream.turn(true);
  for (const std::uint64_t number : {0U, 1U, 5U, 6U, 7U}) stream.take(tick_of(number, 1));
  const auto events = stream.take_events(2000, false);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(ticks_of(events[0]).back().tick, 1U);
  EXPECT_EQ(ticks_of(events[1]).front().tick, 5U);
}

TEST(TickStream, AboveItTheExtremesAndAllFlagsOfEachCell) {
  TickStream stream;
  stream.turn(true);
  // 20 kHz: ten ticks in 0.5 ms. The command counter of the flags' upper bits stays that of the tick.
  constexpr std::uint32_t kSteered = 5U << wire::kTickSteeredShift;
  for (std::uint64_t i = 0; i < 25; ++i)
    stream.take(tick_of(i,
                        i == 3   ? 2.0F
                        : i == 7 ? -1.0F
                                 : 0.0F,
                        kSteered | (i == 5 ? wire::kTickSlewLimited : 0)));
  const auto events = stream.take_events(20'000, false);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(schema::control_number(events[0], "cell_ticks"), 10);
  const auto ticks = ticks_of(events[0]);
  ASSERT_GE(ticks.size(), 3U);
  EXPECT_EQ(ticks[0].drive_v, 2.0F);
  EXPECT_EQ(ticks[0].time_ns, 3 * 50'000);
  EXPECT_EQ(ticks[1].drive_v, -1.0F);
  EXPECT_EQ(ticks[1].encoder, 7 * 3);
  for (const SessionTick& tick : ticks)
    EXPECT_EQ(tick.flags, kSteered | (tick.time_ns < 10 * 50'000 ? wire::kTickSlewLimited : 0U))
        << tick.time_ns;
  EXPECT_LT(ticks.back().time_ns, 20 * 50'000) << "the third cell has no end yet";
  const auto rest = stream.take_events(20'000, true);
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_GE(ticks_of(rest[0]).front().time_ns, 20 * 50'000);
}

TEST(TickStream, ForcesOfThreeAxesFitIntoALine) {
  TickStream stream;
  stream.turn(true);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    SessionTick tick = tick_of(i, 0);
    tick.axes = 3;
    tick.counts = {static_cast<std::int32_t>(i), 2, 3};
    tick.force_n = {0.5F, -0.25F, static_cast<float>(i)};
    stream.take(tick);
  }
  std::size_t count = 0;
  for (const auto& event : stream.take_events(4000, true)) {
    EXPECT_EQ(schema::control_number(event, "block"), 8);
    for (const SessionTick& tick : ticks_of(event)) {
      EXPECT_EQ(tick.counts[0], static_cast<std::int32_t>(count));
      EXPECT_EQ(tick.force_n[2], static_cast<float>(count++));
    }
  }
  EXPECT_EQ(count, 1000U);
}

}  // namespace
}  // namespace tacto::playback
