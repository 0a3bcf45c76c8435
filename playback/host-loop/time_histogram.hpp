// SPDX-License-Identifier: GPL-3.0-or-later
// A histogram of durations: counted in the tick, read by any thread.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <string>

namespace tacto::playback {

/// The status reports the part of the ticks that are later than each of these.
inline constexpr std::array<double, 5> kLateBoundsS{10e-6, 50e-6, 100e-6, 500e-6, 1e-3};
/// The name of that part in the status: "late_over_10us_part".
std::string late_part_name(double bound_s);

/// Eight buckets per octave from 16 ns to 4 s: a quantile is exact to 12.5 %. Safe in the tick: one store.
class TimeHistogram {
 public:
  void add(std::int64_t ns) noexcept {
    std::atomic<std::uint64_t>& count = counts_[bucket(ns < 0 ? 0 : static_cast<std::uint64_t>(ns))];
    count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  /// The upper bound of the bucket that contains the quantile, s; 0 if the histogram is empty.
  double quantile_s(double part) const {
    std::uint64_t total = 0, below = 0;
    for (const auto& count : counts_) total += count.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < kBuckets && total > 0; ++i) {
      below += counts_[i].load(std::memory_order_relaxed);
      if (static_cast<double>(below) >= part * static_cast<double>(total)) return 1e-9 * upper_ns(i);
    }
    return 0;
  }
  /// The part that took longer than this, to the resolution of a bucket; 0 if the histogram is empty.
  double part_over(double seconds) const {
    std::uint64_t total = 0, over = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      const std::uint64_t count = counts_[i].load(std::memory_order_relaxed);
      total += count;
      if (1e-9 * upper_ns(i) > seconds) over += count;
    }
    return total > 0 ? static_cast<double>(over) / static_cast<double>(total) : 0;
  }

 private:
  static constexpr std::size_t kPerOctave = 8, kFirstOctave = 4, kBuckets = kPerOctave * 28;
  static std::size_t bucket(std::uint64_t ns) noexcept {
    if (ns < 16) return 0;
    const auto octave = static_cast<std::size_t>(std::bit_width(ns) - 1);
    const std::size_t within = (ns >> (octave - 3)) & 7U;
    return std::min((octave - kFirstOctave) * kPerOctave + within, kBuckets - 1);
  }
  static double upper_ns(std::size_t index) {
    const std::size_t octave = kFirstOctave + index / kPerOctave;
    return static_cast<double>((std::uint64_t{9} + index % kPerOctave) << (octave - 3));
  }
  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
};

}  // namespace tacto::playback
