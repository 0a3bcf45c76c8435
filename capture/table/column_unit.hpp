// SPDX-License-Identifier: GPL-3.0-or-later
// Units in the tables of other programs, in the name of a column or in a row below it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/quantity.hpp"

namespace tacto::capture {

/// Splits "Force (N)", "Weg [mm]", "F / N" into name and unit. The unit is empty if the name has none; the
/// part after a slash is a unit only if it is known.
struct NameWithUnit {
  std::string name, unit;
};
NameWithUnit split_unit(std::string_view name);

/// The unit for a text, with or without brackets, also with spellings such as "sec", "Volts", "m/s2".
/// `target` decides if two dimensions have the same symbol ("g"). nullopt for an unknown unit.
std::optional<schema::Unit> known_unit(std::string_view text, schema::Dimension target);
bool is_known_unit(std::string_view text);

/// Whether a field may be part of a row of units: empty, a dash, in brackets, or a known unit.
bool may_be_unit(std::string_view text);

}  // namespace tacto::capture
