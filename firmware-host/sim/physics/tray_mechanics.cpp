// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/tray_mechanics.hpp"

#include <cmath>
#include <numbers>

namespace tacto::firmware_host {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

TrayMechanics::TrayMechanics(const schema::Transducer& t, const TrayPhysics& physics)
    : mass_kg_(t.mass_kg),
      damping_n_s_per_m_(t.damping_n_s_per_m),
      stiffness_n_per_m_(t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m) {
  if (physics.second_mode) add(*physics.second_mode);
  if (physics.finger_load) add(*physics.finger_load, t.mass_kg);
}

void TrayMechanics::add(const SecondMode& mode) {
  const double w2 = std::pow(kTurn * mode.frequency_hz, 2);
  const double whole_kg = mass_kg_, inner_kg = mode.mass_share * whole_kg;
  mass_kg_ = whole_kg - inner_kg;
  inner_n_per_m_ =
      inner_kg * w2 * (stiffness_n_per_m_ - mass_kg_ * w2) / (stiffness_n_per_m_ - whole_kg * w2);
  inner_n_s_per_m_ = 2 * mode.damping_ratio * std::sqrt(inner_n_per_m_ * inner_kg);
  per_inner_mass_kg_ = 1 / inner_kg;
}

void TrayMechanics::add(const FingerLoad& load, double tray_kg) {
  const double stiffness_n_per_m = 1 / load.compliance_m_per_n;
  mass_kg_ += load.mass_share * tray_kg;
  stiffness_n_per_m_ += stiffness_n_per_m;
  damping_n_s_per_m_ += stiffness_n_per_m / (kTurn * load.corner_hz);
}

double least_second_mode_hz(const schema::Transducer& transducer, const SecondMode& mode) {
  return 1.05 * schema::resonance_hz(transducer) / std::sqrt(1 - mode.mass_share);
}

}  // namespace tacto::firmware_host
