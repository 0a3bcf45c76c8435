// SPDX-License-Identifier: GPL-3.0-or-later
// Several textures' trades as one: what serves a scene has to serve each of its textures.
#pragma once

#include <vector>

#include "analysis/trade/trade_page.hpp"

namespace tacto::analysis {

/// For each choice that was measured on all of them the largest error, cost and latency, and the memory of
/// all together. Precondition: at least one, all of the same halves.
Trade worst_trade(const std::vector<Trade>& trades);

}  // namespace tacto::analysis
