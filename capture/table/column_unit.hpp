// SPDX-License-Identifier: GPL-3.0-or-later
// Units as other programs write them, over a column or under its name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/quantity.hpp"

namespace tacto::capture {

/// "Force (N)", "Weg [mm]", "F / N" in their parts. The unit is empty where the name has none; a part after
/// a slash is one only where it is known.
struct NameWithUnit {
  std::string name, unit;
};
NameWithUnit split_unit(std::string_view name);

/// What a unit is worth, in brackets or not, spelt as in "sec", "Volts", "m/s2". `wanted` decides where two
/// dimensions have one symbol ("g"). nullopt for one that is not known.
std::optional<schema::Unit> known_unit(std::string_view text, schema::Dimension target);
bool is_known_unit(std::string_view text);

/// Whether a field may be part of a row of units: empty, a dash, in brackets, or known.
bool may_be_unit(std::string_view text);

}  // namespace tacto::capture
