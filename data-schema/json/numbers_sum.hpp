// SPDX-License-Identifier: GPL-3.0-or-later
// The checksum over the numbers of a sidecar that give its samples their meaning. Internal to data-schema.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {

/// SHA-256 of a recording or texture (`data.numbers_sha256`); nothing for other kinds. Covers the members
/// that numbers_sum.cpp lists for the kind: all their numbers, quantities and units, but no other text and no
/// member x_... For each of them, ordered by the bytes of its JSON pointer: pointer, line feed, then the
/// number as a little-endian float64, or the text and a line feed.
std::optional<std::string> numbers_sum(std::string_view kind, const Json& document);

}  // namespace tacto::schema
