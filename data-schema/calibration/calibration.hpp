// SPDX-License-Identifier: GPL-3.0-or-later
// A device's calibration in SERIAL.calibration.json: each result with its date and uncertainty.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/folder_lock.hpp"

namespace tacto::schema {

/// One channel calibrated once. Uncertainties are standard ones (k = 1); `degrees_of_freedom` belongs to
/// them. A stored number is the number in a recording's WAV: physical = (stored - zero) * scale.
struct CalibrationEntry {
  std::string channel, unit;    ///< the recording's channel, and the SI unit that it is in
  std::string method;           ///< "tare", "weights", "reference net_force", "released weight", "travel"
  std::string date;             ///< ISO 8601, UTC
  double nominal_scale = 1;     ///< the device's own at that time, unit per stored number
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
  std::string serial, device;             ///< serial number and name of the device
  std::string simulated;                  ///< by what, where the device is emulated
  std::vector<CalibrationEntry> entries;  ///< the oldest first; entries are never removed
  std::string extra_json, newer_version;
  std::vector<std::string> unknown_members = {};
};

/// The default place of a device's file: calibrations/SERIAL.calibration.json in $XDG_CONFIG_HOME/tactograph,
/// or else in ~/.config/tactograph. Characters that a file name should not contain become "_". Errors:
/// unsuitable: a device without a serial number; not_found: neither variable is set.
Result<std::string> calibration_path(const std::string& serial);

/// By file name. Errors: not_found, malformed, unsupported_version.
Result<CalibrationFile> read_calibration(const std::string& path);

/// Whole or not at all; makes the folder. Errors: cannot_write; unsuitable: a number that is not finite.
Result<void> write_calibration(const std::string& path, const CalibrationFile& file);

/// Makes the file's folder and locks it against changes by others. Hold it from reading a file to writing it
/// with more entries; otherwise two calibrations at once lose entries. Errors: cannot_write.
Result<FolderLock> lock_calibration(const std::string& path);

/// The channel's newest entry with a scale, or with a zero; nullptr if there is none. Of entries of the same
/// second, the last one.
const CalibrationEntry* newest_scale(const CalibrationFile& file, std::string_view channel);
const CalibrationEntry* newest_zero(const CalibrationFile& file, std::string_view channel);

/// The time from one ISO date or time ("2026-11-21T17:35:00Z", "2026-11-21") to another, in seconds; none if
/// one of them is not a date.
std::optional<double> seconds_between(const std::string& from, const std::string& to);

}  // namespace tacto::schema
