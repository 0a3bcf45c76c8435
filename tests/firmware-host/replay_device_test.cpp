// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as a device: its codes, its gaps, its end; listing and opening of recordings.
#include "firmware-host/replay/replay_device.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "firmware-host/open_device.hpp"
#include "firmware-host/scan.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/firmware-host/sim_stream.hpp"

namespace tacto::firmware_host {
namespace {

schema::RecordingHeader header_like(const Capabilities& capabilities) {
  schema::RecordingHeader header;
  header.format = schema::SampleFormat::pcm32;
  header.sample_rate_hz = capabilities.sample_rate_hz;
  header.channels = capabilities.channels;
  header.channels[0].unit = "N";
  header.clock = "device";
  header.device = "sim:";
  header.simulated = capabilities.simulated;
  header.transducer = capabilities.transducer;
  header.gaps = {{100, 120, 20}, {300, 325, 5}};
  return header;
}

class Replay : public testing::Test {
 protected:
  void SetUp() override {
    stream_ = tests::stream_of("sim:surface=A", 0.05);
    auto writer = schema::RecordingWriter::create(name_, header_like(stream_.capabilities));
    ASSERT_TRUE(writer && writer->write(std::span<const std::int32_t>(stream_.codes)) && writer->close());
  }
  tests::TemporaryFolder folder_;
  std::string name_ = folder_ / "oak";
  tests::SimStream stream_;
};

TEST_F(Replay, GivesTheSameCodesAndGapsAndEnds) {
  const auto device = open_device("replay:" + name_);
  ASSERT_TRUE(device) << message(device.error());
  EXPECT_EQ((*device)->capabilities().simulated, stream_.capabilities.simulated);
  EXPECT_EQ((*device)->capabilities().transducer->name, "wiertlewski2011");
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE((*device)->start());
    std::vector<std::int32_t> codes, block(64 * 4);
    std::vector<schema::Gap> gaps;
    for (std::size_t frames = 1; frames > 0;) {
      frames = *(*device)->read(block);
      for (const schema::Gap& gap : (*device)->take_events().gaps) {
        EXPECT_EQ(gap.frame, codes.size() / 4) << "told before what follows it";
        gaps.push_back(gap);
      }
      codes.insert(codes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(frames * 4));
    }
    EXPECT_EQ(codes, stream_.codes);
    ASSERT_EQ(gaps.size(), 2U);
    EXPECT_EQ(gaps[1].count, 5U);
    EXPECT_EQ((*device)->counts().lost_frames, 25U);
    EXPECT_EQ((*device)->counts().frames, 500U);
  }
}

TEST_F(Replay, PacedItTakesAsLongAsItTook) {
  const auto device = open_device("replay:" + name_ + ",paced=1");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE((*device)->start());
  for (int reads = 0; reads < 3; ++reads) tests::read_frames(**device, 0.01);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(28));
}

TEST(PacedSim, TakesRealTime) {
  const auto begin = std::chrono::steady_clock::now();
  const auto device = open_device("sim:paced=1");
  ASSERT_TRUE((*device)->start());
  tests::read_frames(**device, 0.1);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(95));
}

TEST_F(Replay, WhatCannotBeReplayedIsRefused) {
  EXPECT_EQ(open_device("replay:").error().kind, schema::ErrorKind::usage);
  EXPECT_EQ(open_device("replay:" + (folder_ / "nothing")).error().kind, schema::ErrorKind::not_found);
  const auto device = open_device("replay:" + name_);
  std::vector<std::int32_t> block(4);
  EXPECT_EQ((*device)->read(block).error().what, "the device is not started");
}

TEST(Scan, EveryListedDeviceAnswers) {
  const auto found = scan_devices();
  EXPECT_EQ(found.size(), 9U);
  for (const FoundDevice& device : found) {
    ASSERT_TRUE(device.said) << device.uri;
    EXPECT_FALSE(device.said->simulated.empty());
    EXPECT_NE(device.said->surface, "");
  }
}

}  // namespace
}  // namespace tacto::firmware_host
