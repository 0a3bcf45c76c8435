// SPDX-License-Identifier: GPL-3.0-or-later
// The place of a number in the source, for messages.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tacto::capture {

/// Names a row of the source for messages: "line 17", "sample 16". Rows count from 0.
using PlaceOf = std::function<std::string(std::uint64_t row)>;

}  // namespace tacto::capture
