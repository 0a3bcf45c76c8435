// SPDX-License-Identifier: GPL-3.0-or-later
// The main chain on five surfaces of the emulated device: record, texture, spectrogram, replay.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::analysis {

/// error = came(t + delay) - target(t), both signals filtered to the band; RMS without `settle_s` at both
/// ends.
struct ReplayError {
  double delay_s = 0;  ///< of `came` behind `target`, with the smallest error
  double error_rms = 0;
  double target_rms = 0;
  double error_db = 0;  ///< 20 log10(error_rms / target_rms)
};

/// The delay is searched within +-max_delay_s, to 1e-7 s, as a shift of the spectrum's phase. Preconditions:
/// same rate and length, longer than 2 settle_s; `target` has power in the band.
ReplayError replay_error(const schema::TimeSignal& came, const schema::TimeSignal& target,
                         const spatial::Band& band, double settle_s, double max_delay_s = 5e-3);

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

struct DemoSummary {
  std::vector<DemoSurface> surfaces;
  std::string simulated;  ///< origin of the simulation
  std::string page;       ///< path of index.html
  std::string recording;  ///< the one to work on
};

/// Writes into `folder` (created if it does not exist), for each surface A to E: a recording, a texture, its
/// spectrogram as picture and netCDF; one page about all; and `finger`, a recording of four strokes over E to
/// work on. Replaces the files of an earlier demo.
/// `progress` receives 0 to 1. Errors: cannot_write, and those of every step.
schema::Result<DemoSummary> run_demo(const std::string& folder, const std::function<void(double)>& progress);

}  // namespace tacto::analysis
