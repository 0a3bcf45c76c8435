// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/stream_blocks.hpp"

namespace tacto::core {

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

}  // namespace tacto::core
