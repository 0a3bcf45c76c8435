// SPDX-License-Identifier: GPL-3.0-or-later
// What a recording says of itself when it is played out as a device.
#pragma once

#include <string>
#include <vector>

#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/wire/device_messages.hpp"

namespace tacto::firmware_host {

/// Flagged as simulated, whatever the recording was: what comes now is no measurement. An empty `serial`:
/// "replay". It has an output where the recording names a transducer.
wire::Welcome replay_welcome(const schema::Recording& recording, const std::string& serial);
std::vector<wire::Channel> replay_channels(const schema::RecordingHeader& header);
std::vector<wire::Note> replay_notes(const schema::Recording& recording);

}  // namespace tacto::firmware_host
