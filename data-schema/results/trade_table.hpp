// SPDX-License-Identifier: GPL-3.0-or-later
// The cost of the choices between speed and accuracy on a machine, and their errors: NAME.trade.json.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The error of a sine with so many samples a period: RMS of the error, re the sine's RMS.
struct ErrorPoint {
  double points_per_period = 0, error = 0;
};

struct MeasuredChoice {
  std::string stage;               ///< "resampling", "grid", "reading" ...
  std::string name;                ///< the choice: "linear"
  std::string per;                 ///< unit of the cost: "sample", "tick", "tap"
  double cost_ns = 0;              ///< CPU time, median
  double memory_bytes = 0;         ///< for each of `per`, if it needs any
  std::vector<ErrorPoint> errors;  ///< by rising points per period; empty if it has no error of its own

  /// The error at so many points a period: that of the nearest point below, an upper bound because errors
  /// fall with points; 1 below the first.
  double error_at(double points_per_period) const;
};

struct TradeTable {
  std::string machine;  ///< processor and build
  std::vector<MeasuredChoice> choices;
  std::string created, creator;
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};

  /// The choices of a stage, in the table's order.
  std::vector<MeasuredChoice> at(const std::string& stage) const;
};

/// NAME.trade.json, in full. Errors: not_found; malformed, also where points do not rise;
/// unsupported_version.
Result<TradeTable> read_trade_table(const std::string& path);

/// The file's text. Errors: unsuitable, where the schema does not allow it.
Result<std::string> trade_table_json(const TradeTable& table);

/// The table that ships with the program.
Result<TradeTable> shipped_trade_table();

/// The path of this machine's own table: $XDG_CONFIG_HOME/tactograph/machine.trade.json, under ~/.config
/// without that variable. Errors: not_found, if neither it nor HOME is set.
Result<std::string> machine_trade_path();

struct FoundTradeTable {
  TradeTable table;
  std::string
      origin;  ///< "measured on this machine (PATH)", or that it is the shipped one and what makes one
};

/// This machine's own table if there is one, else the shipped one. Errors: as of read_trade_table.
Result<FoundTradeTable> find_trade_table();

/// Writes the machine's own table and replaces an earlier one. Errors: cannot_write; unsuitable.
Result<std::string> write_machine_trade_table(const TradeTable& table);

}  // namespace tacto::schema
