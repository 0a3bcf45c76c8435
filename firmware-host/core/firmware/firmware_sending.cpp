// SPDX-License-Identifier: Apache-2.0
// The messages of the device, in the order: answers to commands, its description, faults, data.
#include "firmware-host/core/firmware/firmware.hpp"

namespace tacto::core {

using wire::FaultCode;

// True if the last frame has been sent and the next one may be composed.
bool Firmware::flush() noexcept {
  while (sent_ < sending_size_) {
    const size_t taken = hal_.send(hal_.board, sending_ + sent_, sending_size_ - sent_);
    if (taken == 0) return false;
    sent_ += taken;
  }
  return true;
}

template <class Message>
bool Firmware::put(const Message& message) noexcept {
  sending_size_ = wire::encode_frame(message, sequence_, sending_, sizeof sending_);
  sent_ = 0;
  ++sequence_;
  return true;
}

template <class Block>
bool Firmware::put_block(Block& block) noexcept {
  put(block.message());
  block.clear();
  return true;
}

// Once more after the data: some messages wait until all data have been sent.
bool Firmware::compose() noexcept {
  return compose_prompt() || compose_data() || compose_prompt();
}

bool Firmware::compose_prompt() noexcept {
  return compose_owed() || compose_description() || compose_fault();
}

bool Firmware::compose_owed() noexcept {
  const Owed owed = owed_;
  if (owed == Owed::nothing || (owed == Owed::answer_after_data && streams_data())) return false;
  owed_ = Owed::nothing;
  return owed == Owed::pulse ? put(pulse()) : put(answer_);
}

bool Firmware::compose_description() noexcept {
  if (described_ >= messages_of_description()) return false;
  uint16_t next = described_++;
  if (next == 0) {
    board_.about.nonce = nonce_;
    return put(board_.about);
  }
  --next;
  if (board_.axes != nullptr && next-- == 0) {
    wire::Axes axes = *board_.axes;
    axes.scene_bytes = scene_.most_bytes();
    return put(axes);
  }
  return next < board_.channel_count ? put(board_.channels[next])
                                     : put(board_.notes[next - board_.channel_count]);
}

// A converter's fault ends the stream, so it is reported after the stream's last frame.
bool Firmware::compose_fault() noexcept {
  if (!greeted_) return false;
  wire::Fault fault;
  const FaultCode drive = ticker_.supervisor().fault();
  if (drive != reported_) {
    reported_ = drive;
    fault.code = drive;
    fault.detail = ticker_.supervisor().fault_detail();
    fault.device_ticks = ticker_.fault_clock();
    return drive != FaultCode::none && put(fault);
  }
  if (stream_fault_ == FaultCode::none) stream_fault_ = ticker_.take_stream_fault();
  if (stream_fault_ == FaultCode::none || (stream_fault_ == FaultCode::converter && streams_data()))
    return false;
  fault.code = stream_fault_;
  fault.detail = stream_fault_ == FaultCode::ring_full ? ticker_.counts().lost_records : 0;
  fault.device_ticks = hal_.clock(hal_.board);
  stream_fault_ = FaultCode::none;
  return put(fault);
}

// Frames that are not sent yet.
bool Firmware::streams_data() noexcept {
  return ticker_.records().front() != nullptr || !samples_.empty();
}

bool Firmware::compose_full_blocks() noexcept {
  if (samples_.full()) return put_block(samples_);
  if (ticks_.full()) return put_block(ticks_);
  return axis_ticks_.full() && put_block(axis_ticks_);
}

// Moves records into the blocks. True if a full block was composed first.
bool Firmware::gather() noexcept {
  for (const Record* record; (record = ticker_.records().front()) != nullptr; ticker_.records().pop()) {
    const bool old = record->sampled && record->run != run_;
    if (old) continue;
    if (!samples_.fits(*record)) return put_block(samples_);
    if (!ticks_.fits(*record)) return put_block(ticks_);
    if (!axis_ticks_.fits(*record)) return put_block(axis_ticks_);
    samples_.add(*record);
    ticks_.add(*record);
    axis_ticks_.add(*record);
  }
  return false;
}

bool Firmware::compose_data() noexcept {
  if (compose_full_blocks() || gather() || compose_full_blocks()) return true;
  if (!samples_.empty() && !ticker_.streaming()) return put_block(samples_);
  if (!idle()) return false;
  if (!ticks_.empty()) return put_block(ticks_);
  return !axis_ticks_.empty() && put_block(axis_ticks_);
}

wire::Pulse Firmware::pulse() noexcept {
  const TickCounts& counts = ticker_.counts();
  const wire::DecoderCounts& damaged = decoder_.counts();
  wire::Pulse pulse;
  pulse.token = token_;
  pulse.device_ticks = hal_.clock(hal_.board);
  pulse.state = drive_state();
  pulse.fault = ticker_.supervisor().fault();
  pulse.streaming = ticker_.streaming();
  pulse.enabled = hal_.enable_closed(hal_.board);
  pulse.encoder = hal_.read_encoder(hal_.board);
  pulse.drive_v = ticker_.kernel().last_v();
  pulse.drive_queued = ticker_.drive_queue().size();
  pulse.late_ticks = counts.late;
  pulse.lost_records = counts.lost_records;
  pulse.underruns = counts.underruns;
  pulse.amplitude_limited = counts.amplitude_limited;
  pulse.slew_limited = counts.slew_limited;
  pulse.damaged_frames = damaged.oversize + damaged.bad_check + damaged.truncated;
  pulse.missing_frames = order_.lost();
  return pulse;
}

}  // namespace tacto::core
