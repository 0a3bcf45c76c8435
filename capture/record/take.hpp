// SPDX-License-Identifier: GPL-3.0-or-later
// Frames in memory, for calibrating.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct Take {
  schema::RecordingHeader header;          ///< channels as the device says them, without any calibration
  std::string device_name;                 ///< where a device was there to say it
  std::vector<std::vector<double>> codes;  ///< of each channel, as a recording stores them

  std::size_t frames() const { return codes.front().size(); }
};

/// A part of a recording: "oak", or "oak@1s..3s".
struct RecordingPart {
  std::string name;
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
};

/// Errors: usage: what follows the "@" is no span of time.
schema::Result<RecordingPart> parse_recording_part(const std::string& text);

/// Starts the device, passes over 0.1 s in which its filters settle, takes its frames for so long, and stops
/// it. At least 0.1 s. Errors: usage: a time that
/// is none; device: as of Device; frames lost, or a stream that ends early.
schema::Result<Take> take_from(firmware_host::Device& device, double time_s);

/// Errors: as open_recording(); unsuitable: no serial number (an import), numbers of another program, a part
/// that ends beyond the recording, a gap in it, less than 0.1 s of it.
schema::Result<Take> take_from(const RecordingPart& part);

/// A channel as its device says it, before calibration.
schema::Channel nominal(const schema::Channel& channel);

}  // namespace tacto::capture
