// SPDX-License-Identifier: GPL-3.0-or-later
// The gadget without a kernel: its ticks, its queue, its descriptors for FunctionFS, and its intentional
// faults.
#include <gtest/gtest.h>
#include <linux/usb/functionfs.h>

#include <cstring>

#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"
#include "firmware-host/gadget/gadget.hpp"
#include "firmware-host/gadget/gadget_loop.hpp"
#include "firmware-host/gadget/usb_link.hpp"
#include "tests/firmware-host/faulty_link.hpp"

namespace tacto::firmware_host {
namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

std::uint32_t word(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST(TickPacer, KeepsTheRateHoweverItIsWoken) {
  TickPacer pacer;
  const TickPacer::Clock::time_point start{};
  pacer.start(1e-4, start);
  std::uint64_t ticks = 0;
  double slipped_s = 0;
  for (auto now = start; now <= start + seconds(10); now += microseconds(ticks % 7 == 0 ? 17300 : 730)) {
    const std::uint64_t due = pacer.due(now, slipped_s);
    EXPECT_EQ(slipped_s, 0);
    pacer.did(due);
    ticks += due;
    EXPECT_NEAR(static_cast<double>(ticks) * 1e-4, std::chrono::duration<double>(now - start).count(),
                1.1e-4);
    EXPECT_GE(pacer.next_wake(now) - now, milliseconds(1));
  }
}

TEST(TickPacer, GivesUpWhatAStallCost) {
  TickPacer pacer;
  const TickPacer::Clock::time_point start{};
  pacer.start(1e-4, start);
  double slipped_s = 0;
  EXPECT_EQ(pacer.due(start + seconds(3), slipped_s), 0U);
  EXPECT_NEAR(slipped_s, 3, 1e-9);
  EXPECT_EQ(pacer.due(start + seconds(3) + microseconds(1050), slipped_s), 10U);
  EXPECT_EQ(slipped_s, 0);
}

// 2 V at 2 kHz, falling to zero: the level at the fault, and the last tick with a drive.
TEST(DriveWatch, MeasuresTheFallToTheLastTickWithADrive) {
  constexpr double kTickS = 0.5e-3;
  DriveWatch watch;
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(watch.observe(wire::DriveState::playing, -2, kTickS));
  std::optional<DriveFall> fall;
  int ticks = 0;
  for (; !fall; ++ticks)
    fall = watch.observe(wire::DriveState::fault, ticks == 10 || ticks >= 30 ? 0 : 1, kTickS);
  EXPECT_EQ(ticks, 200);
  EXPECT_EQ(fall->from_v, 2);
  EXPECT_EQ(fall->left_v, 0);
  EXPECT_NEAR(fall->fell_s, 30 * kTickS, 1e-12);
  EXPECT_FALSE(watch.observe(wire::DriveState::fault, 0, kTickS)) << "a fault is told once";
}

// At 2 kHz, with the last message 100 ticks before the fault; later bytes do not change the result.
TEST(DriveWatch, SaysHowLongBeforeTheFaultTheHostWasHeard) {
  constexpr double kTickS = 0.5e-3;
  DriveWatch watch;
  for (int i = 0; i < 50; ++i) {
    watch.heard();
    watch.observe(wire::DriveState::playing, 2, kTickS);
  }
  for (int i = 0; i < 99; ++i) watch.observe(wire::DriveState::playing, 2, kTickS);
  std::optional<DriveFall> fall;
  for (int i = 0; !fall; ++i) {
    fall = watch.observe(wire::DriveState::fault, i < 20 ? 1 : 0, kTickS);
    watch.heard();
  }
  EXPECT_NEAR(fall->silent_s, 100 * kTickS, 1e-12);
  EXPECT_NEAR(fall->fell_s, 20 * kTickS, 1e-12);
}

TEST(DriveWatch, SeesTheDriveRiseOnceAfterAFall) {
  DriveWatch watch;
  for (int i = 0; i < 5; ++i) {
    watch.observe(wire::DriveState::playing, 2, 1e-3);
    EXPECT_FALSE(watch.rose());
  }
  for (std::optional<DriveFall> fall; !fall;) fall = watch.observe(wire::DriveState::fault, 0, 1e-3);
  EXPECT_FALSE(watch.rose());
  watch.observe(wire::DriveState::armed, 0, 1e-3);
  EXPECT_FALSE(watch.rose());
  watch.observe(wire::DriveState::playing, 0.1, 1e-3);
  EXPECT_TRUE(watch.rose());
  watch.observe(wire::DriveState::playing, 0.2, 1e-3);
  EXPECT_FALSE(watch.rose());
}

TEST(DriveWatch, SaysWhatIsLeftWhereTheDriveStays) {
  DriveWatch watch;
  std::optional<DriveFall> fall;
  while (!fall) fall = watch.observe(wire::DriveState::fault, 0.25, 1e-3);
  EXPECT_EQ(fall->left_v, 0.25);
  EXPECT_NEAR(fall->fell_s, DriveWatch::kWatchS, 1e-3);
  EXPECT_FALSE(watch.observe(wire::DriveState::idle, 0, 1e-3));
  EXPECT_FALSE(watch.observe(wire::DriveState::fault, 1, 1e-3));
  fall = watch.observe(wire::DriveState::idle, 0, 1e-3);
  ASSERT_TRUE(fall) << "disarmed before the watch is over";
  EXPECT_NEAR(fall->fell_s, 1e-3, 1e-12);
}

TEST(BurstQueue, JoinsWaitingBytes) {
  BurstQueue queue;
  queue.put(Bytes{1, 2});
  queue.put(Bytes{3});
  EXPECT_EQ(queue.waiting(), 3U);
  const Burst first = queue.take(16, milliseconds(0));
  EXPECT_EQ(first.bytes, (Bytes{1, 2, 3}));
  EXPECT_TRUE(first.last);
  queue.put(Bytes{4, 5, 6});
  const Burst second = queue.take(2, milliseconds(0));
  EXPECT_EQ(second.bytes, (Bytes{4, 5}));
  EXPECT_FALSE(second.last);
  const Burst rest = queue.take(2, milliseconds(0));
  EXPECT_EQ(rest.bytes, (Bytes{6}));
  EXPECT_TRUE(rest.last);
  queue.put(Bytes{7});
  queue.clear();
  EXPECT_TRUE(queue.take(2, milliseconds(1)).bytes.empty());
}

// As the kernel parses them: its own magic numbers, the total length, three interfaces.
TEST(FunctionFs, DescriptorsAddUp) {
  const Bytes bytes = functionfs_descriptors();
  EXPECT_EQ(word(bytes, 0), std::uint32_t{FUNCTIONFS_DESCRIPTORS_MAGIC_V2});
  EXPECT_EQ(word(bytes, 4), bytes.size());
  std::size_t at = 24, descriptors = 0;
  for (; at < bytes.size() && bytes[at] > 0; at += bytes[at]) ++descriptors;
  EXPECT_EQ(at, bytes.size());
  EXPECT_EQ(descriptors, word(bytes, 12) + word(bytes, 16) + word(bytes, 20));
  const Bytes strings = functionfs_strings("oak");
  EXPECT_EQ(word(strings, 4), strings.size());
  EXPECT_EQ(strings.back(), 0);
}

class Faults : public testing::Test, private BoardLink {
 protected:
  // The result of ten messages of samples with a pulse behind each.
  void pass(const std::string& plan) {
    const auto here = [this] { frames_before_ = frames(); };
    tests::FaultyLink link(*this, tests::parse_fault_plan(plan).value(), {here, here});
    Bytes frames;
    for (std::uint32_t i = 0; i < 10; ++i) {
      wire::Samples samples;
      samples.first_frame = i * 2;
      samples.channels = 1;
      samples.count = 2;
      add(samples, 2 * i, frames);
      add(wire::Pulse{}, 2 * i + 1, frames);
    }
    link.send(frames);
    whole_ = frames.size();
  }

  template <class Message>
  static void add(const Message& message, std::uint32_t sequence, Bytes& frames) {
    std::uint8_t frame[wire::kMaxFrame];
    const std::size_t size = wire::encode_frame(message, sequence, frame, sizeof frame);
    frames.insert(frames.end(), frame, frame + size);
  }

  // The number of frames that a host's decoder finds.
  std::size_t frames() {
    wire::FrameDecoder decoder;
    majors_.clear();
    std::size_t count = 0;
    wire::Arrival arrival = wire::Arrival::frame;
    for (std::size_t at = 0; at < sent_.size() || arrival != wire::Arrival::nothing;) {
      wire::Frame frame;
      std::size_t used = 0;
      arrival = decoder.take(sent_.data() + at, sent_.size() - at, used, frame);
      at += used;
      count += arrival == wire::Arrival::frame;
      if (arrival == wire::Arrival::frame) majors_.push_back(frame.header.major);
    }
    return count;
  }

  // A host that reads while the board waits.
  void send(std::span<const std::uint8_t> bytes) override {
    sent_.insert(sent_.end(), bytes.begin(), bytes.end());
    waiting_ += bytes.size();
    longest_ = std::max(longest_, waiting_);
  }
  std::size_t waiting() const override { return waiting_; }
  void take_received(std::vector<std::uint8_t>&) override {}
  void wait_until(Clock::time_point) override { waiting_ = 0; }

  Bytes sent_, majors_;
  std::size_t whole_ = 0, waiting_ = 0, longest_ = 0, frames_before_ = 0;
};

TEST_F(Faults, NoneUnlessAskedFor) {
  pass("");
  EXPECT_EQ(frames(), 20U);
  EXPECT_EQ(sent_.size(), whole_);
}

TEST_F(Faults, DropCorruptTruncateRepeatOnlySamples) {
  for (const auto& [plan, left] : {std::pair{"drop-every=3", 17U}, std::pair{"corrupt-every=2", 15U},
                                   std::pair{"truncate-every=5", 18U}, std::pair{"repeat-every=4", 22U}}) {
    sent_.clear();
    pass(plan);
    EXPECT_EQ(frames(), left) << plan;
  }
}

TEST_F(Faults, ClaimAnotherVersionSoundly) {
  pass("version=2.7");
  EXPECT_EQ(frames(), 20U);
  EXPECT_EQ(majors_, Bytes(20, 2));
}

TEST_F(Faults, StallUnplugAndSilenceComeInTheirPlaces) {
  pass("stall-after=4");
  EXPECT_EQ(frames_before_, 4U);
  EXPECT_EQ(frames(), 20U);
  sent_.clear();
  pass("unplug-after=7");
  EXPECT_EQ(frames_before_, 7U);
  EXPECT_EQ(frames(), 7U) << "nothing follows";
  const std::size_t unplugged = sent_.size();
  sent_.clear();
  pass("silent-after=7");
  EXPECT_GT(unplugged, sent_.size()) << "half a frame more";
  sent_.clear();
  pass("silent-after=5");
  EXPECT_EQ(frames(), 5U);
}

TEST_F(Faults, ShortPacketsHoldTheSameBytes) {
  pass("packet=13");
  EXPECT_EQ(frames(), 20U);
  EXPECT_EQ(longest_, 13U) << "each transfer waits for the one before it";
}

TEST(GadgetOptions, AreReadOrRefused) {
  const char* const good[] = {"--board", "replay:oak", "--id", "1d50:60ab"};
  const auto options = parse_gadget_options(good);
  ASSERT_TRUE(options);
  EXPECT_EQ(options->board, "replay:oak");
  EXPECT_EQ(options->vendor, 0x1d50);
  EXPECT_EQ(options->product, 0x60ab);
  for (const auto& [name, value] :
       {std::pair{"--id", "1d50"}, std::pair{"--id", "x:1"}, std::pair{"--udc", (const char*)nullptr}}) {
    const char* const bad[] = {name, value};
    EXPECT_FALSE(parse_gadget_options(std::span(bad).first(value == nullptr ? 1 : 2))) << name;
  }
}

}  // namespace
}  // namespace tacto::firmware_host
