// SPDX-License-Identifier: GPL-3.0-or-later
// The moving part of the transducer: its acceleration under a force.
#pragma once

#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"

namespace tacto::firmware_host {

struct TrayMotion {
  double tray_m = 0, tray_mps = 0;
  double inner_m = 0, inner_mps = 0;  ///< the inner mass of the second mode
};

/// m x'' + b_r x' + (k_r + k_p) x = f, Wiertlewski 2011, equation (1). With a second mode, a share of m is an
/// inner mass at y, and
///   m_1 x'' = f - b_r x' - (k_r + k_p) x + k_2 (y - x) + c_2 (y' - x'),
///   m_2 y'' = -k_2 (y - x) - c_2 (y' - x'),
/// where k_2 = m_2 w^2 (k - m_1 w^2) / (k - m w^2) sets the second undamped natural frequency to w (exact).
/// With a finger's load, its mass, damper and spring are added to those of the tray.
class TrayMechanics {
 public:
  /// Precondition: the second mode is above the resonance of the remaining mass.
  explicit TrayMechanics(const schema::Transducer& transducer, const TrayPhysics& physics = {});

  double tray_mps2(const TrayMotion& s, double force_n) const {
    return (force_n - damping_n_s_per_m_ * s.tray_mps - stiffness_n_per_m_ * s.tray_m + inner_pull_n(s)) /
           mass_kg_;
  }
  double inner_mps2(const TrayMotion& s) const { return -inner_pull_n(s) * per_inner_mass_kg_; }
  double stiffness_n_per_m() const { return stiffness_n_per_m_; }

 private:
  void add(const SecondMode& mode);
  void add(const FingerLoad& load, double tray_kg);
  double inner_pull_n(const TrayMotion& s) const {
    return inner_n_per_m_ * (s.inner_m - s.tray_m) + inner_n_s_per_m_ * (s.inner_mps - s.tray_mps);
  }

  double mass_kg_, damping_n_s_per_m_, stiffness_n_per_m_;
  double inner_n_per_m_ = 0, inner_n_s_per_m_ = 0, per_inner_mass_kg_ = 0;
};

/// The lowest second frequency that is possible with this share of the mass, in Hz: 5 % above the tray's
/// resonance without that share.
double least_second_mode_hz(const schema::Transducer& transducer, const SecondMode& mode);

}  // namespace tacto::firmware_host
