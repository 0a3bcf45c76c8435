// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/host-loop/count_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware-host/link/encoder_counts.hpp"

namespace tacto::playback {
namespace {

constexpr double kMostBehindS = 0.02, kMostBeyondS = 2e-3, kWindowS = 0.5;
constexpr float kMostDrift = 0.02F;  // of a period, per tick
constexpr float kSpare = 0.5F;       // periods between reading place and newest count, at least
constexpr float kNone = std::numeric_limits<float>::max();

std::int32_t periods_in(double time_s, double rate_hz) {
  return std::max(2, static_cast<std::int32_t>(time_s * rate_hz));
}

// A counter that passes 2^31 wraps around.
std::int32_t wrapped_sum(std::int32_t count, std::int32_t way) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(count) + static_cast<std::uint32_t>(way));
}

}  // namespace

CountTrack::CountTrack(double rate_hz) noexcept
    : period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)),
      most_behind_(std::min<std::int32_t>(periods_in(kMostBehindS, rate_hz), kKept / 2)),
      most_beyond_(periods_in(kMostBeyondS, rate_hz)),
      window_(periods_in(kWindowS, rate_hz)),
      least_(kNone) {}

void CountTrack::set_reserve(std::uint32_t periods) noexcept {
  reserve_ = std::min(periods, static_cast<std::uint32_t>(most_behind_) / 2);
}

void CountTrack::put(std::uint32_t period, std::int32_t count, std::int64_t made_ns) noexcept {
  if (!begun_)
    for (auto& stood : counts_) stood.store(count, std::memory_order_relaxed);
  const std::uint32_t passed = begun_ ? period - put_ : 1;
  const std::int32_t before = kept(put_);
  const std::int64_t way = firmware_host::counts_between(before, count);
  for (std::uint32_t i = passed > kKept ? passed - kKept : 1; i < passed; ++i)
    counts_[(put_ + i) % kKept].store(wrapped_sum(before, static_cast<std::int32_t>(way * i / passed)),
                                      std::memory_order_relaxed);
  counts_[period % kKept].store(count, std::memory_order_relaxed);
  newest_ns_.store(made_ns, std::memory_order_relaxed);
  newest_.store(period, std::memory_order_release);
  put_ = period, begun_ = true;
}

CountTrack::Sight CountTrack::begin() noexcept {
  seen_ = newest_.load(std::memory_order_acquire);
  at_ = seen_ - reserve_;
  part_ = drift_ = 0, least_ = kNone, in_window_ = 0;
  return {kept(at_), 0, newest_ns_.load(std::memory_order_relaxed) - reserve_ * period_ns_, true, at_, 0};
}

// The position of a count is the middle of its step.
std::int32_t CountTrack::count_here(std::uint32_t newest) const noexcept {
  const auto beyond = static_cast<std::int32_t>(at_ - newest);
  const std::uint32_t from = beyond >= 0 ? newest - 1 : at_;
  const float along = part_ + static_cast<float>(beyond >= 0 ? beyond + 1 : 0);
  const auto way = static_cast<float>(firmware_host::counts_between(kept(from), kept(from + 1)));
  return wrapped_sum(kept(from), static_cast<std::int32_t>(std::floor(0.5F + along * way)));
}

// Controls the smallest lag within a window: a lag that is too large is latency, and the next window reduces
// it; one that is too small is increased at once.
void CountTrack::keep_near(float lag) noexcept {
  if (lag < 0) {
    part_ -= kMostDrift;
    drift_ = 0, least_ = kNone, in_window_ = 0;
    return;
  }
  least_ = std::min(least_, lag);
  if (++in_window_ < window_) return;
  drift_ = std::clamp((least_ - kSpare) / static_cast<float>(window_), 0.0F, kMostDrift);
  least_ = kNone, in_window_ = 0;
}

CountTrack::Sight CountTrack::see() noexcept {
  const std::uint32_t newest = newest_.load(std::memory_order_acquire), before = at_;
  const bool fresh = newest != seen_;
  seen_ = newest;
  part_ += drift_;
  const float whole = std::floor(part_);
  at_ += 1 + static_cast<std::uint32_t>(static_cast<std::int32_t>(whole));
  part_ -= whole;
  const auto ahead = static_cast<std::int32_t>(newest - at_);
  if (ahead > most_behind_ || ahead < -most_beyond_) {
    at_ = ahead > 0 ? newest - reserve_ : newest + static_cast<std::uint32_t>(most_beyond_);
    part_ = 0;
  }
  const auto left = static_cast<std::int32_t>(newest - at_);
  keep_near(static_cast<float>(left) - part_);
  const std::int64_t made_ns = newest_ns_.load(std::memory_order_relaxed) - left * period_ns_;
  return {count_here(newest), at_ - before, made_ns, fresh, at_, part_};
}

}  // namespace tacto::playback
