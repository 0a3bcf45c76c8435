// SPDX-License-Identifier: GPL-3.0-or-later
// Text that assigns a column to a channel: "tangential_force=lateral_V*0.444444N",
// "normal_force=normal_V*-0.31+1.6647N".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/physical_value.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::capture {

/// A column and the scale of its numbers.
struct ScaledColumn {
  std::size_t column = 0;  ///< 0-based
  double scale = 1;
  double offset = 0;
  std::string other_unit = {};  ///< of the column, if the text has another unit of the same quantity

  /// In the SI unit of the channel's dimension.
  double physical(double number) const { return schema::physical_value(number, scale, offset); }
};

/// A channel and its column.
struct ChannelSpec {
  std::string name;      ///< the quantity, or the label before it
  std::string quantity;  ///< one of schema::quantity_names()
  schema::Dimension dimension = schema::Dimension::none;
  ScaledColumn source;
};

/// The column names of a source, and the units that it gives for them; both may be empty.
struct ColumnNames {
  ColumnNames(const std::vector<std::string>& their_names, std::vector<std::string> their_units = {})
      : names(their_names), units(std::move(their_units)) {
    units.resize(names.size());
  }
  std::vector<std::string> names, units;
};

/// Reads COLUMN[*SCALE][+OFFSET|-OFFSET]UNIT. COLUMN is a 1-based number or a name of `columns`, the longest
/// that matches, also without its unit ("Force" for "Force (N)"). The unit applies to both scale and offset
/// ("*-0.31+1.6647N"); it may be left out if the dimension is none or if the column has a known unit. Errors:
/// usage, for a column that does not exist or a name that several columns have (with the list of columns), a
/// unit that is missing, unknown or of another quantity (with those that are possible), a scale of zero.
schema::Result<ScaledColumn> parse_scaled_column(std::string_view text, schema::Dimension dimension,
                                                 const ColumnNames& columns);

/// Reads QUANTITY=... or LABEL:QUANTITY=..., the rest as parse_scaled_column(). Errors: usage, as there, and
/// for an unknown quantity (with the list of quantities).
schema::Result<ChannelSpec> parse_channel(std::string_view text, const ColumnNames& columns);

/// All channels of a recording. Errors: usage, as parse_channel(), and for two channels of the same name.
schema::Result<std::vector<ChannelSpec>> parse_channels(const std::vector<std::string>& texts,
                                                        const ColumnNames& columns);

}  // namespace tacto::capture
