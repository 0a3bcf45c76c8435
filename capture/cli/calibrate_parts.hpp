// SPDX-License-Identifier: GPL-3.0-or-later
// The three ways to calibrate, and what they share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/apply_calibration.hpp"
#include "capture/record/take.hpp"
#include "data-schema/command/verb.hpp"

namespace tacto::capture {

/// Where frames come from, and where the result goes.
struct CalibrateOptions {
  std::string device = "usb:";
  std::string calibration;  ///< the file; empty: where calibrations are kept
  bool dry_run = false;
  bool anyway = false;  ///< also what can't be right
};

void declare_common(CLI::App& app, CalibrateOptions& options);

/// Each adds its options to a subcommand and gives what it does.
cli::Action declare_tare(CLI::App& app);
cli::Action declare_force(CLI::App& app);
cli::Action declare_encoder(CLI::App& app);

/// "scale", "scale_uncertainty", "interval of 95 %", against the device's own. `per` is the unit's ending.
void add_scale(cli::Report& report, const Uncertain& scale, double own_scale, const std::string& unit);

/// Keeps the entries unless it is a dry run, and says where. A scale that can't be right (doubt_of_scale) is
/// warned of where nothing is kept or `anyway` was said. Errors: unsuitable: one, else; as
/// keep_calibration().
schema::Result<cli::Report> kept(cli::Report report, const CalibrateOptions& options, const Take& take,
                                 std::vector<schema::CalibrationEntry> entries);

/// The report's first lines: whose calibration it is.
cli::Report report_on(const Take& take);

}  // namespace tacto::capture
