// SPDX-License-Identifier: GPL-3.0-or-later
// Frames contain their own number, so that lost and doubled frames are detected.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include "firmware-host/open_device.hpp"

#include "tests/firmware-host/sim_stream.hpp"

namespace tacto::firmware_host {
namespace {

void expect_counted(const std::vector<std::int32_t>& codes, std::size_t channels, std::uint64_t first) {
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const auto target = static_cast<std::uint32_t>(16 * (first + i / channels) + i % channels);
    ASSERT_EQ(static_cast<std::uint32_t>(codes[i]), target) << i;
  }
}

TEST(CounterStream, EveryFrameOfEveryWidthAndRateComes) {
  for (const std::size_t channels : {1, 8, 16})
    for (const char* rate : {"1kHz", "100kHz", "200kHz"}) {
      const auto stream =
          tests::stream_of("sim:source=counter,channels=" + std::to_string(channels) + ",rate=" + rate, 0.3);
      ASSERT_EQ(stream.capabilities.channels.size(), channels);
      EXPECT_EQ(stream.capabilities.channels.back().unit, "1");
      EXPECT_FALSE(stream.capabilities.transducer);
      EXPECT_NE(stream.capabilities.simulated.find("contain their numbers"), std::string::npos);
      expect_counted(stream.codes, channels, 0);
    }
}

// The link holds 20 ms, the ring 2.56 ms; nothing is read for 300 ms or more.
TEST(CounterStream, AReaderThatStaysAwayLosesFramesAndIsToldWhich) {
  const auto device = open_device("sim:source=counter,channels=8,rate=100kHz,paced=1,link_buffer=20ms");
  ASSERT_TRUE(device);
  ASSERT_TRUE((*device)->start());
  std::vector<std::int32_t> codes(std::size_t{8} * 1000);
  std::uint64_t next = 0, lost = 0;
  for (int block = 0; block < 40; ++block) {
    if (block == 1) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto frames = (*device)->read(codes);
    ASSERT_TRUE(frames);
    for (const schema::Gap& gap : (*device)->take_events().gaps) {
      next += gap.count;
      EXPECT_EQ(gap.device_sequence, next) << "of the first frame after the gap";
      lost += gap.count;
    }
    expect_counted({codes.begin(), codes.begin() + static_cast<std::ptrdiff_t>(*frames * 8)}, 8, next);
    next += *frames;
  }
  EXPECT_GE(lost, 27000U) << "300 ms less what link and ring hold";
  EXPECT_EQ((*device)->counts().lost_frames, lost);
}

TEST(CounterStream, WithoutALinksLimitEmulatedTimeWaitsForTheReader) {
  const auto device = open_device("sim:source=counter,channels=2,rate=10kHz,paced=1");
  ASSERT_TRUE(device);
  ASSERT_TRUE((*device)->start());
  const auto before = tests::read_frames(**device, 0.02);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  expect_counted(tests::read_frames(**device, 0.02), 2, 200);
  EXPECT_EQ((*device)->counts().lost_frames, 0U);
  EXPECT_EQ(before.size(), 400U);
}

}  // namespace
}  // namespace tacto::firmware_host
