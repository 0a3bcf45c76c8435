// SPDX-License-Identifier: GPL-3.0-or-later
// A device's calibration: what was found, when and how well, act by act, in SERIAL.calibration.json.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/folder_lock.hpp"

namespace tacto::schema {

/// One channel calibrated once. Uncertainties are standard ones (k = 1); `degrees_of_freedom` tells how far
/// they can be trusted. A stored number is what a recording's WAV holds: physical = (stored - zero) * scale.
struct CalibrationEntry {
  std::string channel, unit;    ///< the recording's channel, and the SI unit that it is in
  std::string method;           ///< "tare", "weights", "reference net_force", "released weight", "travel"
  std::string date;             ///< ISO 8601, UTC
  double nominal_scale = 1;     ///< the device's own then, unit per stored number
  std::optional<double> scale;  ///< unit per stored number
  std::optional<double> scale_uncertainty;
  std::optional<double> zero;  ///< the stored number at which the quantity is 0
  std::optional<double> zero_uncertainty;
  double degrees_of_freedom = 0;        ///< of the uncertainty; 0: not from scatter
  std::optional<double> noise_rms;      ///< in unit, of a tare
  std::optional<double> noise_density;  ///< in unit per root hertz, of a tare
  std::vector<std::string> notes;       ///< how the uncertainty was found, mains lines ...
};

struct CalibrationFile {
  std::string serial, device;             ///< of which device: its serial number and its name
  std::string simulated;                  ///< by what, where the device is emulated
  std::vector<CalibrationEntry> entries;  ///< the oldest first; none is ever taken out
  std::string extra_json, newer_version;
};

/// Where a device's file is kept unless told otherwise: calibrations/SERIAL.calibration.json in
/// $XDG_CONFIG_HOME/tactograph, or else in ~/.config/tactograph. What a file's name should not hold becomes
/// "_". Errors: unsuitable: a device without a serial number; not_found: neither variable is set.
Result<std::string> calibration_path(const std::string& serial);

/// By file name. Errors: not_found, malformed, unsupported_version.
Result<CalibrationFile> read_calibration(const std::string& path);

/// Whole or not at all; makes the folder. Errors: cannot_write; unsuitable: a number that is not finite.
Result<void> write_calibration(const std::string& path, const CalibrationFile& file);

/// Makes the file's folder and keeps others from changing what is in it: to be held from reading a file to
/// writing it with more in it, or one of two who calibrate at once loses his entries. Errors: cannot_write.
Result<FolderLock> lock_calibration(const std::string& path);

/// The channel's newest entry that has a scale, or a zero; nullptr where none has. Entries of one second: the
/// one that stands last.
const CalibrationEntry* newest_scale(const CalibrationFile& file, std::string_view channel);
const CalibrationEntry* newest_zero(const CalibrationFile& file, std::string_view channel);

/// From an ISO date or time ("2026-11-21T17:35:00Z", "2026-11-21") to another, in seconds; none where one is
/// no such date.
std::optional<double> seconds_between(const std::string& from, const std::string& to);

}  // namespace tacto::schema
