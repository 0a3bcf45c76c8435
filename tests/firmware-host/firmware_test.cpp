// SPDX-License-Identifier: GPL-3.0-or-later
// The device's protocol: its description, its stream, its refusals and their reasons.
#include <gtest/gtest.h>

#include "tests/firmware-host/firmware_bench.hpp"

namespace tacto::core {
namespace {

using tests::FirmwareBench;
using tests::kTenKilohertz;
using wire::AnswerCode;
using wire::DriveState;
using wire::FaultCode;

TEST(Firmware, SaysWhatItIs) {
  FirmwareBench bench;
  bench.send(wire::Hello{1, 0, 0, 99});
  ASSERT_EQ(bench.welcomes.size(), 2U);
  const wire::Welcome& welcome = bench.welcomes[1];
  EXPECT_EQ(welcome.nonce, 99U);
  EXPECT_STREQ(welcome.name, "test board");
  EXPECT_EQ(welcome.channels, 2);
  EXPECT_EQ(welcome.ring_records, kRingRecords);
  EXPECT_EQ(welcome.profile_samples, 4096U);
  EXPECT_EQ(bench.channels.size(), 4U);
  EXPECT_EQ(bench.notes.size(), 2U);
  EXPECT_EQ(bench.channels[3].index, 1);
}

TEST(Firmware, NothingIsSaidUnasked) {
  tests::TestBoard board;
  Firmware firmware(board.about(), board.hal());
  firmware.poll();
  EXPECT_TRUE(board.to_host.empty());
  EXPECT_EQ(board.rate_millihertz, 0U);
}

TEST(Firmware, BeforeHelloCommandsAreRefused) {
  tests::TestBoard board;
  Firmware firmware(board.about(), board.hal());
  board.from_host = tests::framed(wire::Play{}, 0);
  firmware.poll();
  wire::Answer answer;
  ASSERT_EQ(wire::parse(board.to_host.data() + wire::kHeaderSize, 12, answer), wire::Parse::ok);
  EXPECT_EQ(answer.code, AnswerCode::wrong_state);
  EXPECT_EQ(answer.detail, 255U);
}

TEST(Firmware, AHostOfAnotherMajorIsToldWhatItSpeaksAndRefused) {
  FirmwareBench bench;
  bench.send(wire::Hello{2, 0, 0, 5});
  EXPECT_EQ(bench.welcomes.back().major, 1);
  EXPECT_EQ(bench.code(wire::Play{}), AnswerCode::wrong_state);
  bench.greet();
  std::uint8_t frame[wire::kMaxFrame];
  const std::size_t size = wire::seal_frame({2, 0x0C, 0, bench.sequence_++}, frame);
  bench.board.from_host.insert(bench.board.from_host.end(), frame, frame + size);
  bench.answers.clear();
  bench.poll();
  ASSERT_EQ(bench.answers.size(), 1U);
  EXPECT_EQ(bench.answers[0].code, AnswerCode::wrong_version);
  EXPECT_EQ(bench.answers[0].detail, 1U);
}

TEST(Firmware, StreamsEveryFrameInBlocks) {
  FirmwareBench bench;
  ASSERT_EQ(bench.code(wire::StreamStart{kTenKilohertz, 32}), AnswerCode::ok);
  EXPECT_EQ(bench.board.rate_millihertz, kTenKilohertz);
  for (int i = 0; i < 1000; ++i) {
    bench.board.encoder = i;
    bench.board.enabled = i != 40;
    bench.run(1, false);
  }
  ASSERT_EQ(bench.code(wire::StreamStop{}), AnswerCode::ok);
  ASSERT_EQ(bench.samples.size(), 32U);
  EXPECT_EQ(bench.samples.back().count, 1000 - 31 * 32);
  for (std::size_t i = 0; i < 1000; ++i) {
    const wire::Samples& block = bench.samples[i / 32];
    ASSERT_EQ(block.first_frame, i / 32 * 32);
    ASSERT_EQ(block.codes[i % 32 * 2 + 1], static_cast<std::int32_t>(i));
    ASSERT_EQ((block.enabled >> (i % 32)) & 1, i == 40 ? 0U : 1U);
  }
  EXPECT_EQ(bench.samples[1].device_ticks - bench.samples[0].device_ticks,
            32 * (tests::kTestClockHz / 10000));
  bench.poll();
  EXPECT_EQ(bench.board.rate_millihertz, 0U) << "what is not used does not tick";
}

TEST(Firmware, TheAnswerToStopComesAfterTheLastFrame) {
  FirmwareBench bench;
  bench.code(wire::StreamStart{kTenKilohertz, 32});
  for (int i = 0; i < 10; ++i) bench.firmware->tick();
  bench.order.clear();
  bench.send(wire::StreamStop{});
  EXPECT_EQ(bench.order, (std::vector{wire::MessageType::samples, wire::MessageType::answer}));
}

TEST(Firmware, StartedAgainItBeginsAtZeroWithNothingOfBefore) {
  FirmwareBench bench;
  bench.code(wire::StreamStart{kTenKilohertz, 8});
  bench.run(13, false);
  for (int i = 0; i < 5; ++i) bench.firmware->tick();
  bench.code(wire::StreamStart{kTenKilohertz, 8});
  bench.samples.clear();
  bench.run(16, false);
  ASSERT_EQ(bench.samples.size(), 2U);
  EXPECT_EQ(bench.samples[0].first_frame, 0U);
  EXPECT_EQ(bench.board.rates_set, 2U) << "the converters began anew";
}

TEST(Firmware, WhatTheLinkDoesNotTakeIsAGapAndAFault) {
  FirmwareBench bench;
  bench.code(wire::StreamStart{kTenKilohertz, 32});
  bench.board.link_room = 0;
  bench.run(1000, false);
  bench.board.link_room = std::numeric_limits<std::size_t>::max();
  bench.run(100, false);
  std::uint64_t next = 0, missing = 0;
  for (const wire::Samples& block : bench.samples) {
    missing += block.first_frame - next;
    next = block.first_frame + block.count;
  }
  EXPECT_GT(missing, 600U);
  EXPECT_EQ(bench.pulse().lost_records, missing);
  ASSERT_EQ(bench.faults.size(), 1U);
  EXPECT_EQ(bench.faults[0].code, FaultCode::ring_full);
}

TEST(Firmware, AConverterThatFailsEndsTheStreamAfterItsFrames) {
  FirmwareBench bench;
  bench.code(wire::StreamStart{kTenKilohertz, 32});
  bench.run(40, false);
  bench.board.converter_works = false;
  bench.run(5, false);
  ASSERT_EQ(bench.samples.size(), 2U);
  EXPECT_EQ(bench.samples[1].count, 8);
  ASSERT_EQ(bench.faults.size(), 1U);
  EXPECT_EQ(bench.faults[0].code, FaultCode::converter);
  EXPECT_EQ(bench.order.back(), wire::MessageType::fault);
}

TEST(Firmware, RefusesWithTheReason) {
  FirmwareBench bench;
  EXPECT_EQ(bench.code(wire::StreamStart{999'999, 32}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::StreamStart{20'000'001, 32}), AnswerCode::bad_value);
  EXPECT_EQ(bench.command(wire::StreamStart{kTenKilohertz, 33}).detail, 1U);
  EXPECT_EQ(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}), AnswerCode::no_limits);
  EXPECT_EQ(bench.code(wire::Play{}), AnswerCode::wrong_state);
  EXPECT_EQ(bench.code(wire::Gain{std::numeric_limits<float>::infinity()}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::Sweep{6, 1, 2, 1}), AnswerCode::bad_value);
  bench.expect_ok(bench.code(tests::kTestLimits));
  EXPECT_EQ(bench.code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}), AnswerCode::incomplete);
  EXPECT_EQ(bench.code(wire::Arm{wire::DriveSource::sweep, kTenKilohertz}), AnswerCode::incomplete);
  EXPECT_EQ(bench.code(wire::Arm{static_cast<wire::DriveSource>(3), kTenKilohertz}), AnswerCode::bad_value);
  bench.board.enabled = false;
  EXPECT_EQ(bench.code(wire::Arm{wire::DriveSource::host, kTenKilohertz}), AnswerCode::enable_open);
}

TEST(Firmware, LimitsAreNeverWiderThanItsOwn) {
  FirmwareBench bench;
  const auto field_refused = [&](wire::Limits limits) {
    const wire::Answer answer = bench.command(limits);
    return answer.code == AnswerCode::bad_value ? static_cast<int>(answer.detail) : -1;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float drive_v : {5.001F, 0.0F, -1.0F, nan})
    EXPECT_EQ(field_refused({drive_v, 15708, 0, 0, 50, 1}), 0);
  for (const float slew : {15709.0F, 0.0F, nan}) EXPECT_EQ(field_refused({5, slew, 0, 0, 50, 1}), 1);
  for (const float onset : {-0.1F, 11.0F, nan}) EXPECT_EQ(field_refused({5, 15708, onset, 0, 50, 1}), 2);
  for (const float release : {-0.1F, 0.0178F, nan})
    EXPECT_EQ(field_refused({5, 15708, 0, release, 50, 1}), 3);
  for (const std::uint16_t ms : {std::uint16_t{9}, std::uint16_t{1001}})
    EXPECT_EQ(field_refused({5, 15708, 0, 0, ms, 1}), 4);
  EXPECT_EQ(field_refused({5, 15708, 0, 0, 50, 0}), 5);
  EXPECT_EQ(field_refused({5, 15708, 0, 0.0176F, 50, 1}), -1);
}

TEST(Firmware, UnknownTypesAndShortPayloadsAreAnswered) {
  FirmwareBench bench;
  const auto answer_to = [&](std::uint8_t type, std::uint16_t length) {
    std::uint8_t frame[wire::kMaxFrame] = {};
    const std::size_t size = wire::seal_frame({1, type, length, bench.sequence_++}, frame);
    bench.board.from_host.insert(bench.board.from_host.end(), frame, frame + size);
    bench.answers.clear();
    bench.poll();
    return bench.answers.at(0);
  };
  EXPECT_EQ(answer_to(0x7E, 0).code, AnswerCode::unknown_type);
  EXPECT_EQ(answer_to(0x7E, 0).detail, 0x7EU);
  for (const int type : {0x02, 0x04, 0x05, 0x06, 0x07, 0x08, 0x09, 0x0A, 0x0B, 0x0F, 0x10})
    EXPECT_EQ(answer_to(static_cast<std::uint8_t>(type), 0).code, AnswerCode::bad_payload) << type;
}

TEST(Firmware, ARepeatedFrameIsNotObeyedTwice) {
  FirmwareBench bench;
  const auto frame = tests::framed(wire::Heartbeat{1}, bench.sequence_++);
  for (int i = 0; i < 2; ++i)
    bench.board.from_host.insert(bench.board.from_host.end(), frame.begin(), frame.end());
  bench.poll();
  EXPECT_EQ(bench.pulses.size(), 1U);
}

TEST(Firmware, CountsWhatTheHostSentDamagedOrNotAtAll) {
  FirmwareBench bench;
  auto frame = tests::framed(wire::Heartbeat{1}, bench.sequence_++);
  frame[13] ^= 1;
  bench.board.from_host.insert(bench.board.from_host.end(), frame.begin(), frame.end());
  bench.poll();
  const wire::Pulse pulse = bench.pulse();
  EXPECT_EQ(pulse.damaged_frames, 1U);
  EXPECT_EQ(pulse.missing_frames, 1U);
  EXPECT_EQ(pulse.token, 7U);
}

TEST(ProfileUpload, TakesChunksInOrderAndChecksThem) {
  FirmwareBench bench;
  wire::ProfileChunk chunk{};
  chunk.count = 10;
  EXPECT_EQ(bench.command(wire::ProfileBegin{4097, 0, 0, 1, wire::ProfileEnds::stop}).detail, 4096U);
  EXPECT_EQ(bench.code(wire::ProfileBegin{5, 0, 0, 1, wire::ProfileEnds::stop}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::ProfileBegin{20, 0, 0, 0, wire::ProfileEnds::stop}), AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::ProfileBegin{20, 0, 0, 1, static_cast<wire::ProfileEnds>(3)}),
            AnswerCode::bad_value);
  EXPECT_EQ(bench.code(wire::ProfileEnd{0}), AnswerCode::incomplete);
  EXPECT_EQ(bench.code(chunk), AnswerCode::incomplete) << "nothing has begun";
  bench.expect_ok(bench.code(wire::ProfileBegin{20, 0, 0, 1, wire::ProfileEnds::stop}));
  chunk.first = 5;
  EXPECT_EQ(bench.code(chunk), AnswerCode::incomplete) << "a hole";
  chunk.first = 0;
  bench.expect_ok(bench.code(chunk));
  bench.expect_ok(bench.code(chunk));
  EXPECT_EQ(bench.command(wire::ProfileEnd{0}).detail, 10U);
  chunk.first = 10, chunk.count = 11;
  EXPECT_EQ(bench.code(chunk), AnswerCode::too_large);
  chunk.count = 10, chunk.values[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(bench.command(chunk).detail, 13U);
  chunk.values[3] = 1;
  bench.expect_ok(bench.code(chunk));
  EXPECT_EQ(bench.code(wire::ProfileEnd{0}), AnswerCode::check_failed);
  const float sent[20] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
  bench.expect_ok(
      bench.code(wire::ProfileEnd{wire::crc32c(reinterpret_cast<const std::uint8_t*>(sent), 80)}));
}

// The check covers the final samples, also if a chunk is sent again with other samples.
TEST(ProfileUpload, AChunkThatComesAgainChangesTheCheck) {
  FirmwareBench bench;
  const auto chunk_of = [](std::uint32_t first, float value) {
    wire::ProfileChunk chunk{};
    chunk.first = first, chunk.count = 8;
    std::fill_n(chunk.values, 8, value);
    return chunk;
  };
  bench.expect_ok(bench.code(FirmwareBench::begin_of(24)));
  for (const std::uint32_t first : {0U, 8U, 16U}) bench.expect_ok(bench.code(chunk_of(first, 1)));
  for (const std::uint32_t again : {8U, 0U, 16U}) {
    bench.expect_ok(bench.code(chunk_of(again, 2)));
    const auto* there = reinterpret_cast<const std::uint8_t*>(bench.board.profile);
    bench.expect_ok(bench.code(wire::ProfileEnd{wire::crc32c(there, 96)}));
  }
}

TEST(Filters, UnstableOnesAreRefusedByTheirPlace) {
  FirmwareBench bench;
  wire::Filters filters{};
  filters.count = 3;
  filters.sections[2].a2 = 1.01F;
  EXPECT_EQ(bench.command(filters).detail, 2U);
  filters.sections[2].a2 = 0.5F;
  EXPECT_EQ(bench.code(filters), AnswerCode::ok);
}

}  // namespace
}  // namespace tacto::core
