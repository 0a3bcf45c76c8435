// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/firmware.hpp"

namespace tacto::core {

using wire::AnswerCode;

void SampleBlock::begin(uint8_t channels, uint8_t frames) noexcept {
  frames_ = frames;
  block_.channels = channels;
  block_.count = 0;
}

bool SampleBlock::fits(const Record& record) const noexcept {
  return !record.sampled || empty() || (!full() && record.frame == block_.first_frame + block_.count);
}

void SampleBlock::add(const Record& record) noexcept {
  if (!record.sampled) return;
  if (empty()) {
    block_.first_frame = record.frame;
    block_.device_ticks = record.clock;
    block_.enabled = 0;
  }
  if ((record.flags & wire::kTickEnabled) != 0) block_.enabled |= UINT32_C(1) << block_.count;
  int32_t* codes = block_.codes + size_t{block_.count} * block_.channels;
  for (uint8_t i = 0; i < block_.channels; ++i) codes[i] = record.codes[i];
  ++block_.count;
}

bool TickBlock::fits(const Record& record) const noexcept {
  return !record.driven || record.axes > 0 || empty() ||
         (!full() && record.tick == block_.first_tick + block_.count);
}

void TickBlock::add(const Record& record) noexcept {
  if (!record.driven || record.axes > 0) return;
  if (empty()) {
    block_.first_tick = record.tick;
    block_.device_ticks = record.clock;
  }
  block_.ticks[block_.count++] = {record.encoder, record.drive_v, record.flags};
}

bool AxisTickBlock::fits(const Record& record) const noexcept {
  return record.axes == 0 || empty() || (!full() && record.tick == block_.first_tick + block_.count);
}

void AxisTickBlock::add(const Record& record) noexcept {
  if (record.axes == 0) return;
  if (empty()) {
    block_.first_tick = record.tick;
    block_.device_ticks = record.clock;
  }
  wire::AxisTick& tick = block_.ticks[block_.count++];
  for (uint8_t i = 0; i < record.axes; ++i) {
    tick.counts[i] = record.counts[i];
    tick.force_n[i] = record.force_n[i];
  }
  tick.flags = record.flags;
}

// The first part of a block begins it anew.
Reply SceneUpload::part(const wire::ScenePart& message) noexcept {
  if (message.bytes > most_bytes()) return {AnswerCode::too_large, most_bytes()};
  if (message.first == 0) {
    forget();
    bytes_ = message.bytes;
  }
  if (message.bytes != bytes_) return bad_value(0);
  if (message.first > here_) return {AnswerCode::incomplete, here_};
  if (message.count > bytes_ - message.first) return {AnswerCode::too_large, bytes_};
  complete_ = false;
  __builtin_memcpy(reinterpret_cast<uint8_t*>(memory_) + message.first, message.data, message.count);
  const uint32_t end = message.first + message.count;
  here_ = end > here_ ? end : here_;
  if (here_ < bytes_) return {};
  const SceneFault fault = read_scene_block(memory_, bytes_, view_);
  // Tables that the hand changes are there twice.
  if (fault == SceneFault::none && view_.live_words() > words_ - bytes_ / 4)
    return {AnswerCode::too_large, most_bytes() / 2};
  complete_ = fault == SceneFault::none;
  return complete_ ? Reply{} : Reply{AnswerCode::check_failed, static_cast<uint32_t>(fault)};
}

Firmware::Firmware(const Board& board, const Hal& hal) noexcept
    : board_(board),
      hal_(hal),
      ticker_(hal),
      scene_(board.profile_memory, board.profile_samples),
      upload_(board.profile_memory, board.profile_samples),
      next_(board.profile_memory, board.profile_samples) {
  wire::Welcome& about = board_.about;
  about.major = wire::kProtocolMajor;
  about.minor = wire::kProtocolMinor;
  about.features |= wire::kFeatureTextures | wire::kFeatureHysteresis;
  if (board.axes != nullptr) about.features |= wire::kFeatureForces;
  about.channels = board.channel_count;
  about.notes = board.note_count;
  about.most_sections = wire::kMaxSections;
  about.ring_records = kRingRecords;
  about.profile_samples = board.profile_samples;
  about.drive_queue = kDriveQueue;
  described_ = messages_of_description();
  filters_.count = 0;
}

uint16_t Firmware::messages_of_description() const noexcept {
  return static_cast<uint16_t>(1 + (board_.axes != nullptr ? 1 : 0) + board_.channel_count +
                               board_.note_count);
}

void Firmware::poll() noexcept {
  do {
    while (flush() && compose()) {
    }
  } while (receive());
  rest_if_unused();
}

// One command at a time: the next one is read after this answer has been sent.
bool Firmware::receive() noexcept {
  if (owed_ != Owed::nothing) return false;
  if (received_used_ == received_size_) {
    received_size_ = hal_.receive(hal_.board, received_, sizeof received_);
    received_used_ = 0;
  }
  wire::Frame frame;
  size_t used = 0;
  const wire::Arrival arrival =
      decoder_.take(received_ + received_used_, received_size_ - received_used_, used, frame);
  received_used_ += used;
  if (arrival == wire::Arrival::frame) accept(frame);
  return arrival != wire::Arrival::nothing || received_size_ > 0;
}

void Firmware::accept(const wire::Frame& frame) noexcept {
  const bool hello = frame.header.type == static_cast<uint8_t>(wire::MessageType::hello);
  if (hello) order_.expect_any();
  if (order_.check(frame.header.sequence) == wire::Order::stale) return;
  if (hello) return greet(frame);
  ticker_.supervisor().heard();
  obey(frame);
}

void Firmware::rest_if_unused() noexcept {
  if (rate_millihertz_ == 0 || ticker_.streaming() || !idle()) return;
  rate_millihertz_ = 0;
  hal_.set_rate(hal_.board, 0);
}

}  // namespace tacto::core
