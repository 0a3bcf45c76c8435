// SPDX-License-Identifier: GPL-3.0-or-later
// Which programs have a file or a device open, in words.
#pragma once

#include <string>
#include <string_view>

namespace tacto::schema {

/// "tactographd (process 4711)", all of them with commas; `otherwise` if none is found. This process is left
/// out, and so are those of other users, unless root asks.
std::string programs_with(const std::string& path, std::string_view otherwise);

}  // namespace tacto::schema
