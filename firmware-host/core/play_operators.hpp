// SPDX-License-Identifier: Apache-2.0
// Plays in parallel: hysteresis, or what undoes it.
#pragma once

#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// Prandtl-Ishlinskii operator (Kuhnen 2003): y = straight x + sum_i weight_i p_i, where each play p_i
/// follows x at a distance of at most threshold_i: p_i <- max(x - threshold_i, min(x + threshold_i, p_i)).
/// Summed in four sums that are added at the end: the order is part of the result, and the same everywhere.
/// The inverse of such an operator is one. Without plays it is straight x. Safe in the tick.
class PlayOperators {
 public:
  /// At most kMaxPlays; comes to rest.
  void set(const wire::Hysteresis& plays) noexcept {
    straight_ = plays.straight;
    count_ = static_cast<uint8_t>((plays.count + 3U) & ~3U);
    for (uint8_t i = 0; i < count_; ++i) {
      thresholds_[i] = i < plays.count ? plays.plays[i].threshold : 0;
      weights_[i] = i < plays.count ? plays.plays[i].weight : 0;
    }
    rest();
  }
  /// Passes what comes.
  void clear() noexcept { straight_ = 1, count_ = 0; }
  /// Forgets the past: all plays at 0.
  void rest() noexcept {
    for (float& play : plays_) play = 0;
  }
  float follow(float x) noexcept {
    float sums[4] = {};
    for (uint8_t i = 0; i < count_; i = static_cast<uint8_t>(i + 4))
      for (uint8_t j = 0; j < 4; ++j) sums[j] += weights_[i + j] * step(x, i + j);
    return straight_ * x + ((sums[0] + sums[2]) + (sums[1] + sums[3]));
  }

 private:
  float step(float x, unsigned i) noexcept {
    const float above = x + thresholds_[i], below = x - thresholds_[i];
    const float most = plays_[i] < above ? plays_[i] : above;
    return plays_[i] = most > below ? most : below;
  }

  float thresholds_[wire::kMaxPlays] = {}, weights_[wire::kMaxPlays] = {}, plays_[wire::kMaxPlays] = {};
  float straight_ = 1;
  uint8_t count_ = 0;
};

}  // namespace tacto::core
