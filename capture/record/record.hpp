// SPDX-License-Identifier: GPL-3.0-or-later
// Records raw frames from a device to disk, without processing.
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
  std::string name;              ///< NAME.wav and NAME.json; existing files are never replaced
  std::optional<double> time_s;  ///< the duration; none: until `strokes` are made or stop() returns true
  std::size_t strokes = 0;       ///< ends after this many strokes; 0 for no limit
  std::string subject, finger, notes;
  std::string surface;                                 ///< empty: the surface that the device reports
  std::optional<schema::CalibrationFile> calibration;  ///< is written into the recording
  double stale_after_s = kStaleAfter_s;                ///< an older calibration causes a warning
};

/// Callbacks of a running recording. All are called on the thread of record(), between blocks of 20 ms; all
/// may be empty.
struct RecordHooks {
  std::function<void(double)> progress;  ///< fractions from 0 to 1, if a time is given
  /// Ten times a second at most.
  std::function<void(const LiveView&, const schema::RecordingHeader&)> view;
  std::function<bool()> stop;  ///< true ends the recording
  std::function<std::vector<std::string>()>
      new_marks;  ///< the labels of the marks requested since the last call
  /// A mark is set; its time is since the first frame, lost frames included.
  std::function<void(const schema::Mark&, double time_s)> marked;
};

struct Recorded {
  schema::Recording recording;
  std::vector<schema::Statistics> statistics;  ///< of each channel, in its unit
  firmware_host::StreamCounts counts;
  /// The reason of an early end: the device failed, or the disk is full. The frames before it are kept, and
  /// header.ended has the same reason. If header.ended is empty, the recording is complete, and the error is
  /// that the device could not be stopped.
  std::optional<schema::Error> ended_by;
};

/// Starts the device, streams its frames to NAME.wav as 32-bit codes, stops it, and closes the recording. One
/// thread reads the device, another writes and syncs; LiveRecording says which data survive a crash. The
/// volts of the transducer are scaled to newtons by its nominal gain (see sensor_in_newtons), then by the
/// calibration (apply_calibration); the counted strokes are written to the sidecar. A stream that ends early
/// results in a shorter recording with the reason. Memory: at most 16 MB of blocks, for any duration. Errors:
/// usage: a time that is not positive, or an existing file of that name; device: it failed before the first
/// frame, or has no transducer; unsuitable: another device's calibration; cannot_write: also if the disk has
/// no room for the time. After an error there is no recording, unless it could not be closed: then it can be
/// recovered.
schema::Result<Recorded> record(firmware_host::Device& device, const RecordRequest& request,
                                const RecordHooks& hooks = {});

}  // namespace tacto::capture
