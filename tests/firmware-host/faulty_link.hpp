// SPDX-License-Identifier: GPL-3.0-or-later
// Intentional faults of a device, so that hosts can be tested: a link that damages what the board sends.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "firmware-host/gadget/board_link.hpp"

namespace tacto::tests {

/// No faults by default. `every` counts messages of samples, from 1; `after` counts all frames that the
/// device has sent since its start, and the fault occurs once.
struct FaultPlan {
  std::optional<std::uint64_t> corrupt_every;       ///< one bit is inverted
  std::optional<std::uint64_t> drop_every;          ///< left out
  std::optional<std::uint64_t> truncate_every;      ///< its second half is left out
  std::optional<std::uint64_t> repeat_every;        ///< sent twice
  std::optional<std::uint64_t> packet;              ///< the largest size of a transfer in bytes
  std::optional<std::uint64_t> stall_after;         ///< the endpoint to the host stalls
  std::optional<std::uint64_t> unplug_after;        ///< in the middle of a frame
  std::optional<std::uint64_t> silent_after;        ///< nothing more is sent, but the device stays plugged in
  std::optional<std::uint64_t> stop_reading_after;  ///< nothing more is received, after so many transfers
  std::optional<std::uint8_t> major;                ///< the protocol version in its welcome
  std::uint8_t minor = 0;
};

inline bool read_fault_number(std::string_view text, std::uint64_t& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

inline bool read_fault(std::string_view name, std::string_view text, FaultPlan& plan) {
  constexpr std::pair<std::string_view, std::optional<std::uint64_t> FaultPlan::*> kCounts[] = {
      {"corrupt-every", &FaultPlan::corrupt_every},
      {"drop-every", &FaultPlan::drop_every},
      {"truncate-every", &FaultPlan::truncate_every},
      {"repeat-every", &FaultPlan::repeat_every},
      {"packet", &FaultPlan::packet},
      {"stall-after", &FaultPlan::stall_after},
      {"unplug-after", &FaultPlan::unplug_after},
      {"silent-after", &FaultPlan::silent_after},
      {"deaf-after", &FaultPlan::stop_reading_after}};
  std::uint64_t number = 0, minor = 0;
  for (const auto& [key, count] : kCounts) {
    if (key != name || !read_fault_number(text, number)) continue;
    plan.*count = number;
    return number > 0 || name.ends_with("-after");
  }
  const std::size_t point = std::min(text.find('.'), text.size() - 1);
  if (name != "version" || !read_fault_number(text.substr(0, point), number) ||
      !read_fault_number(text.substr(point + 1), minor))
    return false;
  plan.major = static_cast<std::uint8_t>(number);
  plan.minor = static_cast<std::uint8_t>(minor);
  return true;
}

/// "corrupt-every=100,version=2.0". Errors: usage: an unknown key, a value that is not a number.
inline schema::Result<FaultPlan> parse_fault_plan(std::string_view text) {
  FaultPlan plan;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find(','));
    const std::size_t equals = std::min(pair.find('='), pair.size());
    if (equals + 1 >= pair.size() || !read_fault(pair.substr(0, equals), pair.substr(equals + 1), plan))
      return schema::fail(schema::ErrorKind::usage, fmt::format("'{}' is not a known fault", pair),
                          "--fault");
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
  }
  return plan;
}

/// What happens to the cable itself; it depends on the kind of link. The bytes before it have been sent.
/// After `unplug` the inner link is not used any more.
struct CableFaults {
  std::function<void()> stall, unplug;
};

/// Passes frames from the board to a link, with the faults of a plan.
class FaultyLink final : public firmware_host::BoardLink {
 public:
  FaultyLink(BoardLink& inner, const FaultPlan& plan, CableFaults cable = {})
      : inner_(inner), plan_(plan), cable_(std::move(cable)) {}

  /// Precondition: whole frames.
  void send(std::span<const std::uint8_t> frames) override {
    while (!frames.empty()) {
      const std::size_t size = wire::kHeaderSize + header_of(frames).length + wire::kCheckSize;
      send_frame(frames.first(size));
      frames = frames.subspan(size);
    }
  }
  std::size_t waiting() const override { return gone_ ? 0 : inner_.waiting(); }
  void take_received(std::vector<std::uint8_t>& bytes) override {
    if (!gone_) inner_.take_received(bytes);
  }
  void wait_until(Clock::time_point time) override {
    if (gone_) return std::this_thread::sleep_until(time);
    inner_.wait_until(time);
  }

 private:
  static wire::FrameHeader header_of(std::span<const std::uint8_t> frame) {
    wire::FrameHeader header;
    wire::read_header(frame.data(), header);
    return header;
  }
  static bool is(std::span<const std::uint8_t> frame, wire::MessageType type) {
    return header_of(frame).type == static_cast<std::uint8_t>(type);
  }
  bool falls_on(const std::optional<std::uint64_t>& every) const { return every && samples_ % *every == 0; }

  void send_frame(std::span<const std::uint8_t> frame) {
    if (gone_ || (plan_.silent_after && frames_ >= *plan_.silent_after)) return;
    if (frames_ == plan_.unplug_after) {
      inner_.send(frame.first(frame.size() / 2));
      let_out();
      cable_.unplug();
      gone_ = true;
      return;
    }
    if (frames_ == plan_.stall_after) {
      let_out();
      cable_.stall();
    }
    ++frames_;
    std::vector<std::uint8_t> bytes(frame.begin(), frame.end());
    if (plan_.major) claim_version(bytes);
    if (is(frame, wire::MessageType::samples)) return send_samples(bytes);
    emit(bytes);
  }

  // Inverts another bit each time, so that errors occur in header, payload and check.
  void send_samples(std::vector<std::uint8_t>& frame) {
    ++samples_;
    if (falls_on(plan_.drop_every)) return;
    const std::uint64_t bit = samples_ * 7919 % (frame.size() * 8);
    if (falls_on(plan_.corrupt_every)) frame[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    if (falls_on(plan_.truncate_every)) frame.resize(frame.size() / 2);
    emit(frame);
    if (falls_on(plan_.repeat_every)) emit(frame);
  }

  // Changes a frame to one of a device of that version.
  void claim_version(std::span<std::uint8_t> frame) const {
    if (is(frame, wire::MessageType::welcome)) {
      frame[wire::kHeaderSize] = *plan_.major;
      frame[wire::kHeaderSize + 1] = plan_.minor;
    }
    wire::FrameHeader header = header_of(frame);
    header.major = *plan_.major;
    wire::seal_frame(header, frame.data());
  }

  void emit(std::span<const std::uint8_t> bytes) {
    if (!plan_.packet) return inner_.send(bytes);
    while (!bytes.empty()) {
      const std::size_t size = std::min<std::size_t>(bytes.size(), *plan_.packet);
      let_out();
      inner_.send(bytes.first(size));
      bytes = bytes.subspan(size);
    }
  }

  // A link ends its transfer when nothing waits. A second at most: the host may not read.
  void let_out() {
    const auto latest = Clock::now() + std::chrono::seconds(1);
    while (inner_.waiting() > 0 && Clock::now() < latest)
      inner_.wait_until(Clock::now() + std::chrono::milliseconds(1));
  }

  BoardLink& inner_;
  FaultPlan plan_;
  CableFaults cable_;
  bool gone_ = false;
  std::uint64_t frames_ = 0, samples_ = 0;
};

}  // namespace tacto::tests
