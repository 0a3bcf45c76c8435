// SPDX-License-Identifier: GPL-3.0-or-later
// Host client, wire, firmware core and physics together, over a good cable and over faulty ones. Every fault
// ends in the stated gap or error: never a hang, a crash or an unreported loss.
#include "firmware-host/link/wire_device.hpp"

#include <gtest/gtest.h>

#include "firmware-host/sim/device/sim_device.hpp"
#include "firmware-host/sim/device/sim_transport.hpp"
#include "tests/firmware-host/faulty_transport.hpp"
#include "tests/firmware-host/sim_stream.hpp"

namespace tacto::firmware_host {
namespace {

using tests::FaultyTransport;
using tests::Harm;
using wire::MessageType;

constexpr const char* kParameters = "surface=sine,seed=3";
constexpr std::size_t kChannels = 4;

struct Bench {
  std::unique_ptr<SimBoard> board;
  schema::Result<std::unique_ptr<WireDevice>> device;
};

Bench bench_with(FaultyTransport::Choice choice) {
  const auto parameters = parse_sim_parameters(kParameters);
  auto board = std::make_unique<SimBoard>(*parameters, *schema::read_transducer("wiertlewski2011"),
                                          *make_surface(parameters->surface));
  auto transport = std::make_unique<FaultyTransport>(std::make_unique<SimTransport>(*board, false), choice);
  auto device = WireDevice::open("test:", std::move(transport));
  return {std::move(board), std::move(device)};
}

// Damages the n-th frame of a type.
FaultyTransport::Choice harm_the(int n, MessageType type, Harm harm) {
  return [=, count = 0](MessageType of) mutable { return of == type && ++count == n ? harm : Harm::none; };
}

FaultyTransport::Choice harm_all(MessageType type, Harm harm) {
  return [=](MessageType of) { return of == type ? harm : Harm::none; };
}

struct Streamed {
  std::vector<std::int32_t> codes;
  StreamEvents events;
  std::optional<schema::Error> error;
};

void append(StreamEvents& all, const StreamEvents& more) {
  all.gaps.insert(all.gaps.end(), more.gaps.begin(), more.gaps.end());
  all.faults.insert(all.faults.end(), more.faults.begin(), more.faults.end());
  all.clock_pairs.insert(all.clock_pairs.end(), more.clock_pairs.begin(), more.clock_pairs.end());
}

// Reads until this number of frames has arrived, or an error.
Streamed stream_from(Device& device, std::size_t frames) {
  Streamed streamed;
  if (const auto started = device.start(); !started) streamed.error = started.error();
  std::vector<std::int32_t> block(777 * kChannels);
  while (!streamed.error && streamed.codes.size() < frames * kChannels) {
    const auto read = device.read(block);
    append(streamed.events, device.take_events());
    if (!read) streamed.error = read.error();
    if (read) streamed.codes.insert(streamed.codes.end(), block.begin(), block.begin() + *read * kChannels);
  }
  return streamed;
}

const std::vector<std::int32_t>& truth() {
  static const auto kCodes = tests::stream_of(std::string("sim:") + kParameters, 1.5).codes;
  return kCodes;
}

// Every frame equals the device's frame with its number, as the gaps give it.
void expect_no_silent_hole(const Streamed& streamed) {
  std::size_t next_gap = 0, missing = 0;
  for (std::size_t i = 0; i < streamed.codes.size() / kChannels; ++i) {
    const auto& gaps = streamed.events.gaps;
    for (; next_gap < gaps.size() && gaps[next_gap].frame == i; ++next_gap) {
      missing += gaps[next_gap].count;
      ASSERT_EQ(gaps[next_gap].device_sequence, i + missing);
    }
    for (std::size_t k = 0; k < kChannels; ++k)
      ASSERT_EQ(streamed.codes[i * kChannels + k], truth()[(i + missing) * kChannels + k]) << "frame " << i;
  }
}

TEST(WireDevice, ASoundCableGivesEveryFrame) {
  Bench bench = bench_with([](MessageType) { return Harm::none; });
  ASSERT_TRUE(bench.device) << message(bench.device.error());
  const Streamed streamed = stream_from(**bench.device, 10000);
  EXPECT_FALSE(streamed.error);
  EXPECT_TRUE(streamed.events.gaps.empty());
  EXPECT_TRUE(streamed.events.faults.empty());
  expect_no_silent_hole(streamed);
  EXPECT_TRUE((*bench.device)->stop());
  const LinkCounts counts = (*bench.device)->client().counts();
  EXPECT_EQ(counts.lost + counts.stale + counts.frames.dropped_bytes, 0U);
}

TEST(WireDevice, ClocksComeInPairsEachSecond) {
  Bench bench = bench_with([](MessageType) { return Harm::none; });
  const auto pairs = stream_from(**bench.device, 10500).events.clock_pairs;
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_NEAR(pairs[1].device_s - pairs[0].device_s, 1, 0.09);
  EXPECT_NEAR(static_cast<double>(pairs[1].device_sequence - pairs[0].device_sequence) * 1e-4,
              pairs[1].device_s - pairs[0].device_s, 1e-9);
}

struct LostBlock {
  const char* name;
  Harm harm;
};
class OneBlockHarmed : public testing::TestWithParam<LostBlock> {};

TEST_P(OneBlockHarmed, IsAGapOfThatBlock) {
  Bench bench = bench_with(harm_the(100, MessageType::samples, GetParam().harm));
  const Streamed streamed = stream_from(**bench.device, 10000);
  EXPECT_FALSE(streamed.error);
  ASSERT_EQ(streamed.events.gaps.size(), 1U);
  EXPECT_EQ(streamed.events.gaps[0].frame, 99 * 32U);
  EXPECT_EQ(streamed.events.gaps[0].count, 32U);
  EXPECT_EQ(streamed.events.gaps[0].device_sequence, 100 * 32U);
  EXPECT_EQ((*bench.device)->counts().lost_frames, 32U);
  expect_no_silent_hole(streamed);
}

INSTANTIATE_TEST_SUITE_P(Harms, OneBlockHarmed,
                         testing::Values(LostBlock{"dropped", Harm::drop},
                                         LostBlock{"corrupt", Harm::corrupt},
                                         LostBlock{"truncated", Harm::truncate},
                                         LostBlock{"delayed", Harm::delay}),
                         [](const auto& harm) { return harm.param.name; });

TEST(WireDevice, ASingleLostFrameIsAGap) {
  Bench bench = bench_with(harm_the(100, MessageType::samples, Harm::shorten));
  const Streamed streamed = stream_from(**bench.device, 10000);
  EXPECT_FALSE(streamed.error);
  ASSERT_EQ(streamed.events.gaps.size(), 1U);
  EXPECT_EQ(streamed.events.gaps[0].frame, 100 * 32 - 1U);
  EXPECT_EQ(streamed.events.gaps[0].count, 1U);
  EXPECT_EQ(streamed.events.gaps[0].device_sequence, 100 * 32U);
  EXPECT_EQ((*bench.device)->counts().lost_frames, 1U);
  expect_no_silent_hole(streamed);
}

TEST(WireDevice, DoubledFramesAndGarbageDoNoHarm) {
  for (const Harm harm : {Harm::duplicate, Harm::garbage_before}) {
    Bench bench = bench_with(harm_all(MessageType::samples, harm));
    const Streamed streamed = stream_from(**bench.device, 5000);
    EXPECT_FALSE(streamed.error);
    EXPECT_TRUE(streamed.events.gaps.empty());
    expect_no_silent_hole(streamed);
  }
}

TEST(WireDevice, RandomHarmToEverythingLeavesNoSilentHole) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    Bench bench = bench_with(
        [&](MessageType) { return random() % 20 == 0 ? static_cast<Harm>(1 + random() % 6) : Harm::none; });
    if (!bench.device) {
      EXPECT_EQ(bench.device.error().kind, schema::ErrorKind::device);
      continue;
    }
    const Streamed streamed = stream_from(**bench.device, 8000);
    EXPECT_TRUE(!streamed.error || streamed.error->kind == schema::ErrorKind::device);
    expect_no_silent_hole(streamed);
    EXPECT_GT(streamed.events.gaps.size(), 0U) << seed;
  }
}

TEST(WireDevice, WhatWasLostOfAConversationIsAskedAgain) {
  for (const auto type : {MessageType::welcome, MessageType::channel, MessageType::note, MessageType::answer})
    for (const Harm harm : {Harm::drop, Harm::corrupt, Harm::truncate, Harm::duplicate}) {
      Bench bench = bench_with(harm_the(1, type, harm));
      ASSERT_TRUE(bench.device) << message(bench.device.error());
      const Streamed streamed = stream_from(**bench.device, 1000);
      ASSERT_FALSE(streamed.error) << message(*streamed.error);
      expect_no_silent_hole(streamed);
      EXPECT_TRUE((*bench.device)->stop());
    }
}

// A program was killed in the middle of a frame, so its device waits for the frame's end.
TEST(WireDevice, HalfAFrameOfAnEarlierProgramIsFlushed) {
  const auto parameters = parse_sim_parameters(kParameters);
  SimBoard board(*parameters, *schema::read_transducer("wiertlewski2011"),
                 *make_surface(parameters->surface));
  wire::Drive drive;
  drive.count = wire::kMaxChunk;
  std::uint8_t frame[wire::kMaxFrame];
  const std::size_t size = wire::encode_frame(drive, 7, frame, sizeof frame);
  for (const std::size_t left : {size_t{1}, size_t{13}, size / 2, size - 1}) {
    board.from_host().assign(frame, frame + left);
    const auto device = WireDevice::open("test:", std::make_unique<SimTransport>(board, false));
    ASSERT_TRUE(device) << left << " bytes of " << size << ": " << message(device.error());
  }
}

// A serial line in emulated time: each byte takes ten bits.
class SlowSerialLine final : public Transport {
 public:
  SlowSerialLine(std::unique_ptr<Transport> inner, double baud) : inner_(std::move(inner)), baud_(baud) {}
  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    const double until_s = now_s() + timeout_s;
    do {
      std::array<std::uint8_t, 4096> fresh;
      const std::vector<std::uint8_t> arrived = arrived_by_now(to_device_, fresh.size());
      if (!arrived.empty()) TACTO_TRY(inner_->write(arrived, 0));
      const auto came = inner_->read(fresh, kStepS);
      TACTO_TRY(came);
      begin(to_host_, std::span(fresh).first(*came));
      const std::vector<std::uint8_t> received = arrived_by_now(to_host_, bytes.size());
      std::ranges::copy(received, bytes.begin());
      if (!received.empty()) return received.size();
    } while (now_s() < until_s);
    return std::size_t{0};
  }
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double) override {
    begin(to_device_, bytes);
    return {};
  }
  double now_s() override { return inner_->now_s(); }
  double baud() const override { return baud_; }

 private:
  static constexpr double kStepS = 1e-3;
  struct Way {
    std::deque<std::pair<double, std::uint8_t>> bytes;  // with the time of arrival
    double free_s = 0;
  };
  void begin(Way& way, std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      way.free_s = std::max(way.free_s, now_s()) + 10 / baud_;
      way.bytes.emplace_back(way.free_s, byte);
    }
  }
  std::vector<std::uint8_t> arrived_by_now(Way& way, std::size_t most) {
    std::vector<std::uint8_t> bytes;
    for (; bytes.size() < most && !way.bytes.empty() && way.bytes.front().first <= now_s();
         way.bytes.pop_front())
      bytes.push_back(way.bytes.front().second);
    return bytes;
  }
  std::unique_ptr<Transport> inner_;
  double baud_;
  Way to_device_, to_host_;
};

// The slowest line that is allowed: the zeros take 0.37 s, and the description of this board 0.42 s, twice if
// the first hello is found in the half frame.
TEST(WireDevice, HalfAFrameIsFlushedOverTheSlowestLine) {
  const auto parameters = parse_sim_parameters(kParameters);
  SimBoard board(*parameters, *schema::read_transducer("wiertlewski2011"),
                 *make_surface(parameters->surface));
  wire::Drive drive;
  drive.count = wire::kMaxChunk;
  std::uint8_t frame[wire::kMaxFrame];
  const std::size_t size = wire::encode_frame(drive, 7, frame, sizeof frame);
  board.from_host().assign(frame, frame + size / 2);
  const auto device = WireDevice::open(
      "test:", std::make_unique<SlowSerialLine>(std::make_unique<SimTransport>(board, false), 57'600));
  ASSERT_TRUE(device) << message(device.error());
}

// If the stream is read in pieces, a known gap counts as a loss only after it is reached.
TEST(WireDevice, LossesAreCountedWhenTheirGapIsTold) {
  Bench bench = bench_with(harm_the(10, MessageType::samples, Harm::drop));
  ASSERT_TRUE((*bench.device)->start());
  std::vector<std::int32_t> piece(7 * kChannels);
  std::uint64_t told = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE((*bench.device)->read(piece));
    for (const schema::Gap& gap : (*bench.device)->take_events().gaps) told += gap.count;
    ASSERT_EQ((*bench.device)->counts().lost_frames, told) << "read " << i;
  }
  EXPECT_EQ(told, 32U);
}

TEST(WireDevice, WhatCameDamagedOrNotIsCounted) {
  Bench bench = bench_with(harm_the(1, MessageType::samples, Harm::corrupt));
  (void)stream_from(**bench.device, 3000);
  EXPECT_EQ((*bench.device)->counts().missing_messages, 1U);
  EXPECT_EQ((*bench.device)->counts().damaged_messages, 1U);
  Bench dropping = bench_with(harm_the(20, MessageType::samples, Harm::drop));
  (void)stream_from(**dropping.device, 3000);
  EXPECT_EQ((*dropping.device)->counts().missing_messages, 1U);
  EXPECT_EQ((*dropping.device)->counts().damaged_messages, 0U);
}

TEST(WireDevice, ADeviceThatNeverAnswersIsAnError) {
  for (const auto type : {MessageType::welcome, MessageType::channel}) {
    Bench bench = bench_with(harm_all(type, Harm::drop));
    ASSERT_FALSE(bench.device);
    EXPECT_EQ(bench.device.error().kind, schema::ErrorKind::device);
    EXPECT_NE(bench.device.error().what.find("1.5 s"), std::string::npos) << message(bench.device.error());
  }
  Bench bench = bench_with(harm_all(MessageType::answer, Harm::drop));
  const auto started = (*bench.device)->start();
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().what.find("stream_start"), std::string::npos);
}

// A bus that transfers two thirds of what a device sends: the rest waits in the device, and all later answers
// behind it.
class SlowBus final : public Transport {
 public:
  explicit SlowBus(std::unique_ptr<Transport> inner) : inner_(std::move(inner)) {}
  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    std::array<std::uint8_t, 4096> fresh;
    const auto came = inner_->read(fresh, waiting_.empty() ? timeout_s : kReadS);
    if (!came) return came;
    waiting_.insert(waiting_.end(), fresh.begin(), fresh.begin() + static_cast<std::ptrdiff_t>(*came));
    const std::size_t size =
        std::min({bytes.size(), waiting_.size(), *came > 0 ? *came * 2 / 3 + 1 : kIdleBytes});
    std::copy_n(waiting_.begin(), size, bytes.begin());
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override {
    return inner_->write(bytes, timeout_s);
  }
  double now_s() override { return inner_->now_s(); }

 private:
  static constexpr double kReadS = 4e-3;
  static constexpr std::size_t kIdleBytes = 300;
  std::unique_ptr<Transport> inner_;
  std::deque<std::uint8_t> waiting_;
};

TEST(WireDevice, AnAnswerBehindSecondsOfFramesIsWaitedFor) {
  const auto parameters = parse_sim_parameters(kParameters);
  SimBoard board(*parameters, *schema::read_transducer("wiertlewski2011"),
                 *make_surface(parameters->surface));
  auto bus = std::make_unique<SlowBus>(std::make_unique<SimTransport>(board, false));
  Transport& clock = *bus;
  const auto device = WireDevice::open("test:", std::move(bus));
  ASSERT_TRUE(device) << message(device.error());
  const Streamed streamed = stream_from(**device, 40000);
  EXPECT_FALSE(streamed.error);
  EXPECT_TRUE(streamed.events.gaps.empty());
  const double asked_s = clock.now_s();
  const auto stopped = (*device)->stop();
  EXPECT_TRUE(stopped) << message(stopped.error());
  EXPECT_GT(clock.now_s() - asked_s, 1.5) << "longer than a silent device is waited for";
}

TEST(WireDevice, AStreamThatStallsIsAnErrorAfterItsFrames) {
  int blocks = 0;
  Bench bench = bench_with([&](MessageType type) {
    return type == MessageType::samples && ++blocks > 50 ? Harm::drop : Harm::none;
  });
  const Streamed streamed = stream_from(**bench.device, 10000);
  EXPECT_EQ(streamed.codes.size(), 50 * 32 * kChannels);
  ASSERT_TRUE(streamed.error);
  EXPECT_NE(streamed.error->what.find(" 1 s"), std::string::npos);
  expect_no_silent_hole(streamed);
}

TEST(WireDevice, UnpluggedItGivesItsFramesAndThenTheReason) {
  Bench bench = bench_with(harm_the(60, MessageType::samples, Harm::unplug));
  const Streamed streamed = stream_from(**bench.device, 10000);
  EXPECT_EQ(streamed.codes.size(), 59 * 32 * kChannels);
  ASSERT_TRUE(streamed.error);
  EXPECT_EQ(streamed.error->what, "the device was unplugged");
  expect_no_silent_hole(streamed);
  EXPECT_FALSE((*bench.device)->stop());
}

// A device of any version that implements only the welcome.
class OtherVersion final : public Transport {
 public:
  explicit OtherVersion(std::uint8_t major) : major_(major) {}
  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    now_s_ += timeout_s;
    std::copy(reply_.begin(), reply_.end(), bytes.begin());
    return std::exchange(reply_, {}).size();
  }
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double) override {
    wire::Hello hello;
    wire::parse(bytes.data() + wire::kHeaderSize, bytes.size() - wire::kHeaderSize, hello);
    std::uint8_t frame[wire::kMaxFrame];
    wire::FieldWriter writer(frame + wire::kHeaderSize, wire::kMaxPayload);
    const char name[32] = "far future", serial[32] = "X9", firmware[24] = "9.0";
    writer(major_, std::uint8_t{4}, std::uint16_t{0}, hello.nonce, name, serial, firmware);
    const wire::FrameHeader header{major_, static_cast<std::uint8_t>(MessageType::welcome),
                                   static_cast<std::uint16_t>(writer.size()), 0};
    reply_.assign(frame, frame + wire::seal_frame(header, frame));
    return {};
  }
  double now_s() override { return now_s_; }

 private:
  std::uint8_t major_;
  std::vector<std::uint8_t> reply_;
  double now_s_ = 0;
};

TEST(WireDevice, ANewerVersionIsRefusedByName) {
  const auto device = WireDevice::open("test:", std::make_unique<OtherVersion>(std::uint8_t{2}));
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, schema::ErrorKind::unsupported_version);
  EXPECT_NE(device.error().what.find(" 2.4"), std::string::npos) << message(device.error());
  EXPECT_EQ(device.error().remedy, "update tactograph");
}

TEST(WireDevice, ADeviceThatWelcomesWithNoVersionIsNoDevice) {
  const auto device = WireDevice::open("test:", std::make_unique<OtherVersion>(std::uint8_t{0}));
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, schema::ErrorKind::device);
}

}  // namespace
}  // namespace tacto::firmware_host
