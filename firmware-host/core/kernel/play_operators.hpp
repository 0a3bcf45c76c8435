// SPDX-License-Identifier: Apache-2.0
// Play operators in parallel: a hysteresis, or its inverse.
#pragma once

#include "firmware-host/core/kernel/four.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// Prandtl-Ishlinskii operator (Kuhnen 2003): y = straight x + sum_i weight_i p_i, where each play p_i
/// follows x at a distance of at most threshold_i: p_i <- max(x - threshold_i, min(x + threshold_i, p_i)).
/// Summed in four sums that are added at the end: the order is part of the result, and the same everywhere.
/// The inverse of such an operator is one. Without plays it is straight x, and where none was set x. Safe in
/// the tick.
class PlayOperators {
 public:
  /// At most kMaxPlays; comes to rest.
  void set(const wire::Hysteresis& plays) noexcept {
    follows_ = true;
    straight_ = plays.straight;
    count_ = static_cast<uint8_t>((plays.count + 3U) & ~3U);
    for (uint8_t i = 0; i < count_; ++i) {
      thresholds_[i] = i < plays.count ? plays.plays[i].threshold : 0;
      weights_[i] = i < plays.count ? plays.plays[i].weight : 0;
    }
    rest();
  }
  /// Passes the input unchanged.
  void clear() noexcept { follows_ = false; }
  /// Resets all plays to 0.
  void rest() noexcept {
    for (float& play : plays_) play = 0;
  }
  float follow(float x) noexcept {
    if (!follows_) return x;
    Four sum{};
    for (uint8_t i = 0; i < count_; i = static_cast<uint8_t>(i + 4))
      sum += load_four(weights_ + i) * step(x, i);
    return straight_ * x + sum_of(sum);
  }

 private:
  Four step(float x, uint8_t i) noexcept {
    const Four threshold = load_four(thresholds_ + i), play = load_four(plays_ + i);
    const Four above = x + threshold, below = x - threshold;
    const Four most = play < above ? play : above;
    const Four next = most > below ? most : below;
    store_four(plays_ + i, next);
    return next;
  }

  float thresholds_[wire::kMaxPlays] = {}, weights_[wire::kMaxPlays] = {}, plays_[wire::kMaxPlays] = {};
  float straight_ = 1;
  uint8_t count_ = 0;
  bool follows_ = false;
};

}  // namespace tacto::core
