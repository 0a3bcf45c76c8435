// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/tick_view.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/core/kernel/counts_between.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::playback {
namespace {

constexpr double kSpeedOverS = 0.02, kLevelOverS = 0.1, kLateOverS = 1;
constexpr std::uint32_t kHeldBack = wire::kTickGated | wire::kTickPlaying;
constexpr std::uint32_t kPlaysOrFails = wire::kTickPlaying | wire::kTickFault;

}  // namespace

void TickView::begin(double rate_hz, double metres_per_count) {
  *this = {};
  rate_hz_ = rate_hz;
  metres_per_count_ = metres_per_count;
  share_ = 1 / (kLevelOverS * rate_hz);
}

void TickView::take(const schema::SessionTick& tick) {
  count_ = ticks_ == 0 ? tick.encoder : count_ + core::counts_between(last_.encoder, tick.encoder);
  last_ = tick;
  expected_ = tick.tick + 1;
  counts_[tick.tick % kPlaces] = tick.encoder;
  least_ = std::min(least_, count_);
  greatest_ = std::max(greatest_, count_);
  ++ticks_;
  late_ += (tick.flags & wire::kTickLate) != 0;
  const bool playing = (tick.flags & kPlaysOrFails) == wire::kTickPlaying;
  playing_ += playing;
  off_ += playing && (position_m() < from_m_ || position_m() > to_m_);
  blind_ += (tick.flags & wire::kTickBlind) != 0;
  limits_.add(tick.flags);
  gated_ += (tick.flags & kHeldBack) == kHeldBack;
  const double drive_v = tick.drive_v;
  mean_square_ += share_ * (drive_v * drive_v - mean_square_);
  peak_v_ = std::max(peak_v_, std::abs(drive_v));
  double force_n = 0;
  for (const float axis_n : tick.force_n) force_n = std::hypot(force_n, axis_n);
  force_peak_n_ = std::max(force_peak_n_, force_n);
  const auto second = static_cast<std::uint64_t>(kLateOverS * rate_hz_);
  if (ticks_ - second_from_ < second) return;
  late_part_ = static_cast<double>(late_ - late_before_) / static_cast<double>(second);
  second_from_ = ticks_;
  late_before_ = late_;
}

double TickView::speed_mps() const {
  const auto span =
      static_cast<std::uint64_t>(std::clamp(kSpeedOverS * rate_hz_, 1.0, static_cast<double>(kPlaces - 1)));
  if (ticks_ <= span) return 0;
  const double moved = core::counts_between(counts_[(last_.tick - span) % kPlaces], last_.encoder);
  return moved * metres_per_count_ * rate_hz_ / static_cast<double>(span);
}

double TickView::drive_rms_v() const {
  return std::sqrt(std::max(0.0, mean_square_));
}

}  // namespace tacto::playback
