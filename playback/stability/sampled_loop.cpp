// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/sampled_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "firmware-host/sim/planar/linear_motion.hpp"

namespace tacto::playback {
namespace {

using firmware_host::PlaceAndSpeed;

constexpr int kSquarings = 45;

class SquareMatrix {
 public:
  explicit SquareMatrix(std::size_t size) : size_(size), values_(size * size) {}
  double& at(std::size_t row, std::size_t column) { return values_[row * size_ + column]; }
  double* row(std::size_t row) { return values_.data() + row * size_; }
  std::size_t size() const { return size_; }

  SquareMatrix squared() const {
    SquareMatrix result(size_);
    for (std::size_t i = 0; i < size_; ++i)
      for (std::size_t k = 0; k < size_; ++k) {
        const double factor = values_[i * size_ + k];
        if (factor == 0) continue;
        for (std::size_t j = 0; j < size_; ++j) result.at(i, j) += factor * values_[k * size_ + j];
      }
    return result;
  }
  SquareMatrix scaled(double factor) const {
    SquareMatrix result = *this;
    for (double& value : result.values_) value *= factor;
    return result;
  }
  double norm() const {
    double sum = 0;
    for (const double value : values_) sum += value * value;
    return std::sqrt(sum);
  }
  double trace() const {
    double sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += values_[i * size_ + i];
    return sum;
  }

 private:
  std::size_t size_;
  std::vector<double> values_;
};

bool is_contraction(SquareMatrix power) {
  for (int i = 0; i < kSquarings; ++i) {
    const double norm = power.norm();
    if (norm < 1) return true;
    if (!std::isfinite(norm) || std::abs(power.trace()) > static_cast<double>(power.size())) return false;
    power = power.squared();
  }
  return false;
}

// In units of the mass and of the tick.
struct ScaledLoop {
  double viscous, hand_stiffness;
  SampledLoad load;
  double delay_ticks;

  ScaledLoop(const HeldMass& held, const TickTiming& timing, const SampledLoad& of)
      : load(of), delay_ticks(timing.delay_ticks) {
    const double mass = held.mass_kg, by_speed = timing.period_s / mass,
                 by_place = by_speed * timing.period_s;
    viscous = held.damping_n_s_per_m * by_speed;
    hand_stiffness = held.stiffness_n_per_m * by_place;
    load.stiffness_n_per_m *= by_place;
    load.damping_n_s_per_m *= by_speed;
    load.integral_n_per_m_s *= by_place * timing.period_s;
    load.integral_leak_per_s *= timing.period_s;
    for (CoupledBody& body : load.bodies) {
      body.mass_kg /= mass;
      body.own_damping_n_s_per_m *= by_speed;
      body.stiffness_n_per_m *= by_place;
      body.damping_n_s_per_m *= by_speed;
    }
  }
};

PlaceAndSpeed after_one(double mass, double damping, double stiffness, double time) {
  return firmware_host::LinearMotion{mass, damping, stiffness, 1, 0}.after({}, time);
}

constexpr std::size_t kPlace = 0, kSpeed = 1, kStep = 2, kIntegral = 3, kFirstBody = 4;

// All bodies are free.
SquareMatrix state_matrix(const ScaledLoop& loop) {
  const auto& [stiffness, damping, bodies, integral, leak] = loop.load;
  const auto whole = static_cast<std::size_t>(loop.delay_ticks);
  const std::size_t first_force = kFirstBody + 2 * bodies.size(), size = first_force + whole + 1;
  const double part = loop.delay_ticks - static_cast<double>(whole);
  const auto [g, h] = after_one(1, loop.viscous, loop.hand_stiffness, 1);
  const auto [g1, h1] = after_one(1, loop.viscous, loop.hand_stiffness, 1 - part);
  SquareMatrix matrix(size);

  std::vector<double> force(size);  // of this tick, by the state
  if (integral > 0) matrix.at(kIntegral, kPlace) = integral, matrix.at(kIntegral, kIntegral) = 1 - leak;
  force[kPlace] = -stiffness - matrix.at(kIntegral, kPlace);
  force[kIntegral] = -matrix.at(kIntegral, kIntegral);
  force[kStep] = -damping;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    force[kFirstBody + 2 * i] -= bodies[i].stiffness_n_per_m;
    force[kFirstBody + 2 * i + 1] += bodies[i].damping_n_s_per_m;
    force[kStep] -= bodies[i].damping_n_s_per_m;
  }
  const auto add_force = [&](double* row, std::size_t ticks_ago, double gain) {
    if (ticks_ago > 0) row[first_force + ticks_ago - 1] += gain;
    for (std::size_t j = 0; j < size && ticks_ago == 0; ++j) row[j] += gain * force[j];
  };
  double* const step = matrix.row(kStep);
  step[kPlace] = -loop.hand_stiffness * g;
  step[kSpeed] = h;
  add_force(step, whole, g1);
  add_force(step, whole + 1, g - g1);
  double* const speed = matrix.row(kSpeed);
  speed[kPlace] = -loop.hand_stiffness * h;
  speed[kSpeed] = 1 - loop.viscous * h - loop.hand_stiffness * g;
  add_force(speed, whole, h1);
  add_force(speed, whole + 1, h - h1);
  if (stiffness > 0 || loop.hand_stiffness > 0 || integral > 0) {
    std::copy_n(step, size, matrix.row(kPlace));
    matrix.at(kPlace, kPlace) += 1;
  }

  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto& [mass, own, coupling, coupling_damping, may_rest, semi_implicit] = bodies[i];
    const std::size_t way = kFirstBody + 2 * i, moves = way + 1;
    const double at_end = 1 / (mass + own);
    const auto [by_place, by_speed] =
        semi_implicit ? PlaceAndSpeed{at_end, at_end} : after_one(mass, own, 0, 1);
    double* const row = matrix.row(moves);
    row[way] = by_speed * coupling;
    row[kStep] = by_speed * coupling_damping;
    row[moves] = 1 - by_speed * (own + coupling_damping);
    if (!(coupling > 0)) continue;  // nothing depends on the distance to the hand
    double* const distance = matrix.row(way);
    std::copy_n(step, size, distance);
    distance[way] += 1 - by_place * coupling;
    distance[kStep] -= by_place * coupling_damping;
    distance[moves] -= mass * by_speed - by_place * coupling_damping;
  }
  for (std::size_t j = 0; j < size; ++j) matrix.at(first_force, j) = force[j];
  for (std::size_t i = first_force + 1; i < size; ++i) matrix.at(i, i - 1) = 1;
  return matrix;
}

}  // namespace

bool is_stable(const HeldMass& held, const TickTiming& timing, const SampledLoad& load) {
  const auto resting = std::ranges::find_if(load.bodies, &CoupledBody::may_rest);
  if (resting == load.bodies.end()) return is_contraction(state_matrix({held, timing, load}));
  SampledLoad at_rest = load, free = load;
  const auto i = resting - load.bodies.begin();
  free.bodies[static_cast<std::size_t>(i)].may_rest = false;
  at_rest.bodies.erase(at_rest.bodies.begin() + i);
  at_rest.stiffness_n_per_m += resting->stiffness_n_per_m;
  at_rest.damping_n_s_per_m += resting->damping_n_s_per_m;
  return is_stable(held, timing, free) && is_stable(held, timing, at_rest);
}

double growth_per_tick(const HeldMass& held, const TickTiming& timing, const SampledLoad& load) {
  SquareMatrix power = state_matrix({held, timing, load});
  double logarithm = 0, share = 1;  // of the tick that the power is scaled by
  for (int i = 0; i < kSquarings; ++i, share /= 2) {
    const double norm = power.norm();
    if (!(norm > 0)) return 0;
    logarithm += share * std::log(norm);
    power = power.scaled(1 / norm).squared();
  }
  return std::exp(logarithm);
}

}  // namespace tacto::playback
