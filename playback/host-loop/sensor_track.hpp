// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of the tray's sensor, with their times on the clock of the ticks.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "playback/host-loop/sample_run.hpp"

namespace tacto::playback {

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

}  // namespace tacto::playback
