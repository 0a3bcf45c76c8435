// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of a real transducer that the paper's equations leave out, and of a finger on its tray.
#pragma once

#include <optional>

namespace tacto::firmware_host {

/// A part of the moving mass is on its own spring and damper. The static behaviour does not change: total
/// mass and static stiffness are those of the transducer. Wiertlewski 2011, section III-B, saw "a small
/// un-modeled resonance at 800 Hz" above one at 500 Hz. With the default share the first resonance falls from
/// the 548 Hz of Table I to 503 Hz.
struct SecondMode {
  double frequency_hz = 800;    ///< the second natural frequency of the system, undamped
  double damping_ratio = 0.03;  ///< of the inner spring and mass alone; ours
  double mass_share = 0.15;     ///< ours: of the moving mass
};

/// The pulp of a resting finger, attached to the tray: its mass moves with the tray, its spring and damper
/// are connected to the bone. About 1 N/mm with elasticity below 100 Hz and damping above, about 0.1 g
/// (Wiertlewski, Hayward 2012, "Mechanical behavior of the fingertip in the range of frequencies and
/// displacements relevant to touch"); chosen within that range so that the resonance falls by the 3 dB that
/// Wiertlewski 2011, section III-B, reports.
struct FingerLoad {
  double compliance_m_per_n = 1e-3;
  double corner_hz = 90;  ///< where damper and spring have equal force: damping = stiffness / (2 pi corner)
  double mass_share = 0.015;  ///< of the tray's mass
};

/// All off: only the paper's equations.
struct TrayPhysics {
  std::optional<SecondMode> second_mode = std::nullopt;
  std::optional<FingerLoad> finger_load =
      std::nullopt;  ///< of a driven tray; a recording finger is simulated in full
  /// Of the bender: the opening of the loop at zero voltage, relative to its height, when it is driven
  /// between its largest voltages. 0: none. Wiertlewski 2011, Figure 7: 0.16.
  double hysteresis = 0;
  /// Of the driven tray: the cut-off of an analog Butterworth low-pass of order 3 between converter and
  /// amplifier (Wiertlewski 2011: 600 Hz).
  std::optional<double> reconstruction_cutoff_hz = std::nullopt;
};

}  // namespace tacto::firmware_host
