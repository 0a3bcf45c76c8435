// SPDX-License-Identifier: GPL-3.0-or-later
// Confirmation with the Enter key by the person at the bench.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// Prints the instruction to stderr and waits for a line on stdin. Errors: usage: stdin has ended.
schema::Result<void> wait_for_enter(const std::string& what_to_do);

/// Whether a line has arrived on stdin since the last call; does not wait. Errors: usage: stdin has ended.
schema::Result<bool> enter_was_pressed();

}  // namespace tacto::capture
