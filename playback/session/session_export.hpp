// SPDX-License-Identifier: GPL-3.0-or-later
// Exports a session as a table for other programs.
#pragma once

#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::playback {

/// Call before any computation: checks whether a session may be exported to `file`. Errors: usage, for
/// another ending than those below, an existing file that must not be replaced, or one that is not such a
/// table.
schema::Result<void> check_session_output(const std::string& file, schema::Existing existing);

/// The format follows from the file's ending: `.csv`, one line per tick; `.wav`, 64-bit float at the tick
/// rate: drive in volts, position and, if the tray has a sensor, its measured displacement in metres; `.nc`,
/// netCDF-4 with units. The measured value is the sensor's sample nearest to the tick, within half a period
/// of the sensor. Time is the same as in the strokes: seconds since the session's first tick; the device's
/// clock is a column of its own (`device_time_s`, in netCDF `device_time`). Sessions of any length need
/// little memory; `progress` receives fractions. Returns a note or an empty string: that a WAV contains
/// interpolated periods without a tick. Errors: as reading; usage: another ending; unsuitable: a WAV of a
/// session with missing ticks, which it could not show, or with more periods without a tick than with one
/// (and half an hour of them); cannot_write; of check_session_output().
schema::Result<std::string> export_session(const std::string& session, const std::string& file,
                                           schema::Existing existing,
                                           const std::function<void(double)>& progress = {});

}  // namespace tacto::playback
