// SPDX-License-Identifier: GPL-3.0-or-later
// A session as a table for other programs.
#pragma once

#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::playback {

/// Before any work is done: whether a session may be exported to `file`. Errors: usage, for an ending that
/// is not among those below, a file that is there and to be kept, or one that is no such table.
schema::Result<void> check_session_output(const std::string& file, schema::Existing existing);

/// By the file's ending: `.csv`, a line a tick; `.wav`, 64-bit float at the ticks' rate, drive in
/// volts, position and, where the tray has a sensor, its measured displacement in metres; `.nc`, netCDF-4
/// with units. Measured is the sensor's sample nearest to the tick, within half a period of the sensor's.
/// Time is that of the strokes in all of them: seconds since the session's first tick; what the device's
/// clock said is a column of its own
/// (`device_time_s`, in netCDF `device_time`). All of any length, in little memory; `progress` hears
/// fractions. Gives what there is to say of it, empty or a sentence: that a WAV holds periods in which there
/// was no tick, on a line between their neighbours. Errors: as reading; usage: another ending; unsuitable: a
/// WAV of a session with ticks missing, which it could not show, or with more periods without a tick than
/// with one (and half an hour of them); cannot_write; of check_session_output().
schema::Result<std::string> export_session(const std::string& session, const std::string& file,
                                           schema::Existing existing,
                                           const std::function<void(double)>& progress = {});

}  // namespace tacto::playback
