// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include "firmware-host/open_device.hpp"

#include "tests/firmware-host/sim_stream.hpp"

namespace tacto::firmware_host {
namespace {

using tests::stream_of;

// FNV-1a, 64 bits.
std::uint64_t fingerprint(const std::vector<std::int32_t>& codes) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const std::int32_t code : codes)
    for (int shift = 0; shift < 32; shift += 8) {
      hash ^= (static_cast<std::uint32_t>(code) >> shift) & 0xFFU;
      hash *= 0x100000001B3U;
    }
  return hash;
}

TEST(SimDevice, SaysWhatItIs) {
  const auto device = open_device("sim:surface=C,speed=50mm/s,seed=1");
  ASSERT_TRUE(device);
  const Capabilities& capabilities = (*device)->capabilities();
  EXPECT_EQ(capabilities.sample_rate_hz, 10e3);
  EXPECT_EQ(capabilities.channels.size(), 4U);
  EXPECT_EQ(capabilities.channels[0].unit, "V");
  EXPECT_EQ(capabilities.channels[0].scale, 10 / 0x1p31);
  EXPECT_EQ(capabilities.channels[0].range_min, -10.0);
  EXPECT_EQ(capabilities.channels[1].scale, 1e-6);
  EXPECT_EQ(capabilities.channels[2].native_rate_hz, 1000.0);
  EXPECT_EQ(capabilities.transducer->name, "wiertlewski2011");
  EXPECT_NE(capabilities.simulated.find("emulated device"), std::string::npos);
  EXPECT_NE(capabilities.simulated.find("seed 1"), std::string::npos);
  EXPECT_NE(capabilities.simulated.find("on C: milled"), std::string::npos) << "its samples are of that";
}

TEST(SimDevice, OtherTransportsAreRefusedByName) {
  for (const char* uri : {"serial:/dev/ttyACM0", "serial:oak", "surface=C", ""}) {
    const auto device = open_device(uri);
    ASSERT_FALSE(device) << uri;
    EXPECT_EQ(device.error().kind, schema::ErrorKind::usage);
    EXPECT_NE(device.error().remedy.find("sim:"), std::string::npos);
  }
}

TEST(SimDevice, MustBeStartedToBeRead) {
  const auto device = open_device("sim:");
  std::vector<std::int32_t> frame(4);
  EXPECT_EQ((*device)->read(frame).error().kind, schema::ErrorKind::device);
  ASSERT_TRUE((*device)->start());
  EXPECT_EQ((*device)->read(frame), 1U);
  ASSERT_TRUE((*device)->stop());
  EXPECT_FALSE((*device)->read(frame));
}

TEST(SimDevice, OnlyWholeFramesAreGiven) {
  const auto device = open_device("sim:");
  ASSERT_TRUE((*device)->start());
  std::vector<std::int32_t> codes(11, -1);
  EXPECT_EQ((*device)->read(codes), 2U);
  EXPECT_EQ(std::count(codes.begin() + 8, codes.end(), -1), 3);
  EXPECT_EQ((*device)->counts().frames, 2U);
}

TEST(SimDevice, OneSeedGivesTheSameFramesHoweverTheyAreRead) {
  const auto device = open_device("sim:surface=D,seed=3");
  ASSERT_TRUE((*device)->start());
  const auto whole = tests::read_frames(**device, 0.5);
  ASSERT_TRUE((*device)->start());
  auto parts = tests::read_frames(**device, 0.2);
  const auto rest = tests::read_frames(**device, 0.3);
  parts.insert(parts.end(), rest.begin(), rest.end());
  EXPECT_EQ(parts, whole);
  EXPECT_EQ(stream_of("sim:surface=D,seed=3", 0.5).codes, whole);
  EXPECT_NE(stream_of("sim:surface=D,seed=4", 0.5).codes, whole);
  EXPECT_NE(stream_of("sim:surface=D,seed=3,person=2", 0.5).codes, whole);
}

// Stored fingerprints: any compiler, optimisation or processor must give these frames. They change only with
// the physics.
TEST(SimDevice, FramesAreTheSameOnEveryMachine) {
  EXPECT_EQ(fingerprint(stream_of("sim:surface=A,seed=1", 0.5).codes), 6790481903509420105U);
  EXPECT_EQ(fingerprint(stream_of("sim:surface=sine,seed=2,speed=80mm/s", 0.5).codes), 12137953936224948991U);
}

TEST(SimDevice, WhatDivergesIsAnErrorWithItsTime) {
  const auto device = open_device("sim:surface=A,friction=2,static_ratio=3,load=3N");
  ASSERT_TRUE((*device)->start());
  std::vector<std::int32_t> codes(40000);
  auto read = (*device)->read(codes);
  ASSERT_TRUE(read) << "what came before is given first";
  EXPECT_LT(*read, codes.size() / 4);
  read = (*device)->read(codes);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, schema::ErrorKind::device);
  EXPECT_NE(read.error().what.find(" 0."), std::string::npos) << read.error().what;
}

TEST(SimDevice, ATransducerThatDivergesAtRestIsNamed) {
  const auto device = open_device("sim:transducer=wiertlewski2011-as-printed");
  ASSERT_TRUE((*device)->start());
  std::vector<std::int32_t> codes(40000);
  auto read = (*device)->read(codes);
  if (read) read = (*device)->read(codes);
  ASSERT_FALSE(read);
  const std::string said = message(read.error());
  EXPECT_NE(said.find((*device)->capabilities().transducer->name), std::string::npos) << said;
  EXPECT_NE(said.find("another transducer"), std::string::npos) << said;
}

TEST(SimDevice, RatesFromOneToTwoHundredKilohertz) {
  for (const char* uri : {"sim:rate=1kHz", "sim:rate=9.7kHz", "sim:rate=200kHz"}) {
    const auto stream = stream_of(uri, 0.4);
    const auto position_m = stream.channel(tests::kPosition);
    EXPECT_NEAR(position_m.back() - position_m.front(), 12.5e-3, 2.5e-3)
        << uri;  // 0.3 s without the ramp, with speed variation
  }
}

}  // namespace
}  // namespace tacto::firmware_host
