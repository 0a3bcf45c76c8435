// SPDX-License-Identifier: GPL-3.0-or-later
// Selects the measured choices that are worth their cost (Pareto front and knee).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"

namespace tacto::analysis {

/// The front of one knob: the rows that no other row beats. Costs within a tenth count as equal (two runs of
/// one choice differ by as much), and errors within 2 % or below 1e-6.
struct Worth {
  bool on_front = false;
  bool knee = false;      ///< the front's point farthest from the line between its ends, on logarithmic axes
  bool judged = true;     ///< error and cost were measured; otherwise a row is neither on a front nor beaten
  std::string beaten_by;  ///< a choice with no larger error or cost (time, memory, latency), one smaller
};

/// One for each row. Rows are compared within their knob. If a front has fewer than 3 choices, its knee is
/// the cheapest with an error below 1 %, if any; a knob with one choice has no knee.
std::vector<Worth> worth_of(std::span<const TradeRow> rows);

/// "the knee", "yes", "never: " and the choice that beats it, or "not judged".
std::string worth_words(const Worth& worth);

/// Summary of a knob: which choice is the knee, and how many are never worth their cost.
struct PlainAnswer {
  std::string knob, knee, never;
  std::optional<std::size_t> knee_row = {};  ///< index in the given rows
  std::size_t choices = 0, never_worth_it = 0;
};
std::vector<PlainAnswer> plain_answers(std::span<const TradeRow> rows);

}  // namespace tacto::analysis
