// SPDX-License-Identifier: GPL-3.0-or-later
// A person at the bench who says when it is done.
#pragma once

#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// Prints what to do to stderr and waits for a line on stdin. Errors: usage: stdin has ended.
schema::Result<void> wait_for_enter(const std::string& what_to_do);

/// Whether a line has come on stdin since the last call; does not wait. Errors: usage: stdin has ended.
schema::Result<bool> enter_was_pressed();

}  // namespace tacto::capture
