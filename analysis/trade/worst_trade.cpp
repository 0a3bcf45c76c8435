// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/worst_trade.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::analysis {
namespace {

const TradeRow* same_choice(const TradeHalf& half, const TradeRow& row) {
  const auto found = std::ranges::find_if(
      half.rows, [&](const TradeRow& other) { return other.knob == row.knob && other.choice == row.choice; });
  return found == half.rows.end() ? nullptr : &*found;
}

// Both have the same fingers; a finger may be without an error (NaN) in one of them.
void take_worse(std::vector<ErrorAtSpeed>& errors, const std::vector<ErrorAtSpeed>& others) {
  for (std::size_t i = 0; i < std::min(errors.size(), others.size()); ++i)
    errors[i].error = std::fmax(errors[i].error, others[i].error);
}

void take_worse(TradeRow& row, const TradeRow& other) {
  if (other.is_judged() && !(other.error <= row.error)) row.note = other.note;
  row.error = std::fmax(row.error, other.error);
  take_worse(row.by_speed, other.by_speed);
  row.cost_ns = std::max(row.cost_ns, other.cost_ns);
  row.latency_s = std::max(row.latency_s, other.latency_s);
  row.memory_bytes += other.memory_bytes;
}

TradeHalf worse_half(const TradeHalf& half, const TradeHalf& other) {
  TradeHalf both{half.name, {}};
  for (TradeRow row : half.rows)
    if (const TradeRow* same = same_choice(other, row)) {
      take_worse(row, *same);
      both.rows.push_back(std::move(row));
    }
  return both;
}

}  // namespace

Trade worst_trade(const std::vector<Trade>& trades) {
  Trade worst = trades.front();
  for (std::size_t i = 1; i < trades.size(); ++i) {
    for (std::size_t half = 0; half < worst.halves.size(); ++half)
      worst.halves[half] = worse_half(worst.halves[half], trades[i].halves[half]);
    if (worst.simulated.empty()) worst.simulated = trades[i].simulated;
  }
  return worst;
}

}  // namespace tacto::analysis
