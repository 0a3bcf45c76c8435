// SPDX-License-Identifier: GPL-3.0-or-later
// Counts the ticks in which a limit changed the drive, from arming to disarming, with the onset and the
// release.
#pragma once

#include <cstdint>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::playback {

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

}  // namespace tacto::playback
