// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/kernel/finger_tracker.hpp"

#include "firmware-host/core/kernel/counts_between.hpp"

namespace tacto::core {
namespace {

constexpr float kOutlierAlpha = 0.2F,
                kMaxOutlierAlpha = 0.5F;  // alpha if the residual exceeds the uncertainty
constexpr float kEdgeNoise = 0.1F;        // counts: standard error of an edge's position
constexpr float kRestartResidual = 4;
constexpr float kOverdueFactor = 1.5F;
constexpr int32_t kSettled = 400;

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

// No edge in this tick: if the next one is long overdue, the finger is slower than estimated.
void FingerTracker::stay() noexcept {
  const float most = kOverdueFactor / since_;
  speed_ = clamped(speed_, -most, most);
  offset_ = clamped(offset_, -1, 2);
}

// The finger crossed the same border twice, or was at rest: only its position is known.
void FingerTracker::turn(int32_t moved) noexcept {
  offset_ = moved > 0 ? 0.0F : 1.0F;
  speed_ = 0;
  seen_ = 1;
}

FingerTracker::Gains FingerTracker::gains_of(float alpha) noexcept {
  return {alpha, alpha * alpha / (2 - alpha)};
}

void FingerTracker::set(const TrackerSetup& setup) noexcept {
  setup_ = setup;
  begun_ = false;
  every_tick_ = gains_of(clamped(1 / (1 + setup.smoothing_ticks), 0, kMostAlpha));
}

// The gains of the first edges, then those for the residual of this edge.
FingerTracker::Gains FingerTracker::gains(float miss, float since) noexcept {
  const float per_tick = clamped(speed(), 0, 1);  // uncertainty: a tick's motion, at most one count
  const float excess = (miss < 0 ? -miss : miss) - kEdgeNoise - 0.5F * per_tick;
  const float haste = kOutlierAlpha * (2 - per_tick);
  const float hasty = excess > 0 ? clamped(haste + haste * excess, 0, kMaxOutlierAlpha) : 0;
  if (seen_ >= kSettled && hasty <= every_tick_.alpha && since <= 1) return every_tick_;
  const float usual = clamped(since / (since + setup_.smoothing_ticks), 0, kMostAlpha);
  const float steady = hasty > usual ? hasty : usual;
  if (seen_ >= kSettled) return gains_of(steady);
  const auto n = static_cast<float>(++seen_);
  const float line = 2 * (2 * n - 1) / (n * (n + 1));
  if (line <= steady) return gains_of(steady);
  return {line, n > 1 ? 6 / (n * (n + 1)) : 0};
}

void FingerTracker::correct(float miss, float since) noexcept {
  const Gains by = gains(miss, since);
  offset_ += by.alpha * miss;
  speed_ += since > 1 ? by.beta * miss / since : by.beta * miss;
}

void FingerTracker::see(int32_t moved) noexcept {
  const auto way = static_cast<float>(moved);
  offset_ -= way;
  if (way * speed_ < 0) return turn(moved);
  const float border = moved > 0 ? 0.0F : 1.0F;
  const float miss = border + 0.5F * clamped(speed_, -1, 1) - offset_;
  if (seen_ > 1 && (miss > kRestartResidual || miss < -kRestartResidual)) {
    offset_ += miss;
    speed_ = way / since_;
    seen_ = 2;
    return;
  }
  correct(miss, since_);
}

FingerPlace FingerTracker::track(int32_t count) noexcept {
  if (!begun_) begin(count);
  const int32_t moved = counts_between(count_, count);
  since_ += 1;
  offset_ += speed_;
  count_ = count;
  if (moved == 0) stay();
  if (moved != 0) {
    see(moved);
    since_ = 0;
  }
  const float within = setup_.between_counts ? clamped(offset_, 0, 1) : 0;
  return {count, within + setup_.look_ahead_ticks * speed_, speed_};
}

}  // namespace tacto::core
