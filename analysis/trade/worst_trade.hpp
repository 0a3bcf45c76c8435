// SPDX-License-Identifier: GPL-3.0-or-later
// Combines the trades of several textures: a choice for a scene has to serve each of its textures.
#pragma once

#include <vector>

#include "analysis/trade/trade_page.hpp"

namespace tacto::analysis {

/// For each choice that was measured on all textures: the largest error, cost and latency, and the sum of the
/// memory. Precondition: at least one trade, all with the same halves.
Trade worst_trade(const std::vector<Trade>& trades);

}  // namespace tacto::analysis
