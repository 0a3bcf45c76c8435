// SPDX-License-Identifier: GPL-3.0-or-later
// A faulty cable: frames from the device are dropped, damaged, cut, doubled or delayed on request. Also a
// device whose ring was full for one period.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"
#include "firmware-host/link/transport.hpp"

namespace tacto::tests {

enum class Harm { none, drop, corrupt, truncate, duplicate, delay, garbage_before, unplug, shorten };

class FaultyTransport final : public firmware_host::Transport {
 public:
  /// Selects the fault of each frame by its type.
  using Choice = std::function<Harm(wire::MessageType type)>;
  FaultyTransport(std::unique_ptr<firmware_host::Transport> inner, Choice choice)
      : inner_(std::move(inner)), choice_(std::move(choice)) {}

  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    if (out_.empty() && !unplugged_) {
      std::uint8_t fresh[700];
      const auto got = inner_->read(fresh, timeout_s);
      if (!got) return got;
      take_in(fresh, *got);
    }
    if (out_.empty() && unplugged_)
      return schema::fail(schema::ErrorKind::device, "the device was unplugged", "test");
    const std::size_t size = std::min(bytes.size(), out_.size());
    std::copy_n(out_.begin(), size, bytes.begin());
    out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override {
    if (unplugged_) return schema::fail(schema::ErrorKind::device, "the device was unplugged", "test");
    return inner_->write(bytes, timeout_s);
  }
  double now_s() override { return inner_->now_s(); }

 private:
  using Bytes = std::vector<std::uint8_t>;

  void take_in(const std::uint8_t* fresh, std::size_t size) {
    pending_.insert(pending_.end(), fresh, fresh + size);
    for (wire::FrameHeader header; pending_.size() >= wire::kHeaderSize;) {
      if (!wire::read_header(pending_.data(), header)) std::abort();  // the device never sends garbage
      const std::size_t whole = wire::kHeaderSize + header.length + wire::kCheckSize;
      if (pending_.size() < whole) return;
      pass(Bytes(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(whole)),
           choice_(static_cast<wire::MessageType>(header.type)));
      pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(whole));
    }
  }
  void pass(Bytes frame, Harm harm) {
    const std::size_t place = random_() % frame.size();
    if (harm == Harm::corrupt) frame[place] = static_cast<std::uint8_t>(frame[place] ^ (1 + random_() % 255));
    if (harm == Harm::truncate) frame.resize(place);
    if (harm == Harm::shorten) frame = shortened(frame);
    if (harm == Harm::garbage_before)
      for (int i = 0; i < 40; ++i) out_.push_back(static_cast<std::uint8_t>(i % 3 == 0 ? 0xA5 : random_()));
    if (harm == Harm::unplug) {
      frame.resize(place);
      unplugged_ = true;
    }
    if (harm != Harm::drop && harm != Harm::delay) put(frame);
    if (harm == Harm::duplicate) put(frame);
    if (harm != Harm::delay && !held_.empty()) put(std::exchange(held_, {}));
    if (harm == Harm::delay) held_ = frame;
  }
  // The same message without its last frame or tick.
  static Bytes shortened(const Bytes& frame) {
    wire::FrameHeader header;
    wire::read_header(frame.data(), header);
    return static_cast<wire::MessageType>(header.type) == wire::MessageType::ticks
               ? one_less<wire::Ticks>(frame, header)
               : one_less<wire::Samples>(frame, header);
  }
  template <class Message>
  static Bytes one_less(const Bytes& frame, const wire::FrameHeader& header) {
    Message message{};
    if (wire::parse(frame.data() + wire::kHeaderSize, header.length, message) != wire::Parse::ok)
      std::abort();
    --message.count;
    Bytes shorter(frame.size());
    shorter.resize(wire::encode_frame(message, header.sequence, shorter.data(), shorter.size()));
    return shorter;
  }
  void put(const Bytes& bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }

  std::unique_ptr<firmware_host::Transport> inner_;
  Choice choice_;
  std::mt19937 random_{1};
  Bytes pending_, held_;
  std::deque<std::uint8_t> out_;
  bool unplugged_ = false;
};

}  // namespace tacto::tests
