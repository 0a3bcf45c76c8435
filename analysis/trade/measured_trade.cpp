// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/measured_trade.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/trade/offline/offline_half.hpp"
#include "analysis/trade/realtime_half.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/machine_words.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

using schema::machine_words;

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

bool is_even(const schema::SpaceSignal& signal) {
  const auto [least, largest] = std::ranges::minmax_element(signal.values);
  return least == signal.values.end() || *least == *largest;
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

schema::Result<Trade> measure_trade(const schema::Texture& texture, const schema::Transducer& transducer,
                                    TradeHalves halves, const std::function<void(double)>& progress) {
  if (is_even(texture.signal))
    return schema::fail(schema::ErrorKind::unsuitable, "is constant: it has no error to measure",
                        "the texture", "use a texture that varies");
  Trade trade{{}, machine_words(), texture.simulated, {}};
  const double share = halves == TradeHalves::both ? 0.5 : 1;
  if (halves != TradeHalves::real_time) {
    auto rows = measure_offline(texture, [&](double part) { progress(share * part); });
    TACTO_TRY(rows);
    trade.halves.push_back({"offline", std::move(*rows)});
  }
  if (halves != TradeHalves::offline) {
    auto rows = measure_realtime(texture, transducer, [&](double part) { progress(1 - share * (1 - part)); });
    TACTO_TRY(rows);
    trade.halves.push_back({"real time", std::move(*rows)});
  }
  return trade;
}

schema::TradeTable measure_trade_table(const std::function<void(double)>& progress) {
  schema::TradeTable table;
  table.machine = machine_words();
  table.created = schema::creation_time();
  table.creator = kCreator;
  table.choices = measure_resampling();
  progress(0.5);
  table.choices.push_back(measure_grid());
  std::ranges::move(measure_spectrogram(), std::back_inserter(table.choices));
  progress(0.7);
  std::ranges::move(measure_reading_choices(), std::back_inserter(table.choices));
  return table;
}

}  // namespace tacto::analysis
