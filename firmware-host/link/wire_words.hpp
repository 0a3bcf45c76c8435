// SPDX-License-Identifier: GPL-3.0-or-later
// Messages for the numbers of the protocol.
#pragma once

#include <string>
#include <string_view>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::firmware_host {

/// A message and its remedy.
struct FaultWords {
  std::string what, remedy;
};

/// "nothing was heard from the host for 1000 ticks". Codes of newer versions are given by their number.
FaultWords words_of(wire::FaultCode code, std::uint32_t detail);
/// Why a command was refused.
FaultWords words_of(wire::AnswerCode code, std::uint32_t detail);
std::string_view to_string(wire::DriveState state);
std::string_view to_string(wire::MessageType type);

}  // namespace tacto::firmware_host
