// SPDX-License-Identifier: GPL-3.0-or-later
// The values of a record after the band-pass in time, only for the requested strokes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "spatial/strokes/frame_range.hpp"
#include "spatial/strokes/touch_source.hpp"
#include "spatial/texture/block_time_filter.hpp"

namespace tacto::spatial {

/// Filters each section between two gaps as a whole and holds only the requested frames. Requests ordered by
/// time are fast; a request before the last one filters its piece again from the beginning.
class FilteredTrack {
 public:
  FilteredTrack(double sample_rate_hz, const TimeFilter& filter, SpectralGain equaliser,
                Track track = Track::value);

  /// Filtered values of `frames`, which are inside `piece`, a section of `source` between two gaps; valid
  /// until the next call. All calls have the same source. Errors: of check(filter, sample_rate_hz); of
  /// reading.
  schema::Result<std::span<const double>> values(TouchSource& source, FrameRange piece, FrameRange frames);

 private:
  schema::Result<void> begin(FrameRange piece);
  void drop_before(std::size_t frame);
  schema::Result<void> advance(TouchSource& source);

  double sample_rate_hz_;
  TimeFilter filter_;
  SpectralGain equaliser_;
  Track track_;
  FrameRange piece_;
  std::optional<BlockTimeFilter> stream_;
  std::size_t next_ = 0;       // the frame to feed next
  std::size_t kept_from_ = 0;  // the frame of kept_[0]
  std::vector<double> kept_, chunk_;
};

}  // namespace tacto::spatial
