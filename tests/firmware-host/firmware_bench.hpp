// SPDX-License-Identifier: GPL-3.0-or-later
// The firmware on a test board, controlled by messages.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "firmware-host/core/wire/crc32c.hpp"
#include "tests/firmware-host/test_board.hpp"

namespace tacto::tests {

inline constexpr std::uint32_t kTenKilohertz = 10'000'000;
inline constexpr wire::Limits kTestLimits{5, 15708, 0.002F, 0.005F, 50, 100};

class FirmwareBench {
 public:
  FirmwareBench() { greet(); }
  /// With axes.
  struct WithForces {};
  explicit FirmwareBench(WithForces /*tag*/)
      : firmware(std::make_unique<core::Firmware>(board.about_forces(), board.hal())) {
    greet();
  }

  template <class Message>
  void send(const Message& message) {
    const auto bytes = framed(message, sequence_++);
    board.from_host.insert(board.from_host.end(), bytes.begin(), bytes.end());
    poll();
  }
  /// Sends a command and returns the firmware's answer.
  template <class Message>
  wire::Answer command(const Message& message) {
    answers.clear();
    send(message);
    if (answers.size() != 1) throw std::runtime_error("not one answer but " + std::to_string(answers.size()));
    return answers[0];
  }
  template <class Message>
  wire::AnswerCode code(const Message& message) {
    return command(message).code;
  }
  void greet() { send(wire::Hello{}); }
  wire::Pulse pulse() {
    pulses.clear();
    send(wire::Heartbeat{7});
    return pulses.at(0);
  }

  /// Ticks, with an occasional message of the host if `heard`.
  void run(int count, bool heard = true) {
    for (int i = 0; i < count && board.rate_millihertz > 0; ++i) {
      board.clock += kTestClockHz / (board.rate_millihertz / 1000);
      firmware->tick();
      drives.push_back(board.drive_v);
      if (heard && i % 100 == 0) send(wire::Heartbeat{1});
      poll();
    }
  }
  void poll() {
    firmware->poll();
    collect();
  }

  void upload_constant(float value) { upload(std::vector<float>(64, value)); }
  /// Uploads a loop with one sample per count, sample 0 at count 0.
  void upload(const std::vector<float>& target) {
    expect_ok(code(begin_of(target.size())));
    upload_samples(target);
  }
  static wire::ProfileBegin begin_of(std::size_t samples) {
    return {static_cast<std::uint32_t>(samples), 0, 0, UINT64_C(1) << 32, wire::ProfileEnds::loop};
  }
  /// The part of an upload after profile_begin.
  void upload_samples(const std::vector<float>& target) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(target.data());
    wire::ProfileChunk chunk{};
    for (; chunk.first < target.size(); chunk.first += chunk.count) {
      const std::size_t left = target.size() - chunk.first;
      chunk.count = static_cast<std::uint16_t>(std::min(left, wire::kMaxChunk));
      std::copy_n(target.begin() + chunk.first, chunk.count, chunk.values);
      expect_ok(code(chunk));
    }
    expect_ok(code(wire::ProfileEnd{wire::crc32c(bytes, target.size() * 4)}));
  }
  /// Uploads the block of a scene; the answer to its last part, or the first that is not ok.
  wire::AnswerCode upload_scene(const void* block, std::size_t bytes, std::size_t part = 32) {
    wire::AnswerCode last = wire::AnswerCode::ok;
    for (std::size_t first = 0; first < bytes && last == wire::AnswerCode::ok; first += part) {
      wire::ScenePart message{};
      message.bytes = static_cast<std::uint32_t>(bytes);
      message.first = static_cast<std::uint32_t>(first);
      message.count = static_cast<std::uint16_t>(std::min(part, bytes - first));
      std::memcpy(message.data, static_cast<const char*>(block) + first, message.count);
      last = code(message);
    }
    return last;
  }
  void arm_profile(float value) {
    expect_ok(code(kTestLimits));
    upload_constant(value);
    expect_ok(code(wire::Arm{wire::DriveSource::profile, kTenKilohertz}));
  }
  /// Plays with the full level.
  void play_profile(float value) {
    arm_profile(value);
    expect_ok(code(wire::Play{}));
    run(60);
  }
  static void expect_ok(wire::AnswerCode code) {
    if (code != wire::AnswerCode::ok)
      throw std::runtime_error("refused: " + std::to_string(static_cast<int>(code)));
  }

  TestBoard board;
  std::unique_ptr<core::Firmware> firmware = std::make_unique<core::Firmware>(board.about(), board.hal());
  std::vector<wire::Answer> answers;
  std::vector<wire::Welcome> welcomes;
  std::vector<wire::Channel> channels;
  std::vector<wire::Note> notes;
  std::vector<wire::Samples> samples;
  std::vector<wire::Tick> ticks;
  std::vector<wire::Axes> axes;
  std::vector<wire::AxisTick> axis_ticks;
  std::vector<std::uint64_t> first_ticks;
  std::vector<wire::Pulse> pulses;
  std::vector<wire::Fault> faults;
  std::vector<float> drives;
  std::vector<wire::MessageType> order;
  std::uint32_t sequence_ = 0;

 private:
  template <class Message>
  static Message parsed(const wire::Frame& frame) {
    Message message{};
    if (wire::parse(frame.payload, frame.header.length, message) != wire::Parse::ok)
      throw std::runtime_error("the firmware sent what does not parse");
    return message;
  }
  void collect() {
    const std::vector<std::uint8_t> bytes = std::exchange(board.to_host, {});
    wire::Arrival arrival = wire::Arrival::frame;
    for (std::size_t at = 0; at < bytes.size() || arrival != wire::Arrival::nothing;) {
      wire::Frame frame;
      std::size_t used = 0;
      arrival = decoder_.take(bytes.data() + at, bytes.size() - at, used, frame);
      at += used;
      if (arrival == wire::Arrival::frame) keep(frame);
    }
  }
  void keep(const wire::Frame& frame) {
    using wire::MessageType;
    const auto type = static_cast<MessageType>(frame.header.type);
    order.push_back(type);
    if (type == MessageType::answer) answers.push_back(parsed<wire::Answer>(frame));
    if (type == MessageType::welcome) welcomes.push_back(parsed<wire::Welcome>(frame));
    if (type == MessageType::channel) channels.push_back(parsed<wire::Channel>(frame));
    if (type == MessageType::note) notes.push_back(parsed<wire::Note>(frame));
    if (type == MessageType::samples) samples.push_back(parsed<wire::Samples>(frame));
    if (type == MessageType::pulse) pulses.push_back(parsed<wire::Pulse>(frame));
    if (type == MessageType::fault) faults.push_back(parsed<wire::Fault>(frame));
    if (type == MessageType::axes) axes.push_back(parsed<wire::Axes>(frame));
    if (type == MessageType::axis_ticks) {
      const auto block = parsed<wire::AxisTicks>(frame);
      first_ticks.push_back(block.first_tick);
      axis_ticks.insert(axis_ticks.end(), block.ticks, block.ticks + block.count);
    }
    if (type != MessageType::ticks) return;
    const auto block = parsed<wire::Ticks>(frame);
    first_ticks.push_back(block.first_tick);
    ticks.insert(ticks.end(), block.ticks, block.ticks + block.count);
  }
  wire::FrameDecoder decoder_;
};

}  // namespace tacto::tests
