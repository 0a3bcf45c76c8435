// SPDX-License-Identifier: GPL-3.0-or-later
// Units in tables, in the name of a column or in a row below it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/quantity.hpp"

namespace tacto::schema {

/// Splits "Force (N)", "Weg [mm]", "F / N", "x_mm", "force_n", "speed_cm_per_s", "speed_cm_s" into name and
/// unit. The unit is empty if the name has none; the part after a slash or underline is a unit only if it is
/// known. After an underline, names of this project's files count too: n, v, hz, mps, mps2, in small letters.
struct NameWithUnit {
  std::string name, unit;
};
NameWithUnit split_unit(std::string_view name);

/// The unit for a text, with or without brackets, also with spellings such as "sec", "Volts", "m/s2".
/// `target` decides if two dimensions have the same symbol ("g"). nullopt for an unknown unit.
std::optional<Unit> known_unit(std::string_view text, Dimension target);
bool is_known_unit(std::string_view text);

/// Whether a field may be part of a row of units: empty, a dash, in brackets, or a known unit.
bool may_be_unit(std::string_view text);

/// The text without spaces, tabs and carriage returns around it.
std::string_view without_blanks(std::string_view text);

}  // namespace tacto::schema
