// SPDX-License-Identifier: GPL-3.0-or-later
// Frames in memory, for calibration.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct Take {
  schema::RecordingHeader header;  ///< with the channels that the device reports, without any calibration
  std::string device_name;         ///< empty if there was no device
  std::vector<std::vector<double>> codes;  ///< of each channel, as in a recording

  std::size_t frames() const { return codes.front().size(); }
};

/// A part of a recording: "oak", or "oak@1s..3s".
struct RecordingPart {
  std::string name;
  double from_s = 0;
  double to_s = std::numeric_limits<double>::infinity();
};

/// Errors: usage: the text after the "@" is not a time span.
schema::Result<RecordingPart> parse_recording_part(const std::string& text);

/// Starts the device, skips 0.1 s in which its filters settle, reads frames for `time_s`, and stops it. At
/// least 0.1 s. Errors: usage: a time out of range; device: as in Device; lost frames, or a stream that ends
/// early.
schema::Result<Take> take_from(firmware_host::Device& device, double time_s);

/// Errors: as open_recording(); unsuitable: no serial number (an import), numbers of another program, a part
/// that ends after the recording, a gap in it, or less than 0.1 s.
schema::Result<Take> take_from(const RecordingPart& part);

/// A channel with the nominal scale of its device, before calibration.
schema::Channel nominal(const schema::Channel& channel);

}  // namespace tacto::capture
