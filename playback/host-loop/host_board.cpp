// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/host-loop/host_board.hpp"

#include <algorithm>
#include <limits>

#include "firmware-host/link/wire_fields.hpp"

namespace tacto::playback {

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
    return of(b).from_player_.take({bytes, size});
  };
  hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
    return of(b).to_player_.put({bytes, size});
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
