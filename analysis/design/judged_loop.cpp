// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/design/judged_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/design/boundary.hpp"
#include "playback/stability/free_limit.hpp"
#include "playback/stability/hand_limit.hpp"
#include "playback/stability/passive_limit.hpp"

namespace tacto::analysis {

double JudgedLoop::limit(Holder holder, double damping) const {
  switch (holder) {
    case Holder::nothing:
      if (damping > 0)
        return playback::stiffness_limit({axis.mass_kg, axis.viscous_n_s_per_m, 0}, timing(), damping);
      return playback::free_stiffness_limit(axis.mass_kg, axis.viscous_n_s_per_m, period_s,
                                            timing().delay_ticks);
    case Holder::hand:
      return playback::hand_stiffness_limit(axis, *hand, timing(), damping);
    case Holder::lumped:
      return playback::lumped_stiffness_limit(axis, *hand, timing(), damping);
    case Holder::any:
      return playback::passive_stiffness_limit(axis, timing(), damping);
    case Holder::slower:
      break;
  }
  return playback::passive_stiffness_limit(axis, timing(), damping, *speed_mps);
}

bool JudgedLoop::is_stable(Holder holder, const VirtualLoad& load) const {
  if (!is_computed_with_bodies(holder)) return false;
  const schema::Hand held = holder == Holder::hand ? *hand : schema::Hand();
  return playback::is_stable(
      {axis.mass_kg + held.mass_kg, axis.viscous_n_s_per_m + held.damping_n_s_per_m, held.stiffness_n_per_m},
      timing(), load);
}

double JudgedLoop::limit(Holder holder, const VirtualLoad& load) const {
  if (load.bodies.empty()) return limit(holder, load.damping_n_s_per_m);
  if (!is_computed_with_bodies(holder)) return NAN;
  VirtualLoad tried = load;
  return last_good(std::max(load.stiffness_n_per_m, 1.0), 1e-6, 1e9, [&](double stiffness) {
    tried.stiffness_n_per_m = stiffness;
    return is_stable(holder, tried);
  });
}

bool JudgedLoop::carries(Holder holder, const VirtualLoad& load) const {
  if (!load.bodies.empty()) return is_stable(holder, load);
  return is_nothing(load) || load.stiffness_n_per_m < limit(holder, load.damping_n_s_per_m);
}

double JudgedLoop::margin(Holder holder, const VirtualLoad& load) const {
  if (is_nothing(load)) return std::numeric_limits<double>::infinity();
  if (load.damping_n_s_per_m <= 0 && load.bodies.empty()) return limit(holder, 0) / load.stiffness_n_per_m;
  return last_good(1, 1e-6, 1e9, [&](double factor) {
    VirtualLoad grown = load;
    grown.stiffness_n_per_m *= factor;
    grown.damping_n_s_per_m *= factor;
    for (playback::CoupledBody& body : grown.bodies) {
      body.stiffness_n_per_m *= factor;
      body.damping_n_s_per_m *= factor;
    }
    return carries(holder, grown);
  });
}

double JudgedLoop::greatest_period_s(Holder holder, const VirtualLoad& load) const {
  const double shortest_s = std::max(1e-7, delay_s / kMostDelayTicks * kBoundaryStep);
  return last_good(period_s, shortest_s, 1e4, [&](double tried_s) {
    JudgedLoop other = *this;
    other.period_s = tried_s;
    return other.carries(holder, load);
  });
}

double JudgedLoop::largest_delay_s(Holder holder, const VirtualLoad& load) const {
  JudgedLoop other = *this;
  other.delay_s = 0;
  if (!other.carries(holder, load)) return -1;
  const double most_s = kMostDelayTicks * period_s / kBoundaryStep;
  return last_good(delay_s > 0 ? delay_s : period_s / 10, 1e-6 * period_s, most_s / kBoundaryStep,
                   [&](double tried_s) {
                     other.delay_s = tried_s;
                     return other.carries(holder, load);
                   });
}

}  // namespace tacto::analysis
