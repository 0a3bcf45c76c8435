// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the measured choices are worth their cost.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"

namespace tacto::analysis {

/// Of the rows of one knob: those that no other beats. Costs that lie within a tenth count as alike (two runs
/// of one choice differ by as much); so do errors within 2 %, and below 1e-6.
struct Worth {
  bool on_front = false;
  bool knee = false;      ///< of the front: farthest from the line between its ends, on logarithmic axes
  bool judged = true;     ///< error and cost were measured; what was not is on no front and beaten by nobody
  std::string beaten_by;  ///< a choice that errs and costs no more (time, memory, latency), one of them less
};

/// One for each row. Rows are compared within their knob. A knob whose front has fewer than 3 choices has its
/// knee at the cheapest that errs by less than 1 %, where there is one; a knob of one choice has none.
std::vector<Worth> worth_of(std::span<const TradeRow> rows);

/// "the knee", "yes", "never: " and by what it is beaten, or "not judged".
std::string worth_words(const Worth& worth);

/// What people ask of a knob: which choice is the knee, and which are never worth it.
struct PlainAnswer {
  std::string knob, knee, never;
  std::optional<std::size_t> knee_row = {};  ///< of the rows that were asked about
  std::size_t choices = 0, never_worth_it = 0;
};
std::vector<PlainAnswer> plain_answers(std::span<const TradeRow> rows);

}  // namespace tacto::analysis
