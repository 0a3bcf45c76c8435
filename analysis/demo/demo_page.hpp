// SPDX-License-Identifier: GPL-3.0-or-later
// The demo's page: every picture and figure in one HTML file that needs no other files.
#pragma once

#include <string>
#include <vector>

namespace tacto::analysis {

/// The demo's results for one surface, all from the emulated device.
struct DemoSurface {
  std::string surface;      ///< "A" ... "E"
  std::string simulated;    ///< origin of the simulation
  std::string description;  ///< how the surface was made, from Table II of the paper
  double record_speed_mps = 0;
  double replay_speed_mps = 0;  ///< mean of |speed| along the replayed path
  double force_rms_n = 0;       ///< of the texture
  double peak_position_m = 0;   ///< where the spectrogram is strongest
  double peak_frequency_per_m = 0;
  double gain_m_per_n = 0;  ///< displacement for force
  double drive_peak_v = 0;
  double target_rms_m = 0;
  double error_rms_m = 0;       ///< displacement minus target, 15-500 Hz, delay removed
  double error_db = 0;          ///< error_rms_m over target_rms_m
  double delay_s = 0;           ///< of the displacement behind the target
  std::string spectrogram_svg;  ///< pictures, as SVG text
  std::string replay_svg;
};

/// The page. Its top has the origin `simulated`; each surface repeats it with its details.
std::string demo_page(const std::vector<DemoSurface>& surfaces, const std::string& simulated);

}  // namespace tacto::analysis
