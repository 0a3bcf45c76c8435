// SPDX-License-Identifier: GPL-3.0-or-later
// What each choice of a spectrogram costs and errs.
#pragma once

#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// Resolution, hop, padding and window round the standard ones; references: see measure_offline. Cost in ns a
/// sample of the texture. Errors: of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_trade(const schema::Texture& texture);

}  // namespace tacto::analysis
