// SPDX-License-Identifier: GPL-3.0-or-later
// The description of a recording that is played as a device.
#pragma once

#include <string>
#include <vector>

#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::firmware_host {

/// Always flagged as simulated, because a replay is not a measurement. An empty `serial`: "replay". The
/// device has an output if the recording names a transducer.
wire::Welcome replay_welcome(const schema::Recording& recording, const std::string& serial);
std::vector<wire::Channel> replay_channels(const schema::RecordingHeader& header);
std::vector<wire::Note> replay_notes(const schema::Recording& recording);

}  // namespace tacto::firmware_host
