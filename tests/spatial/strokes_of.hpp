// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes and facts of positions in memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "spatial/strokes/position_facts.hpp"
#include "spatial/strokes/strokes.hpp"

namespace tacto::spatial {

inline ReadFrames reader_of(std::span<const double> position_m) {
  return [position_m](std::size_t first, std::span<double> out) -> schema::Result<void> {
    std::ranges::copy(position_m.subspan(first, out.size()), out.begin());
    return {};
  };
}

inline PositionFacts facts_of(std::span<const double> position_m, double sample_rate_hz,
                              std::span<const schema::Gap> gaps = {}) {
  double furthest_m = 0;
  for (const double x : position_m) furthest_m = std::max(furthest_m, std::abs(x));
  const auto pieces = pieces_between_gaps(position_m.size(), gaps);
  return *position_facts(reader_of(position_m), pieces, sample_rate_hz, furthest_m);
}

inline std::vector<Stroke> strokes_of(std::span<const double> position_m, double sample_rate_hz,
                                      std::span<const schema::Gap> gaps = {}) {
  const auto pieces = pieces_between_gaps(position_m.size(), gaps);
  return find_strokes(reader_of(position_m), pieces, sample_rate_hz,
                      facts_of(position_m, sample_rate_hz, gaps))
      ->strokes;
}

}  // namespace tacto::spatial
