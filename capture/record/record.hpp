// SPDX-License-Identifier: GPL-3.0-or-later
// Frames from a device to a recording on disk, raw and as they come.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/record/apply_calibration.hpp"
#include "capture/record/live_view.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/statistics.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct RecordRequest {
  std::string name;              ///< NAME.wav and NAME.json, never over files that are there
  std::optional<double> time_s;  ///< how long; without it until strokes are made, or stop() says so
  std::size_t strokes = 0;       ///< ends after so many strokes; 0 for any number
  std::string subject, finger, notes;
  std::string surface;                                 ///< empty: what the device says lies on its tray
  std::optional<schema::CalibrationFile> calibration;  ///< the device's, to go into the recording
  double stale_after_s = kStaleAfter_s;                ///< an older calibration is warned of
};

/// What a recording under way is told, and tells. All are called on the thread that calls record(), between
/// blocks of 20 ms; all may be empty.
struct RecordHooks {
  std::function<void(double)> progress;  ///< fractions from 0 to 1, where a time is given
  /// Ten times a second at most.
  std::function<void(const LiveView&, const schema::RecordingHeader&)> view;
  std::function<bool()> stop;              ///< true ends the recording
  std::function<std::size_t()> new_marks;  ///< how many marks were asked for since the last call
};

struct Recorded {
  schema::Recording recording;
  std::vector<schema::Statistics> statistics;  ///< of each channel, in its unit
  firmware_host::StreamCounts counts;
  /// Why it ended, where it could not go on: the device failed, the disk is full. What came before is kept,
  /// and header.ended says the same. Where header.ended is empty the recording is whole, and the device did
  /// not stop.
  std::optional<schema::Error> ended_by;
};

/// Starts the device, streams its frames to NAME.wav as 32-bit codes, stops it, and closes the recording. One
/// thread reads the device, another writes and syncs: see LiveRecording for what survives what. The
/// transducer's volts are scaled to newtons by its nominal gain (see sensor_in_newtons), then as the
/// calibration says (apply_calibration); strokes as they were counted go into the sidecar. A stream that ends
/// early gives a shorter recording that says so. Memory: 16 MB of blocks at most, whatever the length.
/// Errors: usage: a time that is not positive, or something of that name; device: it failed before the first
/// frame, or has no transducer; unsuitable: another device's calibration; cannot_write: also where the disk
/// has no room for the time. After an error there is no recording, but where it could not be closed: then it
/// can be recovered.
schema::Result<Recorded> record(firmware_host::Device& device, const RecordRequest& request,
                                const RecordHooks& hooks = {});

}  // namespace tacto::capture
