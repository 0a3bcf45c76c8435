// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse filters for a transducer, and the error of each.
#pragma once

#include <cstdint>
#include <vector>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A filter that prepare() would make, with its error.
struct InverseChoice {
  Inverse inverse = Inverse::full;
  double delay_s = 0;
  std::uint16_t taps = 0;
  double error = 0;  ///< largest_inverse_error()

  /// The options with this filter.
  PrepareOptions in(PrepareOptions options) const;
};

/// All useful filters at this rate: full, of 8 to 128 taps and 0.5 to 4 ms (as far as the taps reach), and
/// the gain alone. `keep_inverse`: only the kind in the options. They are designed and judged here for this
/// transducer, not taken from a table, in some 0.2 s. In order of taps.
std::vector<InverseChoice> inverse_choices(const schema::Transducer& transducer,
                                           const PrepareOptions& options, bool keep_inverse);

}  // namespace tacto::playback
