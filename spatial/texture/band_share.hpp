// SPDX-License-Identifier: GPL-3.0-or-later
// What the band-pass in time takes of a recording: how far what it lets pass is from what was recorded.
#pragma once

#include <span>

#include "data-schema/base/error.hpp"
#include "spatial/strokes/touch_record.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {

/// RMS of the recorded values less the filtered ones, about its mean, re the RMS of the filtered ones in the
/// same frames; each the largest of any stroke.
struct BandShare {
  double whole = 0;  ///< in all frames of a stroke
  double inside =
      0;  ///< in their middle half: the force's steps where a finger sets out and stops are outside
};

/// Without an equaliser. Filters once what lies between two gaps. Errors: unsuitable, where frames are
/// missing inside a stroke; of check(filter, sample_rate_hz); of reading.
schema::Result<BandShare> band_share(const TouchRecord& record, const TimeFilter& filter,
                                     std::span<const Stroke> strokes);

}  // namespace tacto::spatial
