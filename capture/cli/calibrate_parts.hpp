// SPDX-License-Identifier: GPL-3.0-or-later
// The three kinds of calibration, and their common parts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/apply_calibration.hpp"
#include "capture/record/take.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/command/verb.hpp"

namespace tacto::capture {

/// Prints the instruction to stderr and waits for a line on stdin. Errors: usage: stdin has ended.
schema::Result<void> wait_for_enter(const std::string& what_to_do);

/// Whether a line has arrived on stdin since the last call; does not wait. Errors: usage: stdin has ended.
schema::Result<bool> enter_was_pressed();

/// The source of the frames and the destination of the result.
struct CalibrateOptions {
  std::string device = "usb:";
  std::string calibration;  ///< the file; empty: the default path of calibrations
  bool dry_run = false;
  bool anyway = false;  ///< keep implausible results, too
};

void declare_common(CLI::App& app, CalibrateOptions& options);

/// Each adds its options to a subcommand and returns the subcommand's action.
cli::Action declare_tare(CLI::App& app);
cli::Action declare_force(CLI::App& app);
cli::Action declare_encoder(CLI::App& app);

/// Adds "scale", its uncertainty, its 95 % interval and its ratio to the nominal scale. `unit` is "N" or "m".
void add_scale(cli::Report& report, const Uncertain& scale, double own_scale, const std::string& unit);

/// Writes the entries to the calibration file, except in a dry run, and adds the path to the report. An
/// implausible scale (scale_fault) causes a warning if nothing is written or `anyway` is set. Errors:
/// unsuitable: an implausible scale in any other case; as keep_calibration().
schema::Result<cli::Report> kept(cli::Report report, const CalibrateOptions& options, const Take& take,
                                 std::vector<schema::CalibrationEntry> entries);

/// The first lines of the report: which device it is.
cli::Report report_on(const Take& take);

}  // namespace tacto::capture
