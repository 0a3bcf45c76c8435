// SPDX-License-Identifier: GPL-3.0-or-later
// Text of other programs as UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace tacto::capture {

/// Whether the bytes are well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates).
bool is_utf8(std::string_view bytes);

/// The text as UTF-8: unchanged where it is that already, else read as Latin-1 (ISO 8859-1).
std::string to_utf8(std::string_view bytes);

}  // namespace tacto::capture
