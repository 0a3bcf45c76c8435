// SPDX-License-Identifier: GPL-3.0-or-later
// How people name a column to a channel: "tangential_force=lateral_V*0.444444N",
// "normal_force=normal_V*-0.31+1.6647N".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::capture {

/// A column and what its numbers are worth: physical = number * scale + offset, in the SI unit of a
/// dimension.
struct ScaledColumn {
  std::size_t column = 0;  ///< 0-based
  double scale = 1;
  double offset = 0;
};

/// A channel to be made of a column.
struct ChannelSpec {
  std::string name;      ///< the quantity, or the label before it
  std::string quantity;  ///< one of schema::quantity_names()
  schema::Dimension dimension = schema::Dimension::none;
  ScaledColumn source;
};

/// What a source calls its columns, and the units that it writes to them; both may be empty.
struct ColumnNames {
  ColumnNames(const std::vector<std::string>& their_names, std::vector<std::string> their_units = {})
      : names(their_names), units(std::move(their_units)) {
    units.resize(names.size());
  }
  std::vector<std::string> names, units;
};

/// Reads COLUMN[*SCALE][+OFFSET|-OFFSET]UNIT. COLUMN is a name of `columns`, the longest that fits, also
/// without the unit in it ("Force" of "Force (N)"), or a 1-based number; the unit holds for scale and offset
/// both
/// ("*-0.31+1.6647N"). It may be left out for a dimension of none, and where the column's own is known.
/// Errors: usage, for a column that doesn't exist or a name that several columns have (with the columns there
/// are), a unit that is missing, unknown or of another quantity (with those that fit), a scale of zero.
schema::Result<ScaledColumn> parse_scaled_column(std::string_view text, schema::Dimension dimension,
                                                 const ColumnNames& columns);

/// Reads QUANTITY=... or LABEL:QUANTITY=..., the rest as parse_scaled_column(). Errors: usage, as there, and
/// for an unknown quantity (with those there are).
schema::Result<ChannelSpec> parse_channel(std::string_view text, const ColumnNames& columns);

/// All channels of a recording. Errors: usage, as parse_channel(), and for two channels of one name.
schema::Result<std::vector<ChannelSpec>> parse_channels(const std::vector<std::string>& texts,
                                                        const ColumnNames& columns);

}  // namespace tacto::capture
