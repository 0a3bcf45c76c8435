// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/finger_tracker.hpp"

namespace tacto::core {
namespace {

constexpr float kMostAlpha = 0.2F;
constexpr float kTolerableMiss = 1.5F;
constexpr int32_t kSettled = 1000;

float clamped(float value, float least, float most) noexcept {
  return value < least ? least : value > most ? most : value;
}

}  // namespace

void FingerTracker::begin(int32_t count) noexcept {
  begun_ = true;
  count_ = count;
  offset_ = 0.5F;
  speed_ = since_ = 0;
  seen_ = 0;
}

// No edge: the finger is still in its count. Once the next edge is overdue, it is slower than was thought.
void FingerTracker::stay() noexcept {
  offset_ = clamped(offset_, 0, 1);
  const float most = 1 / since_;
  speed_ = clamped(speed_, -most, most);
}

// It crossed the same border twice, or stood: what is known is where it is.
void FingerTracker::turn(int32_t moved) noexcept {
  offset_ = moved > 0 ? 0.0F : 1.0F;
  speed_ = 0;
  seen_ = 1;
}

void FingerTracker::correct(float miss, float since) noexcept {
  if (seen_ < kSettled) ++seen_;
  const auto n = static_cast<float>(seen_);
  const float steady = clamped(since / (since + setup_.smoothing_ticks), 0, kMostAlpha);
  const float line = 2 * (2 * n - 1) / (n * (n + 1));
  const bool lining = line > steady;
  const float alpha = lining ? line : steady;
  const float beta = lining ? (n > 1 ? 6 / (n * (n + 1)) : 0) : steady * steady / (2 - steady);
  offset_ = clamped(offset_ + alpha * miss, 0, 1);
  speed_ += beta * miss / since;
}

void FingerTracker::see(int32_t moved) noexcept {
  const auto way = static_cast<float>(moved);
  offset_ -= way;
  if (way * speed_ < 0) return turn(moved);
  const float border = moved > 0 ? 0.0F : 1.0F;
  const float miss = border + 0.5F * clamped(speed_, -1, 1) - offset_;
  if (seen_ > 1 && (miss > kTolerableMiss || miss < -kTolerableMiss)) {
    offset_ += miss;
    speed_ = way / since_;
    seen_ = 2;
    return;
  }
  correct(miss, since_);
}

FingerPlace FingerTracker::track(int32_t count) noexcept {
  if (!begun_) begin(count);
  // Counters run over.
  const auto moved = static_cast<int32_t>(static_cast<uint32_t>(count) - static_cast<uint32_t>(count_));
  since_ += 1;
  offset_ += speed_;
  count_ = count;
  if (moved == 0) stay();
  if (moved != 0) {
    see(moved);
    since_ = 0;
  }
  const float within = setup_.between_counts ? offset_ : 0;
  return {count, within + setup_.look_ahead_ticks * speed_, speed_};
}

}  // namespace tacto::core
