// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of the simulated fingertip.
#pragma once

namespace tacto::firmware_host {

/// A pulp (mass, spring, damper) that the bone carries tangentially, with elastic skin ridges on its contact
/// patch. Spacing, jitter, patch, friction and the pulp's three constants are chosen together to reproduce
/// the paper's Figure 1 (a second harmonic above the fundamental on a triangular grating, with
/// sub-harmonics); with the damping of a living pulp the sub-harmonics disappear. The paper itself says "of
/// the order of 1e3 N/m" (section III-A).
struct FingerParameters {
  double stiffness_n_per_m = 1510;
  double damping_n_s_per_m = 0.205;
  double mass_kg = 2.85e-3;

  double patch_m = 4.4e-3;
  double ridge_spacing_m = 0.353e-3;
  double ridge_jitter = 0.1;  ///< of the spacing, RMS

  /// Normal to the surface, of each of the patch's twelve ridges: its share of 0.5 N compresses a ridge by 8
  /// um.
  double ridge_stiffness_n_per_m = 5000;
  /// Skin bridges features that are narrower than its contact: the width of each of three running means over
  /// the surface.
  double ridge_width_m = 0.1e-3;

  double friction = 0.92;      ///< force over load when sliding
  double static_ratio = 1.7;   ///< static over sliding friction
  double stribeck_mps = 2e-3;  ///< speed at which half of the excess remains
  /// LuGre bristles: skin on plastic deflects by about 10 um before it slides.
  double bristle_stiffness_per_m = 1e5;  ///< friction coefficient over bristle deflection
  double bristle_damping_s_per_m = 5;    ///< friction coefficient over rate of deflection
};

}  // namespace tacto::firmware_host
