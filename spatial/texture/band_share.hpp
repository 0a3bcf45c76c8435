// SPDX-License-Identifier: GPL-3.0-or-later
// The RMS of what the band-pass in time removes from a recording, relative to what it passes.
#pragma once

#include <span>

#include "data-schema/base/error.hpp"
#include "spatial/strokes/touch_record.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {

/// RMS of the recorded values minus the filtered ones, about its mean, over the RMS of the filtered ones in
/// the same frames; each is the largest of all strokes.
struct BandShare {
  double whole = 0;   ///< in all frames of a stroke
  double inside = 0;  ///< in their middle half, without the steps of the force at start and stop
};

/// Without an equaliser. Each section between two gaps is filtered once. Errors: unsuitable, if frames are
/// missing inside a stroke; of check(filter, sample_rate_hz); of reading.
schema::Result<BandShare> band_share(const TouchRecord& record, const TimeFilter& filter,
                                     std::span<const Stroke> strokes);

}  // namespace tacto::spatial
