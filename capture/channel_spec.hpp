// SPDX-License-Identifier: GPL-3.0-or-later
// How people name a column to a channel: "tangential_force=lateral_V*0.444444N",
// "normal_force=normal_V*-0.31+1.6647N".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/quantity.hpp"

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

/// Reads COLUMN[*SCALE][+OFFSET|-OFFSET]UNIT. COLUMN is a name of `columns`, the longest that fits, or a
/// 1-based number; the unit holds for scale and offset both ("*-0.31+1.6647N"), and is left out only for a
/// dimension of none. Errors: usage, for a column that doesn't exist or a name that stands twice (with the
/// columns there are), a unit that is missing, unknown or of another quantity (with those that fit), a scale
/// of zero.
schema::Result<ScaledColumn> parse_scaled_column(std::string_view text, schema::Dimension dimension,
                                                 const std::vector<std::string>& columns);

/// Reads QUANTITY=... or LABEL:QUANTITY=..., the rest as parse_scaled_column(). Errors: usage, as there, and
/// for an unknown quantity (with those there are).
schema::Result<ChannelSpec> parse_channel(std::string_view text, const std::vector<std::string>& columns);

/// All channels of a recording. Errors: usage, as parse_channel(), and for two channels of one name.
schema::Result<std::vector<ChannelSpec>> parse_channels(const std::vector<std::string>& texts,
                                                        const std::vector<std::string>& columns);

}  // namespace tacto::capture
