// SPDX-License-Identifier: GPL-3.0-or-later
// Which formants of one texture are in another.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "data-schema/texture/formants.hpp"

namespace tacto::analysis {

struct FormantMatch {
  std::vector<std::pair<std::size_t, std::size_t>> matched;  ///< of A and of B
  std::vector<std::size_t> missed;                           ///< of A, not in B
  std::vector<std::size_t> extra;                            ///< of B, not in A
};

/// Strongest of A first, each takes the nearest in frequency of B that is left, at most half the resolution
/// away (1.7268 / window: as ridges are linked); where `by_place`, their extents also overlap by half of the
/// shorter. Both lists on one axis of position.
FormantMatch match_formants(std::span<const schema::Formant> a, std::span<const schema::Formant> b,
                            double resolution_per_m, bool by_place);

}  // namespace tacto::analysis
