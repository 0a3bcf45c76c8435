// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/hand_limit.hpp"

#include <algorithm>

#include "playback/stability/free_limit.hpp"

namespace tacto::playback {

double hand_stiffness_limit(const schema::DeviceAxis& axis, const schema::Hand& hand,
                            const TickTiming& timing, double virtual_damping_n_s_per_m) {
  const HeldMass held{axis.mass_kg + hand.mass_kg, axis.viscous_n_s_per_m + hand.damping_n_s_per_m,
                      hand.stiffness_n_per_m};
  return stiffness_limit(held, timing, virtual_damping_n_s_per_m);
}

double lumped_stiffness_limit(const schema::DeviceAxis& axis, const schema::Hand& hand,
                              const TickTiming& timing, double virtual_damping_n_s_per_m) {
  const double damping = axis.viscous_n_s_per_m + hand.damping_n_s_per_m + virtual_damping_n_s_per_m;
  const double all =
      free_stiffness_limit(axis.mass_kg + hand.mass_kg, damping, timing.period_s, timing.delay_ticks);
  return std::max(0.0, all - hand.stiffness_n_per_m);
}

}  // namespace tacto::playback
