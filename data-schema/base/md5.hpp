// SPDX-License-Identifier: GPL-3.0-or-later
// MD5, the checksum inside other programs' files. It finds damage, and does not protect from forgery.
#pragma once

#include <string>
#include <string_view>

namespace tacto::schema {

/// In lower-case hexadecimal.
std::string md5_of(std::string_view bytes);

}  // namespace tacto::schema
