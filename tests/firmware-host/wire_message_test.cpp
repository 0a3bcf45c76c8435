// SPDX-License-Identifier: GPL-3.0-or-later
// Each message is encoded and decoded, cut, too long, and compared with the bytes of WIRE.md.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

#include "firmware-host/core/wire/crc32c.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"
#include "tests/firmware-host/wire_messages.hpp"

namespace tacto::wire {
namespace {

using tests::framed;
using tests::random_message;

std::uint32_t check_of(const std::string& text) {
  return crc32c(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

TEST(Crc32c, IsThatOfRfc3720) {
  EXPECT_EQ(check_of("123456789"), 0xE3069283U);
  EXPECT_EQ(check_of(std::string(32, '\0')), 0x8A9136AAU);  // RFC 3720, B.4
  EXPECT_EQ(check_of(std::string(32, '\xFF')), 0x62A8AB43U);
  EXPECT_EQ(check_of(""), 0U);
}

TEST(Crc32c, GoesOnWhereItStopped) {
  const std::uint8_t bytes[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(crc32c(bytes + 4, 5, crc32c(bytes, 4)), 0xE3069283U);
}

template <class Message>
class WireMessage : public testing::Test {};

template <class Tuple>
struct TypesOf;
template <class... Messages>
struct TypesOf<std::tuple<Messages...>> {
  using Type = testing::Types<Messages...>;
};
TYPED_TEST_SUITE(WireMessage, TypesOf<tests::AllMessages>::Type);

TYPED_TEST(WireMessage, ComesBackAsItWas) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto bytes = framed(random_message<TypeParam>(seed), 9);
    ASSERT_GE(bytes.size(), kHeaderSize + kCheckSize);
    TypeParam back{};
    ASSERT_EQ(parse(bytes.data() + kHeaderSize, bytes.size() - kHeaderSize - kCheckSize, back), Parse::ok);
    EXPECT_EQ(framed(back, 9), bytes);
  }
}

TYPED_TEST(WireMessage, AnyShorterPayloadIsTruncated) {
  const auto bytes = framed(random_message<TypeParam>(3), 0);
  const std::size_t size = bytes.size() - kHeaderSize - kCheckSize;
  for (std::size_t cut = 0; cut < size; ++cut) {
    const std::vector<std::uint8_t> payload(bytes.begin() + kHeaderSize, bytes.begin() + kHeaderSize + cut);
    TypeParam back{};
    ASSERT_EQ(parse(payload.data(), cut, back), Parse::truncated) << cut;
  }
}

TYPED_TEST(WireMessage, ANewerMinorVersionMayAppend) {
  auto payload = framed(random_message<TypeParam>(4), 0);
  TypeParam back{};
  EXPECT_EQ(parse(payload.data() + kHeaderSize, payload.size() - kHeaderSize, back), Parse::ok);
}

TYPED_TEST(WireMessage, DoesNotFitInLessThanItsSize) {
  const auto message = random_message<TypeParam>(5);
  const std::size_t size = framed(message, 0).size();
  std::vector<std::uint8_t> small(size - 1);
  EXPECT_EQ(encode_frame(message, 0, small.data(), small.size()), 0U);
  std::vector<std::uint8_t> right(size);
  EXPECT_EQ(encode_frame(message, 0, right.data(), right.size()), size);
}

TEST(WireMessages, CountsBeyondTheirArraysAreRefused) {
  Samples samples{};
  std::vector<std::uint8_t> payload(kMaxPayload, 0);
  payload[20] = 17;
  EXPECT_EQ(parse(payload.data(), payload.size(), samples), Parse::out_of_range);
  payload[20] = 16, payload[21] = 33;
  EXPECT_EQ(parse(payload.data(), payload.size(), samples), Parse::out_of_range);
  Ticks ticks{};
  payload[16] = 65;
  EXPECT_EQ(parse(payload.data(), payload.size(), ticks), Parse::out_of_range);
  ProfileChunk chunk{};
  payload[4] = 1, payload[5] = 2;
  EXPECT_EQ(parse(payload.data(), payload.size(), chunk), Parse::out_of_range);
  ticks.count = 65;
  EXPECT_TRUE(framed(ticks, 0).empty());
}

TEST(WireMessages, TheLargestFit) {
  Samples samples{};
  samples.channels = kMaxChannels, samples.count = kMaxBlockFrames;
  EXPECT_FALSE(framed(samples, 0).empty());
  ProfileChunk chunk{};
  chunk.count = kMaxChunk;
  EXPECT_FALSE(framed(chunk, 0).empty());
}

// Further lines of a frame are indented by four spaces.
std::map<std::string, std::string> documented_frames() {
  std::map<std::string, std::string> frames;
  std::ifstream file(TACTO_SOURCE "/firmware-host/core/WIRE.md");
  std::string name;
  for (std::string line; std::getline(file, line);) {
    const auto at = line.find(" a554");
    const bool continued = !name.empty() && line.compare(0, 4, "    ") == 0;
    if (!continued) name = at == std::string::npos ? "" : line.substr(0, at);
    if (!name.empty()) frames[name] += line.substr(continued ? 4 : at + 1);
  }
  return frames;
}

template <class Message>
std::string hex_of(const Message& message, std::uint32_t sequence) {
  std::string hex;
  for (const std::uint8_t byte : framed(message, sequence)) {
    hex += "0123456789abcdef"[byte >> 4];
    hex += "0123456789abcdef"[byte & 15];
  }
  return hex;
}

ProfileChunk example_chunk() {
  ProfileChunk chunk{};
  chunk.first = 512, chunk.count = 3;
  chunk.values[0] = 0.5F, chunk.values[1] = -0.25F, chunk.values[2] = 1e-6F;
  return chunk;
}

Filters example_filters() {
  Filters filters{};
  filters.count = 1;
  filters.sections[0] = {1, -1.5F, 0.75F, -1.25F, 0.5F};
  return filters;
}

Drive example_drive() {
  Drive drive{};
  drive.count = 2, drive.drive_v[0] = 0.125F, drive.drive_v[1] = -0.125F;
  return drive;
}

Welcome example_welcome() {
  return {1,  1,         0,        0x12345678, "bench 1", "0007", "1.2.3", 4,    1, 16,
          31, 168000000, 10000000, 1000000,    20000000,  256,    16384,   1024, 5, 15708};
}

Samples example_samples() {
  Samples samples{};
  samples.first_frame = std::uint64_t{1} << 33;
  samples.device_ticks = 0x0102030405060708;
  samples.enabled = 3, samples.channels = 2, samples.count = 2;
  samples.codes[0] = -65536, samples.codes[1] = 1234, samples.codes[2] = 0x7FFF0000, samples.codes[3] = -1;
  return samples;
}

Ticks example_ticks() {
  Ticks ticks{};
  ticks.first_tick = 7, ticks.device_ticks = 99, ticks.count = 1;
  ticks.ticks[0] = {-5, 0.0625F, 3};
  return ticks;
}

ScenePart example_part() {
  ScenePart part{64, 60, 4, {}};
  const std::uint8_t bytes[4] = {0, 0, 0xC8, 0x42};
  std::copy_n(bytes, 4, part.data);
  return part;
}

Axes example_axes() {
  Axes axes;
  axes.count = 2;
  axes.peak_n = 20, axes.continuous_n = 5, axes.slew_n_per_s = 20000, axes.scene_bytes = 32768;
  axes.axes[0] = {AxisAlong::x, {}, 20, 5, 1e-5F, -0.125, 0.125};
  axes.axes[1] = {AxisAlong::y, {}, 18, 4, 2e-5F, -0.25, 0.25};
  return axes;
}

AxisTicks example_axis_ticks() {
  AxisTicks ticks{};
  ticks.first_tick = 7, ticks.device_ticks = 99, ticks.count = 1, ticks.axes = 2;
  ticks.ticks[0] = {{-5, 1234}, {0.0625F, -1.5F}, 3};
  return ticks;
}

TEST(WireDocument, HostFramesAreItsBytes) {
  auto frames = documented_frames();
  EXPECT_EQ(hex_of(Hello{1, 1, 0, 0x12345678}, 0), frames["hello"]);
  EXPECT_EQ(hex_of(StreamStart{10000000, 32}, 1), frames["stream_start"]);
  EXPECT_EQ(hex_of(StreamStop{}, 2), frames["stream_stop"]);
  EXPECT_EQ(hex_of(Limits{5, 15708, 0.05F, 0.01F, 100, 200}, 3), frames["limits"]);
  EXPECT_EQ(hex_of(ProfileBegin{4000, -250, INT64_C(1) << 31, 1 << 28, ProfileEnds::loop}, 4),
            frames["profile_begin"]);
  EXPECT_EQ(hex_of(example_chunk(), 5), frames["profile_chunk"]);
  EXPECT_EQ(hex_of(ProfileEnd{0xDEADBEEF}, 6), frames["profile_end"]);
  EXPECT_EQ(hex_of(example_filters(), 7), frames["filters"]);
  EXPECT_EQ(hex_of(Gain{-2.5F}, 8), frames["gain"]);
  EXPECT_EQ(hex_of(Sweep{0.5F, 10000, 800000, 188000}, 9), frames["sweep"]);
  EXPECT_EQ(hex_of(Arm{DriveSource::profile, 20000000}, 10), frames["arm"]);
  EXPECT_EQ(hex_of(Play{}, 11), frames["play"]);
  EXPECT_EQ(hex_of(Stop{}, 12), frames["stop"]);
  EXPECT_EQ(hex_of(Disarm{}, 13), frames["disarm"]);
  EXPECT_EQ(hex_of(example_drive(), 14), frames["drive"]);
  EXPECT_EQ(hex_of(Heartbeat{42}, 15), frames["heartbeat"]);
  EXPECT_EQ(hex_of(Reset{}, 16), frames["reset"]);
  EXPECT_EQ(hex_of(ProfileLevels{5, Interpolation::sinc, 0, 1601}, 17), frames["profile_levels"]);
  EXPECT_EQ(hex_of(Taps{4, {1.5F, -0.25F, 0.125F, 0}}, 18), frames["taps"]);
  EXPECT_EQ(hex_of(Tracking{1, {}, 4, 8, 12.5F}, 19), frames["tracking"]);
  EXPECT_EQ(hex_of(Energy{1.5F, 0.5F}, 20), frames["energy"]);
  EXPECT_EQ(hex_of(Contact{3, {}, 0.5F, 0.25F, 0x1p-27F, -0.125F}, 21), frames["contact"]);
  EXPECT_EQ(hex_of(Change{0.0625F}, 22), frames["change"]);
  EXPECT_EQ(hex_of(Hysteresis{2, {}, 1.5F, {{0.25F, -0.5F}, {1, -0.125F}}}, 23), frames["hysteresis"]);
  EXPECT_EQ(hex_of(ForceLimits{{20, 18, 0}, {5, 4, 0}, 20, 5, 20000, 0.02F, 0.01F, 100, 0, 2000}, 24),
            frames["force_limits"]);
  EXPECT_EQ(hex_of(example_part(), 25), frames["scene_part"]);
  EXPECT_EQ(hex_of(Set{3, 1, 250, 0.5F}, 26), frames["set"]);
  EXPECT_EQ(hex_of(Move{3, 0, -1000, 2500, 0.5F}, 27), frames["move"]);
  EXPECT_EQ(hex_of(Raise{3}, 28), frames["raise"]);
}

TEST(WireDocument, DeviceFramesAreItsBytes) {
  auto frames = documented_frames();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(hex_of(example_welcome(), 0), frames["welcome"]);
  EXPECT_EQ(
      hex_of(Channel{1, "position", "position", "m", "encoder", 1e-6, 0, nan, nan, nan, "2011-05-01"}, 1),
      frames["channel"]);
  EXPECT_EQ(hex_of(Note{0, NoteKind::surface, "oak, planed"}, 2), frames["note"]);
  EXPECT_EQ(hex_of(Answer{MessageType::arm, AnswerCode::wrong_state, 0, 10, 3}, 3), frames["answer"]);
  EXPECT_EQ(hex_of(example_samples(), 4), frames["samples"]);
  EXPECT_EQ(hex_of(example_ticks(), 5), frames["ticks"]);
  EXPECT_EQ(hex_of(Pulse{42, std::uint64_t{1} << 40, DriveState::playing, FaultCode::none, 1, 1, -77, 1.5F,
                         10, 1, 2, 3, 4, 5, 6, 7},
                   6),
            frames["pulse"]);
  EXPECT_EQ(hex_of(Fault{FaultCode::encoder_jump, {}, 10000, 123456789}, 7), frames["fault"]);
  EXPECT_EQ(hex_of(example_axes(), 8), frames["axes"]);
  EXPECT_EQ(hex_of(example_axis_ticks(), 9), frames["axis_ticks"]);
}

}  // namespace
}  // namespace tacto::wire
