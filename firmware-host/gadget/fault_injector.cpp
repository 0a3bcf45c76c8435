// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/fault_injector.hpp"

#include <algorithm>

#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::firmware_host {
namespace {

bool falls_on(const std::optional<std::uint64_t>& every, std::uint64_t count) {
  return every && count % *every == 0;
}

wire::FrameHeader header_of(std::span<const std::uint8_t> frame) {
  wire::FrameHeader header;
  wire::read_header(frame.data(), header);
  return header;
}

std::size_t size_of(std::span<const std::uint8_t> frame) {
  return wire::kHeaderSize + header_of(frame).length + wire::kCheckSize;
}

bool is(std::span<const std::uint8_t> frame, wire::MessageType type) {
  return header_of(frame).type == static_cast<std::uint8_t>(type);
}

// Another bit each time, so that errors occur in header, payload and check.
void turn_bit(std::span<std::uint8_t> frame, std::uint64_t count) {
  const std::uint64_t bit = count * 7919 % (frame.size() * 8);
  frame[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
}

}  // namespace

void FaultInjector::pass(std::span<const std::uint8_t> frames) {
  while (!frames.empty()) {
    const std::size_t size = size_of(frames);
    pass_frame(frames.first(size));
    frames = frames.subspan(size);
  }
}

void FaultInjector::pass_frame(std::span<const std::uint8_t> frame) {
  if (plan_.silent_after && frames_ >= *plan_.silent_after) return;
  if (frames_ == plan_.unplug_after) send_(frame.first(frame.size() / 2), BurstEnd::unplug);
  if (frames_ == plan_.stall_after) send_({}, BurstEnd::stall);
  ++frames_;
  std::vector<std::uint8_t> bytes(frame.begin(), frame.end());
  if (plan_.major) claim_version(bytes);
  if (is(frame, wire::MessageType::samples)) return pass_samples(bytes);
  emit(bytes);
}

void FaultInjector::pass_samples(std::vector<std::uint8_t>& frame) {
  ++samples_;
  if (falls_on(plan_.drop_every, samples_)) return;
  if (falls_on(plan_.corrupt_every, samples_)) turn_bit(frame, samples_);
  if (falls_on(plan_.truncate_every, samples_)) frame.resize(frame.size() / 2);
  emit(frame);
  if (falls_on(plan_.repeat_every, samples_)) emit(frame);
}

// Changes a frame to one of a device of that version.
void FaultInjector::claim_version(std::span<std::uint8_t> frame) const {
  if (is(frame, wire::MessageType::welcome)) {
    frame[wire::kHeaderSize] = *plan_.major;
    frame[wire::kHeaderSize + 1] = plan_.minor;
  }
  wire::FrameHeader header = header_of(frame);
  header.major = *plan_.major;
  wire::seal_frame(header, frame.data());
}

void FaultInjector::emit(std::span<const std::uint8_t> bytes) {
  if (!plan_.packet) return send_(bytes, BurstEnd::none);
  while (!bytes.empty()) {
    const std::size_t size = std::min<std::size_t>(bytes.size(), *plan_.packet);
    send_(bytes.first(size), BurstEnd::end);
    bytes = bytes.subspan(size);
  }
}

}  // namespace tacto::firmware_host
