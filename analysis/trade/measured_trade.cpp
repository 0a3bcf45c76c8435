// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/measured_trade.hpp"

#include <algorithm>
#include <iterator>

#include "analysis/trade/offline/offline_half.hpp"
#include "analysis/trade/realtime_half.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/machine_words.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

using schema::machine_words;

bool is_even(const schema::SpaceSignal& signal) {
  const auto [least, largest] = std::ranges::minmax_element(signal.values);
  return least == signal.values.end() || *least == *largest;
}

}  // namespace

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
