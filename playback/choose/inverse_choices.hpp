// SPDX-License-Identifier: GPL-3.0-or-later
// The filters that could undo a transducer, and what each leaves.
#pragma once

#include <cstdint>
#include <vector>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A filter that prepare() would make, judged.
struct InverseChoice {
  Inverse inverse = Inverse::full;
  double delay_s = 0;
  std::uint16_t taps = 0;
  double error = 0;  ///< largest_inverse_error()

  /// The options with this filter.
  PrepareOptions in(PrepareOptions options) const;
};

/// Every filter worth thinking of at this rate: full, of 8 to 128 taps and 0.5 to 4 ms (as far as the taps
/// reach), and the gain alone. `keep_inverse`: only of the kind that options name. Designed and judged here,
/// for this transducer, not taken from a table: some 0.2 s. By rising taps.
std::vector<InverseChoice> inverse_choices(const schema::Transducer& transducer,
                                           const PrepareOptions& options, bool keep_inverse);

}  // namespace tacto::playback
