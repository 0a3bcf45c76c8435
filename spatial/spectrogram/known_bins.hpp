// SPDX-License-Identifier: GPL-3.0-or-later
// Which bins of a spectrogram's rows the recording knew.
#pragma once

#include <cstddef>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::spatial {

/// Bins from `first` up to, not including, `end`; none where they are equal.
struct BinRange {
  std::size_t first = 0, end = 0;
  bool holds(std::size_t bin) const { return first <= bin && bin < end; }
};

/// For each row the bins whose frequency its recording knew (known_band.hpp), and at least the resolution
/// away from the limits: where a band-pass ends, every slope has a maximum. From 2 / window on: under that a
/// window holds too little of a wave to tell it from a drift. All bins above that where the spectrogram does
/// not say what is known.
std::vector<BinRange> known_bins(const schema::Spectrogram& spectrogram);

}  // namespace tacto::spatial
