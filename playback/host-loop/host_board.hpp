// SPDX-License-Identifier: GPL-3.0-or-later
// The firmware's core on this computer. Another thread acts as its hardware; they exchange data without
// locks.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/kernel/ring.hpp"
#include "firmware-host/link/client.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/link/memory_transport.hpp"
#include "playback/host-loop/tray_samples.hpp"

namespace tacto::playback {

// The encoder's counts as a device made them, read at the pace of another clock.

/// A device sends its counts in groups, and by its own clock. A tick that used the newest count would get a
/// position that stops and jumps. So each count is stored with its period, and each tick (also after missed
/// ones) advances the reading place by one period, on a line between two counts. Its lag behind the newest
/// count is the smallest with which it does not overtake that count within half a second; to reduce the lag
/// the place moves at most 2 % faster, which is not perceptible. Beyond the newest count it continues on a
/// straight line for 2 ms, then it stops. If the lag exceeds 20 ms, as after a stall, the place is set to a
/// reserve behind the newest count. One thread calls put(), another one the rest; no function locks,
/// allocates or calls the system.
class CountTrack {
 public:
  explicit CountTrack(double rate_hz) noexcept;
  /// How many periods come as one group: the lag at the beginning. Call before see() and begin().
  void set_reserve(std::uint32_t periods) noexcept;
  /// Call in the order of the periods; skipped periods are interpolated linearly. `made_ns`: when the device
  /// sampled it.
  void put(std::uint32_t period, std::int32_t count, std::int64_t made_ns) noexcept;

  /// The count that a tick uses.
  struct Sight {
    std::int32_t count = 0;
    std::uint32_t passed = 0;  ///< periods since the see() before; usually 1
    std::int64_t made_ns = 0;
    bool fresh = false;  ///< a new count came since then
    /// The place in time: this period plus a fraction of the next one.
    std::uint32_t period = 0;
    float part = 0;
  };
  /// Advances by one period.
  Sight see() noexcept;
  /// Sets the place to the reserve behind the newest count; see() continues from there.
  Sight begin() noexcept;

 private:
  static constexpr std::uint32_t kKept = 1024;
  std::int32_t kept(std::uint32_t period) const noexcept {
    return counts_[period % kKept].load(std::memory_order_relaxed);
  }
  std::int32_t count_here(std::uint32_t newest) const noexcept;
  void keep_near(float lag) noexcept;

  std::array<std::atomic<std::int32_t>, kKept> counts_{};
  std::atomic<std::uint32_t> newest_{0};
  std::atomic<std::int64_t> newest_ns_{0};
  std::uint32_t put_ = 0;  // of the thread that calls put()
  bool begun_ = false;     // of the thread that calls put()
  // Of the thread that calls see().
  std::int64_t period_ns_;
  std::int32_t most_behind_, most_beyond_, window_;
  std::uint32_t reserve_ = 0, at_ = 0, seen_ = 0;
  float part_ = 0, drift_ = 0, least_;
  std::int32_t in_window_ = 0;
};

// The samples of the tray's sensor, with their times on the clock of the ticks.

/// If the loop is closed on the host, a tick plays the count that the device sampled in one of its periods
/// (CountTrack). A sample of the same period belongs to the same place of the finger, so it gets that tick's
/// time; one between the periods of two ticks gets a time between theirs. The carrier thread calls put(), the
/// real-time thread read_at(), the player's thread take(); put() and read_at() do not lock, allocate or call
/// the system.
class SensorTrack {
 public:
  explicit SensorTrack(double rate_hz) : period_ns_(1e9 / rate_hz) {}

  void put(std::uint32_t period, std::int32_t code) noexcept {
    codes_[period % kKept].store(tagged(period, static_cast<std::uint32_t>(code)), std::memory_order_release);
  }
  /// Records that a tick used the count of `period` plus a fraction of the next one.
  void read_at(std::uint64_t tick, std::uint32_t period, float part) noexcept {
    places_[tick % kTicks].store(tagged(period, std::bit_cast<std::uint32_t>(part)),
                                 std::memory_order_release);
  }
  /// Appends the samples up to the period that this tick used, each once. `tick`: one of the last 16,384, in
  /// order; tick 0 starts again. Samples that the device has not sent yet are appended at a later tick.
  void take(std::uint64_t tick, std::int64_t due_ns, SampleRun& into) {
    const std::uint64_t place = places_[tick % kTicks].load(std::memory_order_acquire);
    const auto period = static_cast<std::uint32_t>(place >> 32);
    const double part = std::bit_cast<float>(static_cast<std::uint32_t>(place));
    if (tick == 0) first_ = next_ = period;
    for (; static_cast<std::int32_t>(period - next_) >= 0; ++next_) {
      const auto behind = static_cast<double>(period - next_);
      const auto code = code_of(next_);
      if (!code && behind < kOverdueFactor) return;
      const double time_ns = static_cast<double>(due_ns) - (behind + part) * period_ns_;
      if (code) into.add(next_ - first_, std::llround(time_ns), *code);
    }
  }

 private:
  static constexpr std::uint32_t kKept = 4096, kTicks = 16384;
  static constexpr double kOverdueFactor = 256;  // periods; the size of the device's ring
  static std::uint64_t tagged(std::uint32_t tag, std::uint32_t value) noexcept {
    return std::uint64_t{tag} << 32 | value;
  }
  std::optional<std::int32_t> code_of(std::uint32_t period) const {
    const std::uint64_t kept = codes_[period % kKept].load(std::memory_order_acquire);
    if (static_cast<std::uint32_t>(kept >> 32) != period) return std::nullopt;
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(kept));
  }

  double period_ns_;
  std::array<std::atomic<std::uint64_t>, kKept> codes_{};
  std::array<std::atomic<std::uint64_t>, kTicks> places_{};
  std::uint32_t first_ = 0, next_ = 0;  // of the player's thread
};

/// The drive of a tick, and the tick's time.
struct TimedDrive {
  std::int64_t time_ns = 0;
  float drive_v = 0;
  std::int64_t reading_ns = 0;  ///< when the device sampled the count
};

/// The real-time thread calls tick() and rest(); other threads use the inputs and outputs.
class HostBoard {
 public:
  static constexpr std::uint32_t kClockHz = 1'000'000'000;

  /// Has the description of the device, but a single tick rate.
  HostBoard(const firmware_host::Description& device, double rate_hz);
  HostBoard(const HostBoard&) = delete;
  HostBoard& operator=(const HostBoard&) = delete;

  /// Safe in the tick: neither allocates, locks nor calls the system.
  void tick(std::int64_t now_ns, std::int64_t late_ns) noexcept;
  /// Answers the player between runs.
  void rest(std::int64_t now_ns) noexcept;
  bool ticking() const noexcept { return ticking_; }

  // For other threads.
  /// Each count that the device sampled, in order, with the device's period.
  void put_count(std::uint32_t period, std::int32_t encoder, std::int64_t made_ns) noexcept {
    counts_.put(period, encoder, made_ns);
  }
  /// Call before the first tick; see CountTrack::set_reserve().
  void set_reserve(std::uint32_t periods) noexcept { counts_.set_reserve(periods); }
  /// Call before put_count(): the code of the tray's sensor in that period.
  void put_sample(std::uint32_t period, std::int32_t code) noexcept { sensor_.put(period, code); }
  /// The sensor's samples up to the count that a tick used: SensorTrack::take(). For the player's thread.
  void take_samples(std::uint64_t tick, SampleRun& into) { sensor_.take(tick, due_ns(tick), into); }
  void set_enabled(bool enabled) noexcept { enabled_.store(enabled, std::memory_order_release); }
  /// Call before put_count(): the codes of the device's channels in the same period.
  void set_codes(std::span<const std::int32_t> codes) noexcept {
    for (std::size_t i = 0; i < std::min(codes.size(), codes_.size()); ++i)
      codes_[i].store(codes[i], std::memory_order_relaxed);
    coded_.store(true, std::memory_order_release);
  }
  firmware_host::CoreLink& link() noexcept { return link_; }
  core::Ring<TimedDrive, 1024>& drives() noexcept { return drives_; }
  bool wants_drive() const noexcept { return wants_drive_.load(std::memory_order_acquire); }
  /// For one of the last 16,384 ticks since arming.
  std::int32_t lateness_ns(std::uint64_t tick) const noexcept {
    return lateness_[tick % kLatenesses].load(std::memory_order_relaxed);
  }
  /// When that tick was due, by the clock of kClockHz.
  std::int64_t due_ns(std::uint64_t tick) const noexcept {
    return dues_[tick % kLatenesses].load(std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t kLatenesses = 16384;
  static HostBoard& of(void* board) noexcept { return *static_cast<HostBoard*>(board); }
  core::Board board();
  core::Hal hal();
  bool read_codes(std::int32_t* codes) const noexcept;
  void look_at_count(std::int64_t late_ns) noexcept;

  firmware_host::Description about_;
  firmware_host::HostedProfile profile_;
  CountTrack counts_;
  SensorTrack sensor_;
  std::atomic<bool> enabled_{false}, wants_drive_{false}, coded_{false};
  firmware_host::CoreLink link_;
  core::Ring<TimedDrive, 1024> drives_;
  std::array<std::atomic<std::int32_t>, kLatenesses> lateness_{};
  std::array<std::atomic<std::int64_t>, kLatenesses> dues_{};
  std::array<std::atomic<std::int32_t>, wire::kMaxChannels> codes_{};
  std::int64_t period_ns_;
  std::uint32_t age_ = 0, unseen_ = 0;  // in periods
  std::int32_t encoder_ = 0;
  std::int64_t reading_ns_ = 0;
  std::uint32_t read_period_ = 0;
  float read_part_ = 0;
  std::uint64_t ticks_ = 0;  // since arming
  std::int64_t now_ns_ = 0, began_ns_ = 0;
  float drive_v_ = 0;
  bool ticking_ = false;
  std::unique_ptr<core::Firmware> firmware_;
};

}  // namespace tacto::playback
