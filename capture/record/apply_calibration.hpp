// SPDX-License-Identifier: GPL-3.0-or-later
// A device's calibration file, and its way into a recording.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/calibration/calibration.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// After this long a calibration is stale, unless told otherwise. Ours: piezo ceramics age by a per cent or
/// so per decade of time, strain gauges' zeros drift with the room.
inline constexpr double kStaleAfter_s = 30 * 86400.0;

/// A calibration may be dated so far ahead of now: two computers' clocks.
inline constexpr double kClockSlack_s = 86400;

/// Puts the newest scale and the newest zero of each channel into the header: scale, offset, range, and
/// where they come from. Gives what people should be told: a calibration older than `stale_after_s` at `now`
/// (ISO 8601), or dated after it, or made of another own scale of the device, which is not applied. A channel
/// that is calibrated already, a replay's, stays as it is. Errors: unsuitable: the calibration of another
/// device.
schema::Result<std::vector<std::string>> apply_calibration(schema::RecordingHeader& header,
                                                           const schema::CalibrationFile& calibration,
                                                           double stale_after_s, const std::string& now);

/// The device's file: `path` where that is given, else where calibration_path() says. None where nobody gave
/// a path and there is no file. Errors: as read_calibration(), calibration_path().
schema::Result<std::optional<schema::CalibrationFile>> calibration_of(const std::string& serial,
                                                                      const std::string& path);

/// Adds entries to the device's file, dated `now`, and makes it where there is none. Gives its path. Errors:
/// as calibration_of(); unsuitable: the file of another device; cannot_write.
schema::Result<std::string> keep_calibration(const schema::RecordingHeader& device, const std::string& name,
                                             std::vector<schema::CalibrationEntry> entries,
                                             const std::string& path, const std::string& now);

}  // namespace tacto::capture
