// SPDX-License-Identifier: GPL-3.0-or-later
// One axis of a device with a virtual spring and damper, and the five limits by which it can be judged.
#pragma once

#include <optional>
#include <string>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "playback/stability/sampled_loop.hpp"

namespace tacto::analysis {

inline constexpr double kMostDelayTicks = 50;

/// What holds the device.
enum class Holder {
  nothing,  ///< computed by eigenvalues (playback/stability/free_limit.hpp)
  hand,     ///< one known hand, computed by eigenvalues (playback/stability/hand_limit.hpp)
  lumped,   ///< the same as Minsky 1990 computes it
  any,      ///< each passive hand, proved (playback/stability/passive_limit.hpp)
  slower,   ///< each passive hand below a speed, proved (same)
};

/// Proved limits are sufficient; computed ones are exact for the linear device without Coulomb friction and
/// encoder.
constexpr bool is_proof(Holder holder) {
  return holder == Holder::any || holder == Holder::slower;
}

/// Bodies are computed by the eigenvalues of the whole loop; no proof covers them.
constexpr bool is_computed_with_bodies(Holder holder) {
  return holder == Holder::nothing || holder == Holder::hand;
}

/// What the layers at one place add up to.
using VirtualLoad = playback::SampledLoad;

inline bool is_nothing(const VirtualLoad& load) {
  return load.stiffness_n_per_m <= 0 && load.damping_n_s_per_m <= 0 && load.bodies.empty();
}

struct JudgedLoop {
  schema::DeviceAxis axis;
  std::optional<schema::Hand> hand;
  std::optional<double> speed_mps;
  double period_s = 0, delay_s = 0;

  playback::TickTiming timing() const { return {period_s, delay_s / period_s}; }
  /// N/m at this virtual damping. Preconditions: a hand for `hand` and `lumped`, a speed for `slower`.
  double limit(Holder holder, double virtual_damping_n_s_per_m) const;
  /// The same beside the bodies of this load, too: by steps of 1.5 and bisection, from its stiffness on. NaN
  /// with bodies for a holder of which is_computed_with_bodies() is false.
  double limit(Holder holder, const VirtualLoad& load) const;
  bool carries(Holder holder, const VirtualLoad& load) const;
  /// The factor by which stiffness and damping, those of bodies included, together may grow; infinity for no
  /// load, 0 if none is small enough.
  double margin(Holder holder, const VirtualLoad& load) const;
  /// 0 if no period is short enough; with a delay the shortest tried is delay / 50.
  double greatest_period_s(Holder holder, const VirtualLoad& load) const;
  /// Infinity beyond 50 ticks; negative if it is not even stable without delay.
  double largest_delay_s(Holder holder, const VirtualLoad& load) const;

 private:
  bool is_stable(Holder holder, const VirtualLoad& load) const;
};

}  // namespace tacto::analysis
