// SPDX-License-Identifier: GPL-3.0-or-later
// A board for tests: bytes in, bytes out, and inputs that the test sets.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "firmware-host/core/firmware/firmware.hpp"
#include "tests/firmware-host/wire_messages.hpp"

namespace tacto::tests {

inline constexpr std::uint32_t kTestClockHz = 168000000;

struct TestBoard {
  std::vector<std::uint8_t> from_host, to_host;
  std::size_t taken = 0;                                            ///< bytes of from_host that were read
  std::size_t link_room = std::numeric_limits<std::size_t>::max();  ///< free bytes in the link
  std::int32_t encoder = 0;
  std::uint32_t encoder_unseen = 0;  ///< in periods
  bool enabled = true, converter_works = true;
  std::uint64_t clock = 0;
  std::uint32_t rate_millihertz = 0, restarts = 0, rates_set = 0;
  std::vector<float> driven;  ///< the last tick's value is last
  float drive_v = 0;
  float profile[4096] = {};
  std::int32_t counts[wire::kMaxAxes] = {};  ///< of the axes
  float force_n[wire::kMaxAxes] = {};
  wire::Axes axes;
  wire::Channel channels[2] = {};
  wire::Note notes[1] = {};
  core::Firmware* interrupted = nullptr;  ///< ticks once during the next reading of the encoder

  static TestBoard& of(void* board) { return *static_cast<TestBoard*>(board); }

  core::Hal hal() {
    core::Hal hal;
    hal.board = this;
    hal.read_encoder = [](void* b) noexcept {
      if (core::Firmware* const firmware = std::exchange(of(b).interrupted, nullptr)) firmware->tick();
      return of(b).encoder;
    };
    hal.encoder_unseen = [](void* b) noexcept { return of(b).encoder_unseen; };
    hal.read_channels = [](void* b, std::int32_t* codes) noexcept {
      codes[0] = of(b).encoder * 65536;
      codes[1] = of(b).encoder;
      return of(b).converter_works;
    };
    hal.write_drive = [](void* b, float volts) noexcept { of(b).drive_v = volts; };
    hal.read_axes = [](void* b, std::int32_t* to) noexcept { std::copy_n(of(b).counts, wire::kMaxAxes, to); };
    hal.write_forces = [](void* b, const float* newtons) noexcept {
      std::copy_n(newtons, of(b).axes.count, of(b).force_n);
    };
    hal.enable_closed = [](void* b) noexcept { return of(b).enabled; };
    hal.clock = [](void* b) noexcept { return of(b).clock; };
    hal.set_rate = [](void* b, std::uint32_t rate) noexcept {
      of(b).rate_millihertz = rate;
      of(b).rates_set += rate > 0;
    };
    hal.receive = [](void* b, std::uint8_t* bytes, std::size_t capacity) noexcept {
      TestBoard& board = of(b);
      const std::size_t size = std::min(capacity, board.from_host.size() - board.taken);
      if (size > 0) std::memcpy(bytes, board.from_host.data() + board.taken, size);
      board.taken += size;
      return size;
    };
    hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
      TestBoard& board = of(b);
      const std::size_t fits = std::min(size, board.link_room);
      board.to_host.insert(board.to_host.end(), bytes, bytes + fits);
      board.link_room -= fits;
      return fits;
    };
    hal.restart = [](void* b) noexcept { ++of(b).restarts; };
    return hal;
  }

  /// A board with two axes: 10 um, 20 N and 5 N, 20 N/ms.
  core::Board about_forces() {
    core::Board board = about();
    axes.count = 2;
    axes.peak_n = 20, axes.continuous_n = 5, axes.slew_n_per_s = 20000;
    axes.axes[0] = {wire::AxisAlong::x, {}, 20, 5, 1e-5F, -0.1, 0.1};
    axes.axes[1] = {wire::AxisAlong::y, {}, 20, 5, 1e-5F, -0.1, 0.1};
    board.axes = &axes;
    return board;
  }

  core::Board about() {
    core::Board board;
    std::strcpy(board.about.name, "test board");
    std::strcpy(board.about.serial, "T1");
    std::strcpy(board.about.firmware, "1.2.3");
    board.about.features = wire::kFeatureDrive | wire::kFeatureEnableInput;
    board.about.clock_hz = kTestClockHz;
    board.about.default_rate_millihertz = 10000000;
    board.about.least_rate_millihertz = 1000000;
    board.about.most_rate_millihertz = 20000000;
    board.about.drive_limit_v = 5;
    board.about.slew_limit_v_per_s = 15708;
    channels[1].index = 1;
    board.channels = channels;
    board.channel_count = 2;
    board.notes = notes;
    board.note_count = 1;
    board.profile_memory = profile;
    board.profile_samples = 4096;
    return board;
  }
};

}  // namespace tacto::tests
