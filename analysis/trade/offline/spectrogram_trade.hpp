// SPDX-License-Identifier: GPL-3.0-or-later
// Cost and error of each choice of a spectrogram.
#pragma once

#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// Varies resolution, hop, padding and window, one at a time, from the standard ones; references: see
/// measure_offline. Cost in ns per sample of the texture. Errors: those of spatial_spectrogram.
schema::Result<std::vector<TradeRow>> measure_spectrogram_trade(const schema::Texture& texture);

}  // namespace tacto::analysis
