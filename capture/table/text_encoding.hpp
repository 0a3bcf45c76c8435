// SPDX-License-Identifier: GPL-3.0-or-later
// Conversion of other programs' text to UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace tacto::capture {

/// Whether the bytes are well-formed UTF-8 (RFC 3629: no overlong forms, no surrogates).
bool is_utf8(std::string_view bytes);

/// The text as UTF-8: unchanged if it is UTF-8 already, otherwise read as Latin-1 (ISO 8859-1).
std::string to_utf8(std::string_view bytes);

}  // namespace tacto::capture
