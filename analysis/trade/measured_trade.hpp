// SPDX-License-Identifier: GPL-3.0-or-later
// Measures error and cost of the choices for one texture, and of all choices for the table from which the
// verbs choose.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/trade_page.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/results/trade_table.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// For each choice that was measured on all textures: the largest error, cost and latency, and the sum of the
/// memory. Precondition: at least one trade, all with the same halves.
Trade worst_trade(const std::vector<Trade>& trades);

enum class TradeHalves { both, offline, real_time };

/// The trade of one texture; takes about 20 s. Errors: those of measure_offline and measure_realtime.
schema::Result<Trade> measure_trade(const schema::Texture& texture, const schema::Transducer& transducer,
                                    TradeHalves halves, const std::function<void(double)>& progress);

/// Measures every stage of the table on this machine.
schema::TradeTable measure_trade_table(const std::function<void(double)>& progress);

}  // namespace tacto::analysis
