// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/planar/planar_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tacto::firmware_host {

std::int32_t encoder_count(const schema::DeviceAxis& axis, double place_m) {
  if (!std::isfinite(place_m)) return std::numeric_limits<std::int32_t>::min();
  return static_cast<std::int32_t>(std::lround(place_m / axis.encoder_step_m));
}

PlanarBody::PlanarBody(const schema::Device& device, const schema::Hand& hand, double period_s)
    : device_(device), states_(device.axes.size()), push_n_(device.axes.size()), period_s_(period_s) {
  const double whole = std::floor(device.delay_s / period_s + 1e-9);
  late_ticks_ = static_cast<std::size_t>(whole);
  late_s_ = std::max(0.0, device.delay_s - whole * period_s);
  for (const schema::DeviceAxis& axis : device.axes)
    bodies_.push_back({axis.mass_kg + hand.mass_kg, axis.viscous_n_s_per_m + hand.damping_n_s_per_m,
                       axis.coulomb_n, 0, hand.stiffness_n_per_m});
}

void PlanarBody::rest_at(const std::vector<double>& place_m) {
  const std::vector<double> none(place_m.size());
  start_at(place_m, none, none);
}

void PlanarBody::start_at(const std::vector<double>& place_m, const std::vector<double>& speed_mps,
                          const std::vector<double>& push_n) {
  forces_n_.clear();
  push_n_ = push_n;
  for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = {place_m[i], speed_mps[i]};
}

double PlanarBody::force_of(std::size_t axis, std::size_t ticks_ago) const {
  return push_n_[axis] + (ticks_ago < forces_n_.size() ? forces_n_[ticks_ago][axis] : 0);
}

void PlanarBody::step(const std::vector<double>& force_n, const std::vector<double>& hand_from_m,
                      const std::vector<double>& hand_to_m) {
  forces_n_.push_front(force_n);
  if (forces_n_.size() > late_ticks_ + 2) forces_n_.pop_back();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const double speed_mps = (hand_to_m[i] - hand_from_m[i]) / period_s_;
    PlaceAndSpeed& state = states_[i];
    if (late_s_ > 0)
      state = moved(bodies_[i], state, force_of(i, late_ticks_ + 1), {hand_from_m[i], speed_mps}, late_s_);
    state = moved(bodies_[i], state, force_of(i, late_ticks_),
                  {hand_from_m[i] + speed_mps * late_s_, speed_mps}, period_s_ - late_s_);
    const schema::DeviceAxis& axis = device_.axes[i];
    if (state.place_m < axis.travel_from_m) state = {axis.travel_from_m, 0};
    if (state.place_m > axis.travel_to_m) state = {axis.travel_to_m, 0};
  }
}

std::int32_t PlanarBody::count(std::size_t axis) const {
  return encoder_count(device_.axes[axis], states_[axis].place_m);
}

}  // namespace tacto::firmware_host
