// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes the calibration file of a device, and applies it to a recording.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/calibration/calibration.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// The default age at which a calibration is reported as stale. Our choice: piezo ceramics age by about a per
/// cent per decade of time, and the zeros of strain gauges drift with the temperature.
inline constexpr int kStaleAfterDays = 30;
inline constexpr double kStaleAfter_s = kStaleAfterDays * 86400.0;

/// The date of a calibration may be this much in the future: the clocks of two computers differ.
inline constexpr double kClockSlack_s = 86400;

/// Writes the newest scale and the newest zero of each channel into the header: scale, offset, range, and
/// their origin. Returns warnings: a calibration older than `stale_after_s` at `now` (ISO 8601), one dated
/// after it, or one made with another nominal scale of the device, which is not applied. A channel that is
/// already calibrated, as in a replay, is not changed. Errors: unsuitable: the calibration of another device.
schema::Result<std::vector<std::string>> apply_calibration(schema::RecordingHeader& header,
                                                           const schema::CalibrationFile& calibration,
                                                           double stale_after_s, const std::string& now);

/// The device's file: `path` if it is given, otherwise calibration_path(). None if no path is given and no
/// file exists. Errors: as read_calibration(), calibration_path().
schema::Result<std::optional<schema::CalibrationFile>> calibration_of(const std::string& serial,
                                                                      const std::string& path);

/// Adds entries, dated `now`, to the device's file, which is created if it does not exist. Returns its path.
/// Errors: as calibration_of(); unsuitable: the file of another device; cannot_write.
schema::Result<std::string> keep_calibration(const schema::RecordingHeader& device, const std::string& name,
                                             std::vector<schema::CalibrationEntry> entries,
                                             const std::string& path, const std::string& now);

}  // namespace tacto::capture
