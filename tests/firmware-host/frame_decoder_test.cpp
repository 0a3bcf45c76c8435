// SPDX-License-Identifier: GPL-3.0-or-later
// Streams of frames cut anywhere, with garbage between them, damaged, truncated, oversize, out of order.
#include "firmware-host/core/wire/frame_decoder.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "firmware-host/core/wire/crc32c.hpp"
#include "firmware-host/core/wire/sequence_check.hpp"
#include "tests/firmware-host/wire_messages.hpp"

namespace tacto::wire {
namespace {

using Bytes = std::vector<std::uint8_t>;
using tests::framed;
using tests::random_message;

struct Decoded {
  std::vector<std::uint32_t> sequences;
  std::map<Arrival, int> arrivals;
};

// Feeds `bytes` in pieces of the sizes that `next_size` returns.
template <class NextSize>
Decoded decoded(FrameDecoder& decoder, const Bytes& bytes, NextSize next_size) {
  Decoded result;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.size(), at + next_size());
    for (Arrival arrival = Arrival::frame; arrival != Arrival::nothing;) {
      Frame frame;
      std::size_t used = 0;
      arrival = decoder.take(bytes.data() + at, end - at, used, frame);
      at += used;
      ++result.arrivals[arrival];
      if (arrival == Arrival::frame) result.sequences.push_back(frame.header.sequence);
    }
    EXPECT_EQ(at, end) << "nothing, and bytes are left";
  }
  return result;
}

Decoded decoded(FrameDecoder& decoder, const Bytes& bytes) {
  return decoded(decoder, bytes, [&] { return bytes.size(); });
}

Bytes& operator+=(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
  return bytes;
}

std::vector<std::uint32_t> count_to(std::uint32_t n) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < n; ++i) numbers.push_back(i);
  return numbers;
}

Bytes mixed_frames(std::uint32_t count) {
  Bytes bytes;
  for (std::uint32_t i = 0; i < count; ++i)
    bytes += i % 3 == 0   ? framed(random_message<Samples>(i), i)
             : i % 3 == 1 ? framed(random_message<Heartbeat>(i), i)
                          : framed(StreamStop{}, i);
  return bytes;
}

TEST(FrameDecoder, FramesCutAnywhereComeWhole) {
  const Bytes bytes = mixed_frames(200);
  for (const std::size_t size : {1U, 2U, 11U, 12U, 13U, 64U, 512U, 5000U}) {
    FrameDecoder decoder;
    EXPECT_EQ(decoded(decoder, bytes, [&] { return size; }).sequences, count_to(200)) << size;
    EXPECT_EQ(decoder.counts().dropped_bytes, 0U);
    EXPECT_EQ(decoder.finish(), Arrival::nothing);
  }
}

TEST(FrameDecoder, ThePayloadIsTheMessage) {
  FrameDecoder decoder;
  const Bytes bytes = framed(random_message<Pulse>(1), 77);
  Frame frame;
  std::size_t used = 0;
  ASSERT_EQ(decoder.take(bytes.data(), bytes.size(), used, frame), Arrival::frame);
  Pulse back;
  ASSERT_EQ(parse(frame.payload, frame.header.length, back), Parse::ok);
  EXPECT_EQ(framed(back, 77), bytes);
  EXPECT_EQ(frame.header.type, static_cast<std::uint8_t>(MessageType::pulse));
  EXPECT_EQ(frame.header.major, kProtocolMajor);
}

TEST(FrameDecoder, GarbageBetweenFramesIsDroppedAndCounted) {
  std::mt19937 random(1);
  Bytes bytes;
  std::uint32_t garbage = 0;
  for (std::uint32_t i = 0; i < 100; ++i) {
    for (auto n = random() % 300; n > 0; --n, ++garbage)
      bytes.push_back(static_cast<std::uint8_t>(random() % 4 == 0   ? kSync0
                                                : random() % 3 == 0 ? kSync1
                                                                    : random()));
    bytes += framed(random_message<Samples>(i), i);
  }
  FrameDecoder decoder;
  EXPECT_EQ(decoded(decoder, bytes, [&] { return 1 + random() % 200; }).sequences, count_to(100));
  EXPECT_EQ(decoder.counts().dropped_bytes, garbage);
}

// For a change of any byte of a frame, only that frame is lost.
TEST(FrameDecoder, OneDamagedByteCostsOneFrame) {
  const Bytes first = framed(random_message<Pulse>(1), 0), second = framed(random_message<Answer>(2), 1),
              third = framed(random_message<Pulse>(3), 2);
  for (std::size_t place = 0; place < second.size(); ++place)
    for (const int flip : {0x01, 0x80, 0xFF}) {
      Bytes bytes = first, damaged = second;
      damaged[place] = static_cast<std::uint8_t>(damaged[place] ^ flip);
      bytes += damaged;
      bytes += third;
      FrameDecoder decoder;
      ASSERT_EQ(decoded(decoder, bytes).sequences, (std::vector<std::uint32_t>{0, 2}))
          << place << " " << flip;
      EXPECT_EQ(decoder.counts().dropped_bytes, second.size());
      EXPECT_EQ(decoder.counts().bad_check, place >= kHeaderSize ? 1U : 0U);
    }
}

TEST(FrameDecoder, AFrameWithoutItsEndIsTruncatedAndTheNextIsWhole) {
  const Bytes whole = framed(random_message<Welcome>(1), 0), next = framed(random_message<Welcome>(2), 1);
  for (std::size_t cut = kHeaderSize; cut < whole.size(); ++cut) {
    Bytes bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut));
    bytes += next;
    FrameDecoder decoder;
    Decoded result = decoded(decoder, bytes);
    ASSERT_EQ(result.sequences, std::vector<std::uint32_t>{1}) << cut;
    // With a few bytes missing, the claimed end of the frame is in the next one's header.
    EXPECT_EQ(decoder.counts().truncated + decoder.counts().bad_check, 1U);
    EXPECT_EQ(decoder.counts().truncated, whole.size() - cut >= kHeaderSize ? 1U : 0U) << cut;
  }
}

TEST(FrameDecoder, AStreamThatEndsWithinAFrameSaysSo) {
  const Bytes whole = framed(random_message<Welcome>(1), 0);
  FrameDecoder decoder;
  decoded(decoder, Bytes(whole.begin(), whole.begin() + 20));
  EXPECT_EQ(decoder.finish(), Arrival::truncated);
  EXPECT_EQ(decoder.counts().dropped_bytes, 20U);
  EXPECT_EQ(decoder.finish(), Arrival::nothing);
}

TEST(FrameDecoder, ASoundHeaderOfTooMuchIsOversize) {
  Bytes bytes(kMaxFrame + 100);
  FieldWriter writer(bytes.data(), kHeaderSize);
  writer(kSync0, kSync1, kProtocolMajor, std::uint8_t{1}, static_cast<std::uint16_t>(kMaxPayload + 1), 5U);
  writer(static_cast<std::uint16_t>(crc32c(bytes.data(), 10)));
  bytes += framed(Play{}, 6);
  FrameDecoder decoder;
  Decoded result = decoded(decoder, bytes);
  EXPECT_EQ(result.arrivals[Arrival::oversize], 1);
  EXPECT_EQ(result.sequences, std::vector<std::uint32_t>{6});
}

// Random damage of all kinds at once. Every decoded frame must have been sent.
TEST(FrameDecoder, DamagedStreamsGiveOnlyWhatWasSent) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 200; ++round) {
    Bytes bytes;
    for (std::uint32_t i = 0; i < 20; ++i) {
      Bytes frame = framed(random_message<Answer>(i), i);
      if (random() % 4 == 0) frame[random() % frame.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
      if (random() % 8 == 0) frame.resize(random() % frame.size());
      bytes += frame;
    }
    FrameDecoder decoder;
    const auto result = decoded(decoder, bytes, [&] { return 1 + random() % 40; });
    EXPECT_TRUE(std::is_sorted(result.sequences.begin(), result.sequences.end()));
    for (const std::uint32_t sequence : result.sequences) EXPECT_LT(sequence, 20U);
  }
}

TEST(SequenceCheck, CountsWhatIsMissingAndWhatComesTwice) {
  SequenceCheck check;
  EXPECT_EQ(check.check(41), Order::expected);
  EXPECT_EQ(check.check(42), Order::expected);
  EXPECT_EQ(check.check(45), Order::gap);
  EXPECT_EQ(check.lost(), 2U);
  EXPECT_EQ(check.check(45), Order::stale);
  EXPECT_EQ(check.check(43), Order::stale);
  EXPECT_EQ(check.stale(), 2U);
  EXPECT_EQ(check.check(46), Order::expected);
  check.expect_any();
  EXPECT_EQ(check.check(3), Order::expected);
}

TEST(SequenceCheck, RunsOverAtTwoToThe32) {
  SequenceCheck check;
  EXPECT_EQ(check.check(0xFFFFFFFE), Order::expected);
  EXPECT_EQ(check.check(0xFFFFFFFF), Order::expected);
  EXPECT_EQ(check.check(1), Order::gap);
  EXPECT_EQ(check.lost(), 1U);
  EXPECT_EQ(check.check(0), Order::stale);
}

}  // namespace
}  // namespace tacto::wire
