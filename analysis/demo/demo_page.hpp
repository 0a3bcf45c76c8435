// SPDX-License-Identifier: GPL-3.0-or-later
// The demo's page: every picture and figure in one HTML file that needs nothing beside it.
#pragma once

#include <string>
#include <vector>

namespace tacto::analysis {

/// What the demo measured on one surface. All of it comes from the emulated device.
struct DemoSurface {
  std::string surface;      ///< "A" ... "E"
  std::string simulated;    ///< by what
  std::string description;  ///< how Table II of the paper says it was made
  double record_speed_mps = 0;
  double replay_speed_mps = 0;  ///< mean of |speed| along the replayed path
  double force_rms_n = 0;       ///< of the texture
  double peak_position_m = 0;   ///< where the spectrogram is strongest
  double peak_frequency_per_m = 0;
  double gain_m_per_n = 0;  ///< displacement for force
  double drive_peak_v = 0;
  double target_rms_m = 0;
  double error_rms_m = 0;       ///< displacement that came less the wanted one, 15-500 Hz, delay taken out
  double error_db = 0;          ///< error_rms_m over wanted_rms_m
  double delay_s = 0;           ///< of the displacement behind the wanted one
  std::string spectrogram_svg;  ///< pictures, as SVG text
  std::string replay_svg;
};

/// The page. `simulated` says by what, at the top; each surface says it again, with its particulars.
std::string demo_page(const std::vector<DemoSurface>& surfaces, const std::string& simulated);

}  // namespace tacto::analysis
