// SPDX-License-Identifier: GPL-3.0-or-later
// Any conversation with the complete firmware. The input is a list of actions: frames of any type with any
// payload (with valid checks, so that they pass the decoder), raw bytes, ticks, changing inputs. In every
// case the drive (and the forces of two axes) is a finite number within its limits and slew rate, and zero 20
// ms after the input opened.
#include <cmath>
#include <cstdlib>
#include <memory>

#include "tests/firmware-host/test_board.hpp"

namespace {

using namespace tacto;

void demand(bool holds) {
  if (!holds) std::abort();
}

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool more() const { return left_ > 0; }
  std::uint8_t byte() { return left_ > 0 ? (--left_, *data_++) : std::uint8_t{0}; }
  std::size_t bytes(std::uint8_t* to, std::size_t size) {
    const std::size_t taken = std::min(size, left_);
    if (taken > 0) std::memcpy(to, data_, taken);
    data_ += taken;
    left_ -= taken;
    return taken;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

class Conversation {
 public:
  void act(Input& input) {
    switch (input.byte() % 7) {
      case 0:
        return frame(input);
      case 1:
        return raw(input);
      case 2:
        return tick(input.byte());
      case 3:
        board_.enabled = !board_.enabled;
        return;
      case 4:
        board_.encoder += static_cast<std::int8_t>(input.byte());
        return;
      case 6:
        for (std::int32_t& count : board_.counts) count += 64 * static_cast<std::int8_t>(input.byte());
        return;
      default:
        board_.link_room = input.byte() * std::size_t{16};
    }
  }

 private:
  void frame(Input& input) {
    std::uint8_t bytes[wire::kMaxFrame];
    wire::FrameHeader header;
    header.type = static_cast<std::uint8_t>(input.byte() % 28);
    header.sequence = sequence_++;
    header.length = static_cast<std::uint16_t>(input.bytes(bytes + wire::kHeaderSize, input.byte()));
    const std::size_t size = wire::seal_frame(header, bytes);
    board_.from_host.insert(board_.from_host.end(), bytes, bytes + size);
    firmware_->poll();
    board_.to_host.clear();
  }
  void raw(Input& input) {
    std::uint8_t bytes[255];
    const std::size_t size = input.bytes(bytes, input.byte());
    board_.from_host.insert(board_.from_host.end(), bytes, bytes + size);
    firmware_->poll();
  }
  void tick(int count) {
    for (; count > 0 && board_.rate_millihertz > 0; --count) {
      const float before_v = board_.drive_v;
      std::copy_n(board_.force_n, wire::kMaxAxes, before_n_);
      board_.clock += tests::kTestClockHz / (board_.rate_millihertz / 1000);
      firmware_->tick();
      check(before_v);
    }
  }
  void check(float before_v) {
    const float rate_hz = 1e-3F * static_cast<float>(board_.rate_millihertz);
    demand(std::abs(board_.drive_v) <= 5);
    demand(std::abs(board_.drive_v - before_v) <= 15708 / rate_hz * 1.0001F);
    for (std::size_t i = 0; i < board_.axes.count; ++i) {
      demand(std::abs(board_.force_n[i]) <= 20);
      demand(std::abs(board_.force_n[i] - before_n_[i]) <= 20000 / rate_hz * 1.0001F);
    }
    demand(std::hypot(board_.force_n[0], board_.force_n[1]) <= 20 * (1 + 0x1p-22F));
    open_ticks_ = board_.enabled ? 0 : open_ticks_ + 1;
    demand(static_cast<float>(open_ticks_) <= 0.02F * rate_hz || board_.drive_v == 0);
    demand(static_cast<float>(open_ticks_) <= 0.02F * rate_hz ||
           (board_.force_n[0] == 0 && board_.force_n[1] == 0));
  }

  tests::TestBoard board_;
  std::unique_ptr<core::Firmware> firmware_ =
      std::make_unique<core::Firmware>(board_.about_forces(), board_.hal());
  std::uint32_t sequence_ = 0;
  int open_ticks_ = 0;
  float before_n_[wire::kMaxAxes] = {};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const auto conversation = std::make_unique<Conversation>();
  while (input.more()) conversation->act(input);
  return 0;
}
