// SPDX-License-Identifier: GPL-3.0-or-later
// Frames from a device to a recording on disk, raw and as they come.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/recording.hpp"
#include "data-schema/statistics.hpp"
#include "firmware-host/device.hpp"

namespace tacto::capture {

struct RecordRequest {
  std::string name;   ///< NAME.wav and NAME.json, never over files that are there
  double time_s = 0;  ///< how long
  std::string subject, finger, notes;
  std::string surface;  ///< empty: what the device says lies on its tray
};

struct Recorded {
  schema::Recording recording;
  std::vector<schema::Statistics> statistics;  ///< of each channel, in its unit
  firmware_host::StreamCounts counts;
};

/// Starts the device, streams `time_s` of frames to NAME.wav as 32-bit codes, stops it, and closes the
/// recording. The transducer's volts are scaled to newtons by its nominal gain (see sensor_in_newtons). A
/// stream that ends early gives a shorter recording with a warning in it. `progress`, where given, hears
/// fractions from 0 to 1. Errors: usage: a time that is not positive, or a recording of that name; device: it
/// failed, or has no transducer; cannot_write. After an error there is no recording.
schema::Result<Recorded> record(firmware_host::Device& device, const RecordRequest& request,
                                const std::function<void(double)>& progress = {});

}  // namespace tacto::capture
