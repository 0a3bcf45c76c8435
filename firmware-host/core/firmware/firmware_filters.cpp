// SPDX-License-Identifier: Apache-2.0
// Commands that set filters, tracking, energy limit and contact gate, and when they are refused.
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {
namespace {
constexpr float kMostTicksAhead = 2000, kLongestWindowS = 3600, kMostCode = 2147483648.0F;
}

Reply Firmware::filters(const wire::Filters& message) noexcept {
  for (uint8_t i = 0; i < message.count; ++i)
    if (!is_stable(message.sections[i])) return bad_value(i);
  filters_ = message;
  return {};
}

Reply Firmware::taps(const wire::Taps& message) noexcept {
  for (uint16_t i = 0; i < message.count; ++i)
    if (!is_finite(message.taps[i])) return bad_value(i);
  taps_ = message;
  return {};
}

Reply Firmware::hysteresis(const wire::Hysteresis& message) noexcept {
  if (!is_finite(message.straight)) return bad_value(2);
  for (uint8_t i = 0; i < message.count; ++i) {
    if (!within(message.play_operators[i].threshold, 0, kLargestFloat)) return bad_value(3 + 2U * i);
    if (!is_finite(message.play_operators[i].weight)) return bad_value(4 + 2U * i);
  }
  hysteresis_ = message;
  return {};
}

Reply Firmware::tracking(const wire::Tracking& message) noexcept {
  if (message.between_counts > 1) return bad_value(0);
  if (!within(message.look_ahead_ticks, 0, kMostTicksAhead)) return bad_value(2);
  if (!within(message.smoothing_ticks, 0, kLargestFloat)) return bad_value(3);
  if (!within(message.full_detail_counts_per_tick, 0, kLargestFloat)) return bad_value(4);
  (idle() ? tracking_ : next_tracking_) = message;
  return {};
}

Reply Firmware::energy(const wire::Energy& message) noexcept {
  if (!within(message.rms_v, 0, kLargestFloat)) return bad_value(0);
  if (!within(message.window_s, 0, kLongestWindowS)) return bad_value(1);
  energy_ = message;
  return {};
}

Reply Firmware::contact(const wire::Contact& message) noexcept {
  if (message.channel >= board_.channel_count) return bad_value(0);
  if (!within(message.on_n, 0, kLargestFloat)) return bad_value(2);
  if (!within(message.off_n, 0, message.on_n)) return bad_value(3);
  const float most_n = message.newtons_per_code * kMostCode;  // every code must give a finite force
  if (!is_finite(most_n + message.offset_n) || !is_finite(most_n - message.offset_n)) return bad_value(4);
  contact_ = message;
  return {};
}

}  // namespace tacto::core
