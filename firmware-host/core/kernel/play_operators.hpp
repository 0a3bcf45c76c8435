// SPDX-License-Identifier: Apache-2.0
// A Prandtl-Ishlinskii operator, the weighted sum of play operators: a hysteresis, or its inverse.
#pragma once

#include "firmware-host/core/kernel/float4.hpp"
#include "firmware-host/core/wire/host_messages.hpp"

namespace tacto::core {

/// Prandtl-Ishlinskii operator (Kuhnen 2003): y = straight x + sum_i weight_i p_i, where each play p_i
/// follows x at a distance of at most threshold_i: p_i <- max(x - threshold_i, min(x + threshold_i, p_i)).
/// Summed in four partial sums that are added at the end: the order is fixed, so that the bits are the same
/// everywhere. The inverse of such an operator is of the same form. Without plays y = straight x; after
/// clear() y = x. Safe in the tick.
class PlayOperators {
 public:
  /// At most kMaxPlays; resets the plays.
  void set(const wire::Hysteresis& play_operators) noexcept {
    follows_ = true;
    straight_ = play_operators.straight;
    count_ = static_cast<uint8_t>((play_operators.count + 3U) & ~3U);
    for (uint8_t i = 0; i < count_; ++i) {
      thresholds_[i] = i < play_operators.count ? play_operators.play_operators[i].threshold : 0;
      weights_[i] = i < play_operators.count ? play_operators.play_operators[i].weight : 0;
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
    Float4 sum{};
    for (uint8_t i = 0; i < count_; i = static_cast<uint8_t>(i + 4))
      sum += load_float4(weights_ + i) * step(x, i);
    return straight_ * x + sum_of(sum);
  }

 private:
  Float4 step(float x, uint8_t i) noexcept {
    const Float4 threshold = load_float4(thresholds_ + i), play = load_float4(plays_ + i);
    const Float4 above = x + threshold, below = x - threshold;
    const Float4 most = play < above ? play : above;
    const Float4 next = most > below ? most : below;
    store_four(plays_ + i, next);
    return next;
  }

  float thresholds_[wire::kMaxPlays] = {}, weights_[wire::kMaxPlays] = {}, plays_[wire::kMaxPlays] = {};
  float straight_ = 1;
  uint8_t count_ = 0;
  bool follows_ = false;
};

}  // namespace tacto::core
