// SPDX-License-Identifier: GPL-3.0-or-later
// Ticks as text for the control protocol: the payload of a session's block, in base64 (RFC 4648).
#pragma once

#include <span>
#include <string>

#include "data-schema/session/session.hpp"

namespace tacto::schema {

/// The payload of block 1, or of block 8 for ticks of a force device (SESSION.md). Precondition: at least one
/// tick, all of the same device, in order of time, within 4 s.
std::string ticks_base64(std::span<const SessionTick> ticks);

}  // namespace tacto::schema
