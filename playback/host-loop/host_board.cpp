// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/host-loop/host_board.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware-host/link/encoder_counts.hpp"
#include "firmware-host/link/wire_fields.hpp"

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

HostBoard::HostBoard(const firmware_host::Description& device, double rate_hz)
    : about_(device),
      counts_(rate_hz),
      sensor_(rate_hz),
      period_ns_(static_cast<std::int64_t>(1e9 / rate_hz)) {
  wire::Welcome& welcome = about_.welcome;
  welcome.clock_hz = kClockHz;
  welcome.default_rate_millihertz = welcome.least_rate_millihertz = welcome.most_rate_millihertz =
      firmware_host::millihertz(rate_hz);
  firmware_ = std::make_unique<core::Firmware>(board(), hal());
}

core::Board HostBoard::board() {
  return firmware_host::board_of(about_.welcome, about_.channels, about_.notes, profile_);
}

core::Hal HostBoard::hal() {
  core::Hal hal;
  hal.board = this;
  hal.read_encoder = [](void* b) noexcept { return of(b).encoder_; };
  hal.encoder_unseen = [](void* b) noexcept { return of(b).unseen_; };
  hal.read_channels = [](void* b, std::int32_t* codes) noexcept { return of(b).read_codes(codes); };
  hal.write_drive = [](void* b, float volts) noexcept { of(b).drive_v_ = volts; };
  hal.enable_closed = [](void* b) noexcept { return of(b).enabled_.load(std::memory_order_acquire); };
  hal.clock = [](void* b) noexcept { return static_cast<std::uint64_t>(of(b).now_ns_ - of(b).began_ns_); };
  hal.set_rate = [](void* b, std::uint32_t rate) noexcept {
    of(b).ticking_ = rate > 0;
    of(b).ticks_ = 0;
    of(b).age_ = 0;
  };
  hal.receive = [](void* b, std::uint8_t* bytes, std::size_t size) noexcept {
    return of(b).link_.to_core.take({bytes, size});
  };
  hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
    return of(b).link_.from_core.put({bytes, size});
  };
  hal.restart = [](void*) noexcept {};
  return hal;
}

// The newest codes, for the contact gate. If no new codes come, no new counts come either, and the drive
// falls.
bool HostBoard::read_codes(std::int32_t* codes) const noexcept {
  for (std::size_t i = 0; i < about_.channels.size(); ++i)
    codes[i] = codes_[i].load(std::memory_order_relaxed);
  return coded_.load(std::memory_order_acquire);
}

void HostBoard::rest(std::int64_t now_ns) noexcept {
  if (began_ns_ == 0) began_ns_ = now_ns;
  now_ns_ = now_ns;
  encoder_ = counts_.begin().count;
  firmware_->poll();
  wants_drive_.store(ticking_, std::memory_order_release);
}

// Unseen periods are those in which no count came, those that this thread missed, and those of the device of
// which only a later count was received.
void HostBoard::look_at_count(std::int64_t late_ns) noexcept {
  const std::uint32_t slept = late_ns >= period_ns_ ? static_cast<std::uint32_t>(late_ns / period_ns_) : 0;
  const CountTrack::Sight sight = counts_.see();
  encoder_ = sight.count;
  reading_ns_ = sight.made_ns;
  read_period_ = sight.period, read_part_ = sight.part;
  age_ += slept + (sight.fresh ? 0U : 1U);
  unseen_ = std::max(age_, sight.passed > 0 ? sight.passed - 1 : 0);
  if (sight.fresh) age_ = 0;
}

// A drive for which the ring has no space is dropped.
void HostBoard::tick(std::int64_t now_ns, std::int64_t late_ns) noexcept {
  now_ns_ = now_ns;
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  const std::size_t slot = ticks_++ % kLatenesses;
  lateness_[slot].store(static_cast<std::int32_t>(std::min(late_ns, kMost)), std::memory_order_relaxed);
  // Missed periods are skipped: the tick belongs to the last of them.
  dues_[slot].store(now_ns - began_ns_ - late_ns % period_ns_, std::memory_order_relaxed);
  look_at_count(late_ns);
  sensor_.read_at(ticks_ - 1, read_period_, read_part_);
  firmware_->tick();
  if (TimedDrive* place = drives_.place(); place != nullptr) {
    *place = {now_ns, drive_v_, reading_ns_};
    drives_.push();
  }
  firmware_->poll();
  wants_drive_.store(ticking_, std::memory_order_release);
}

}  // namespace tacto::playback
