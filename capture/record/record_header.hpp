// SPDX-License-Identifier: GPL-3.0-or-later
// The header of a recording from a device.
#pragma once

#include "capture/record/record.hpp"

namespace tacto::capture {

/// A channel in volts at the transducer's output, scaled to newtons by its nominal gain: one number, that of
/// 100 Hz. The response is not flat (for Wiertlewski 2011: 1.4 times at 300 Hz, four times at 500 Hz, and a
/// high-pass below 8 Hz); the derivation of the channel says so. The codes do not change.
schema::Channel sensor_in_newtons(const schema::Channel& volts, const schema::Transducer& transducer);

/// The header for a new recording. Errors: device, for a channel in volts without a transducer.
schema::Result<schema::RecordingHeader> header_for(const firmware_host::Capabilities& capabilities,
                                                   const RecordRequest& request);

/// Warnings for the reader of a finished recording: clipping, lost frames, an early end. Empty if there are
/// none.
std::vector<std::string> stream_warnings(const firmware_host::StreamCounts& counts,
                                         std::uint64_t frames_requested);

}  // namespace tacto::capture
