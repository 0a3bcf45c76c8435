// SPDX-License-Identifier: GPL-3.0-or-later
// What a recording says of the device it came from.
#pragma once

#include "capture/record/record.hpp"

namespace tacto::capture {

/// A channel in volts at the transducer's output, read as newtons by its nominal gain: one figure, that of
/// 100 Hz. The response is not flat (for Wiertlewski 2011: 1.4 times as much at 300 Hz, four times at 500 Hz,
/// and a high-pass below 8 Hz); the channel's derivation says so. The codes stay what they were.
schema::Channel sensor_in_newtons(const schema::Channel& volts, const schema::Transducer& transducer);

/// The header of a recording about to begin. Errors: device, where a channel in volts comes without a
/// transducer.
schema::Result<schema::RecordingHeader> header_for(const firmware_host::Capabilities& capabilities,
                                                   const RecordRequest& request);

/// What the reader of a finished recording should be told: clipping, lost frames, an early end. Empty if all
/// went well.
std::vector<std::string> stream_warnings(const firmware_host::StreamCounts& counts,
                                         std::uint64_t frames_wanted);

}  // namespace tacto::capture
