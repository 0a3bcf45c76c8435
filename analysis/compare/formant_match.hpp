// SPDX-License-Identifier: GPL-3.0-or-later
// Matches the formants of two textures.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "data-schema/texture/formants.hpp"

namespace tacto::analysis {

struct FormantMatch {
  std::vector<std::pair<std::size_t, std::size_t>> matched;  ///< indices in A and in B
  std::vector<std::size_t> missed;                           ///< in A, not in B
  std::vector<std::size_t> extra;                            ///< in B, not in A
};

/// Goes through A's formants, strongest first, and matches each with the nearest unmatched frequency in B
/// within half the resolution (1.7268 / window, as for linking ridges). If `by_place`, their extents must
/// also overlap by half of the shorter one. Both lists use one position axis.
FormantMatch match_formants(std::span<const schema::Formant> a, std::span<const schema::Formant> b,
                            double resolution_per_m, bool by_place);

}  // namespace tacto::analysis
