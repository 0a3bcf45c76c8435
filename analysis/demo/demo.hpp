// SPDX-License-Identifier: GPL-3.0-or-later
// The main chain on five surfaces of the emulated device: record, texture, spectrogram, replay.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/demo/demo_page.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::analysis {

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
