// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/extremes/extreme.hpp"

#include "data-schema/base/decibels.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tacto::analysis {

double Extreme::margin_db() const {
  constexpr double kLeast = 1e-300;  // gives a finite margin for an error of 0
  return schema::amplitude_db(most / std::max(error, kLeast));
}

std::vector<Extreme> all_extremes(bool all, const ExtremesProgress& progress) {
  const std::function<std::vector<Extreme>()> rooms[] = {
      capture_extremes,  filter_extremes,  [all] { return space_extremes(all); },
      spectrum_extremes, formant_extremes, inverse_extremes,
      kernel_extremes,   scene_extremes,   identify_compare_extremes};
  std::vector<Extreme> rows;
  for (std::size_t i = 0; i < std::size(rooms); ++i) {
    std::ranges::move(rooms[i](), std::back_inserter(rows));
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(std::size(rooms)));
  }
  return rows;
}

}  // namespace tacto::analysis
