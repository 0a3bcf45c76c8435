// SPDX-License-Identifier: GPL-3.0-or-later
// The known bins of each row of a spectrogram.
#pragma once

#include <cstddef>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::spatial {

/// Bins from `first` up to, not including, `end`; empty if they are equal.
struct BinRange {
  std::size_t first = 0, end = 0;
  bool holds(std::size_t bin) const { return first <= bin && bin < end; }
};

/// For each row the bins with known frequencies (known_band.hpp) that are at least the resolution away from
/// the limits, because every slope has a maximum where a band-pass ends. They begin at 2 / window: a window
/// has too few periods of lower frequencies to separate them from a drift. If the spectrogram has no known
/// band, all bins from there on.
std::vector<BinRange> known_bins(const schema::Spectrogram& spectrogram);

}  // namespace tacto::spatial
