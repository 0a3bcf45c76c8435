// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the ticks in which the limits changed the drive, and computes the RMS of what they removed.
#pragma once

#include <algorithm>
#include <cstdint>

#include "data-schema/base/decibels.hpp"
#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::playback {

// Counts the ticks in which a limit changed the drive, from arming to disarming, with the onset and the
// release.

/// A tick may count in several of these. add() does not allocate: safe in the tick.
struct LimitCounts {
  std::uint64_t amplitude = 0;          ///< drive or force was limited at its peak
  std::uint64_t slew = 0;               ///< ... in its change
  std::uint64_t energy = 0;             ///< ... to keep the limit of its RMS
  std::uint64_t amplitude_or_slew = 0;  ///< ticks with one of these two, or both

  void add(std::uint32_t flags) noexcept {
    amplitude += (flags & wire::kTickAmplitudeLimited) != 0;
    slew += (flags & wire::kTickSlewLimited) != 0;
    energy += (flags & wire::kTickEnergyLimited) != 0;
    amplitude_or_slew += (flags & (wire::kTickAmplitudeLimited | wire::kTickSlewLimited)) != 0;
  }
  void add(const LimitCounts& other) noexcept {
    amplitude += other.amplitude, slew += other.slew, energy += other.energy;
    amplitude_or_slew += other.amplitude_or_slew;
  }
};

/// Call for each tick's output. noexcept and without allocation: safe in the tick.
class LimitTally {
 public:
  void add(const core::TickOutput& output) noexcept {
    ++ticks_;
    limits_.add(output.flags);
    gated_ += (output.flags & wire::kTickGated) != 0;
    const double unlimited_v = output.unlimited_v, removed_v = unlimited_v - output.drive_v;
    unlimited_v2_ += unlimited_v * unlimited_v;
    removed_v2_ += removed_v * removed_v;
  }
  /// Adds the sums of other ticks.
  void add(const LimitTally& other) noexcept {
    ticks_ += other.ticks_;
    limits_.add(other.limits_);
    gated_ += other.gated_;
    unlimited_v2_ += other.unlimited_v2_, removed_v2_ += other.removed_v2_;
  }
  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t amplitude_limited() const { return limits_.amplitude; }
  std::uint64_t slew_limited() const { return limits_.slew; }
  std::uint64_t energy_limited() const { return limits_.energy; }
  std::uint64_t gated() const { return gated_; }
  bool removed_any() const { return removed_v2_ > 0; }
  /// RMS of what amplitude, slew and energy limits removed, re RMS of the unlimited drive; at least -300.
  double removed_db() const {
    return unlimited_v2_ > 0 && removed_v2_ > 0
               ? std::max(schema::power_db(removed_v2_ / unlimited_v2_), -300.0)
               : -300.0;
  }

 private:
  std::uint64_t ticks_ = 0, gated_ = 0;
  LimitCounts limits_;
  double unlimited_v2_ = 0, removed_v2_ = 0;
};

}  // namespace tacto::playback
