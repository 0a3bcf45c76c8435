// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/encoder_watch.hpp"

#include "firmware-host/core/kernel/counts_between.hpp"

namespace tacto::core {

void EncoderWatch::arm(uint32_t counts_per_tick, float rate_hz, int32_t encoder) noexcept {
  *this = {};
  counts_per_tick_ = counts_per_tick;
  blind_ticks_ = blind_ticks(rate_hz);
  count_ = encoder;
}

int32_t EncoderWatch::see(int32_t encoder, uint32_t unseen, bool at_rest) noexcept {
  const bool was_blind = blind_;
  blind_ = unseen > blind_ticks_ || (was_blind && !at_rest);
  found_ = was_blind && !blind_;
  jump_ = 0;
  if (blind_) return count_;
  const int64_t moved = counts_between(count_, encoder);
  const auto distance = static_cast<uint64_t>(moved < 0 ? -moved : moved);
  if (!found_ && distance > counts_per_tick_ * (uint64_t{1} + unseen))
    jump_ = static_cast<uint32_t>(distance);
  count_ = encoder;
  return count_;
}

}  // namespace tacto::core
